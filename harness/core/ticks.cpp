#include "harness/core/ticks.hpp"

#include <algorithm>
#include <cmath>

#include "harness/core/random.hpp"

namespace attest {

namespace {

// Timestamps are in microseconds, so two ticks must be at least this far apart.
constexpr Nanoseconds closest{1000};

// The lateness in periods. Square root and division give the same bits on every platform; pow does
// not.
double lateness(const TickSchedule& schedule, Random& random) {
  const double uniform = random.uniform();
  if (!schedule.heavy_tail) return schedule.jitter * uniform;
  return schedule.jitter * (1 / std::sqrt(1 - uniform) - 1);
}

bool is_dropped(const TickSchedule& schedule, std::int64_t k) {
  const auto& drops = schedule.drops;
  if (schedule.drop_every > 0 && k % schedule.drop_every == schedule.drop_every - 1) return true;
  return std::find(drops.begin(), drops.end(), k) != drops.end();
}

// The time at which a tick that is due at `time` runs.
Nanoseconds after_stall(const Stall& stall, Nanoseconds time) {
  if (stall.every == Nanoseconds(0) || time < stall.every) return time;
  return std::max(time, time - time % stall.every + stall.length);
}

}  // namespace

std::vector<Nanoseconds> ticks(const TickSchedule& schedule, std::int64_t periods) {
  std::vector<Nanoseconds> times;
  times.reserve(static_cast<std::size_t>(periods));
  Random random(schedule.seed);
  for (std::int64_t k = 0; k < periods; ++k) {
    // Also drawn for dropped ticks, so that dropping a tick does not move the others.
    const double late = lateness(schedule, random);
    if (is_dropped(schedule, k)) continue;
    const Nanoseconds begin = schedule.rate.tick(k);
    const Nanoseconds period = schedule.rate.tick(k + 1) - begin;
    const double late_ns = late * static_cast<double>(period.count());
    Nanoseconds time =
        after_stall(schedule.stall, begin + Nanoseconds(static_cast<std::int64_t>(late_ns)));
    if (!times.empty() && time < times.back() + closest) {
      if (!schedule.stall.catches_up) continue;
      time = times.back() + std::max(closest, period / 10);
    }
    times.push_back(time);
  }
  for (Nanoseconds& time : times) time += schedule.phase;
  return times;
}

std::optional<Nanoseconds> ReleaseSchedule::latest(Nanoseconds time) const {
  if (rate) {
    if (time < phase) return std::nullopt;
    // ticks_in counts the releases before an end, so one nanosecond more includes `time` itself.
    const std::int64_t last = rate->ticks_in(time - phase + Nanoseconds(1)) - 1;
    if (last < first) return std::nullopt;
    return phase + rate->tick(last - (last - first) % every);
  }
  const auto after = std::upper_bound(times.begin(), times.end(), time);
  if (after == times.begin()) return std::nullopt;
  return *std::prev(after);
}

}  // namespace attest
