// The supply of the rotors: an ideal source, or a battery that discharges, with the firmware's
// estimate of its voltage.
#pragma once

#include <optional>

#include "controller/actuation/battery_status.hpp"
#include "controller/attest_unit.h"
#include "harness/casefile/flight.hpp"
#include "harness/plant/battery.hpp"
#include "harness/plant/vehicle.hpp"

namespace attest {

class Supply {
 public:
  Supply(const std::optional<BatteryFlight>& battery, const Vehicle& vehicle);

  // The battery task: measures the battery and returns battery_status.scale. REQUIRES: there is a
  // battery; times do not decrease.
  float sample(Nanoseconds now, const PlantState& state, float throttle, bool armed);

  // The factor on the rotors' speed, at the last sample; 1 with an ideal source.
  double ratio() const { return battery_ ? battery_->supply_ratio() : 1; }

  double voltage_V() const { return battery_ ? battery_->voltage_V() : 0; }  // 0: ideal source

 private:
  const Vehicle& vehicle_;
  std::optional<Battery> battery_;
  std::optional<actuation::BatteryStatus> status_;
};

}  // namespace attest
