#include "harness/loop/timing_file.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/core/file.hpp"
#include "harness/core/json_text.hpp"

namespace attest {
namespace {

using nlohmann::json;

constexpr int format = 1;

constexpr const char* attitude_ticks = "attitude_ticks_ns";

// Enough for an hour at the rates 4000:8000: 43.2e6 ticks of about 45 bytes.
constexpr std::uintmax_t most_bytes = std::uintmax_t{2} << 30;

// Ten times the longest `duration_s`. Sums of such times fit into 64 bits.
constexpr std::int64_t most_ns = 10'000'000'000'000'000;

std::optional<Nanoseconds> time_of(const json& value) {
  if (!value.is_number_integer()) return std::nullopt;
  const bool is_above = value.is_number_unsigned() && value.get<std::uint64_t>() > most_ns;
  if (is_above || value.get<std::int64_t>() < -most_ns) return std::nullopt;
  return Nanoseconds(value.get<std::int64_t>());
}

std::optional<LoopTick> tick_of(const json& value) {
  if (!value.is_array() || value.size() != 3) return std::nullopt;
  const auto sampled = time_of(value[0]), begins = time_of(value[1]), commanded = time_of(value[2]);
  if (!sampled || !begins || (!commanded && !value[2].is_null())) return std::nullopt;
  return LoopTick{*sampled, *begins, commanded};
}

// Whether `tick` follows `last` as LoopTiming requires; `last` is null for the first tick.
bool follows(const LoopTick& tick, const LoopTick* last, Nanoseconds last_commanded) {
  const Nanoseconds commanded = tick.commanded.value_or(std::max(last_commanded, tick.begins));
  const bool ordered = tick.sampled <= tick.begins && tick.begins <= commanded &&
                       last_commanded <= commanded && tick.begins >= Nanoseconds(0);
  if (last == nullptr) return ordered;
  return ordered && last->sampled <= tick.sampled &&
         last->begins + std::chrono::microseconds(1) <= tick.begins;
}

Result<LoopTiming> ticks_of(const json& values, const std::string& file) {
  const auto wrong = [&](std::size_t tick) {
    return fail_at(file, fmt::format("tick {}: {} is not [sampled, begins, commanded] in "
                                     "nanoseconds up to 1e16, each at or after the one before it",
                                     tick, text_of(values[tick])));
  };
  LoopTiming ticks;
  for (const json& value : values) {
    const auto tick = tick_of(value);
    if (!tick) return wrong(ticks.size());
    ticks.push_back(*tick);
  }
  if (const auto tick = first_disorder(ticks)) return wrong(*tick);
  if (ticks.empty()) return fail_at(file, "has no ticks");
  return ticks;
}

Result<RunConfiguration> configuration_of(const json& root) {
  auto rate = LoopRate::parse(root.value("rate", ""));
  if (!rate) return tl::unexpected(rate.error());
  auto plant = parse_plant_kind(root.value("plant", ""));
  if (!plant) return tl::unexpected(plant.error());
  return RunConfiguration{*rate, PlantConfiguration{root.value("vehicle", ""), *plant}};
}

json ticks_json(const LoopTiming& timing) {
  json ticks = json::array();
  for (const LoopTick& tick : timing) {
    json commanded = tick.commanded ? json(tick.commanded->count()) : json();
    ticks.push_back({tick.sampled.count(), tick.begins.count(), std::move(commanded)});
  }
  return ticks;
}

}  // namespace

std::optional<std::size_t> first_disorder(const LoopTiming& timing) {
  Nanoseconds last_commanded{0};
  for (std::size_t i = 0; i < timing.size(); ++i) {
    if (!follows(timing[i], i > 0 ? &timing[i - 1] : nullptr, last_commanded)) return i;
    last_commanded = timing[i].commanded.value_or(last_commanded);
  }
  return std::nullopt;
}

Result<TimingFile> read_timing(const std::filesystem::path& path) {
  const std::string file = path.string();
  const auto text = read_file(path, most_bytes);
  if (!text) return tl::unexpected(text.error());
  const auto parsed = parse_json(*text, file);
  if (!parsed) return tl::unexpected(parsed.error());
  const json& root = *parsed;
  const auto texts = {"case", "case_sha256", "rate", "vehicle", "plant"};
  bool complete = root.is_object() && root.contains("attest_timing") &&
                  root["attest_timing"] == format && root.contains("ticks_ns") &&
                  root["ticks_ns"].is_array() && root.contains("duration_s") &&
                  root["duration_s"].is_number();
  for (const char* key : texts) complete = complete && root.contains(key) && root[key].is_string();
  if (!complete) {
    return fail_at(file, "is no timing file; `attest stress --record-timing` writes them");
  }
  auto configuration = configuration_of(root);
  if (!configuration) return fail_at(file, configuration.error().message);
  auto ticks = ticks_of(root["ticks_ns"], file);
  if (!ticks) return tl::unexpected(ticks.error());
  FlightTiming times(*std::move(ticks));
  if (configuration->rate.attitude_unit) {
    if (!root.contains(attitude_ticks) || !root[attitude_ticks].is_array()) {
      return fail_at(file, fmt::format("has two rates, but no `{}`", attitude_ticks));
    }
    auto attitude = ticks_of(root[attitude_ticks], file);
    if (!attitude) return tl::unexpected(attitude.error());
    times.attitude_unit = *std::move(attitude);
  }
  TimingFile timing{root["case"], root["case_sha256"], *configuration, root["duration_s"],
                    std::move(times)};
  const bool sane = timing.duration_s > 0 && timing.duration_s <= 1e6;
  if (!sane) return fail_at(file, "`duration_s` must be positive, up to 1e6");
  const auto& attitude = timing.ticks.attitude_unit;
  if (!attitude.empty() && in_seconds(attitude.back().begins) >= timing.duration_s) {
    return fail_at(file, fmt::format("`{}` has ticks after `duration_s`", attitude_ticks));
  }
  return timing;
}

Result<void> write_timing(const TimingFile& timing, const std::filesystem::path& path) {
  return AtomicFile::open(path).and_then(
      [&](AtomicFile&& file) { return write_timing(timing, std::move(file)); });
}

Result<void> write_timing(const TimingFile& timing, AtomicFile file) {
  json root = {{"attest_timing", format},
               {"case", timing.case_id},
               {"case_sha256", timing.case_sha256},
               {"rate", timing.configuration.rate.to_string()},
               {"vehicle", timing.configuration.plant_configuration->vehicle},
               {"plant", name_of(timing.configuration.plant_configuration->plant)},
               {"duration_s", timing.duration_s},
               {"ticks_ns", ticks_json(timing.ticks.unit)}};
  if (timing.configuration.rate.attitude_unit) {
    root[attitude_ticks] = ticks_json(timing.ticks.attitude_unit);
  }
  return file.commit(text_of(root) + "\n");
}

Case with_timing(Case the_case, const TimingFile& timing) {
  the_case.duration = {timing.duration_s, Span::In::seconds};
  std::erase_if(the_case.flight->metrics, [&](const Metric& metric) {
    const bool starts = metric.window.from_s < timing.duration_s &&
                        (!metric.versus || metric.versus->from_s < timing.duration_s);
    return !starts;
  });
  return the_case;
}

}  // namespace attest
