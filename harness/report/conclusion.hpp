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

// "18 of 20 vectors failed, 1 passed; 1 need --level exact (px4-v1.5.5, numeric, 1 rate) in 1.2 s".
// `duration` is " in 1.2 s", or empty.
std::string conclusion_text(const RunResult& run, std::string_view duration = {});

// The vectors that neither passed nor failed, with their reasons. Ends with an empty line; empty if
// there are no such vectors.
std::string counted_apart_text(const RunResult& run);

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
