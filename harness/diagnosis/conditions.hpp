// The conditions that may separate the ticks at which a port deviates from the others.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "harness/loop/open_loop.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// What a condition is about: the state of the law, such as an error, an input alone, or a
// parameter, which is the same at all ticks of a vector. The later ones hold more often by chance.
enum class ConditionKind : std::uint8_t { law, input, parameter };

struct Condition {
  std::string text;  // "the tilt error exceeds 90 deg"
  // Whether it holds at a tick, for an output about `axis` (OutputsOf::axis).
  std::function<bool(std::size_t tick, int axis)> holds;
  ConditionKind kind = ConditionKind::law;
};

// Those of the law come first, then those of the parameters of the trace, then those of each input.
// `trace` has the inputs and the expected outputs of a vector, and must outlive the result.
std::vector<Condition> conditions_of(const Trace& trace, const ModuleUnderTest& subject);

}  // namespace attest
