#include "harness/report/replay_json.hpp"

#include <nlohmann/json.hpp>

#include "harness/core/json_reader.hpp"
#include "harness/core/json_text.hpp"
#include "harness/core/version.hpp"
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

ordered_json topic_of(const TopicAgreement& topic, const LoggedOutput& logged,
                      const LogLimits& limits) {
  ordered_json out = {{"topic", topic.topic},
                      {"judged", topic.not_judged.empty()},
                      {"not_judged", topic.not_judged},
                      {"agrees", topic.agrees(limits)},
                      {"logged", logged.samples},
                      {"paired", logged.paired},
                      {"left_out", topic.left_out},
                      {"within", topic.within},
                      {"between_samples", topic.between_samples},
                      {"unexplained", topic.unexplained()},
                      {"missing", topic.missing},
                      {"non_finite", topic.non_finite},
                      {"median", json_of(topic.median)},
                      {"p90", json_of(topic.p90)},
                      {"p99", json_of(topic.p99)},
                      {"largest", json_of(topic.largest)}};
  if (topic.first_unexplained) out["first_unexplained"] = pair_of(*topic.first_unexplained);
  return out;
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
    entry["topics"].push_back(topic_of(result.topics[i], unit.outputs[i], limits));
  }
  entry["notes"] = log.notes;
  return entry;
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
