#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "harness/core/json_reader.hpp"
#include "harness/core/json_text.hpp"
#include "harness/core/version.hpp"
#include "harness/report/replay_document.hpp"
#include "harness/verify/verdict_json.hpp"

namespace attest {
namespace {

using nlohmann::ordered_json;

ordered_json entry_of(const VectorResult& result, Module module, const char* kind) {
  return {{"file", result.name},
          {"kind", kind},
          {"module", name_of(module)},
          {"profile", result.profile},
          {"verdict", name_of(result.verdict)},
          {"reason", result.reason},
          {"ticks", result.ticks}};
}

ordered_json pair_of(const LoggedPair& pair) {
  return {{"tick", pair.tick},
          {"timestamp_us", pair.timestamp_us},
          {"channel", channels()[pair.channel].name},
          {"got", json_of(pair.got)},
          {"logged", json_of(pair.logged)}};
}

// `logged`, `paired`: samples of the topic in the log; of these, those of a tick.
ordered_json topic_of(const TopicAgreement& topic, std::size_t logged, std::size_t paired,
                      const LogLimits& limits) {
  ordered_json out = {{"topic", topic.topic},
                      {"condition", topic.condition},
                      {"judged", topic.not_judged.empty()},
                      {"not_judged", topic.not_judged},
                      {"agrees", topic.agrees(limits)},
                      {"logged", logged},
                      {"paired", paired},
                      {"left_out", topic.left_out},
                      {"within", topic.within},
                      {"between_samples", topic.between_samples},
                      {"unexplained", topic.unexplained()},
                      {"missing", topic.missing},
                      {"mistakes", topic.mistakes},
                      {"non_finite", topic.non_finite},
                      {"median", json_of(topic.median)},
                      {"p90", json_of(topic.p90)},
                      {"p99", json_of(topic.p99)},
                      {"largest", json_of(topic.largest)}};
  if (topic.first_unexplained) out["first_unexplained"] = pair_of(*topic.first_unexplained);
  if (topic.worst) out["worst"] = pair_of(*topic.worst);
  return out;
}

ordered_json json_of_steps(const SingleSteps& steps) {
  ordered_json left_out = ordered_json::array();
  for (const auto& [why, outputs] : steps.left_out) {
    left_out.push_back({{"why", why}, {"outputs", outputs}});
  }
  return {{"logged", steps.logged},
          {"with_own_setpoint", steps.with_own_setpoint},
          {"with_given_setpoint", steps.with_given_setpoint},
          {"oldest_setpoint_us", steps.oldest_us},
          {"left_out", left_out}};
}

}  // namespace

ordered_json json_of_trace(const VectorResult& result, Module module) {
  ordered_json entry = entry_of(result, module, "trace");
  const nlohmann::json all = to_json(result);
  for (const char* key : {"deviating_ticks", "first", "worst", "tightest"}) {
    if (all.contains(key)) entry[key] = all[key];
  }
  return entry;
}

ordered_json json_of_unit(const FlightLog& log, const LoggedUnit& unit, const LogResult& result,
                          const LogLimits& limits) {
  ordered_json entry = entry_of(result.result, unit.module, "log");
  entry["has_every_step"] = unit.has_every_step;
  entry["topics"] = ordered_json::array();
  for (std::size_t i = 0; i < result.topics.size(); ++i) {
    const TopicAgreement& topic = result.topics[i];
    entry["topics"].push_back(
        result.single_steps ? topic_of(topic, result.single_steps->logged, topic.paired, limits)
                            : topic_of(topic, output_of(unit, topic.topic).samples,
                                       output_of(unit, topic.topic).paired, limits));
  }
  if (result.single_steps) entry["single_steps"] = json_of_steps(*result.single_steps);
  if (is_judged(result.result.verdict)) {
    entry["not_judged"] = ordered_json::array();
    for (const auto& [what, why] : not_judged_in(unit, result)) {
      entry["not_judged"].push_back({{"what", what}, {"why", why}});
    }
  }
  entry["notes"] = log.notes;
  if (result.result.verdict == Verdict::pass) {
    entry["pass_means"] = meaning_of_pass(unit.trace.source);
  }
  return entry;
}

std::string not_judged_text(const std::vector<ordered_json>& entries) {
  std::vector<std::pair<std::string, std::vector<std::string>>> by_reason;
  for (const ordered_json& entry : entries) {
    for (const ordered_json& one : entry.value("not_judged", ordered_json::array())) {
      const auto why = one.at("why").get<std::string>(), what = one.at("what").get<std::string>();
      auto known = std::ranges::find(by_reason, why, &decltype(by_reason)::value_type::first);
      if (known == by_reason.end()) known = by_reason.insert(known, {why, {}});
      if (std::ranges::find(known->second, what) == known->second.end()) {
        known->second.push_back(what);
      }
    }
  }
  std::vector<std::string> parts;
  for (const auto& [why, outputs] : by_reason) {
    parts.push_back(fmt::format("{} ({})", fmt::join(outputs, ", "), why));
  }
  return parts.empty() ? "" : fmt::format("not judged: {}", fmt::join(parts, "; "));
}

std::string replay_json(const std::string& port, std::string_view level, const LogLimits& limits,
                        const std::vector<ordered_json>& results) {
  return document_of({{"schema", "attest-replay-1"},
                      {"attest_version", version},
                      {"port", port},
                      {"level", level},
                      {"log_limits",
                       {{"within", limits.within},
                        {"least_part_within", limits.least_part_within},
                        {"most_unexplained", limits.most_unexplained}}},
                      {"results", results}});
}

}  // namespace attest
