#include "harness/report/flight_document.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "harness/report/failure_text.hpp"
#include "harness/report/flight_columns.hpp"
#include "harness/report/text.hpp"

namespace attest {
namespace {

// REQUIRES: a flight with at least one tick of each unit.
struct NamedFlight {
  std::string name;  // the name of the plant; empty for a single flight
  const Flown* flown;
  bool is_reference = false;
};

constexpr std::size_t most_frames = 2000;  // of the animation, evenly spaced

Plot plot_of(const std::vector<NamedFlight>& flights, Plot plot, const ColumnsOf& signals,
             const ColumnsOf& setpoints = {}) {
  // The lines of flights that agree coincide. A dark dotted line on a coloured line remains
  // visible.
  constexpr int dark = 5, quiet = 4;
  const auto add = [&](const NamedFlight& flight, const Columns& columns, LinePattern pattern) {
    const std::string suffix = flight.name.empty() ? "" : " (" + flight.name + ")";
    for (std::size_t i = 0; i < columns.size(); ++i) {
      plot.series.push_back({columns[i].first + suffix, seconds_of(flight.flown->trace),
                             columns[i].second, pattern,
                             pattern != LinePattern::dotted ? static_cast<int>(i)
                             : flight.is_reference          ? quiet
                                                            : dark});
    }
  };
  for (const NamedFlight& flight : flights) {
    const bool is_first = &flight == &flights.front();
    add(flight, signals(*flight.flown), is_first ? LinePattern::solid : LinePattern::dotted);
    if (is_first && setpoints) add(flight, setpoints(*flight.flown), LinePattern::dashed);
  }
  return plot;
}

std::vector<float> at(const std::vector<float>& values, const std::vector<std::size_t>& ticks) {
  std::vector<float> out;
  for (const std::size_t tick : ticks) out.push_back(values[tick]);
  return out;
}

ReplayVehicle replay_of(const NamedFlight& flight) {
  const Trace& flown = flight.flown->trace;
  const std::size_t size = flown.samples.size(), frames = std::min(size, most_frames);
  std::vector<std::size_t> ticks;
  for (std::size_t i = 0; i < frames; ++i) ticks.push_back(i * size / frames);
  const Quaternions attitude = attitudes_of(*flight.flown);
  const Quaternions setpoint = setpoints_of(*flight.flown);
  const std::vector<double> times = seconds_of(flown);
  ReplayVehicle vehicle;
  vehicle.name = flight.name;
  vehicle.times = at({times.begin(), times.end()}, ticks);
  for (std::size_t i = 0; i < attitude.size(); ++i) {
    vehicle.attitude[i] = at(attitude[i], ticks);
    vehicle.setpoint[i] = at(setpoint[i], ticks);
  }
  return vehicle;
}

// Whether all values of all lines are 0, so that the plot shows nothing.
bool is_zero(const Plot& plot) {
  return std::ranges::all_of(plot.series, [](const PlotSeries& series) {
    return std::ranges::all_of(series.y, [](float value) { return value == 0; });
  });
}

// All plots, in the order of FlightPlot. Setpoints are those of the first flight. REQUIRES: at
// least one flight.
std::vector<Plot> all_plots(const std::vector<NamedFlight>& flights) {
  const auto attitude = [](const Flown& flown) { return angle_columns(attitudes_of(flown), ""); };
  const auto attitude_setpoint = [](const Flown& flown) {
    return angle_columns(setpoints_of(flown), "setpoint ");
  };
  const LawColumns law = columns_of_law(module_of(flights.front().flown->trace.present));
  std::vector<Plot> plots = {
      plot_of(flights, {"Attitude", "deg"}, attitude, attitude_setpoint),
      plot_of(flights, {"Attitude error", "deg"}, attitude_error_column),
      plot_of(flights, {"Body rates", "rad/s"},
              columns_named(about_axes(
                  {"plant/vehicle_attitude.rollspeed", "plant/vehicle_attitude.pitchspeed",
                   "plant/vehicle_attitude.yawspeed"},
                  "rate")),
              columns_named(law.rates_setpoint)),
      plot_of(flights, {"Length of the body rate", "rad/s"}, rate_length_column),
      plot_of(flights, {law.controls_title}, columns_named(law.controls)),
      plot_of(flights, {"Thrust"}, columns_named(law.thrust)),
      plot_of(flights, {"Integrals"}, columns_named(law.integrals)),
      plot_of(flights, {"Motor commands"}, motor_columns),
      plot_of(flights, {law.saturation_title},
              columns_named({{"plant/mixer.saturated", "saturated"}})),
      plot_of(flights, {"Position", "m"}, position_columns)};
  plots[static_cast<std::size_t>(FlightPlot::saturation)].shape = PlotShape::steps;
  // What an engineer would call still.
  const std::array least_spans{1.0, 1.0, 0.05, 0.05, 0.02, 0.02, 0.002, 0.02, 1.0, 0.1};
  for (std::size_t i = 0; i < plots.size(); ++i) plots[i].least_span = least_spans[i];
  return plots;
}

// Plots in which all is zero are left out.
PlotGroup plots_of(const std::vector<NamedFlight>& flights, const FlightBackground& background,
                   const std::set<std::string>& missed) {
  std::vector<Plot> plots = all_plots(flights);
  std::set<FlightPlot> measured;
  for (const Metric& metric : background.metrics) {
    const FlightPlot number = plot_of(metric.measure);
    measured.insert(number);
    Plot& plot = plots[static_cast<std::size_t>(number)];
    for (PlotBound& bound : lines_of_bounds(metric, plot)) {
      bound.is_missed = missed.contains(metric.name);
      plot.bounds.push_back(std::move(bound));
    }
  }
  PlotGroup group{"", "time from the first tick [s]", {}};
  for (std::size_t i = 0; i < plots.size(); ++i) {
    const auto number = static_cast<FlightPlot>(i);
    const bool is_of_metrics =
        number == FlightPlot::attitude_error || number == FlightPlot::rate_length;
    if (is_zero(plots[i]) || (is_of_metrics && !measured.contains(number))) continue;
    plots[i].marks = background.marks;
    group.plots.push_back(std::move(plots[i]));
  }
  return group;
}

// The metrics that a flight misses.
std::set<std::string> missed_metrics(const std::vector<SimulatedFlight>& flights) {
  std::set<std::string> missed;
  for (const SimulatedFlight& flight : flights) {
    for (const MetricResult& metric : flight.result.metrics) {
      if (!metric.within()) missed.insert(metric.name);
    }
  }
  return missed;
}

std::string plant_of(const SimulatedFlight& flight) {
  const auto& configuration = flight.result.plant_configuration;
  return configuration ? std::string(name_of(configuration->plant)) : "";
}

// A time is infinite if what it waits for did not happen.
std::string value_of(const MetricResult& metric) {
  return std::isinf(metric.value) ? "never" : fmt::format("{:.4g}", metric.value);
}

// A flight in which the port fails may have no metrics, so the rows are those of the flight with
// the most metrics.
DocumentTable metrics_table(const std::vector<SimulatedFlight>& flights) {
  const auto most = std::ranges::max_element(
      flights, {}, [](const SimulatedFlight& flight) { return flight.result.metrics.size(); });
  DocumentTable table{"Metrics of the flight", {"metric", "measure"}};
  for (const SimulatedFlight& flight : flights) {
    table.header.push_back(flights.size() > 1 ? plant_of(flight) : "value");
  }
  table.header.insert(table.header.end(), {"bounds", ""});
  for (std::size_t i = 0; i < most->result.metrics.size(); ++i) {
    const MetricResult& metric = most->result.metrics[i];
    std::vector<Cell> row = {metric.name, std::string(name_of(metric.measure))};
    bool all_within = true;
    for (const SimulatedFlight& flight : flights) {
      const auto& metrics = flight.result.metrics;
      const bool is_known = i < metrics.size();
      row.emplace_back(is_known ? value_of(metrics[i]) : "-");
      all_within = all_within && is_known && metrics[i].within();
    }
    row.emplace_back(metric_bounds(metric));
    row.emplace_back(std::string(name_of(all_within ? RowVerdict::within : RowVerdict::missed)),
                     all_within ? Verdict::pass : Verdict::fail);
    table.rows.push_back(std::move(row));
  }
  return table;
}

DocumentHead head_of(const std::vector<SimulatedFlight>& flights, const Declarations& port) {
  const auto failed = std::ranges::find_if(flights, [](const SimulatedFlight& flight) {
    return flight.result.verdict != Verdict::pass;
  });
  const VectorResult& result = (failed == flights.end() ? flights.front() : *failed).result;
  std::string title = flights.front().result.id();
  for (std::size_t i = 1; i < flights.size(); ++i) title += " and on " + plant_of(flights[i]);
  return {result.verdict, std::move(title),
          fmt::format("{} {}, {} ticks", port.name, port.version, flights.front().result.ticks)};
}

}  // namespace

Document flight_document(const std::vector<SimulatedFlight>& flights, const Declarations& port,
                         const FlightBackground& background) {
  Document document{head_of(flights, port)};
  document.tables = {metrics_table(flights)};
  if (document.tables.front().rows.empty()) document.tables.clear();
  std::vector<NamedFlight> flown;
  for (const SimulatedFlight& flight : flights) {
    const std::string plant = flights.size() > 1 ? plant_of(flight) : "";
    const std::string& reason = flight.result.reason;
    if (!reason.empty()) {
      document.notes.push_back(
          {plant.empty() ? reason : fmt::format("{}: {}", plant, reason), true});
    }
    if (!flight.flown.trace.samples.empty()) flown.push_back({plant, &flight.flown});
  }
  if (flown.empty()) return document;
  for (const NamedFlight& flight : flown) document.replay.push_back(replay_of(flight));
  if (background.reference && !background.reference->trace.samples.empty()) {
    flown.push_back({"reference", &*background.reference, true});
  }
  document.groups = {plots_of(flown, background, missed_metrics(flights))};
  return document;
}

namespace {

// "1 of 3 metrics is out of its bounds: settles", or why the flight has no metrics.
std::string metrics_sentence(const VectorResult& result) {
  if (!result.reason.empty()) return one_line(result.reason);
  std::vector<std::string> missed;
  for (const MetricResult& metric : result.metrics) {
    if (!metric.within()) missed.push_back(metric.name);
  }
  if (missed.empty()) return "the metrics are within their bounds";
  return fmt::format("{} of {} {} out of {} bounds: {}", missed.size(),
                     counted(result.metrics.size(), "metric"), missed.size() == 1 ? "is" : "are",
                     missed.size() == 1 ? "its" : "their", fmt::join(missed, ", "));
}

}  // namespace

std::string flight_conclusion(const std::vector<SimulatedFlight>& flights, const Document& document,
                              bool is_reference) {
  const auto& shown = *std::ranges::find_if(flights, [&](const SimulatedFlight& flight) {
    return flight.result.verdict == document.head.verdict;
  });
  const auto deviates = [](const SimulatedFlight& flight) {
    return flight.result.first.has_value();
  };
  const bool any_deviates = std::ranges::any_of(flights, deviates);
  if (any_deviates && shown.result.verdict == Verdict::pass) {
    return fmt::format(
        "{} the metrics are within their bounds, which is exit code 0, but the outputs deviate "
        "from the reference's for the same inputs; `attest run` judges them",
        capitals(name_of(RowVerdict::differs)));
  }
  std::string out =
      fmt::format("{} {}", capitals(document.head.word), metrics_sentence(shown.result));
  if (flights.size() > 1 && shown.result.verdict != Verdict::pass) {
    out += fmt::format(" ({})", name_of(shown.result.plant_configuration->plant));
  }
  const bool is_compared =
      !is_reference && is_judged(shown.result.verdict) && shown.result.ticks > 0;
  if (any_deviates) {
    out += "; the outputs deviate from the reference's for the same inputs, too";
  } else if (is_compared) {
    out += "; the outputs agree with the reference's for the same inputs";
  }
  return out;
}

}  // namespace attest
