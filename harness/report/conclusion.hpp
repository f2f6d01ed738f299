// The conclusion and the diagnosis of a run, the same in every report for people.
#pragma once

#include <string>
#include <string_view>

#include "harness/diagnosis/diagnose.hpp"
#include "harness/verify/run_result.hpp"

namespace attest {

// fail: a vector failed, or an error occurred. stopped: it was not run to its end. pass: at least
// one vector passed. none: all others.
Conclusion conclusion_of(const RunResult& run);

// Why a vector that was not judged does not apply to the port: "it has no module mixer (extension
// attest.mixer.v1)". Empty for other vectors.
std::string_view why_not_applicable(const VectorResult& result);

// "18 of 20 vectors failed, 1 passed; 1 need --level exact (px4-v1.5.5, numeric, 1 rate) in 1.2 s".
// `duration` is " in 1.2 s", or empty.
std::string conclusion_text(const RunResult& run, std::string_view duration = {});

// "first stage to differ: attitude law in 18 vectors, mixer in 2 vectors": the number of first
// deviations in each stage. Empty without a deviation.
std::string first_stages(const RunResult& run);

// "rate law: values about yaw have the other sign, only where ..."
std::string pattern_text(const Pattern& pattern);

// "it looks like:\n  `quat-order-xyzw`: ...", and the most specific failing case with its purpose;
// each with a newline at its end, or empty.
std::string mistakes_text(const Diagnosis& diagnosis);
std::string specific_case_text(const Diagnosis& diagnosis);

// Both, in this order.
std::string diagnosis_text(const Diagnosis& diagnosis);

// "the port declares that it lacks tpa, but it has that"; empty if all declarations are true.
std::string needless_lacks_text(const RunResult& run);

}  // namespace attest
