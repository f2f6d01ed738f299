#include "harness/diagnosis/hunt_trace.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/golden/reference.hpp"
#include "harness/trace/output_topics.hpp"

namespace attest {
namespace {

constexpr std::int64_t ns_per_us = 1000;

std::uint64_t at(std::uint64_t from_us, std::int64_t offset_us) {
  const auto time = static_cast<std::int64_t>(from_us) + offset_us;
  return time < 0 ? 0 : static_cast<std::uint64_t>(time);
}

// 0: the decision was not measured, or is far. 7: nearer than its least margin.
std::size_t nearness(Decision decision, double distance) {
  if (!std::isfinite(distance)) return 0;
  const double ratio = distance / least_margin(decision);
  if (ratio < 1) return 7;
  return static_cast<std::size_t>(std::clamp(7 - std::log10(ratio) * 1.5, 0.0, 6.0));
}

std::size_t sign_of(float value) {
  if (!std::isfinite(value)) return 3;
  return value == 0 ? 0 : value > 0 ? 1 : 2;
}

constexpr std::size_t first_of_signs = decision_count * 8;
constexpr std::size_t first_of_topics = first_of_signs + 4 * 64;
constexpr std::size_t first_of_changes = first_of_topics + 1024;
static_assert(first_of_changes + 1024 < feature_limit);

// The bits of `updated` and the published topics of a step, as a number below 1024.
std::size_t pattern_of(std::uint32_t updated, const std::vector<const Channel*>& flags,
                       const Sample& sample) {
  std::size_t pattern = updated;
  for (const Channel* flag : flags) pattern = pattern * 2 + (value_of(*flag, sample) != 0 ? 1 : 0);
  return (pattern * 2654435761U >> 7) % 1024;
}

}  // namespace

HuntTopicSet published_in(const Trace& trace) {
  const auto topics = output_topics(module_of(trace.present));
  HuntTopicSet published;
  for (std::size_t i = 0; i < topics.size(); ++i) {
    const Channel& flag = channels()[topics[i].published];
    published[i] = std::ranges::any_of(
        trace.samples, [&](const Sample& sample) { return is_published(flag, sample); });
  }
  return published;
}

HuntTrace::HuntTrace(const HuntInputs& inputs, HuntFeatures* meets)
    : inputs_(inputs),
      meets_(meets),
      present_(channels_of(inputs.subject.module)),
      is_unit_(info_of(inputs.subject.module).is_unit()) {
  for (std::size_t i = 0; i < channels().size(); ++i) {
    const Channel& channel = channels()[i];
    if (!present_[i] || !channel.is_output()) continue;
    outputs_.push_back(&channel);
    if (channel.type == ChannelType::u8) flags_.push_back(&channel);
  }
  (void)rewind();
}

Result<void> HuntTrace::rewind() {
  reference_ = open_reference();
  meter_ = meets_ != nullptr ? margin_meter(inputs_.subject) : nullptr;
  tick_ = quiet_ = step_ = change_ = 0;
  period_ = 0;
  last_pattern_ = 0;
  held_ = Sample();
  published_.reset();
  is_finished_ = false;
  return {};
}

void HuntTrace::add_tick(Trace& part) {
  const HuntTick& tick = inputs_.ticks[tick_];
  const bool is_quiet = quiet_ > 0;
  if (step_ > 0) period_ += is_quiet ? 1 : tick.periods;
  const std::uint64_t now =
      inputs_.start_us + static_cast<std::uint64_t>(inputs_.rate.tick(period_).count() / ns_per_us);
  const std::uint32_t parameters = parameter_bit(inputs_.subject.module);
  std::uint32_t updated = 0;
  for (const HuntTopic& topic : hunt_topics(inputs_.subject.module)) {
    if (is_quiet ? topic.bit != 0 : !topic.is_new(tick.sample)) continue;
    topic.copy(tick.sample, held_);
    for (const Channel* time : topic.times) {
      const std::uint64_t from = is_from_first_tick(*time) ? inputs_.start_us : now;
      set_integer(*time, held_, at(from, relative_us(*time, tick.sample)));
    }
    updated |= topic.bit;
  }
  if (step_ == 0) updated |= parameters;
  for (; !is_quiet && change_ < inputs_.parameters.size(); ++change_) {
    const ParameterChange& change = inputs_.parameters[change_];
    if (change.tick > tick_) break;
    part.parameters.push_back({part.samples.size(), change.name, change.value});
    updated |= parameters;
  }
  held_.in.timestamp = now;
  if (is_unit_) held_.in.updated = updated;
  part.samples.push_back(held_);
  ++step_;
  const bool goes_on = quiet_ < tick.quiet;
  quiet_ = goes_on ? quiet_ + 1 : 0;
  tick_ += goes_on ? 0 : 1;
}

void HuntTrace::note(const Trace& part) {
  PendingChanges changes(part.parameters);
  for (std::size_t tick = 0; tick < part.samples.size(); ++tick) {
    const Sample& sample = part.samples[tick];
    if (meter_) {
      const Margins& margins = meter_->step(changes.take_until(tick), sample);
      for (std::size_t i = 0; i < decision_count; ++i) {
        const auto decision = static_cast<Decision>(i);
        meets_->set(i * 8 + nearness(decision, margins[decision].distance));
      }
    }
    for (std::size_t i = 0; i < outputs_.size() && i < 64; ++i) {
      if (outputs_[i]->type != ChannelType::f32) continue;
      meets_->set(first_of_signs + 4 * i + sign_of(float_of(*outputs_[i], sample)));
    }
    const std::size_t pattern = pattern_of(is_unit_ ? sample.in.updated : 0, flags_, sample);
    meets_->set(first_of_topics + pattern);
    const std::size_t published = pattern_of(0, flags_, sample);
    meets_->set(first_of_changes + (published + 7 * last_pattern_) % 1024);
    last_pattern_ = published;
  }
}

Result<void> HuntTrace::next_part(std::size_t most, Trace& part) {
  part.source = source_;
  part.samples.clear();
  part.parameters.clear();
  part.present = present_;
  const std::size_t first = step_;
  part.samples.reserve(std::min(most, inputs_.steps() - std::min(step_, inputs_.steps())));
  while (part.samples.size() < most && tick_ < inputs_.ticks.size()) add_tick(part);
  if (is_finished_) return {};
  is_finished_ = part.samples.size() < most;
  ModuleUnderTest subject = inputs_.subject;
  subject.part = {first, is_finished_};
  if (const auto fault = reference_->drive(subject, part))
    return fail("the reference: " + fault->what);
  published_ |= published_in(part);
  if (meets_ != nullptr) note(part);
  return {};
}

Trace inputs_of(const HuntInputs& inputs) {
  HuntInputs without_quiet = inputs;
  for (HuntTick& tick : without_quiet.ticks) tick.quiet = 0;
  HuntTrace parts(without_quiet);
  Trace trace;
  trace.present = parts.present();
  while (parts.tick_ < without_quiet.ticks.size()) parts.add_tick(trace);
  return trace;
}

Result<Trace> whole_trace_of(const HuntInputs& inputs) {
  Trace whole;
  HuntTrace parts(inputs);
  if (auto read = parts.next_part(whole_trace, whole); !read) return tl::unexpected(read.error());
  return whole;
}

HuntInputs begin_that_meets(const HuntFeatures& features, const HuntInputs& inputs) {
  HuntFeatures met;
  HuntTrace parts(inputs, &met);
  Trace part;
  std::size_t steps = 0, last = 0;
  constexpr std::size_t steps_of_part = 4;  // the begin may be longer by as much
  for (std::size_t before = 0; before < features.count();) {
    if (!parts.next_part(steps_of_part, part) || part.samples.empty()) return inputs;
    steps += part.samples.size();
    const std::size_t now = (met & features).count();
    if (now > before) last = steps - 1;
    before = now;
  }
  HuntInputs begin = inputs;
  begin.ticks.resize(tick_of_step(inputs, last) + 1);
  std::erase_if(begin.parameters,
                [&](const ParameterChange& change) { return change.tick >= begin.ticks.size(); });
  return begin;
}

std::string text_of(const HuntFeatures& features) {
  std::vector<std::string_view> decisions;
  for (std::size_t i = 0; i < decision_count; ++i) {
    for (std::size_t near = 1; near < 8; ++near) {
      if (!features[i * 8 + near]) continue;
      decisions.push_back(name_of(static_cast<Decision>(i)));
      break;
    }
  }
  if (!decisions.empty()) {
    return fmt::format("the reference came nearer to a decision: {}", fmt::join(decisions, ", "));
  }
  for (std::size_t i = first_of_signs; i < first_of_topics; ++i) {
    if (features[i]) return "an output of the reference had another sign";
  }
  return "topics were new or published in another combination";
}

std::size_t tick_of_step(const HuntInputs& inputs, std::size_t step) {
  std::size_t end = 0;
  for (std::size_t tick = 0; tick < inputs.ticks.size(); ++tick) {
    end += 1 + inputs.ticks[tick].quiet;
    if (step < end) return tick;
  }
  return inputs.ticks.empty() ? 0 : inputs.ticks.size() - 1;
}

}  // namespace attest
