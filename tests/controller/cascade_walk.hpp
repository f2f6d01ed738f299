// Random flights of the two units of the cascade, that reach every part of the law: quiet ones, in
// which states settle, and restless ones; half turns, poles, other norms, NaN, changed parameters.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "controller/attest_cascade.h"

namespace attest::test {

using Setting = std::pair<std::string_view, float>;  // a parameter

template <typename Inputs>
struct WalkStep {
  Inputs in{};
  std::optional<Setting> set;  // before the step
};

template <typename Inputs>
struct Walk {
  std::vector<Setting> parameters;  // before the first step
  std::vector<WalkStep<Inputs>> steps;
};

// The same ones in each call.
std::vector<Walk<attest_attitude_inputs>> attitude_walks();
std::vector<Walk<attest_rate_inputs>> rate_walks();

}  // namespace attest::test
