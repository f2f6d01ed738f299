#include "harness/realtime/deadline_misses.hpp"

#include <algorithm>

namespace attest {
namespace {

// The usual delay is at most the period divided by this number.
constexpr int usual_part_of_period = 10;

// A unit in one of the two computed timelines of deadline_misses.hpp: the start of its last step,
// and the finish of that step, when the unit becomes free.
struct Course {
  Nanoseconds free = Nanoseconds::min();
  Nanoseconds start{0};

  void step(const LiveTick& tick, Nanoseconds before, Nanoseconds rest) {
    start = std::max(tick.release, free) + before;
    free = start + rest;
  }
};

// The delay of a tick by the machine, before its start and after it.
struct Delay {
  Nanoseconds before{0}, after{0};
};

std::vector<Delay> delays_of(const std::vector<LiveTick>& ticks) {
  std::vector<Delay> delays;
  delays.reserve(ticks.size());
  Nanoseconds free = Nanoseconds::min();
  for (const LiveTick& tick : ticks) {
    const Nanoseconds before = tick.start - std::max(tick.release, free);
    const Nanoseconds after = tick.finish - tick.start - tick.execution();
    delays.push_back({std::max(before, Nanoseconds(0)), std::max(after, Nanoseconds(0))});
    free = tick.finish;
  }
  return delays;
}

// REQUIRES: not empty.
Nanoseconds usual_delay(const std::vector<Delay>& delays, const Rate& rate) {
  std::vector<Nanoseconds> sums;
  sums.reserve(delays.size());
  for (const Delay& delay : delays) sums.push_back(delay.before + delay.after);
  const auto middle = sums.begin() + static_cast<std::ptrdiff_t>((sums.size() - 1) / 2);
  std::nth_element(sums.begin(), middle, sums.end());
  return std::min(*middle, rate.tick(1) / usual_part_of_period);
}

// The number of skipped releases that are the port's. A release is skipped if the thread is still
// busy when the next release is due, which is also the deadline of the skipped one.
std::uint64_t skipped_by_port(const LiveTick& tick, const Rate& rate, Nanoseconds machines_finish,
                              Nanoseconds ports_finish) {
  std::uint64_t count = 0;
  for (std::int64_t k = 1; k <= std::int64_t{tick.skipped}; ++k) {
    const Nanoseconds deadline = rate.tick(tick.release_number + k + 1);
    if (machines_finish < deadline && deadline <= ports_finish) ++count;
  }
  return count;
}

}  // namespace

DeadlineMisses deadline_misses(const std::vector<LiveTick>& ticks, const Rate& rate,
                               Nanoseconds latency_limit) {
  DeadlineMisses misses;
  if (ticks.empty()) return misses;
  const std::vector<Delay> delays = delays_of(ticks);
  const Nanoseconds usual = usual_delay(delays, rate);
  Course machines, ports;
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    const LiveTick& tick = ticks[i];
    const auto [before, after] = delays[i];
    const Nanoseconds usual_before = std::min(before, usual);
    machines.step(tick, before, after);
    ports.step(tick, usual_before, std::min(after, usual - usual_before) + tick.execution());

    if (tick.finish > tick.deadline) {
      ++misses.late;
      if (machines.free <= tick.deadline && ports.free > tick.deadline) ++misses.by_port;
    }
    misses.skipped += tick.skipped;
    misses.by_port += skipped_by_port(tick, rate, machines.free, ports.free);
    if (tick.latency() > latency_limit) {
      ++misses.late_starts;
      const Nanoseconds limit = tick.release + latency_limit;
      if (machines.start <= limit && ports.start > limit) ++misses.late_starts_by_port;
    }
  }
  return misses;
}

}  // namespace attest
