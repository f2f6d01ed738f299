// Estimates from the times of a log's samples how many steps of a unit the log lacks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "harness/trace/module.hpp"

namespace attest {

struct StepGaps {
  std::size_t steps = 0;  // in the log
  double median_us = 0;   // of the times between them; 0 with fewer than two steps
  std::uint64_t longest_us = 0;
  std::size_t missing = 0;  // estimate: a gap of n medians (rounded) lacks n - 1 steps
  double period_us = 0;     // of the loop, estimated; 0: not known

  double part_missing() const;  // missing / (steps + missing), 0..1
};

// Takes the times of the steps one by one. Memory: the different gaps, of which the log of a flight
// has few.
class GapCounts {
 public:
  // REQUIRES: later than the time before.
  void add(std::uint64_t time_us);
  // `fastest_hz`: the loop is not faster; without it, its period is not estimated.
  StepGaps gaps(std::optional<double> fastest_hz = {}) const;

 private:
  double period_us(double shortest_us) const;

  std::size_t steps_ = 0;
  std::uint64_t last_us_ = 0;
  std::map<std::uint64_t, std::size_t> counts_;  // gap -> how often
};

// Why outputs that depend on earlier steps cannot be computed from a log with these gaps. Empty if
// they can be computed approximately: at most 1% of the steps are missing, and PX4 can run this
// loop as slowly as the median of the gaps says. `fastest_hz`: IMU_GYRO_RATEMAX in the log, for the
// text.
std::string too_sparse(Module module, const StepGaps& gaps, std::optional<double> fastest_hz);

// Whether the log may have every step: no step is missing, and a rate unit is about as fast as
// `fastest_hz` allows. False for a rate unit without `fastest_hz`.
bool may_be_complete(Module module, const StepGaps& gaps, std::optional<double> fastest_hz);

}  // namespace attest
