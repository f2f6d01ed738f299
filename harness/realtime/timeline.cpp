#include "harness/realtime/timeline.hpp"

#include <algorithm>
#include <numeric>

namespace attest {
namespace {

constexpr std::int64_t most_parts = 400;
constexpr std::size_t longest_kept = 8;

void add(const LiveTick& tick, const TimelineLimits& limits, TimelinePart& part) {
  ++part.ticks;
  part.latency = std::max(part.latency, tick.latency());
  part.execution = std::max(part.execution, tick.execution());
  part.response = std::max(part.response, tick.response());
  part.late += tick.finish > tick.deadline ? 1 : 0;
  part.skipped += tick.skipped;
  part.overruns += limits.execution && tick.execution() > *limits.execution ? 1 : 0;
  part.late_starts += tick.latency() > limits.latency ? 1 : 0;
}

std::vector<TimelineTick> worst_of(const std::vector<LiveTick>& ticks) {
  std::vector<std::size_t> numbers(ticks.size());
  std::iota(numbers.begin(), numbers.end(), std::size_t{0});
  const std::size_t count = std::min(ticks.size(), longest_kept);
  std::partial_sort(numbers.begin(), numbers.begin() + static_cast<std::ptrdiff_t>(count),
                    numbers.end(), [&](std::size_t a, std::size_t b) {
                      const Nanoseconds of_a = ticks[a].response(), of_b = ticks[b].response();
                      return of_a != of_b ? of_a > of_b : a < b;
                    });
  std::vector<TimelineTick> worst;
  for (std::size_t i = 0; i < count; ++i) worst.push_back({numbers[i], ticks[numbers[i]]});
  return worst;
}

}  // namespace

FlightTimeline flight_timeline(const std::vector<LiveTick>& ticks, const TimelineLimits& limits) {
  FlightTimeline timeline;
  if (ticks.empty()) return timeline;
  const Nanoseconds begin = ticks.front().release;
  const Nanoseconds length = (ticks.back().release - begin) / most_parts + Nanoseconds(1);
  for (const LiveTick& tick : ticks) {
    const Nanoseconds part_begin = begin + (tick.release - begin) / length * length;
    if (timeline.parts.empty() || timeline.parts.back().begin != part_begin) {
      timeline.parts.push_back({});
      timeline.parts.back().begin = part_begin;
    }
    add(tick, limits, timeline.parts.back());
  }
  timeline.worst = worst_of(ticks);
  return timeline;
}

}  // namespace attest
