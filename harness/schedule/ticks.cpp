#include "harness/schedule/ticks.hpp"

#include <algorithm>

#include "harness/schedule/random.hpp"

namespace attest {

std::vector<Nanoseconds> ticks(const TickSchedule& schedule, std::int64_t periods) {
  std::vector<Nanoseconds> times;
  times.reserve(static_cast<std::size_t>(periods));
  Random random(schedule.seed);
  for (std::int64_t k = 0; k < periods; ++k) {
    // Drawn for dropped ticks too, so that dropping one leaves the others where they were.
    const double late = schedule.jitter * random.uniform();
    const auto& drops = schedule.drops;
    if (std::find(drops.begin(), drops.end(), k) != drops.end()) continue;
    const Nanoseconds begin = schedule.rate.tick(k);
    const auto period = static_cast<double>((schedule.rate.tick(k + 1) - begin).count());
    times.push_back(schedule.phase + begin + Nanoseconds(static_cast<std::int64_t>(late * period)));
  }
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
