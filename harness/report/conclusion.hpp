// The conclusion of a run, the same in every report for people.
#pragma once

#include <string>
#include <string_view>

#include "harness/verify/run_result.hpp"

namespace attest {

enum class Conclusion {
  pass,  // no vector failed, no error occurred, and at least one vector passed
  fail,
  none  // no failure and no error, but no vector passed
};

Conclusion conclusion_of(const RunResult& run);
std::string_view name_of(Conclusion conclusion);  // "PASS"

// "18 failed; 1 of 20 vectors conform, 1 skip (px4-v1.5.5, numeric, 1 rate) in 1.2 s". `duration`
// is " in 1.2 s", or empty.
std::string conclusion_text(const RunResult& run, std::string_view duration = {});

// "first stage to differ: attitude law in 18, mixer in 2": the number of first deviations in each
// stage. Empty without a deviation.
std::string first_stages(const RunResult& run);

}  // namespace attest
