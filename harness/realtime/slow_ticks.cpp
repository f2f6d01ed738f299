#include "harness/realtime/slow_ticks.hpp"

#include <algorithm>

namespace attest {
namespace {

constexpr std::size_t worst_kept = 8;

bool by_execution(const SlowTick& a, const SlowTick& b) { return a.execution > b.execution; }

}  // namespace

SlowTicks slow_ticks(const std::vector<LiveTick>& ticks, Nanoseconds median) {
  SlowTicks result;
  result.threshold = std::max(8 * median, median + std::chrono::microseconds(20));
  std::vector<SlowTick> slow;
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    if (ticks[i].execution() <= result.threshold) continue;
    slow.push_back({i, ticks[i].execution(), ticks[i].elapsed});
    numbers.push_back(i);
  }
  result.count = slow.size();
  result.rhythm = find_rhythm(numbers, ticks.size());
  std::stable_sort(slow.begin(), slow.end(), by_execution);
  slow.resize(std::min(slow.size(), worst_kept));
  result.worst = std::move(slow);
  return result;
}

}  // namespace attest
