#include "harness/verify/judge.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "harness/compare/misrecording.hpp"
#include "harness/host/recorded_outputs.hpp"
#include "harness/trace/output_topics.hpp"

namespace attest {

bool marks_declined(const Declarations& port, const std::string& group) {
  const auto& declined = port.unsupported_groups;
  return std::find(declined.begin(), declined.end(), group) != declined.end();
}

bool marks_declined(const Declarations& port, VectorResult& result) {
  if (port.is_recorded && result.plant_configuration) {
    result.verdict = Verdict::skip;
    result.reason = "a recorded port does not fly: the inputs of a flight depend on its outputs";
    return true;
  }
  if (!marks_declined(port, result.group)) return false;
  result.verdict = Verdict::unsupported;
  result.reason = fmt::format("the port declares that it does not support {}", result.group);
  return true;
}

void judge(const PortFault& fault, VectorResult& result) {
  result.reason = fault.what;
  switch (fault.kind) {
    case PortFault::Kind::profile:
      result.applies = false;
      result.verdict = Verdict::skip;
      return;
    case PortFault::Kind::unanswered:
      result.verdict = Verdict::skip;
      return;
    case PortFault::Kind::module:
      result.applies = false;
      result.verdict = Verdict::unsupported;
      return;
    case PortFault::Kind::unsupported:
      result.verdict = Verdict::unsupported;
      return;
    case PortFault::Kind::protocol:
      result.verdict = Verdict::protocol;
      return;
    case PortFault::Kind::crash:
      result.verdict = Verdict::crash;
      return;
    case PortFault::Kind::timeout:
      result.verdict = Verdict::timeout;
      return;
    default:
      result.verdict = Verdict::fail;
  }
}

bool leaves_ticks_to_judge(const PortFault& fault) {
  return fault.kind == PortFault::Kind::unsupported && fault.tick > 0;
}

void leave_out_from(std::size_t tick, const Trace& want, Trace& answered) {
  for (std::size_t i = tick; i < answered.samples.size(); ++i) {
    answered.samples[i].copy_outputs(want.samples[i]);
  }
}

void fill_in(const ChannelSet& not_judged, const Trace& want, Trace& answered) {
  const ChannelSet filled = not_judged & channels_of(module_of(want.present));
  if (filled.none()) return;
  for (std::size_t i = 0; i < channels().size(); ++i) {
    if (!filled[i]) continue;
    for (std::size_t tick = 0; tick < answered.samples.size(); ++tick) {
      copy_value(channels()[i], want.samples[tick], answered.samples[tick]);
    }
  }
  keep_unpublished(answered);
}

bool leaves_values_to_judge(const ChannelSet& not_judged, const Trace& want) {
  const Module module = module_of(want.present);
  ChannelSet values = channels_of(module, "out/") & ~not_judged;
  for (const OutputTopic& topic : output_topics(module)) {
    const Channel& flag = channels()[topic.published];
    values.reset(topic.published);
    const auto publishes = [&](const Sample& sample) { return is_published(flag, sample); };
    if (!not_judged[topic.published] || std::ranges::any_of(want.samples, publishes)) continue;
    values &= ~channels_of(module, fmt::format("out/{}.", topic.name));
  }
  for (std::size_t i = 0; i < channels().size(); ++i) {
    const auto is_something = [&](const Sample& sample) {
      return value_of(channels()[i], sample) != 0;  // NaN is something
    };
    if (values[i] && std::ranges::any_of(want.samples, is_something)) return true;
  }
  return false;
}

void explain_recording(const Trace& answered, const Trace& want, VectorResult& result) {
  const std::string mistake = misrecording(answered, want);
  if (mistake.empty()) return;
  result.reason += fmt::format("{}{}", result.reason.empty() ? "" : "; ", mistake);
}

void judge_after(const PortFault& fault, VectorResult& result) {
  if (result.verdict != Verdict::pass) {
    result.reason += fmt::format("{}an output was wrong before {}",
                                 result.reason.empty() ? "" : "; ", fault.what);
    return;
  }
  result.tightest.reset();
  result.ticks = std::min(result.ticks, fault.tick);
  judge(fault, result);
}

void judge(const Comparison& comparison, VectorResult& result) {
  result.ticks = comparison.ticks;
  result.deviating_ticks = comparison.deviating_ticks;
  result.first = comparison.first;
  result.worst = comparison.worst;
  result.tightest = comparison.tightest;
  result.largest = comparison.largest;
  result.reason = comparison.mismatch.empty() ? comparison.event : comparison.mismatch;
  if (comparison.agrees()) return;
  result.verdict = comparison.got_non_finite ? Verdict::non_finite : Verdict::fail;
  const bool is_shown =
      !comparison.got_non_finite || !comparison.first || !std::isfinite(comparison.first->got);
  if (is_shown) return;
  result.reason = fmt::format("{}{}an output is NaN or infinite where the reference has a number",
                              result.reason, result.reason.empty() ? "" : "; ");
}

}  // namespace attest
