#include "harness/realtime/slow_ticks.hpp"

#include <algorithm>
#include <set>

namespace attest {
namespace {

constexpr std::size_t worst_kept = 8;
constexpr std::size_t examined = 64;  // the first of them, for a rhythm
constexpr double nearly_all = 0.8;
constexpr std::size_t fewest = 3;

bool by_execution(const SlowTick& a, const SlowTick& b) { return a.execution > b.execution; }

struct Rhythm {
  std::size_t every = 0, first = 0, last = 0, count = 0;

  // Of those that a strict rhythm would have up to the end of the ticks.
  double completeness(std::size_t ticks) const {
    const std::size_t expected = (ticks - 1 - first % every) / every + 1;
    return static_cast<double>(count) / static_cast<double>(expected);
  }
};

Rhythm rhythm(const std::vector<std::size_t>& slow, std::size_t every, std::size_t phase) {
  Rhythm found{every, 0, 0, 0};
  for (const std::size_t tick : slow) {
    if (tick % every != phase) continue;
    if (found.count++ == 0) found.first = tick;
    found.last = tick;
  }
  return found;
}

// The shortest distance that nearly all multiples of are there.
std::optional<Rhythm> find_rhythm(const std::vector<std::size_t>& slow, std::size_t ticks) {
  std::set<std::size_t> distances;
  for (std::size_t i = 0; i < slow.size(); ++i) {
    for (std::size_t j = i + 1; j < slow.size(); ++j) distances.insert(slow[j] - slow[i]);
  }
  for (const std::size_t every : distances) {
    if (every < 2) continue;
    for (const std::size_t tick : slow) {
      const Rhythm found = rhythm(slow, every, tick % every);
      if (found.count >= fewest && found.completeness(ticks) >= nearly_all) return found;
    }
  }
  return std::nullopt;
}

}  // namespace

SlowTicks slow_ticks(const std::vector<LiveTick>& ticks, Nanoseconds median) {
  SlowTicks result;
  result.threshold = std::max(8 * median, median + std::chrono::microseconds(20));
  std::vector<SlowTick> slow;
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    if (ticks[i].execution > result.threshold)
      slow.push_back({i, ticks[i].execution, ticks[i].cpu});
  }
  result.count = slow.size();
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < std::min(slow.size(), examined); ++i) numbers.push_back(slow[i].tick);
  // With more of them than are examined, these cover only a part of the ticks.
  const std::size_t covered = slow.size() <= examined ? ticks.size() : numbers.back() + 1;
  if (const auto found = find_rhythm(numbers, covered)) {
    result.every = found->every;
    result.first_regular = found->first;
  }
  std::stable_sort(slow.begin(), slow.end(), by_execution);
  slow.resize(std::min(slow.size(), worst_kept));
  result.worst = std::move(slow);
  return result;
}

}  // namespace attest
