#include "harness/report/html/flight_page.hpp"

#include <fmt/format.h>

#include "harness/report/failure_text.hpp"
#include "harness/report/html/flight_plots.hpp"
#include "harness/report/html/plot_page.hpp"

namespace attest {
namespace {

PageTable metrics_table(const CaseResult& result) {
  PageTable table{"Metrics of the flight", {"metric", "value", "bounds"}, {}};
  for (const MetricResult& metric : result.metrics) {
    const Verdict verdict = metric.within() ? Verdict::pass : Verdict::fail;
    table.rows.push_back({{metric.name, std::nullopt, std::string(name_of(metric.measure))},
                          fmt::format("{:.4g}", metric.value),
                          {metric.within() ? "within" : "missed", verdict, metric_bounds(metric)}});
  }
  return table;
}

}  // namespace

std::string flight_page(const SimulatedFlight& flight, const PortSays& port) {
  const CaseResult& result = flight.result;
  PlotPage page;
  page.conclusion = {result.verdict, std::string(name_of(result.verdict)), result.id(),
                     fmt::format("{} {}, {} ticks", port.name, port.version, result.ticks)};
  if (!result.reason.empty()) page.notes = {{result.reason, true}};
  if (!result.metrics.empty()) page.tables = {metrics_table(result)};
  if (!flight.flown.samples.empty()) {
    const std::vector<NamedFlight> flights = {{"", &flight.flown}};
    page.groups = {flight_plots(flights)};
    page.replay = replay_of(flights);
  }
  return plot_page(page);
}

}  // namespace attest
