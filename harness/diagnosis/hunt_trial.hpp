// Judges a port in a trial of a hunt.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "harness/diagnosis/hunt_generator.hpp"
#include "harness/diagnosis/hunt_trace.hpp"
#include "harness/host/port_host.hpp"
#include "harness/verify/verdict.hpp"

namespace attest {

// What a trial showed.
struct HuntTrial {
  std::uint64_t number = 0;
  std::size_t steps = 0;
  // The largest deviation in units of its tolerance; 0 at the level exact. Of a failure, at
  // least 1.
  double deviation = 0;
  bool agrees = false;  // all outputs do; false if a deviation did not count
  // Topics that the reference publishes, and the port. Empty if the port did not make all steps.
  HuntTopicSet due, published;
  HuntFeatures meets;
  std::optional<VectorResult> failure;  // the port is wrong
};

inline constexpr const char* hunt_group = "hunt";  // of the cases of findings

// The inputs as a case file makes them: parameters in its order, without changes that change
// nothing, the constants of the port in place of other values.
void make_orderly(const Lacks& lacks, HuntInputs& inputs);

// Gives the inputs to a fresh instance, and compares it with the reference. A deviation at the
// level numeric counts only if rounding cannot explain it: up to its tick, the reference in double
// precision stays well within the tolerances, and no decision of the law is nearer than its margin.
// Inputs with a feature of `target.lacks` are not judged, nor are its outputs. Errors: the
// reference fails.
Result<HuntTrial> judge_trial(const HuntInputs& inputs, const HuntTarget& target, PortHost& host);

}  // namespace attest
