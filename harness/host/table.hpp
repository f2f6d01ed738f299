// A table of numbers, as other programs exchange it: columns with names, a row for each tick.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "harness/trace/trace.hpp"

namespace attest {

struct Column {
  std::string name;
  std::vector<double> values;           // as many as in the other columns
  ChannelType type = ChannelType::f32;  // for writing; reading does not set it
};

using Table = std::vector<Column>;

// All columns of a trace, in the order of its CSV columns.
Table table_of(const Trace& trace);
// Those of the inputs and parameters.
Table inputs_of(const Trace& trace);

// The name as an identifier of MATLAB, C or Python. Names with the same identifier are the same
// name: "out/actuator_controls_0.control[1]" is "out_actuator_controls_0_control_1", and so is
// what MATLAB makes of it, "out_actuator_controls_0_control_1_".
std::string identifier_of(std::string_view name);

}  // namespace attest
