#include <nlohmann/json.hpp>

#include "harness/core/json_reader.hpp"
#include "harness/core/json_text.hpp"
#include "harness/report/conclusion.hpp"
#include "harness/report/failure_text.hpp"
#include "harness/report/report.hpp"
#include "harness/report/statement.hpp"
#include "harness/report/text.hpp"
#include "harness/verify/claim.hpp"
#include "harness/verify/verdict_json.hpp"

namespace attest {
namespace {

using nlohmann::ordered_json;

ordered_json totals(const RunResult& run) {
  ordered_json out;
  for (int i = 0; i < verdict_count; ++i) {
    const auto verdict = static_cast<Verdict>(i);
    out[std::string(name_of(verdict))] = run.count(verdict);
  }
  return out;
}

ordered_json rates(const RunResult& run) {
  ordered_json out = ordered_json::array();
  for (const LoopRate& rate : run.rates) out.push_back(rate.to_string());
  return out;
}

ordered_json errors(const RunResult& run) {
  ordered_json out = ordered_json::array();
  for (const Error& error : run.errors) {
    out.push_back({{"message", error.message},
                   {"file", error.file},
                   {"line", error.line},
                   {"column", error.column}});
  }
  return out;
}

// The members in an order that is easy to read, without the elapsed times.
ordered_json results(const RunResult& run) {
  ordered_json out = ordered_json::array();
  for (const VectorResult& result : run.results) {
    const nlohmann::json all = to_json(result);
    ordered_json entry;
    for (const char* key : {"id",        "profile",    "group",    "name",
                            "rate",      "vehicle",    "plant",    "verdict",
                            "reason",    "exact_only", "applies",  "by_golden",
                            "no_golden", "compared",   "ticks",    "deviating_ticks",
                            "first",     "worst",      "tightest", "largest",
                            "metrics",   "after",      "lacking",  "has_after_all",
                            "silent"}) {
      if (all.contains(key)) entry[key] = all[key];
    }
    out.push_back(std::move(entry));
  }
  return out;
}

ordered_json not_run(const RunResult& run) {
  ordered_json out = ordered_json::array();
  for (const NotRun& left : run.not_run) {
    out.push_back({{"profile", left.profile},
                   {"group", left.group},
                   {"rate", left.rate.to_string()},
                   {"vectors", left.vectors}});
  }
  return out;
}

// Which vectors were selected, and with which parameters and timing.
ordered_json selection(const RunResult& run) {
  ordered_json parameters = ordered_json::array();
  for (const ParameterChange& change : run.parameters) {
    parameters.push_back({{"name", change.name}, {"value", json_of(change.value)}});
  }
  ordered_json out = {{"options", run.selection},
                      {"vectors", run.selected},
                      {"whole_cases", run.all_configurations},
                      {"parameters", parameters}};
  if (run.shard.count > 1) out["shard"] = run.shard.to_string();
  if (!run.timing.empty()) out["timing"] = run.timing;
  return out;
}

ordered_json diagnosis(const Diagnosis& found) {
  ordered_json suspects = ordered_json::array();
  for (const Suspect& suspect : found.suspects) {
    ordered_json others = ordered_json::array();
    for (const faults::Fault* other : suspect.ambiguity_group) others.push_back(other->id);
    suspects.push_back({{"fault", suspect.fault->id},
                        {"stage", name_of(suspect.fault->stage)},
                        {"what", suspect.fault->what},
                        {"kind", suspect.fault->kind},
                        {"explained_vectors", suspect.explained},
                        {"ambiguity_group", others}});
  }
  ordered_json patterns = ordered_json::array();
  for (const Pattern& pattern : found.patterns) {
    patterns.push_back({{"stage", name_of(pattern.stage)},
                        {"axes", pattern.axes},
                        {"relation", pattern.relation},
                        {"condition", pattern.condition},
                        {"vectors", pattern.vectors},
                        {"groups", pattern.groups},
                        {"text", pattern_text(pattern)}});
  }
  ordered_json first_stages = ordered_json::array();  // at most one
  if (found.first_stage) first_stages.push_back(name_of(*found.first_stage));
  const std::string first = found.first_stage ? std::string(name_of(*found.first_stage)) : "";
  ordered_json out = {{"stage", found.stage ? std::string(name_of(*found.stage)) : first},
                      {"vectors", found.vectors},
                      {"failing_vectors", found.failing},
                      {"unexplained_vectors", found.unexplained},
                      {"first_stages", first_stages},
                      {"suspects", suspects},
                      {"patterns", patterns},
                      {"remarks", found.remarks}};
  out["specific_case"] = {
      {"case", found.specific_case}, {"faults", found.shown_by_it}, {"why", one_line(found.why)}};
  return out;
}

ordered_json claims(const RunResult& run) {
  ordered_json out = ordered_json::array();
  for (const Claim& claim : claims_of(run)) {
    out.push_back({{"profile", claim.profile},
                   {"conformant", claim.conforms()},
                   {"groups", claim.whole},
                   {"modules", claim.modules},
                   {"of_modules", claim.is_of_modules},
                   {"failing", claim.failing},
                   {"missing", claim.missing}});
  }
  return out;
}

ordered_json limits(const Limits& of) {
  ordered_json out = {{"own_process", of.own_process}};
  if (!of.own_process) return out;
  out["timeout_s"] = of.timeout_s;
  if (of.memory_gib) out["memory_gib"] = *of.memory_gib;
  out["file_mib"] = of.file_mib;
  out["barrier"] = {{"files", of.barrier.files}, {"signals", of.barrier.signals}};
  return out;
}

ordered_json port(const RunResult& run) {
  ordered_json out = {
      {"specification", run.port}, {"name", run.port_name}, {"version", run.port_version}};
  if (!run.port_sha256.empty()) out["sha256"] = run.port_sha256;
  if (!run.port_files.empty()) out["files"] = run.port_files;
  out["modules"] = names_of(run.port_modules);
  if (run.fraction_bits) out["fraction_bits"] = *run.fraction_bits;
  if (run.fixed_step) out["fixed_step"] = run.fixed_step->to_string();
  if (run.lacks.any()) out["lacks"] = run.lacks.words;
  return out;
}

ordered_json suite(const RunResult& run) {
  ordered_json out = {{"cases", run.cases_version},
                      {"golden", run.golden_version},
                      {"sha256", run.suite_sha256},
                      {"released", run.suite_is_released}};
  if (!run.suite_reference.empty()) out["reference"] = run.suite_reference;
  return out;
}

}  // namespace

std::string json_report(const RunResult& run, const std::optional<Diagnosis>& found) {
  ordered_json report = {
      {"schema", "attest-report-1"},
      {"attest_version", run.attest_version},
      {"port", port(run)},
      {"level", name_of(run.level)},
      {"selection", selection(run)},
      {"rates", rates(run)},
      {"totals", totals(run)},
      {"conformant", standing_of(run) == Standing::conformant},
      {"standing", name_of(standing_of(run))},
      {"conformance", conformance_statement(run)},
      {"claims", claims(run)},
      {"suite", suite(run)},
      {"date", run.date},
      {"limits", limits(run.limits)},
      {"stopped_early", run.stopped_early},
      {"errors", errors(run)},
      {"results", results(run)},
  };
  if (!run.not_run.empty()) report["not_run"] = not_run(run);
  if (found) report["diagnosis"] = diagnosis(*found);
  return document_of(report);
}

}  // namespace attest
