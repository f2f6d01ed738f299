#include "harness/report/html/flight_page.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "harness/report/document.hpp"
#include "harness/report/failure_text.hpp"
#include "harness/report/html/flight_plots.hpp"

namespace attest {
namespace {

std::string plant_of(const SimulatedFlight& flight) {
  const auto& configuration = flight.result.plant_configuration;
  return configuration ? std::string(name_of(configuration->plant)) : "";
}

// A flight in which the port fails may have no metrics, so the rows are those of the flight with
// the most metrics.
DocumentTable metrics_table(const std::vector<SimulatedFlight>& flights) {
  const auto most = std::max_element(flights.begin(), flights.end(),
                                     [](const SimulatedFlight& a, const SimulatedFlight& b) {
                                       return a.result.metrics.size() < b.result.metrics.size();
                                     });
  DocumentTable table{"Metrics of the flight", {"metric"}};
  for (const SimulatedFlight& flight : flights) {
    table.header.push_back(flights.size() > 1 ? plant_of(flight) : "value");
  }
  table.header.push_back("bounds");
  for (std::size_t i = 0; i < most->result.metrics.size(); ++i) {
    const MetricResult& metric = most->result.metrics[i];
    std::vector<Cell> row = {{metric.name, std::nullopt, std::string(name_of(metric.measure))}};
    bool all_within = true;
    for (const SimulatedFlight& flight : flights) {
      const auto& metrics = flight.result.metrics;
      const bool is_known = i < metrics.size();
      row.push_back(is_known ? fmt::format("{:.4g}", metrics[i].value) : "-");
      all_within = all_within && is_known && metrics[i].within();
    }
    row.push_back({all_within ? "within" : "missed", all_within ? Verdict::pass : Verdict::fail,
                   metric_bounds(metric)});
    table.rows.push_back(std::move(row));
  }
  return table;
}

DocumentHead page_conclusion(const std::vector<SimulatedFlight>& flights,
                             const Declarations& port) {
  const auto failed = std::find_if(
      flights.begin(), flights.end(),
      [](const SimulatedFlight& flight) { return flight.result.verdict != Verdict::pass; });
  const VectorResult& result = (failed == flights.end() ? flights.front() : *failed).result;
  std::string title = flights.front().result.id();
  for (std::size_t i = 1; i < flights.size(); ++i) title += " and on " + plant_of(flights[i]);
  return {result.verdict, std::string(name_of(result.verdict)), std::move(title),
          fmt::format("{} {}, {} ticks", port.name, port.version, flights.front().result.ticks)};
}

}  // namespace

std::string flight_page(const std::vector<SimulatedFlight>& flights, const Declarations& port) {
  Document page;
  page.head = page_conclusion(flights, port);
  page.tables = {metrics_table(flights)};
  if (page.tables.front().rows.empty()) page.tables.clear();
  std::vector<NamedFlight> flown;
  for (const SimulatedFlight& flight : flights) {
    const std::string plant = flights.size() > 1 ? plant_of(flight) : "";
    const std::string& reason = flight.result.reason;
    if (!reason.empty()) {
      page.notes.push_back({plant.empty() ? reason : fmt::format("{}: {}", plant, reason), true});
    }
    if (!flight.flown.trace.samples.empty()) flown.push_back({plant, &flight.flown});
  }
  if (!flown.empty()) {
    page.groups = {flight_plots(flown)};
    page.replay = replay_of(flown);
  }
  return html_page(page);
}

}  // namespace attest
