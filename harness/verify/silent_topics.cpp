#include "harness/verify/silent_topics.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

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

// The ticks that publish the topic.
std::vector<std::size_t> ticks_of(const OutputTopic& topic, const Trace& trace) {
  std::vector<std::size_t> ticks;
  for (std::size_t tick = 0; tick < trace.samples.size(); ++tick) {
    if (is_published(channels()[topic.published], trace.samples[tick])) ticks.push_back(tick);
  }
  return ticks;
}

// A topic that is due and not published.
struct Silence {
  Deviation first;
  std::size_t ticks = 0;  // at which it is due
};

Silence silence_of(const OutputTopic& topic, const std::vector<std::size_t>& due,
                   const Trace& want) {
  const Sample& sample = want.samples[due.front()];
  Silence silence{{due.front(), sample.in.timestamp, topic.published}, due.size()};
  silence.first.want = value_of(channels()[topic.published], sample);
  return silence;
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
  ChannelSet outputs;
  std::vector<std::string> published, silent;
  std::optional<Silence> first;
  for (const OutputTopic& topic : output_topics(module)) {
    if (lacks[topic.published] || !want.present[topic.published]) continue;
    const std::vector<std::size_t> due = ticks_of(topic, want);
    if (due.empty()) continue;
    const std::string key = key_of(module, topic.name);
    if (!ticks_of(topic, got).empty()) {
      published.push_back(key);
      continue;
    }
    silent.push_back(key);
    outputs |= outputs_of(key);
    if (!first || due.front() < first->first.tick) first = silence_of(topic, due, want);
  }
  result.published.insert(result.published.end(), published.begin(), published.end());
  if (!first || published.empty()) return {};
  result.silent.insert(result.silent.end(), silent.begin(), silent.end());
  // The other unit of a flight may have been silent before.
  if (!result.first_silence || first->first.timestamp_us < result.first_silence->timestamp_us) {
    result.first_silence = first->first;
    result.silent_ticks = first->ticks;
  }
  return outputs;
}

Result<void> leave_out_silent(const Lacks& lacks, Trace& flown, VectorResult& result) {
  // The expected outputs of a flight cost time, and a silent topic is rare.
  const auto is_silent = [&](const OutputTopic& topic) { return ticks_of(topic, flown).empty(); };
  if (std::ranges::none_of(output_topics(module_of(flown.present)), is_silent)) return {};
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
      const bool is_elsewhere = published.contains(key);
      VectorResult failed = result;
      fail_for(is_elsewhere
                   ? fmt::format("{} is published at no tick", topic_of(topic))
                   : fmt::format("the port never publishes {}, which {} of these vectors need; "
                                 "their other outputs are judged",
                                 topic_of(topic), vectors[key]),
               failed);
      if (is_elsewhere || is_excused(failed) || found.insert(key).second) {
        result = std::move(failed);
      }
    }
  }
}

}  // namespace attest
