#include "harness/golden/keyframes.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace attest {
namespace {

constexpr std::size_t first_ticks = 4;
constexpr std::size_t regular_ticks = 12;

// Adds the ticks of the smallest and the largest value to `kept`. NaNs are passed over.
void add_extremes(const Channel& channel, const Trace& flown, std::set<std::size_t>& kept) {
  std::size_t lowest = 0, highest = 0;
  for (std::size_t tick = 1; tick < flown.samples.size(); ++tick) {
    const float value = float_of(channel, flown.samples[tick]);
    if (std::isnan(value)) continue;
    // The negated comparisons are also true if the value at `lowest` or `highest`, tick 0, is NaN.
    if (!(value >= float_of(channel, flown.samples[lowest]))) lowest = tick;
    if (!(value <= float_of(channel, flown.samples[highest]))) highest = tick;
  }
  kept.insert({lowest, highest});
}

}  // namespace

std::vector<std::size_t> keyframes_of(const Trace& trace) {
  const std::size_t last = trace.samples.size() - 1;
  std::set<std::size_t> kept;
  for (std::size_t tick = 0; tick < std::min(first_ticks, last); ++tick) kept.insert(tick);
  for (std::size_t i = 0; i <= regular_ticks; ++i) kept.insert(last * i / regular_ticks);
  for (std::size_t i = 0; i < channels().size(); ++i) {
    const Channel& channel = channels()[i];
    if (trace.present[i] && channel.is_output() && channel.type == ChannelType::f32) {
      add_extremes(channel, trace, kept);
    }
  }
  return {kept.begin(), kept.end()};
}

}  // namespace attest
