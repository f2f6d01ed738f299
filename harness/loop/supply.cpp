#include "harness/loop/supply.hpp"

#include <cmath>

namespace attest {
namespace {

BatteryPack pack_of(const BatteryFlight& flight, const Vehicle& vehicle) {
  BatteryPack pack = vehicle.battery;
  if (flight.capacity_hover_s) {
    constexpr double s_per_h = 3600;
    pack.capacity_Ah = pack.hover_current_A * *flight.capacity_hover_s / s_per_h;
  }
  return pack;
}

}  // namespace

Supply::Supply(const std::optional<BatteryFlight>& battery, const Vehicle& vehicle)
    : vehicle_(vehicle) {
  if (!battery) return;
  battery_.emplace(pack_of(*battery, vehicle), battery->charge);
  status_.emplace(actuation::BatteryOptions{.cell_count = vehicle.battery.cells});
}

float Supply::sample(Nanoseconds now, const PlantState& state, float throttle, bool armed) {
  battery_->update(now, state.hover_seconds_used, vehicle_.power_ratio(state.rotor_rad_s));
  return status_->update({static_cast<float>(battery_->voltage_V()),
                          static_cast<float>(battery_->current_A()), throttle, armed});
}

}  // namespace attest
