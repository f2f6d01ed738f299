#include "harness/report/rate_sweep_document.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/core/version.hpp"
#include "harness/report/failure_text.hpp"
#include "harness/report/text.hpp"

namespace attest {
namespace {

constexpr float no_value = std::numeric_limits<float>::quiet_NaN();

// The limits of a vehicle on a plant: a row of the table, and a line in the plots.
struct Line {
  PlantConfiguration on;
  int vehicle = 0;                                // number of the vehicle, for the colour
  double lowest_rate_hz = -1;                     // below 0: no rate is within the bounds
  std::vector<double> largest_delay_ms = {};      // by rate; below 0: no delay is within the bounds
  std::string failure = {};                       // of the port; empty: the port did not fail
  std::map<double, RateSweepTrial> flights = {};  // without further delay, by rate [Hz]

  std::string name() const { return fmt::format("{} on {}", on.vehicle, name_of(on.plant)); }
};

std::vector<Line> lines_in(const RateSweepRun& run) {
  std::vector<Line> lines;
  for (const auto& [result, lowest_rate_hz, largest_delay_ms, trials] : run.results) {
    const PlantConfiguration& on = *result.plant_configuration;
    if (lines.empty() || lines.back().on != on) {
      const bool is_other = !lines.empty() && lines.back().on.vehicle != on.vehicle;
      lines.push_back({on, lines.empty() ? 0 : lines.back().vehicle + (is_other ? 1 : 0)});
    }
    Line& line = lines.back();
    if (result.verdict != Verdict::pass && line.failure.empty()) {
      line.failure = fmt::format("{}: {}", name_of(result.verdict), one_line(result.reason));
    }
    if (lowest_rate_hz) line.lowest_rate_hz = *lowest_rate_hz;
    if (largest_delay_ms) line.largest_delay_ms.push_back(*largest_delay_ms);
    for (const RateSweepTrial& trial : trials) {
      if (trial.delay_ms == 0) line.flights.emplace(trial.rate_hz, trial);
    }
  }
  return lines;
}

// Each vehicle has a colour. On plants other than the first of plant_kinds its line is dark and
// dotted, because the lines of two plants often coincide.
PlotSeries empty_series(const Line& line) {
  constexpr int dark = 5;
  const bool is_first = line.on.plant == plant_kinds.front();
  return {line.name(),
          {},
          {},
          is_first ? LinePattern::solid : LinePattern::dotted,
          is_first ? line.vehicle % dark : dark};
}

Cell limit_cell(double value) {
  if (value < 0) return {"none", Verdict::fail};
  return fmt::format("{:g}", value);
}

DocumentTable limits_table(const RateSweepRun& run, const std::vector<Line>& lines) {
  DocumentTable table{
      "Lowest loop rate, and largest delay of the motor commands, within the bounds",
      {"vehicle", "plant", "lowest rate [Hz]"}};
  for (const LoopRate& rate : run.rates) {
    table.header.push_back(fmt::format("delay at {} Hz [ms]", rate.to_string()));
  }
  for (const Line& line : lines) {
    std::vector<Cell> row = {line.on.vehicle, std::string(name_of(line.on.plant)),
                             limit_cell(line.lowest_rate_hz)};
    for (const double delay : line.largest_delay_ms) row.push_back(limit_cell(delay));
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::string what_is_missed(const Case& the_case, const RateSweepTrial& trial) {
  if (trial.values.empty()) return "the vehicle is lost";
  std::vector<std::string> missed;
  for (std::size_t i = 0; i < trial.values.size(); ++i) {
    const Metric& metric = the_case.flight->metrics[i];
    const double value = trial.values[i];
    if (value >= metric.min && value <= metric.max) continue;
    const MetricResult as_result{metric.name, metric.measure, value, 0, 0, metric.min, metric.max};
    missed.push_back(fmt::format("{} ({}) is {:.4g}, allowed: {}", metric.name,
                                 name_of(metric.measure), value, metric_bounds(as_result)));
  }
  return fmt::format("{}", fmt::join(missed, "; "));
}

DocumentTable failing_table(const RateSweepRun& run, const std::vector<Line>& lines) {
  DocumentTable table{"Highest rate at which a metric is out of bounds",
                      {"vehicle and plant", "rate [Hz]", "what is missed"}};
  for (const Line& line : lines) {
    const auto failing = std::find_if(line.flights.rbegin(), line.flights.rend(),
                                      [](const auto& flight) { return !flight.second.holds; });
    if (failing == line.flights.rend()) continue;
    table.rows.push_back({line.name(), fmt::format("{:g}", failing->first),
                          what_is_missed(run.the_case, failing->second)});
  }
  return table;
}

PlotBand bounds_of(const Metric& metric, const std::vector<PlotSeries>& series) {
  double first = std::numeric_limits<double>::max(), last = 0;
  for (const PlotSeries& one : series) {
    first = std::min(first, one.x.front());
    last = std::max(last, one.x.back());
  }
  const auto [low, high] = drawn_bounds(metric.min, metric.max, series);
  return {"within bounds", {first, last}, {low, low}, {high, high}};
}

Plot metric_plot(const Metric& metric, std::size_t number, const std::vector<Line>& lines) {
  Plot plot{fmt::format("{}: {}", metric.name, name_of(metric.measure)),
            std::string(unit_of(metric.measure)), "infinite values are not drawn"};
  plot.logarithmic_x = true;
  for (const Line& line : lines) {
    PlotSeries series = empty_series(line);
    for (const auto& [rate_hz, trial] : line.flights) {
      series.x.push_back(rate_hz);
      series.y.push_back(trial.values.empty() ? no_value
                                              : static_cast<float>(trial.values[number]));
    }
    if (!series.x.empty()) plot.series.push_back(std::move(series));
  }
  if (!plot.series.empty()) plot.band = bounds_of(metric, plot.series);
  return plot;
}

Plot delay_plot(const RateSweepRun& run, const std::vector<Line>& lines) {
  Plot plot{"Largest delay of the motor commands", "ms"};
  plot.logarithmic_x = true;
  for (const Line& line : lines) {
    std::map<double, float> by_rate;
    for (std::size_t i = 0; i < line.largest_delay_ms.size(); ++i) {
      const double delay = line.largest_delay_ms[i];
      by_rate[run.rates[i].hertz()] = delay < 0 ? no_value : static_cast<float>(delay);
    }
    PlotSeries series = empty_series(line);
    for (const auto& [rate_hz, delay] : by_rate) {
      series.x.push_back(rate_hz);
      series.y.push_back(delay);
    }
    plot.series.push_back(std::move(series));
  }
  return plot;
}

bool has_no_value(const Plot& plot) {
  return std::ranges::none_of(plot.series, [](const PlotSeries& series) {
    return std::ranges::any_of(series.y, [](float value) { return std::isfinite(value); });
  });
}

}  // namespace

Document rate_sweep_document(const RateSweepRun& run) {
  const std::vector<Line> lines = lines_in(run);
  Document document;
  for (const Line& line : lines) {
    if (line.failure.empty()) continue;
    document.notes.push_back({fmt::format("{}: {}", line.name(), line.failure), true});
  }
  const bool failed = !document.notes.empty();
  document.head = {failed ? Conclusion::fail : Conclusion::measured,
                   fmt::format("{}: limits of loop rate and delay", run.the_case.id()),
                   fmt::format("{} {}, {} with a plant", run.says.name, run.says.version,
                               counted(lines.size(), "vehicle"))};
  document.facts = {{"attest", version}, {"port", run.port}};
  document.tables = {limits_table(run, lines), failing_table(run, lines)};
  if (document.tables.back().rows.empty()) document.tables.pop_back();
  PlotGroup group{"By loop rate", "loop rate [Hz]", {}};
  const auto& metrics = run.the_case.flight->metrics;
  for (std::size_t i = 0; i < metrics.size(); ++i) {
    group.plots.push_back(metric_plot(metrics[i], i, lines));
  }
  group.plots.push_back(delay_plot(run, lines));
  std::erase_if(group.plots, has_no_value);
  if (!group.plots.empty()) document.groups = {std::move(group)};
  return document;
}

std::string rate_sweep_csv(const RateSweepRun& run) {
  const auto cell = [](double value) { return value < 0 ? "" : fmt::format("{:g}", value); };
  std::string out = "vehicle,plant,rate_hz,largest_delay_ms,lowest_rate_hz\n";
  for (const Line& line : lines_in(run)) {
    for (std::size_t i = 0; i < line.largest_delay_ms.size(); ++i) {
      out += fmt::format("{},{},{},{},{}\n", line.on.vehicle, name_of(line.on.plant),
                         run.rates[i].to_string(), cell(line.largest_delay_ms[i]),
                         cell(line.lowest_rate_hz));
    }
  }
  return out;
}

}  // namespace attest
