#include "harness/realtime/rhythm.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include <boost/math/distributions/binomial.hpp>

namespace attest {
namespace {

constexpr std::size_t ticks_max = 1u << 17, events_max = 1u << 11;
constexpr std::size_t fewest_blocks = 5;
constexpr double complete = 0.8;  // at least this share of all blocks must have an event at a place
constexpr double false_alarms = 1e-4;

// The examined ticks and events, cut so that the search takes a quarter of a second at most.
struct Examined {
  std::vector<std::size_t> events;
  std::size_t ticks = 0;
};

Examined examined_of(const std::vector<std::size_t>& events, std::size_t ticks) {
  Examined sample{events, std::min(ticks, ticks_max)};
  if (sample.events.size() > events_max) {
    sample.ticks = std::min(sample.ticks, sample.events[events_max]);
  }
  const auto end = std::lower_bound(sample.events.begin(), sample.events.end(), sample.ticks);
  sample.events.erase(end, sample.events.end());
  return sample;
}

std::size_t events_wanted(std::size_t blocks) {
  return static_cast<std::size_t>(std::ceil(complete * static_cast<double>(blocks)));
}

// The upper bound of P(K >= hits) in rhythm.hpp; 1 if `hits` is below the mean of K plus one.
double tail(const Examined& sample, std::size_t every, std::size_t hits) {
  const std::size_t end = sample.ticks / every * every;
  std::size_t events = 0, blocks = 0, last_block = sample.ticks;
  for (const std::size_t tick : sample.events) {
    if (tick >= end) break;
    ++events;
    blocks += tick / every != last_block ? 1 : 0;
    last_block = tick / every;
  }
  const double mean = static_cast<double>(events) / static_cast<double>(every);
  if (static_cast<double>(hits) < mean + 1) return 1;
  const auto trials = static_cast<double>(blocks);
  const boost::math::binomial_distribution<> null(trials, mean / trials);
  return boost::math::cdf(boost::math::complement(null, static_cast<double>(hits) - 1));
}

// The number of events at each place within a block; all zero before and after each call.
class Hits {
 public:
  explicit Hits(std::size_t longest) : counts_(longest) {}

  // The place within a block that has the most events, and their number. Counts whole blocks only.
  std::pair<std::size_t, std::size_t> most(const Examined& sample, std::size_t every) {
    const std::size_t end = sample.ticks / every * every;
    std::size_t first = 0, count = 0;
    for (const std::size_t tick : sample.events) {
      if (tick >= end) break;
      const std::size_t hits = ++counts_[tick % every];
      if (hits > count) std::tie(first, count) = std::pair(tick % every, hits);
    }
    for (const std::size_t tick : sample.events) counts_[tick % every] = 0;
    return {first, count};
  }

 private:
  std::vector<std::size_t> counts_;
};

// The number of pairs (every, p) of rhythm.hpp, with `every` from 2 to `longest`.
double pairs_tried(std::size_t longest) {
  const auto n = static_cast<double>(longest);
  return n * (n + 1) / 2 - 1;
}

}  // namespace

std::optional<Rhythm> find_rhythm(const std::vector<std::size_t>& events, std::size_t ticks) {
  const Examined sample = examined_of(events, ticks);
  const std::size_t longest = sample.ticks / fewest_blocks;
  if (longest < 2 || sample.events.empty()) return std::nullopt;
  // With a shorter period, there are not enough events for 80% of the blocks.
  const auto shortest = static_cast<std::size_t>(complete * static_cast<double>(sample.ticks) /
                                                 static_cast<double>(sample.events.size() + 1));
  Hits hits(longest + 1);
  for (std::size_t every = std::max<std::size_t>(2, shortest); every <= longest; ++every) {
    const auto [phase, count] = hits.most(sample, every);
    if (count < events_wanted(sample.ticks / every)) continue;
    const double chance = tail(sample, every, count) * pairs_tried(longest);
    if (chance > false_alarms) continue;
    const auto first =
        std::find_if(sample.events.begin(), sample.events.end(),
                     [&, rest = phase](std::size_t tick) { return tick % every == rest; });
    return Rhythm{every, *first, chance};
  }
  return std::nullopt;
}

}  // namespace attest
