#include "harness/verify/verdict_json.hpp"

#include <bit>
#include <charconv>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/core/json_reader.hpp"

namespace attest {
namespace {

using nlohmann::json;

// The members that are lists of names, absent if empty.
constexpr std::pair<const char*, std::vector<std::string> VectorResult::*> lists[] = {
    {"after", &VectorResult::after},
    {"lacking", &VectorResult::lacking},
    {"has_after_all", &VectorResult::has_after_all},
    {"published", &VectorResult::published},
    {"silent", &VectorResult::silent},
};

std::string float_bits(double value) {
  return fmt::format("0x{:08x}", std::bit_cast<std::uint32_t>(static_cast<float>(value)));
}

// Writes the name of a channel, and its module if an earlier channel has the same name.
void name_channel(std::size_t index, json& out) {
  const Channel& channel = channels()[index];
  out["channel"] = channel.name;
  if (channels_named(channel.name)._Find_first() != index) out["module"] = name_of(channel.module);
}

json deviation_to_json(const Deviation& deviation) {
  const Channel& channel = channels()[deviation.channel];
  json out = {
      {"tick", deviation.tick},
      {"timestamp_us", deviation.timestamp_us},
      {"stage", name_of(stage_of(deviation))},
      {"got", json_of(deviation.got)},
      {"want", json_of(deviation.want)},
      {"ulp", deviation.ulp},
      {"tolerance", json_of(deviation.tolerance)},
  };
  if (deviation.stages.any()) out["stages"] = attest::names_of(deviation.stages);
  name_channel(deviation.channel, out);
  if (channel.type == ChannelType::f32) {
    out["got_bits"] = float_bits(deviation.got);
    out["want_bits"] = float_bits(deviation.want);
  }
  return out;
}

json headroom_to_json(const Headroom& headroom) {
  json out = {{"ratio", json_of(headroom.ratio)}, {"tick", headroom.tick}};
  name_channel(headroom.channel, out);
  return out;
}

json largest_to_json(const Largest& largest) {
  json out = {{"deviation", json_of(largest.deviation)}};
  name_channel(largest.channel, out);
  return out;
}

std::size_t channel_from(JsonReader& reader, const char* key) {
  const std::string name = reader.text(key);
  const ChannelSet named = channels_named(name);
  if (reader.has("module")) {
    const auto module = module_named(reader.text("module"));
    const auto index = module ? find_channel(*module, name) : std::nullopt;
    if (index) return *index;
  } else if (named.any()) {
    return named._Find_first();
  }
  reader.wrong(fmt::format("there is no signal `{}`", name));
  return 0;
}

// Returns `value`; if it is NaN, with the sign and the payload of the bits under `key`.
double with_bits(JsonReader& reader, double value, const char* key) {
  if (!reader.has(key)) return value;
  const std::string text = reader.text(key);
  std::uint32_t bits = 0;
  const char* const end = text.data() + text.size();
  const bool hex = text.size() == 10 && text.starts_with("0x") &&
                   std::from_chars(text.data() + 2, end, bits, 16).ptr == end;
  if (!hex) reader.wrong(fmt::format("`{}` is not 0x and 8 hex digits", key));
  const float exact = std::bit_cast<float>(bits);
  return hex && std::isnan(value) && std::isnan(exact) ? static_cast<double>(exact) : value;
}

StageSet stages_from(JsonReader& reader, const char* key) {
  StageSet stages;
  for (const std::string& name : reader.texts(key)) {
    const auto stage = stage_named(name);
    if (stage) stages |= only(*stage);
    if (!stage) reader.wrong(fmt::format("there is no stage `{}`", name));
  }
  return stages;
}

Deviation deviation_from(JsonReader reader) {
  Deviation out;
  out.tick = reader.count("tick");
  out.timestamp_us = reader.count("timestamp_us");
  out.channel = channel_from(reader, "channel");
  out.got = with_bits(reader, reader.real("got"), "got_bits");
  out.want = with_bits(reader, reader.real("want"), "want_bits");
  out.ulp = reader.integer("ulp");
  out.tolerance = reader.real("tolerance");
  if (reader.has("stages")) out.stages = stages_from(reader, "stages");
  return out;
}

json metric_to_json(const MetricResult& metric) {
  return {{"name", metric.name},
          {"measure", name_of(metric.measure)},
          {"value", json_of(metric.value)},
          {"reference", json_of(metric.reference)},
          {"tolerance", json_of(metric.tolerance)},
          {"min", json_of(metric.min)},
          {"max", json_of(metric.max)},
          {"within", metric.within()}};
}

MetricResult metric_from(JsonReader reader) {
  MetricResult out;
  out.name = reader.text("name");
  const auto measure = parse_measure(reader.text("measure"));
  if (!measure) reader.wrong(measure.error().message);
  if (measure) out.measure = *measure;
  out.value = reader.real("value");
  out.reference = reader.real("reference");
  out.tolerance = reader.real("tolerance");
  out.min = reader.real("min");
  out.max = reader.real("max");
  return out;
}

PlantConfiguration plant_configuration_from(JsonReader reader) {
  PlantConfiguration plant_configuration{reader.text("vehicle"), PlantKind::mujoco};
  const auto plant = parse_plant_kind(reader.text("plant"));
  if (!plant) reader.wrong(plant.error().message);
  if (plant) plant_configuration.plant = *plant;
  return plant_configuration;
}

Headroom headroom_from(JsonReader reader) {
  return {reader.real("ratio"), reader.count("tick"), channel_from(reader, "channel")};
}

}  // namespace

nlohmann::json to_json(const VectorResult& result) {
  json out = {
      {"id", result.id()},
      {"profile", result.profile},
      {"group", result.group},
      {"name", result.name},
      {"rate", result.rate.to_string()},
      {"verdict", name_of(result.verdict)},
      {"reason", result.reason},
      {"ticks", result.ticks},
      {"deviating_ticks", result.deviating_ticks},
      {"elapsed_s", json_of(result.elapsed_s)},
  };
  if (result.exact_only) out["exact_only"] = true;
  if (!result.applies) out["applies"] = false;
  if (result.by_golden) out["by_golden"] = true;
  if (result.no_golden) out["no_golden"] = true;
  if (result.compared) out["compared"] = name_of(*result.compared);
  if (result.first) out["first"] = deviation_to_json(*result.first);
  if (result.worst) out["worst"] = deviation_to_json(*result.worst);
  if (result.tightest) out["tightest"] = headroom_to_json(*result.tightest);
  for (const Largest& largest : result.largest) {
    out["largest"].push_back(largest_to_json(largest));
  }
  if (result.plant_configuration) {
    out["vehicle"] = result.plant_configuration->vehicle;
    out["plant"] = name_of(result.plant_configuration->plant);
  }
  for (const MetricResult& metric : result.metrics) {
    out["metrics"].push_back(metric_to_json(metric));
  }
  for (const auto& [key, list] : lists) {
    if (!(result.*list).empty()) out[key] = result.*list;
  }
  if (result.first_silence) {
    out["first_silence"] = deviation_to_json(*result.first_silence);
    out["silent_ticks"] = result.silent_ticks;
  }
  return out;
}

Result<VectorResult> vector_result_from_json(const nlohmann::json& json) {
  std::string error;
  JsonReader reader(json, error);
  VectorResult out;
  out.profile = reader.text("profile");
  out.group = reader.text("group");
  out.name = reader.text("name");
  out.reason = reader.text("reason");
  out.ticks = reader.count("ticks");
  out.deviating_ticks = reader.count("deviating_ticks");
  if (reader.has("elapsed_s")) out.elapsed_s = reader.real("elapsed_s");
  const std::string verdict = reader.text("verdict");
  if (const auto known = parse_verdict(verdict))
    out.verdict = *known;
  else
    reader.wrong(fmt::format("there is no verdict `{}`", verdict));
  out.exact_only = reader.has("exact_only") && reader.flag("exact_only");
  out.applies = !reader.has("applies") || reader.flag("applies");
  out.by_golden = reader.has("by_golden") && reader.flag("by_golden");
  out.no_golden = reader.has("no_golden") && reader.flag("no_golden");
  if (reader.has("compared")) {
    const auto level = parse_level(reader.text("compared"));
    if (!level) reader.wrong(level.error().message);
    out.compared = level ? std::optional(*level) : std::nullopt;
  }
  if (out.exact_only && out.verdict != Verdict::skip) {
    reader.wrong(fmt::format("`exact_only` is of a skip, and the verdict is {}", verdict));
  }
  if (!out.applies && is_judged(out.verdict)) {
    reader.wrong(fmt::format("does not apply to the port, and the verdict is {}", verdict));
  }
  if (const auto rate = LoopRate::parse(reader.text("rate")))
    out.rate = *rate;
  else
    reader.wrong(rate.error().message);
  if (reader.has("first")) out.first = deviation_from({reader.member("first"), error});
  if (reader.has("worst")) out.worst = deviation_from({reader.member("worst"), error});
  if (reader.has("tightest")) out.tightest = headroom_from({reader.member("tightest"), error});
  if (reader.has("largest")) {
    for (const auto& one : reader.list("largest")) {
      JsonReader largest(one, error);
      out.largest.push_back({channel_from(largest, "channel"), largest.real("deviation")});
    }
  }
  if (reader.has("vehicle")) out.plant_configuration = plant_configuration_from({json, error});
  for (const auto& [key, list] : lists) {
    if (reader.has(key)) out.*list = reader.texts(key);
  }
  if (reader.has("first_silence")) {
    out.first_silence = deviation_from({reader.member("first_silence"), error});
    out.silent_ticks = reader.count("silent_ticks");
  }
  if (reader.has("metrics")) {
    for (const auto& metric : reader.member("metrics")) {
      out.metrics.push_back(metric_from({metric, error}));
    }
  }
  if (!error.empty()) return fail("a case result as JSON: " + error);
  return out;
}

}  // namespace attest
