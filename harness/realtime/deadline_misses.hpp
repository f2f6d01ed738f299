// Which deadlines a flight missed, and which of the misses the port's execution time explains.
//
// The rule. The recorded ticks are one timeline. Two more are computed from it, with the same
// releases and the same steps:
//
//     delay_i = (start_i - max(release_i, finish_(i-1))) + (finish_i - start_i - execution_i)
//
//     machine's: finish_i = max(release_i, finish_(i-1)) + delay_i
//     port's:    finish_i = max(release_i, finish_(i-1)) + min(delay_i, usual) + execution_i
//
// delay_i is the delay by the machine. It is the sum of three times: from when the step could start
// to its start, preemption within the step, and attest's own work around it. A delay postpones the
// finish of its tick, and so also the later ticks that wait for that finish. `usual` is the median
// of the delays, limited to a tenth of the period. A miss is the port's if both hold:
//
//  1. In the machine's timeline the deadline is kept. A miss that also happens to a port whose
//     steps take no time is the machine's.
//  2. In the port's timeline it is missed. A miss may need both causes, for example a wake-up that
//     is late by nearly a period, and then a short step. On a bad machine a correct port would have
//     such misses, so a port must tolerate the usual delay only, and of that at most a tenth of
//     the period. So a port whose steps all take less than nine tenths of a period never has a
//     miss of its own.
//
// All other misses are the machine's.
//
// A skipped release is a miss too: its deadline passes before a step can start. It is counted with
// the step that ran meanwhile. The same two conditions apply, with the deadline of the release and
// the finish of that step.
//
// Limitation: the execution time is the CPU time in the kernel's accounting. Cold caches,
// interrupts and, on a virtual machine without steal accounting, time of the hypervisor count as
// execution time.
#pragma once

#include <cstdint>
#include <vector>

#include "harness/realtime/live_tick.hpp"
#include "harness/schedule/rate.hpp"

namespace attest {

struct DeadlineMisses {
  std::uint64_t late = 0;         // responses longer than the period
  std::uint64_t skipped = 0;      // skipped releases after the first tick
  std::uint64_t by_port = 0;      // the port's misses, of late and skipped together
  std::uint64_t late_starts = 0;  // wake-up latencies above the limit
  // Late starts attributed to the port: the same two conditions, applied to the start instead of
  // the finish.
  std::uint64_t late_starts_by_port = 0;

  std::uint64_t total() const { return late + skipped; }

  friend bool operator==(const DeadlineMisses&, const DeadlineMisses&) = default;
};

DeadlineMisses deadline_misses(const std::vector<LiveTick>& ticks, const Rate& rate,
                               Nanoseconds latency_limit = Nanoseconds::max());

}  // namespace attest
