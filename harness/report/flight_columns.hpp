// The signals of a flight that its plots show, as columns with names for readers.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "harness/report/document.hpp"
#include "harness/verify/simulate.hpp"

namespace attest {

using Columns = std::vector<std::pair<std::string, std::vector<float>>>;  // a value for each tick
using ColumnsOf = std::function<Columns(const Flown&)>;

// A column of the trace, and its name in a plot.
struct NamedColumn {
  std::string column, name;
};
using NamedColumns = std::vector<NamedColumn>;
ColumnsOf columns_named(NamedColumns wanted);

NamedColumns about_axes(const std::array<const char*, 3>& columns, const std::string& what);

std::vector<double> seconds_of(const Trace& flown);  // from the first tick

Quaternions attitudes_of(const Flown& flown);
Quaternions setpoints_of(const Flown& flown);  // the attitude setpoint in force at each tick

// Roll, pitch and yaw [deg], with `of` before the name.
Columns angle_columns(const Quaternions& q, const std::string& of);

Columns attitude_error_column(const Flown& flown);  // [deg], as metrics measure it
Columns rate_length_column(const Flown& flown);     // of the body rate [rad/s]
Columns position_columns(const Flown& flown);       // north, east and altitude [m]
Columns motor_columns(const Flown& flown);  // those that turn during the flight, and motor 0

// The columns with the outputs of the law.
struct LawColumns {
  NamedColumns rates_setpoint, controls, thrust, integrals;
  const char* controls_title;
  const char* saturation_title;
};
LawColumns columns_of_law(Module module);

}  // namespace attest
