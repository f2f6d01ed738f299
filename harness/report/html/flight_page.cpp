#include "harness/report/html/flight_page.hpp"

#include <fmt/format.h>

#include "harness/report/failure_text.hpp"
#include "harness/report/html/embedded.hpp"
#include "harness/report/html/flight_plots.hpp"
#include "harness/report/html/page_parts.hpp"
#include "harness/report/text.hpp"

namespace attest {
namespace {

data metric_to_data(const MetricResult& metric) {
  data out;
  set_text(out, "name", one_line(metric.name));
  set_text(out, "measure", name_of(metric.measure));
  set_text(out, "value", fmt::format("{:.4g}", metric.value));
  set_text(out, "bounds", metric_bounds(metric));
  const Verdict verdict = metric.within() ? Verdict::pass : Verdict::fail;
  set_text(out, "class", fmt::format("is-{}", name_of(verdict)));
  set_text(out, "word",
           fmt::format("{} {}", symbol_of(verdict), metric.within() ? "within" : "missed"));
  return out;
}

}  // namespace

std::string flight_page(const SimulatedFlight& flight, const PortSays& port) {
  const CaseResult& result = flight.result;
  const bool passed = result.verdict == Verdict::pass;
  data page;
  add_files(page, {{"plots_script", plots_script()}, {"flight_script", flight_script()}});
  set_text(page, "conclusion", passed ? "PASS" : "FAIL");
  set_text(page, "conclusion_symbol", symbol_of(result.verdict));
  set_text(page, "verdict", name_of(result.verdict));
  set_text(page, "id", one_line(result.id()));
  set_text(page, "port_name", one_line(port.name));
  set_text(page, "port_version", one_line(port.version));
  set_text(page, "ticks", fmt::to_string(result.ticks));
  set_text(page, "reason", one_line(result.reason));
  page.set("metrics", list_of(result.metrics, metric_to_data));
  if (!flight.flown.samples.empty()) set_text(page, "flight", flight_plots_json(flight.flown));
  kainjow::mustache::mustache page_of{std::string(flight_template())};
  return page_of.render(page);
}

}  // namespace attest
