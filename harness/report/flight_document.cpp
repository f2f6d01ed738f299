#include "harness/report/flight_document.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "harness/report/failure_text.hpp"
#include "harness/trace/plant_columns.hpp"

namespace attest {
namespace {

// REQUIRES: a flight with at least one tick of each unit.
struct NamedFlight {
  std::string name;  // the name of the plant; empty for a single flight
  const Flown* flown;
  bool is_reference = false;
};

constexpr std::size_t most_frames = 2000;  // of the animation, evenly spaced

// The values of the column `name`: of a channel, or else of the plant.
std::vector<float> column(const Trace& flown, std::string_view name) {
  std::vector<float> values;
  if (const auto channel = find_channel(module_of(flown.present), name)) {
    for (const Sample& sample : flown.samples) {
      values.push_back(static_cast<float>(value_of(channels()[*channel], sample)));
    }
    return values;
  }
  const auto columns = plant_columns();
  const auto found = std::ranges::find(columns, name, &PlantColumn::name);
  for (const PlantSample& sample : flown.plant) values.push_back(found->value(sample));
  return values;
}

Quaternions quaternions(const Trace& flown, const std::string& name) {
  Quaternions out;
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = column(flown, name + "[" + std::to_string(i) + "]");
  }
  return out;
}

// Roll, pitch and yaw [deg] of the rotation from body to world. The intrinsic rotations are yaw,
// then pitch, then roll, as in the class Euler of PX4.
std::array<float, 3> euler_deg(float w, float x, float y, float z) {
  const float degrees = 180 / std::numbers::pi_v<float>;
  const float sin_pitch = std::clamp(2 * (w * y - z * x), -1.0f, 1.0f);
  return {degrees * std::atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)),
          degrees * std::asin(sin_pitch),
          degrees * std::atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))};
}

using Columns = std::vector<std::pair<std::string, std::vector<float>>>;

// The attitude setpoint in force at each tick.
Quaternions setpoints_of(const Flown& flown) {
  Quaternions out;
  const Trace* const attitude = flown.attitude_trace ? &*flown.attitude_trace : nullptr;
  for (const auto& q_d : attitude_setpoints(flown.trace, attitude)) {
    for (std::size_t i = 0; i < out.size(); ++i) out[i].push_back(q_d[i]);
  }
  return out;
}

// Without jumps of a whole turn, which would hide a small change about half a turn.
Columns angles(const Quaternions& q, const std::string& of) {
  Columns columns = {{of + "roll", {}}, {of + "pitch", {}}, {of + "yaw", {}}};
  for (std::size_t tick = 0; tick < q[0].size(); ++tick) {
    const auto angles_deg = euler_deg(q[0][tick], q[1][tick], q[2][tick], q[3][tick]);
    for (std::size_t i = 0; i < 3; ++i) {
      std::vector<float>& angle = columns[i].second;
      const float before = angle.empty() ? 0 : angle.back();
      const float turns = std::round((angles_deg[i] - before) / 360);
      angle.push_back(angles_deg[i] - 360 * (std::isfinite(turns) ? turns : 0));
    }
  }
  return columns;
}

// A column of the trace, and its name in a plot.
struct NamedColumn {
  std::string column, name;
};
using NamedColumns = std::vector<NamedColumn>;

Columns columns_of(const Trace& flown, const NamedColumns& wanted) {
  Columns columns;
  for (const auto& [of, name] : wanted) columns.emplace_back(name, column(flown, of));
  return columns;
}

std::vector<double> seconds(const Trace& flown) {
  std::vector<double> out;
  for (const Sample& sample : flown.samples) {
    const std::uint64_t elapsed_us = sample.in.timestamp - flown.samples.front().in.timestamp;
    out.push_back(1e-6 * static_cast<double>(elapsed_us));
  }
  return out;
}

// Returns the columns to plot of a flight.
using ColumnsOf = std::function<Columns(const Flown&)>;

