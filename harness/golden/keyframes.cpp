#include "harness/golden/keyframes.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "harness/compare/compare.hpp"
#include "harness/port/builtin.hpp"

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

// The samples of `all` at the timestamps of `kept`, with the channels of `kept` only. Ends before
// the first timestamp of `kept` that `all` does not have.
Trace at_ticks_of(const Trace& kept, const Trace& all) {
  Trace chosen;
  chosen.source = all.source;
  chosen.present = kept.present;
  auto sample = all.samples.begin();
  for (const Sample& wanted : kept.samples) {
    sample = std::find_if(sample, all.samples.end(), [&](const Sample& one) {
      return one.in.timestamp == wanted.in.timestamp;
    });
    if (sample == all.samples.end()) break;
    chosen.samples.push_back(*sample);
    chosen.samples.back().in.updated = 0;  // as without_history() does in `kept`
  }
  return chosen;
}

// Removes parameters and in/updated bits, because both describe changes since the previous tick.
// They may come from constants in the provenance of a golden, which are for slower rates at which
// the same case keeps every tick.
Trace without_history(Trace rows) {
  rows.parameters.clear();
  rows.present &= ~channels_of(module_of(rows.present), "in/updated.");
  for (Sample& sample : rows.samples) sample.in.updated = 0;
  return rows;
}

}  // namespace

Trace keyframes_of(const Trace& flown) {
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
  rows.present = flown.present;
  for (const std::size_t tick : kept) rows.samples.push_back(flown.samples[tick]);
  return without_history(std::move(rows));
}

Result<Trace> filled_in(Trace made, Trace kept, const Subject& subject, bool is_exact) {
  kept = without_history(std::move(kept));
  Subject alone = subject;
  alone.instances = Instances::one;
  if (const auto fault = drive(*open_builtin(), alone, made)) {
    return fail_at(kept.source, fmt::format("the reference: {}", fault->what));
  }
  const ChannelSet missing = made.present & channels_of(subject.module, "out/") & ~kept.present;
  if (missing.any()) {
    return fail_at(kept.source, fmt::format("has no {}; bless it anew, or restore it from version "
                                            "control",
                                            channels()[missing._Find_first()].name));
  }
  const Trace chosen = at_ticks_of(kept, made);
  const auto other_input = first_input_difference(chosen, kept);
  if (chosen.samples.size() != kept.samples.size() || other_input) {
    return fail_at(kept.source,
                   "has ticks or inputs that the case does not make; bless it anew, or restore it "
                   "from version control");
  }
  const Tolerances tolerances(is_exact ? Level::exact : Level::numeric);
  if (const auto comparison = compare(chosen, kept, tolerances); comparison.first) {
    const auto& first = *comparison.first;
    return fail_at(
        kept.source,
        fmt::format("at timestamp {} the reference of this build answers another {}; "
                    "bless it anew, or restore it from version control",
                    kept.samples[first.tick].in.timestamp, channels()[first.channel].name));
  }
  return made;
}

}  // namespace attest
