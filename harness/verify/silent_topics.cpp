#include "harness/verify/silent_topics.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>

#include <fmt/format.h>

#include "harness/golden/reference.hpp"
#include "harness/trace/output_topics.hpp"

namespace attest {
namespace {

// "rate_unit/rate_ctrl_status": two modules may have a topic of the same name.
std::string key_of(Module module, std::string_view topic) {
  return fmt::format("{}/{}", name_of(module), topic);
}

std::string_view topic_of(std::string_view key) { return key.substr(key.find('/') + 1); }

ChannelSet outputs_of(std::string_view key) {
  const auto module = module_named(key.substr(0, key.find('/')));
  return module ? channels_of(*module, fmt::format("out/{}.", topic_of(key))) : ChannelSet();
}

// The first tick that publishes; empty if none does.
std::optional<std::size_t> first_published(const OutputTopic& topic, const Trace& trace) {
  const Channel& flag = channels()[topic.published];
  const auto found = std::ranges::find_if(
      trace.samples, [&](const Sample& sample) { return is_published(flag, sample); });
  if (found == trace.samples.end()) return std::nullopt;
  return static_cast<std::size_t>(found - trace.samples.begin());
}

std::size_t count_published(const OutputTopic& topic, const Trace& trace) {
  const Channel& flag = channels()[topic.published];
  return static_cast<std::size_t>(std::ranges::count_if(
      trace.samples, [&](const Sample& sample) { return is_published(flag, sample); }));
}

Deviation missing(const OutputTopic& topic, std::size_t tick, const Trace& want) {
  Deviation deviation;
  deviation.tick = tick;
  deviation.timestamp_us = want.samples[tick].in.timestamp;
  deviation.channel = topic.published;
  deviation.got = 0;
  deviation.want = value_of(channels()[topic.published], want.samples[tick]);
  deviation.ulp = 1;
  return deviation;
}

// Two profiles are two ports.
std::string key_in(const VectorResult& result, const std::string& topic) {
  return fmt::format("{} {}", result.profile, topic);
}

void fail_for(const std::string& reason, VectorResult& result) {
  result.reason = result.reason.empty() ? reason : fmt::format("{}; {}", reason, result.reason);
  if (result.verdict == Verdict::pass) result.verdict = Verdict::fail;
  if (!result.first) {
    result.first = result.first_silence;
    result.deviating_ticks = result.silent_ticks;
  }
  result.tightest.reset();
}

}  // namespace

ChannelSet silent_outputs(const Trace& got, const Trace& want, const ChannelSet& lacks,
                          VectorResult& result) {
  const Module module = module_of(want.present);
  ChannelSet silent;
  std::vector<std::string> published, not_published;
  for (const OutputTopic& topic : output_topics(module)) {
    if (lacks[topic.published] || !want.present[topic.published]) continue;
    const auto due = first_published(topic, want);
    if (!due) continue;
    const std::string key = key_of(module, topic.name);
    if (first_published(topic, got)) {
      published.push_back(key);
      continue;
    }
    not_published.push_back(key);
    silent |= channels_of(module, fmt::format("out/{}.", topic.name));
    const Deviation first = missing(topic, *due, want);
    if (result.first_silence && result.first_silence->timestamp_us <= first.timestamp_us) continue;
    result.first_silence = first;
    result.silent_ticks = count_published(topic, want);
  }
  result.published.insert(result.published.end(), published.begin(), published.end());
  if (silent.none() || published.empty()) {
    result.first_silence.reset();
    return {};
  }
  result.silent.insert(result.silent.end(), not_published.begin(), not_published.end());
  return silent;
}

namespace {

// Whether the port publishes every topic at a tick.
bool publishes_all(const Trace& flown) {
  return std::ranges::all_of(output_topics(module_of(flown.present)),
                             [&](const OutputTopic& topic) {
                               return std::ranges::any_of(flown.samples, [&](const Sample& sample) {
                                 return is_published(channels()[topic.published], sample);
                               });
                             });
}

}  // namespace

Result<void> leave_out_silent(const Lacks& lacks, Trace& flown, VectorResult& result) {
  if (publishes_all(flown)) return {};
  const auto want = reference_outputs({result.profile, module_of(flown.present)}, flown);
  if (!want) return tl::unexpected(want.error());
  flown.present &= ~silent_outputs(flown, *want, lacks.outputs, result);
  return {};
}

namespace {

std::set<std::string> published_in(const std::vector<VectorResult>& results) {
  std::set<std::string> published;
  for (const VectorResult& result : results) {
    for (const std::string& topic : result.published) published.insert(key_in(result, topic));
  }
  return published;
}

}  // namespace

ChannelSet never_published_outputs(const std::vector<VectorResult>& results) {
  const std::set<std::string> published = published_in(results);
  ChannelSet outputs;
  for (const VectorResult& result : results) {
    for (const std::string& topic : result.silent) {
      if (!published.contains(key_in(result, topic))) outputs |= outputs_of(topic);
    }
  }
  return outputs;
}

void settle_silent_topics(std::vector<VectorResult>& results,
                          const std::function<bool(const VectorResult&)>& is_excused) {
  const std::set<std::string> published = published_in(results);
  std::map<std::string, std::size_t> vectors;
  for (const VectorResult& result : results) {
    for (const std::string& topic : result.silent) ++vectors[key_in(result, topic)];
  }
  std::set<std::string> found;
  for (VectorResult& result : results) {
    if (!is_judged(result.verdict)) continue;
    for (const std::string& topic : result.silent) {
      const std::string key = key_in(result, topic);
      if (published.contains(key)) {
        fail_for(fmt::format("{} is published at no tick", topic_of(topic)), result);
      } else if (is_excused(result) || found.insert(key).second) {
        fail_for(fmt::format("the port never publishes {}, which {} of these vectors need; their "
                             "other outputs are judged",
                             topic_of(topic), vectors[key]),
                 result);
      }
    }
  }
}

}  // namespace attest