Plot plot_of(const std::vector<NamedFlight>& flights, Plot plot, const ColumnsOf& signals,
             const ColumnsOf& setpoints = {}) {
  // The lines of flights that agree coincide. A dark dotted line on a coloured line remains
  // visible.
  constexpr int dark = 5, quiet = 4;
  const auto add = [&](const NamedFlight& flight, const Columns& columns, LinePattern pattern) {
    const std::string suffix = flight.name.empty() ? "" : " (" + flight.name + ")";
    for (std::size_t i = 0; i < columns.size(); ++i) {
      plot.series.push_back({columns[i].first + suffix, seconds(flight.flown->trace),
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

ColumnsOf named(NamedColumns wanted) {
  return
      [wanted = std::move(wanted)](const Flown& flown) { return columns_of(flown.trace, wanted); };
}

// The trace has the position in north, east, down.
Columns position(const Flown& flown) {
  Columns columns = columns_of(flown.trace, {{"plant/vehicle_local_position.x", "north"},
                                             {"plant/vehicle_local_position.y", "east"},
                                             {"plant/vehicle_local_position.z", "altitude"}});
  for (float& down : columns.back().second) down = -down;
  return columns;
}

// The columns of the motors that turn during the flight, and of motor 0.
Columns motors(const Flown& flight) {
  const Trace& flown = flight.trace;
  NamedColumns motors;
  for (std::size_t i = 0; i < std::tuple_size_v<decltype(PlantSample::motor)>; ++i) {
    const bool turns = std::any_of(flown.plant.begin(), flown.plant.end(),
                                   [i](const PlantSample& s) { return s.rotor_rad_s[i] != 0; });
    if (!turns && i > 0) continue;
    const std::string number = std::to_string(i);
    motors.push_back({"plant/actuator_outputs.output[" + number + "]", "motor " + number});
  }
  return columns_of(flown, motors);
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
  const Quaternions attitude = quaternions(flown, "plant/vehicle_attitude.q");
  const Quaternions setpoint = setpoints_of(*flight.flown);
  const std::vector<double> times = seconds(flown);
  ReplayVehicle vehicle;
  vehicle.name = flight.name;
  vehicle.times = at({times.begin(), times.end()}, ticks);
  for (std::size_t i = 0; i < attitude.size(); ++i) {
    vehicle.attitude[i] = at(attitude[i], ticks);
    vehicle.setpoint[i] = at(setpoint[i], ticks);
  }
  return vehicle;
}

// The columns with the outputs of the law.
struct LawColumns {
  NamedColumns rates_setpoint, controls, thrust, integrals;
  const char* controls_title;
  const char* saturation_title;
};

NamedColumns about_axes(const std::array<const char*, 3>& columns, const std::string& what) {
  return {{columns[0], "roll " + what}, {columns[1], "pitch " + what}, {columns[2], "yaw " + what}};
}

LawColumns columns_of_law(Module module) {
  if (module == Module::rate_unit) {
    return {
        about_axes({"in/vehicle_rates_setpoint.roll", "in/vehicle_rates_setpoint.pitch",
                    "in/vehicle_rates_setpoint.yaw"},
                   "setpoint"),
        about_axes({"out/vehicle_torque_setpoint.xyz[0]", "out/vehicle_torque_setpoint.xyz[1]",
                    "out/vehicle_torque_setpoint.xyz[2]"},
                   "torque"),
        {{"out/vehicle_thrust_setpoint.xyz[2]", "thrust, down"}},
        about_axes({"out/rate_ctrl_status.rollspeed_integ", "out/rate_ctrl_status.pitchspeed_integ",
                    "out/rate_ctrl_status.yawspeed_integ"},
                   "integral"),
        "Torque setpoint",
        "Saturation of the allocator"};
  }
  return {about_axes({"out/vehicle_rates_setpoint.roll", "out/vehicle_rates_setpoint.pitch",
                      "out/vehicle_rates_setpoint.yaw"},
                     "setpoint"),
          about_axes({"out/actuator_controls_0.control[0]", "out/actuator_controls_0.control[1]",
                      "out/actuator_controls_0.control[2]"},
                     "control"),
          {{"out/actuator_controls_0.control[3]", "thrust"}},
          about_axes(
              {"out/mc_att_ctrl_status.roll_rate_integ", "out/mc_att_ctrl_status.pitch_rate_integ",
               "out/mc_att_ctrl_status.yaw_rate_integ"},
              "integral"),
          "Controls",
          "Saturation of the mixer"};
}

// Whether all values of all lines are 0, so that the plot shows nothing.
bool is_zero(const Plot& plot) {
  return std::ranges::all_of(plot.series, [](const PlotSeries& series) {
    return std::ranges::all_of(series.y, [](float value) { return value == 0; });
  });
}

// Setpoints are those of the first flight. Plots in which all is zero are left out. REQUIRES: at
// least one flight.
PlotGroup plots_of(const std::vector<NamedFlight>& flights, const std::vector<PlotMark>& marks) {
  const auto attitude = [](const Flown& flown) {
    return angles(quaternions(flown.trace, "plant/vehicle_attitude.q"), "");
  };
  const auto attitude_setpoint = [](const Flown& flown) {
    return angles(setpoints_of(flown), "setpoint ");
  };
  const LawColumns law = columns_of_law(module_of(flights.front().flown->trace.present));
  PlotGroup group{"", "time from the first tick [s]", {}};
  group.plots = {
      plot_of(flights, {"Attitude", "deg"}, attitude, attitude_setpoint),
      plot_of(
          flights, {"Body rates", "rad/s"},
          named(about_axes({"plant/vehicle_attitude.rollspeed", "plant/vehicle_attitude.pitchspeed",
                            "plant/vehicle_attitude.yawspeed"},
                           "rate")),
          named(law.rates_setpoint)),
      plot_of(flights, {law.controls_title}, named(law.controls)),
      plot_of(flights, {"Thrust"}, named(law.thrust)),
      plot_of(flights, {"Integrals"}, named(law.integrals)),
      plot_of(flights, {"Motor commands"}, motors),
      plot_of(flights, {law.saturation_title}, named({{"plant/mixer.saturated", "saturated"}})),
      plot_of(flights, {"Position", "m"}, position)};
  group.plots[6].shape = PlotShape::steps;
  // Of the angles, rates, controls, thrust, integrals, motors, saturation and position: what an
  // engineer would call still.
  const std::array least_spans{1.0, 0.05, 0.02, 0.02, 0.002, 0.02, 1.0, 0.1};
  for (std::size_t i = 0; i < group.plots.size(); ++i) {
    group.plots[i].least_span = least_spans[i];
    group.plots[i].marks = marks;
  }
  std::erase_if(group.plots, is_zero);
  return group;
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
    row.emplace_back(all_within ? "within" : "missed", all_within ? Verdict::pass : Verdict::fail);
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
  return {result.verdict, std::string(name_of(result.verdict)), std::move(title),
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
  document.groups = {plots_of(flown, background.marks)};
  return document;
}

}  // namespace attest
