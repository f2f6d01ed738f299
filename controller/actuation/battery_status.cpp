#include "controller/actuation/battery_status.hpp"

namespace attest::actuation {
namespace {

constexpr BatteryOptions defaults;
constexpr float unknown_resistance = -1;

constexpr BatteryParameter table[] = {
    {"BAT_N_CELLS", static_cast<float>(defaults.cell_count), "1",
     "cells in series; 0: not known, and the scale stays 1"},
    {"BAT_V_EMPTY", defaults.empty_cell_V, "V", "a cell's voltage when it is empty"},
    {"BAT_V_CHARGED", defaults.full_cell_V, "V", "a cell's voltage when it is full"},
    {"BAT_V_LOAD_DROP", defaults.load_drop_V, "V", "a cell's drop at full throttle"},
    {"BAT_R_INTERNAL", unknown_resistance, "ohm", "a cell's resistance; negative: unknown"},
};

}  // namespace

std::span<const BatteryParameter> battery_parameters() { return table; }

bool set_battery_parameter(BatteryOptions& options, std::string_view name, float value) {
  if (name == "BAT_N_CELLS") {
    constexpr float most_cells = 100;
    if (!(value >= 0 && value <= most_cells && value == std::floor(value))) return false;
    options.cell_count = static_cast<int>(value);
  } else if (name == "BAT_V_EMPTY") {
    options.empty_cell_V = value;
  } else if (name == "BAT_V_CHARGED") {
    options.full_cell_V = value;
  } else if (name == "BAT_V_LOAD_DROP") {
    options.load_drop_V = value;
  } else if (name == "BAT_R_INTERNAL") {
    options.internal_resistance_ohm = value >= 0 ? std::optional(value) : std::nullopt;
  } else {
    return false;
  }
  return true;
}

}  // namespace attest::actuation
