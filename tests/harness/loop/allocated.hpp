// A quad of any size, and the results of an allocation, for the tests of the control allocator.
#pragma once

#include <cmath>
#include <vector>

#include <gmock/gmock.h>

#include "harness/loop/control_allocator.hpp"

namespace attest::test {

MATCHER_P(IsNear, bound, "") {
  const auto& [actual, expected] = arg;
  return std::abs(actual - expected) <= bound;
}

inline Vehicle quad_x(double x_m, double y_m) {
  Vehicle vehicle;
  vehicle.torque_over_thrust_m = 0.06;
  vehicle.rotors = {
      {{x_m, y_m, 0}, 1}, {{-x_m, -y_m, 0}, 1}, {{x_m, -y_m, 0}, -1}, {{-x_m, y_m, 0}, -1}};
  return vehicle;
}

inline std::vector<double> speeds_of(const Allocation& allocation, const Vehicle& vehicle) {
  std::vector<double> speeds;
  for (std::size_t i = 0; i < vehicle.rotors.size(); ++i) {
    speeds.push_back((static_cast<double>(allocation.commands[i]) + 1) / 2);
  }
  return speeds;
}

}  // namespace attest::test
