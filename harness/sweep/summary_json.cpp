#include "harness/sweep/summary_json.hpp"

#include <cmath>

#include <nlohmann/json.hpp>

#include "harness/core/json_text.hpp"

namespace attest {
namespace {

using Json = nlohmann::ordered_json;

constexpr int report_schema = 1;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
Json number(const std::optional<double>& value) { return value ? number(*value) : Json(nullptr); }

Json json_of(const RequirementResult& result) {
  return {{"name", result.requirement.name},
          {"metric", result.requirement.metric},
          {"min", number(result.requirement.min)},
          {"max", number(result.requirement.max)},
          {"probability", result.requirement.probability},
          {"held", result.held},
          {"count", result.count},
          {"interval", {result.probability.low, result.probability.high}},
          {"decision", name_of(result.decision)},
          {"worst", result.worst}};
}

Json json_of(const SobolIndices& sobol, const std::vector<std::string>& dimensions) {
  Json out = {{"blocks", sobol.blocks}, {"left_out", sobol.left_out}, {"indices", Json::object()}};
  for (std::size_t i = 0; i < sobol.dimensions.size(); ++i) {
    const SobolIndex& one = sobol.dimensions[i];
    out["indices"][dimensions[i]] = {
        {"first", one.first},
        {"first_interval", {one.first_interval.low, one.first_interval.high}},
        {"total", one.total},
        {"total_interval", {one.total_interval.low, one.total_interval.high}}};
  }
  return out;
}

Json json_of(const MetricSummary& metric, const SampleColumns& columns) {
  Json correlation = Json::object();
  for (std::size_t i = 0; i < columns.dispersions.size(); ++i) {
    correlation[columns.dispersions[i]] = number(metric.correlation[i]);
  }
  return {{"name", metric.name},       {"count", metric.count},
          {"min", number(metric.min)}, {"median", number(metric.median)},
          {"p95", number(metric.p95)}, {"p99", number(metric.p99)},
          {"max", number(metric.max)}, {"rank_correlation", std::move(correlation)}};
}

Json json_of(const PortDifference& port) {
  Json metrics = Json::array();
  for (const MetricDifference& one : port.metrics) {
    metrics.push_back({{"name", one.name},
                       {"count", one.count},
                       {"above", one.above},
                       {"below", one.below},
                       {"median", number(one.median)},
                       {"p1", number(one.p1)},
                       {"p99", number(one.p99)},
                       {"p_value", one.p_value},
                       {"differs", one.differs}});
  }
  return {{"differs", port.differs()},         {"pairs_needed", port.pairs_needed},
          {"lost_by_port", port.lost_by_port}, {"lost_by_reference", port.lost_by_reference},
          {"lost_p_value", port.p_value},      {"metrics", std::move(metrics)}};
}

}  // namespace

std::string summary_json(const SweepIdentity& identity, const SampleColumns& columns,
                         const SweepSummary& summary) {
  Json out = {{"schema", report_schema},
              {"attest", identity.attest_version},
              {"sweep_sha256", identity.sweep_sha256},
              {"port", identity.port},
              {"port_sha256", identity.port_sha256},
              {"shard", identity.shard},
              {"samples", summary.samples},
              {"planned_samples", summary.planned},
              {"passes", summary.passes()},
              {"outcomes", summary.outcomes},
              {"requirements", Json::array()},
              {"metrics", Json::array()}};
  for (const auto& one : summary.requirements) out["requirements"].push_back(json_of(one));
  for (const auto& one : summary.metrics) {
    out["metrics"].push_back(json_of(one, columns));
    if (one.sobol) out["metrics"].back()["sobol"] = json_of(*one.sobol, summary.dimensions);
  }
  if (summary.port) out["port_difference"] = json_of(*summary.port);
  return document_of(out);
}

}  // namespace attest
