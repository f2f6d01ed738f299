// A battery that empties: its voltage, and the reduction of the rotors' speed.
#pragma once

#include "harness/core/time.hpp"
#include "harness/plant/vehicle.hpp"

namespace attest {

// No allocation; no clock: the caller passes the time of each measurement.
class Battery {
 public:
  // `charge` [0..1]: the share of the capacity at the start. Until the first update the current is
  // that of hover. REQUIRES: a positive capacity.
  Battery(const BatteryPack& pack, double charge);

  // Measures at `now`. `hover_seconds_used` is that of PlantState. `power_ratio` is the rotors'
  // power divided by their power in hover. REQUIRES: times do not decrease.
  void update(Nanoseconds now, double hover_seconds_used, double power_ratio);

  double charge() const { return charge_; }        // 0..1
  double current_A() const { return current_A_; }  // low-passed
  double voltage_V() const;                        // under load, not below 0

  // The factor on the rotors' speed: the voltage divided by that of a full battery in hover.
  double supply_ratio() const;

 private:
  BatteryPack pack_;
  double initial_charge_;
  double charge_;
  double current_A_;
  Nanoseconds updated_{0};
};

}  // namespace attest
