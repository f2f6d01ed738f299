// The columns with the true state of the vehicle, in the trace of a simulated flight. Each is named
// after PX4's topic if there is one: `plant/vehicle_local_position.x`.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "harness/trace/trace.hpp"

namespace attest {

inline constexpr std::string_view plant_prefix = "plant/";

struct PlantColumn {
  std::string name;  // with its prefix
  std::string unit;  // empty for dimensionless
  float (*read)(const PlantSample& sample, std::size_t index);
  std::size_t index;

  float value(const PlantSample& sample) const { return read(sample, index); }
};

// In column order.
std::span<const PlantColumn> plant_columns();

}  // namespace attest
