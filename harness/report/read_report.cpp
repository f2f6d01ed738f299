#include "harness/report/read_report.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/core/error_json.hpp"
#include "harness/core/file.hpp"
#include "harness/core/json_reader.hpp"
#include "harness/core/json_text.hpp"
#include "harness/port/port.hpp"
#include "harness/report/statement.hpp"
#include "harness/trace/channels.hpp"
#include "harness/verify/claim.hpp"
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

// A count of something that a limit or a format allows, as an int.
int small_count(JsonReader& reader, const char* key) {
  constexpr std::uint64_t most = 1'000'000'000;
  const std::uint64_t count = reader.count(key);
  if (count > most) reader.wrong(fmt::format("`{}` is {}, which is too large", key, count));
  return static_cast<int>(std::min(count, most));
}

void read_port(JsonReader reader, RunResult& run) {
  run.port = reader.text("specification");
  run.port_name = reader.text("name");
  run.port_version = reader.text("version");
  for (const std::string& name : reader.texts("modules")) {
    const auto module = module_named(name);
    if (module) run.port_modules |= only(*module);
    if (!module) reader.wrong(fmt::format("there is no module `{}`", name));
  }
  if (reader.has("sha256")) run.port_sha256 = reader.text("sha256");
  if (reader.has("files")) run.port_files = reader.texts("files");
  if (reader.has("fraction_bits")) {
    const auto bits = parse_fraction_bits(fmt::format("fixed:{}", reader.integer("fraction_bits")));
    if (bits) run.fraction_bits = *bits;
    if (!bits) reader.wrong(bits.error().message);
  }
  if (reader.has("fixed_step"))
    run.fixed_step = rate_from(reader, reader.text("fixed_step")).motor_unit;
  if (!reader.has("lacks")) return;
  const auto lacks = Lacks::parse(reader.texts("lacks"));
  if (lacks) run.lacks = *lacks;
  if (!lacks) reader.wrong("`lacks`: " + lacks.error().message);
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
  if (!std::isfinite(run.limits.timeout_s) || run.limits.timeout_s <= 0) {
    reader.wrong(fmt::format("`timeout_s` is {}; it is a time in seconds", run.limits.timeout_s));
  }
  if (reader.has("memory_gib")) run.limits.memory_gib = small_count(reader, "memory_gib");
  run.limits.file_mib = small_count(reader, "file_mib");
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

bool is_negative_or_nan(double value) { return !(value >= 0); }

// A number in the result that attest does not write; empty if there is none.
std::string impossible_number(const VectorResult& result) {
  for (const auto& deviation : {result.first, result.worst}) {
    if (deviation && is_negative_or_nan(deviation->tolerance)) {
      return fmt::format("a tolerance of {}", deviation->tolerance);
    }
  }
  if (result.tightest && is_negative_or_nan(result.tightest->ratio)) {
    return fmt::format("a headroom of {}", result.tightest->ratio);
  }
  for (const Largest& largest : result.largest) {
    if (is_negative_or_nan(largest.deviation)) {
      return fmt::format("a largest deviation of {}", largest.deviation);
    }
  }
  for (const MetricResult& metric : result.metrics) {
    if (metric.tolerance < 0 || std::isnan(metric.min) || std::isnan(metric.max)) {
      return fmt::format("impossible bounds of the metric `{}`", metric.name);
    }
  }
  return "";
}

// What contradicts a verdict that says that all compared outputs were right; empty if nothing does.
std::string sign_of_failure(const VectorResult& result) {
  if (result.first || result.worst) return "has a deviation";
  if (result.deviating_ticks > 0)
    return fmt::format("has {} deviating ticks", result.deviating_ticks);
  const bool passes = result.verdict == Verdict::pass || result.verdict == Verdict::xpass;
  if (!passes) return "";
  if (result.ticks == 0) return "has no tick that was compared";
  if (result.tightest && result.tightest->ratio < 1) {
    return fmt::format("has a headroom of {}, below 1", result.tightest->ratio);
  }
  for (const MetricResult& metric : result.metrics) {
    if (!metric.within()) return fmt::format("has the metric `{}` out of its bounds", metric.name);
  }
  const bool has_reason = result.verdict == Verdict::pass && !result.reason.empty();
  return has_reason ? fmt::format("has the reason `{}`", result.reason) : "";
}

// What in the result contradicts the rest of the report; empty if nothing does.
std::string contradiction(const VectorResult& result, const RunResult& run) {
  if (std::string number = impossible_number(result); !number.empty()) return "has " + number;
  const auto& rates = run.rates;
  if (std::find(rates.begin(), rates.end(), result.rate) == rates.end()) {
    return fmt::format("is at {} Hz, which `rates` does not have", result.rate.to_string());
  }
  if (result.exact_only && run.level == Level::exact) {
    return "is skipped as a vector of the exact level, which is the level of the run";
  }
  if (!result.lacking.empty() && result.verdict != Verdict::unsupported) {
    return "lacks features, but is not unsupported";
  }
  if (!(result.lacking.empty() && result.has_after_all.empty()) && !run.lacks.any()) {
    return "is of a port that lacks something, which `port` does not have";
  }
  const bool is_right = !fails_a_run(result.verdict) || result.verdict == Verdict::xpass;
  if (!is_right || result.verdict == Verdict::xfail) return "";
  const std::string sign = sign_of_failure(result);
  return sign.empty() ? ""
                      : fmt::format("has the verdict {}, but {}", name_of(result.verdict), sign);
}

// A topic that a vector lacks, without a vector of its profile that failed for it; empty if there
// is none.
std::string unsettled_topic(const RunResult& run) {
  std::set<std::pair<std::string, std::string>> failed;
  for (const VectorResult& result : run.results) {
    if (result.verdict == Verdict::pass) continue;
    for (const std::string& topic : result.silent) failed.emplace(result.profile, topic);
  }
  for (const VectorResult& result : run.results) {
    for (const std::string& topic : result.silent) {
      if (!failed.contains({result.profile, topic})) return topic;
    }
  }
  return "";
}

void read_results(JsonReader& reader, RunResult& run) {
  std::set<std::string> known;
  for (const json& one : reader.list("results")) {
    auto result = vector_result_from_json(one);
    if (!result) return reader.wrong(result.error().message);
    const std::string id = result->id();
    std::string error;
    const std::string stated = JsonReader(one, error).text("id");
    if (stated != id) {
      reader.wrong(fmt::format("contradicts itself: {} has the members of {}", stated, id));
    }
    if (!known.insert(id).second) {
      reader.wrong(fmt::format("contradicts itself: it has {} twice", id));
    }
    if (const std::string what = contradiction(*result, run); !what.empty()) {
      reader.wrong(fmt::format("contradicts itself: {} {}", id, what));
    }
    run.results.push_back(*std::move(result));
  }
  if (const std::string topic = unsettled_topic(run); !topic.empty()) {
    reader.wrong(
        fmt::format("contradicts itself: no vector failed because {} is not published", topic));
  }
  for (const json& one : reader.list("errors")) {
    auto error = error_from_json(one);
    if (!error) return reader.wrong(error.error().message);
    run.errors.push_back(*std::move(error));
  }
}

void read_not_run(JsonReader& reader, std::string& error, RunResult& run) {
  if (!reader.has("not_run")) return;
  for (const json& one : reader.list("not_run")) {
    JsonReader left(one, error);
    const std::string rate = left.text("rate");
    run.not_run.push_back({left.text("profile"), left.text("group"), rate_from(left, rate),
                           static_cast<std::size_t>(left.count("vectors"))});
  }
}

// Errors: the totals are not those of the results, or the number of results contradicts the number
// of selected vectors, or of those that were not run.
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
  std::size_t not_run = 0;
  for (const NotRun& left : run.not_run) not_run += left.vectors;
  const bool has_too_many = not_run > 0 && (!run.stopped_early || results + not_run > run.selected);
  if (has_too_many) {
    reader.wrong(
        fmt::format("contradicts itself: it has {} results of {} vectors, and {} were not "
                    "run",
                    results, run.selected, not_run));
  }
}

