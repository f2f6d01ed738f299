#include "harness/golden/decimate.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace attest {
namespace {

constexpr std::size_t first_ticks = 4;
constexpr std::size_t regular_ticks = 12;

// NaN is neither smallest nor largest.
void add_extremes(const Channel& channel, const Trace& flown, std::set<std::size_t>& kept) {
  std::size_t lowest = 0, highest = 0;
  for (std::size_t tick = 1; tick < flown.samples.size(); ++tick) {
    const float value = float_of(channel, flown.samples[tick]);
    if (value < float_of(channel, flown.samples[lowest])) lowest = tick;
    if (value > float_of(channel, flown.samples[highest])) highest = tick;
  }
  kept.insert({lowest, highest});
}

}  // namespace

Trace decimated(const Trace& flown) {
  const std::size_t last = flown.samples.size() - 1;
  std::set<std::size_t> kept;
  for (std::size_t tick = 0; tick < std::min(first_ticks, last); ++tick) kept.insert(tick);
  for (std::size_t i = 0; i <= regular_ticks; ++i) kept.insert(last * i / regular_ticks);
  for (std::size_t i = 0; i < channels().size(); ++i) {
    const Channel& channel = channels()[i];
    if (flown.present[i] && channel.is_output() && channel.type == ChannelType::f32) {
      add_extremes(channel, flown, kept);
    }
  }
  Trace rows;
  rows.source = flown.source;
  rows.present = flown.present & ~channels_of(Part::mc_att_control, "in/updated.");
  for (const std::size_t tick : kept) {
    rows.samples.push_back(flown.samples[tick]);
    rows.samples.back().in.updated = 0;
  }
  return rows;
}

}  // namespace attest
