#include "harness/compare/compare.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <tuple>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/compare/events.hpp"
#include "harness/compare/gross.hpp"
#include "harness/compare/suspected_stages.hpp"
#include "harness/core/agreement.hpp"

namespace attest {
namespace {

// Maps floats to consecutive integers in the same order, -0 and +0 one step apart.
std::int64_t ordinal(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const auto magnitude = static_cast<std::int64_t>(bits & 0x7fffffffu);
  return (bits >> 31) ? -magnitude - 1 : magnitude;
}

std::int64_t ulp_distance(float a, float b) {
  if (std::isnan(a) || std::isnan(b)) return 0;
  return std::abs(ordinal(a) - ordinal(b));
}

bool truth(std::uint8_t flag) { return flag != 0; }

// Compares all bytes, of all modules.
bool outputs_differ(const Sample& a, const Sample& b) {
  return !std::ranges::equal(a.outputs(), b.outputs());
}

// How far a value is outside its tolerance, to find the worst. 0 for a flag, NaN and infinity,
// which have no distance.
double excess(const Deviation& deviation) {
  if (!std::isfinite(deviation.got) || !std::isfinite(deviation.want)) return 0;
  if (deviation.tolerance <= 0) return static_cast<double>(deviation.ulp);
  return std::abs(deviation.got - deviation.want) / deviation.tolerance;
}

}  // namespace

StageSet stages_of(const Deviation& deviation) {
  return deviation.stages.any() ? deviation.stages : only(channels()[deviation.channel].stage);
}

Stage stage_of(const Deviation& deviation) {
  const StageSet stages = stages_of(deviation);
  const Stage stage = channels()[deviation.channel].stage;
  return contains(stages, stage) ? stage : static_cast<Stage>(stages._Find_first());
}

namespace {

bool is_before(const Deviation& a, const Deviation& b) {
  return std::tuple(a.timestamp_us, stage_of(a)) < std::tuple(b.timestamp_us, stage_of(b));
}

Comparison with_inputs(Comparison comparison, const InputComparer& inputs) {
  comparison.inputs = inputs.first();
  return comparison;
}

}  // namespace

Result<Comparison> compare(TraceParts& got, TraceParts& want, const Tolerances& tolerances) {
  const Module module = module_of(got.present()), expected = module_of(want.present());
  if (module != expected) {
    Comparison incomparable;
    incomparable.mismatch =
        fmt::format("got is a trace of {}, want of {}", name_of(module), name_of(expected));
    return incomparable;
  }
  const bool is_whole = tolerances.level() == Level::events;
  const std::size_t most = is_whole ? whole_trace : 100;
  TickComparer comparer(got.present(), want.present(), tolerances);
  InputComparer inputs(got.present(), want.present(), InputComparer::Compared::in_both);
  Trace got_part, want_part;
  std::size_t got_ticks = 0, want_ticks = 0;
  // Both are read to their end, so that an error anywhere in a file is reported.
  do {
    const auto read_got = got.next_part(most, got_part);
    if (!read_got) return tl::unexpected(read_got.error());
    const auto read_want = want.next_part(most, want_part);
    if (!read_want) return tl::unexpected(read_want.error());
    inputs.add(got_part, want_part);
    if (is_whole) return with_inputs(compare(got_part, want_part, tolerances), inputs);
    comparer.add(got_part, want_part);
    got_ticks += got_part.samples.size();
    want_ticks += want_part.samples.size();
  } while (!got_part.samples.empty() || !want_part.samples.empty());
  return with_inputs(comparer.finish(got_ticks, want_ticks), inputs);
}

Comparison both(Comparison one, const Comparison& other) {
  one.ticks += other.ticks;
  one.deviating_ticks += other.deviating_ticks;
  const auto& first = other.first;
  if (first && (!one.first || is_before(*first, *one.first))) one.first = first;
  if (other.worst && (!one.worst || excess(*other.worst) > excess(*one.worst))) {
    one.worst = other.worst;
  }
  if (other.tightest && (!one.tightest || other.tightest->ratio < one.tightest->ratio)) {
    one.tightest = other.tightest;
  }
  one.largest.insert(one.largest.end(), other.largest.begin(), other.largest.end());
  if (one.mismatch.empty()) one.mismatch = other.mismatch;
  one.got_non_finite |= other.got_non_finite;
  return one;
}

TickComparer::TickComparer(const ChannelSet& got, const ChannelSet& want,
                           const Tolerances& tolerances)
    : level_(tolerances.level()), allowed_(tolerances, module_of(want)) {
  std::vector<std::string_view> missing;
  for (const std::size_t i : outputs_by_stage(got | want)) {
    compared_[i] = got[i] && want[i];
    if (!got[i]) missing.push_back(channels()[i].name);
    result_.only_got[i] = !want[i];
  }
  chosen_ = outputs_by_stage(compared_);
  largest_.resize(chosen_.size());
  if (!missing.empty()) {
    not_recorded_ = fmt::format("got lacks {}, which want has", fmt::join(missing, ", "));
  } else if (chosen_.empty()) {
    not_recorded_ = "nothing to compare: no out/ signals";
  }
}

void TickComparer::add(const Sample& got, const Sample& want,
                       std::span<const ParameterChange> changes) {
  if (!result_.mismatch.empty()) return;
  if (got.in.timestamp != want.in.timestamp) {
    result_.mismatch = fmt::format(
        "tick {} is at {} us, expected at {} us; traces are compared tick by tick, so record both "
        "at the same times",
        tick_, got.in.timestamp, want.in.timestamp);
    return;
  }
  allowed_.next(want, changes);
  const bool differs = outputs_differ(got, want);
  if (differs) note_largest(got, want);
  if (differs && level_ != Level::events) {
    const bool is_first = !result_.first;
    ChannelSet deviating;
    for (const std::size_t channel : chosen_) {
      deviating[channel] = !channel_agrees(channel, got, want);
    }
    result_.deviating_ticks += deviating.any() ? 1 : 0;
    if (is_first && deviating.any()) {
      result_.first->stages = suspected_stages(deviating, compared_, want);
    }
  }
  ++tick_;
}

void TickComparer::add(const Trace& got, const Trace& want) {
  PendingChanges changes(want.parameters);
  const std::size_t common = std::min(got.samples.size(), want.samples.size());
  for (std::size_t tick = 0; tick < common; ++tick) {
    add(got.samples[tick], want.samples[tick], changes.take_until(tick));
  }
}

Comparison TickComparer::finish(std::size_t got_ticks, std::size_t want_ticks) {
  if (result_.mismatch.empty() && got_ticks != want_ticks) {
    result_.mismatch = fmt::format("{} ticks, expected {}", got_ticks, want_ticks);
  }
  if (result_.mismatch.empty()) result_.mismatch = not_recorded_;
  if (!result_.mismatch.empty()) {
    Comparison incomparable;
    incomparable.mismatch = result_.mismatch;
    return incomparable;
  }
  result_.ticks = tick_;
  result_.largest.clear();
  for (std::size_t i = 0; i < chosen_.size(); ++i) {
    if (largest_[i] > 0) result_.largest.push_back({chosen_[i], largest_[i]});
  }
  return result_;
}

bool TickComparer::channel_agrees(std::size_t channel, const Sample& got, const Sample& want) {
  const Channel& what = channels()[channel];
  if (what.type != ChannelType::f32) {
    const auto g = static_cast<std::uint8_t>(value_of(what, got));
    const auto w = static_cast<std::uint8_t>(value_of(what, want));
    if (truth(g) == truth(w)) return true;
    note({tick_, want.in.timestamp, channel, value_of(what, got), value_of(what, want), 0, 0});
    return false;
  }
  const float g = float_of(what, got);
  const float w = float_of(what, want);
  if (same_bits(g, w)) return true;
  const bool both_finite = std::isfinite(g) && std::isfinite(w);
  const double tolerance = both_finite ? allowed_.of(channel, want, g, w) : 0;
  const double difference = distance(g, w);
  if (level_ == Level::numeric && both_finite && difference <= tolerance) {
    note_headroom(channel, difference, tolerance);
    return true;
  }
  if (!std::isfinite(g) && std::isfinite(w)) result_.got_non_finite = true;
  note({tick_, want.in.timestamp, channel, g, w, ulp_distance(g, w), tolerance});
  return false;
}

void TickComparer::note(const Deviation& deviation) {
  if (!result_.first) result_.first = deviation;
  const double now = excess(deviation);
  if (now > (result_.worst ? excess(*result_.worst) : 0)) result_.worst = deviation;
}

void TickComparer::note_largest(const Sample& got, const Sample& want) {
  for (std::size_t i = 0; i < chosen_.size(); ++i) {
    const Channel& channel = channels()[chosen_[i]];
    if (channel.type != ChannelType::f32) continue;
    const double deviation = distance(float_of(channel, got), float_of(channel, want));
    if (std::isfinite(deviation)) largest_[i] = std::max(largest_[i], deviation);
  }
}

void TickComparer::note_headroom(std::size_t channel, double difference, double tolerance) {
  // -0 against +0 differs in bits, not in value.
  const double ratio =
      difference > 0 ? tolerance / difference : std::numeric_limits<double>::infinity();
  if (result_.tightest && result_.tightest->ratio <= ratio) return;
  result_.tightest = Headroom{ratio, tick_, channel};
}

namespace {

Deviation deviation_at(std::size_t tick, std::size_t channel, const Trace& got,
                       const Sample& want) {
  const Channel& signal = channels()[channel];
  return {tick,
          got.samples[tick].in.timestamp,
          channel,
          value_of(signal, got.samples[tick]),
          value_of(signal, want),
          0,
          0,
          suspected_stages(ChannelSet().set(channel), got.present, want)};
}

void compare_events(const Trace& got, const Trace& want, Comparison& result) {
  if (!tells_events(want.present)) {
    result = {};
    result.mismatch = "these outputs define no events; compare at the numeric level";
    return;
  }
  const auto non_finite = first_non_finite_event(got, want);
  std::optional<EventDifference> first = non_finite;
  for (const auto& other : {first_event_difference(got, want), first_gross_difference(got, want)}) {
    if (other && (!first || is_before(*other, *first))) first = other;
  }
  if (!first) return;
  result.first = deviation_at(first->tick, first->channel, got, want.samples[first->tick]);
  result.event = first->what;
  result.deviating_ticks = 1;
  result.got_non_finite = non_finite.has_value();
}

}  // namespace

Comparison compare(const Trace& got, const Trace& want, const Tolerances& tolerances) {
  TickComparer comparer(got.present, want.present, tolerances);
  comparer.add(got, want);
  Comparison result = comparer.finish(got.samples.size(), want.samples.size());
  const bool of_events = tolerances.level() == Level::events && result.mismatch.empty();
  if (of_events) compare_events(got, want, result);
  return result;
}

std::optional<Deviation> first_non_finite(const Trace& got, const Trace& want) {
  ChannelSet judged;
  for (std::size_t i = 0; i < channels().size(); ++i) {
    const Channel& channel = channels()[i];
    const bool is_float = channel.is_output() && channel.type == ChannelType::f32;
    judged[i] = is_float && got.present[i] && want.present[i] &&
                std::all_of(want.samples.begin(), want.samples.end(), [&](const Sample& sample) {
                  return std::isfinite(float_of(channel, sample));
                });
  }
  const std::vector<std::size_t> chosen = outputs_by_stage(judged);
  for (std::size_t tick = 0; tick < got.samples.size(); ++tick) {
    for (const std::size_t i : chosen) {
      if (std::isfinite(float_of(channels()[i], got.samples[tick]))) continue;
      // The expected value is taken from the last row of `want` up to that time.
      const auto after = std::upper_bound(
          want.samples.begin(), want.samples.end(), got.samples[tick].in.timestamp,
          [](std::uint64_t time, const Sample& sample) { return time < sample.in.timestamp; });
      const Sample none{};
      return deviation_at(tick, i, got, after == want.samples.begin() ? none : *(after - 1));
    }
  }
  return std::nullopt;
}

}  // namespace attest
