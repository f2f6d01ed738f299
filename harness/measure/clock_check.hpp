// Compares the step times that a port's process reports with the times that its judge measures. The
// port shares the process that reads the clock: it may have changed the clock, or the memory in
// which the step times are stored.
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>

#include "harness/core/time.hpp"
#include "harness/host/port_host.hpp"

namespace attest {

// What a port's process reports, and what the judge measures, of some requests.
struct ClockTotals {
  std::size_t requests = 0, steps = 0;
  Nanoseconds reported{0};  // by the port's process, for its steps
  Nanoseconds repeated{0};  // of these: for steps that it made twice and reported once
  Nanoseconds wall{0};      // that the judge waited for the answers
  // CPU time of the port's process and its descendants, of each request at most its wall time.
  // Preemption makes the wall time longer, and threads of the port the CPU time.
  Nanoseconds used{0};
};

// "its clock is wrong: ..."; empty if the report may be true. In addition to the steps, an honest
// process needs less than 1 us a step and less than 1 ms a request. About 20 times as much is
// allowed.
std::string clock_contradiction(const ClockTotals& totals);

// Adds one request to the totals.
class TimedRequest {
 public:
  // Begins a request to `host`, which outlives this.
  explicit TimedRequest(const PortHost& host);

  // Ends it. `twice`: the process made the steps twice and reported one run. Nothing is added if
  // the port has no process of its own.
  void end(const StepTimes& reported, bool twice, ClockTotals& totals) const;

 private:
  const PortHost& host_;
  std::optional<Nanoseconds> cpu_before_;
  std::chrono::steady_clock::time_point begin_;
};

}  // namespace attest
