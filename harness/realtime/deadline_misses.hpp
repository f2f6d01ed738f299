// Finds the deadlines that a flight missed, and the misses that the port's execution time explains.
//
// The rule. The recorded ticks are one timeline. Two other timelines are computed from it, with the
// same releases and the same steps:
//
//     delay_i = (start_i - max(release_i, finish_(i-1))) + (finish_i - start_i - execution_i)
//
//     machine's: finish_i = max(release_i, finish_(i-1)) + delay_i
//     port's:    finish_i = max(release_i, finish_(i-1)) + min(delay_i, usual) + execution_i
//
// delay_i is the delay by the machine. It is the sum of three times: from the moment when the step
// could start to its start, preemption within the step, and attest's own work around it. A delay
// postpones the finish of its tick, and so also the later ticks that wait for that finish. `usual`
// is the median of the delays, limited to a tenth of the period. A miss is the port's if both hold:
//
//  1. In the machine's timeline the deadline is kept. If it is missed there, even a port whose
//     steps take no time would miss it.
//  2. In the port's timeline the deadline is missed. This timeline limits the machine's delays to
//     `usual`, because a port need not tolerate longer ones: a correct port also misses a deadline
//     if it is woken up late by nearly a period. If releases are at least a period apart, a port
//     whose steps all take less than nine tenths of a period has no miss of its own.
//
// All other misses are the machine's.
//
// A skipped release is a miss too: its deadline passes before a step can start. It is counted with
// the step during which it came. The same two conditions apply, with the deadline of the release
// and the finish of that step.
//
// Limitation: the execution time is the CPU time in the kernel's accounting (LiveTick::execution).
// Delays by cold caches and interrupts count as execution time. So does time of the hypervisor on a
// virtual machine without steal accounting.
#pragma once

#include <cstdint>
#include <vector>

#include "harness/core/rate.hpp"
#include "harness/realtime/live_tick.hpp"

namespace attest {

struct DeadlineMisses {
  std::uint64_t late = 0;         // responses longer than the period
  std::uint64_t skipped = 0;      // releases skipped after the first tick
  std::uint64_t by_port = 0;      // of `late` and `skipped`, the port's misses
  std::uint64_t late_starts = 0;  // wake-up latencies above the limit
  // Of these, the port's: the same two conditions, with the start instead of the finish, and with
  // the latency limit instead of the period.
  std::uint64_t late_starts_by_port = 0;

  std::uint64_t total() const { return late + skipped; }

  friend bool operator==(const DeadlineMisses&, const DeadlineMisses&) = default;
};

DeadlineMisses deadline_misses(const std::vector<LiveTick>& ticks, const Rate& rate,
                               Nanoseconds latency_limit = Nanoseconds::max());

}  // namespace attest
