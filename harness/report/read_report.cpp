#include "harness/report/read_report.hpp"

#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/core/error_json.hpp"
#include "harness/core/file.hpp"
#include "harness/core/json_reader.hpp"
#include "harness/core/json_text.hpp"
#include "harness/trace/channels.hpp"
#include "harness/verify/verdict_json.hpp"

namespace attest {
namespace {

using nlohmann::json;

LoopRate rate_from(JsonReader& reader, const std::string& text) {
  const auto rate = LoopRate::parse(text);
  if (rate) return *rate;
  reader.wrong(rate.error().message);
  return {};
}

void read_port(JsonReader reader, RunResult& run) {
  run.port = reader.text("specification");
  run.port_name = reader.text("name");
  run.port_version = reader.text("version");
  if (reader.has("sha256")) run.port_sha256 = reader.text("sha256");
  if (reader.has("files")) run.port_files = reader.texts("files");
  if (reader.has("fraction_bits")) {
    run.fraction_bits = static_cast<int>(reader.integer("fraction_bits"));
  }
  if (reader.has("fixed_step")) run.fixed_step = rate_from(reader, reader.text("fixed_step")).unit;
  if (!reader.has("not_recorded")) return;
  for (const std::string& name : reader.texts("not_recorded")) {
    const ChannelSet named = channels_named(name);
    run.not_recorded |= named;
    if (named.none()) reader.wrong(fmt::format("there is no signal `{}`", name));
  }
}

void read_suite(JsonReader reader, RunResult& run) {
  run.cases_version = reader.text("cases");
  run.golden_version = reader.text("golden");
  run.suite_sha256 = reader.text("sha256");
  run.suite_is_released = reader.flag("released");
  if (reader.has("reference")) run.suite_reference = reader.text("reference");
}

void read_limits(JsonReader reader, RunResult& run) {
  run.limits.own_process = reader.flag("own_process");
  if (!run.limits.own_process) return;
  run.limits.timeout_s = reader.real("timeout_s");
  if (reader.has("memory_gib")) {
    run.limits.memory_gib = static_cast<int>(reader.integer("memory_gib"));
  }
  run.limits.file_mib = static_cast<int>(reader.integer("file_mib"));
  JsonReader barrier = reader.object("barrier");
  run.limits.barrier = {barrier.flag("files"), barrier.flag("signals")};
}

void read_selection(JsonReader reader, RunResult& run) {
  run.selection = reader.text("options");
  run.selected = reader.count("vectors");
  run.all_configurations = reader.flag("whole_cases");
  if (reader.has("timing")) run.timing = reader.text("timing");
  if (reader.has("shard")) {
    const auto shard = Shard::parse(reader.text("shard"));
    if (shard) run.shard = *shard;
    if (!shard) reader.wrong(shard.error().message);
  }
  for (const json& change : reader.list("parameters")) {
    std::string error;
    JsonReader parameter(change, error);
    run.parameters.push_back(
        {0, parameter.text("name"), static_cast<float>(parameter.real("value"))});
    if (!error.empty()) reader.wrong(error);
  }
}

void read_results(JsonReader& reader, RunResult& run) {
  for (const json& one : reader.list("results")) {
    auto result = case_result_from_json(one);
    if (!result) return reader.wrong(result.error().message);
    run.results.push_back(*std::move(result));
  }
  for (const json& one : reader.list("errors")) {
    auto error = error_from_json(one);
    if (!error) return reader.wrong(error.error().message);
    run.errors.push_back(*std::move(error));
  }
}

// Errors: the totals are not those of the results, or the number of results contradicts the number
// of selected vectors.
void check_numbers(JsonReader reader, JsonReader totals, const RunResult& run) {
  for (int i = 0; i < verdict_count; ++i) {
    const auto verdict = static_cast<Verdict>(i);
    const std::string name(name_of(verdict));
    const std::size_t total = totals.count(name.c_str());
    if (total == run.count(verdict)) continue;
    reader.wrong(fmt::format("contradicts itself: its totals have {} {}, its results {}", total,
                             name, run.count(verdict)));
  }
  const std::size_t results = run.results.size();
  const bool may_lack_results = run.stopped_early || !run.errors.empty();
  if (results > run.selected || (results < run.selected && !may_lack_results)) {
    reader.wrong(fmt::format("contradicts itself: {} vectors were selected, but it has {} results",
                             run.selected, results));
  }
}

}  // namespace

Result<RunResult> read_report(const std::string& path) {
  const auto text = read_file(path);
  if (!text) return tl::unexpected(text.error());
  const auto parsed = parse_json(*text, path);
  if (!parsed) return tl::unexpected(parsed.error());
  const json& report = *parsed;
  if (!report.is_object() || report.value("schema", json()) != "attest-report-1") {
    return fail_at(path, "is no report of `attest run --json` of this version of the format");
  }
  std::string error;
  JsonReader reader(report, error);
  RunResult run;
  run.attest_version = reader.text("attest_version");
  const auto level = parse_level(reader.text("level"));
  if (level) run.level = *level;
  if (!level) reader.wrong(level.error().message);
  for (const std::string& rate : reader.texts("rates"))
    run.rates.push_back(rate_from(reader, rate));
  run.date = reader.text("date");
  run.stopped_early = reader.flag("stopped_early");
  read_port(reader.object("port"), run);
  read_suite(reader.object("suite"), run);
  read_limits(reader.object("limits"), run);
  read_selection(reader.object("selection"), run);
  read_results(reader, run);
  if (error.empty()) check_numbers(reader, reader.object("totals"), run);
  if (!error.empty()) return fail_at(path, error);
  return run;
}

}  // namespace attest