// What in the result contradicts the level of its case; empty if nothing does.
std::string_view contradiction_of_level(const VectorResult& result, const Case& the_case,
                                        Level level) {
  if (result.exact_only && !the_case.exact_only) {
    return "is skipped as a vector of the exact level, but its case is compared at every level";
  }
  const bool passes = result.verdict == Verdict::pass || result.verdict == Verdict::xpass;
  return passes && the_case.exact_only && level != Level::exact
             ? "passes, but its case is compared at the exact level only"
             : "";
}

}  // namespace

Result<ReadReport> read_report(const std::string& path) {
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
  ReadReport run;
  run.conformant = reader.flag("conformant");
  run.conformance = reader.text("conformance");
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
  read_not_run(reader, error, run);
  if (error.empty()) check_numbers(reader, reader.object("totals"), run);
  if (!error.empty()) return fail_at(path, error);
  return run;
}

Result<void> check_against(const std::vector<SelectedCase>& cases, const ReadReport& report,
                           const std::string& path) {
  std::map<std::string, const Case*> vectors;
  RunResult run = report;
  for (const SelectedCase& selected : cases) {
    const Case& the_case = selected.the_case;
    auto& rates = run.suite[the_case.profile + "/" + the_case.group];
    for (const RunConfiguration& configuration : the_case.configurations()) {
      vectors.emplace(the_case.id_at(configuration), &the_case);
      ++rates[configuration.rate];
    }
  }
  for (const VectorResult& result : run.results) {
    const auto found = vectors.find(result.id());
    if (found == vectors.end()) {
      return fail_at(path, fmt::format("{} is no vector of the suite", result.id()));
    }
    const std::string_view wrong = contradiction_of_level(result, *found->second, run.level);
    if (!wrong.empty()) return fail_at(path, fmt::format("{} {}", result.id(), wrong));
  }
  const bool conforms = standing_of(run) == Standing::conformant;
  const std::string statement = conformance_statement(run);
  if (conforms == report.conformant && statement == report.conformance) return {};
  return fail_at(path,
                 fmt::format("contradicts itself: it states `{}`{}, but its results give `{}`",
                             report.conformance,
                             report.conformant == conforms ? "" : " and `conformant`", statement));
}

}  // namespace attest
