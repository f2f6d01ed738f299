#include "harness/loop/supply.hpp"

#include <gtest/gtest.h>

namespace attest {
namespace {

constexpr auto whole_seconds = [](std::int64_t count) {
  return Nanoseconds(count * 1'000'000'000);
};

Vehicle with_a_pack() {
  Vehicle vehicle;
  vehicle.mass_kg = 1;
  vehicle.rotors.resize(4);
  vehicle.thrust_coefficient = gravity_m_s2 / 4 / (400.0 * 400.0);  // hovers at 400 rad/s
  vehicle.battery = {.cells = 3,
                     .full_V = 12,
                     .fall_V = 3,
                     .resistance_ohm = 0,
                     .capacity_Ah = 1,
                     .current_filter_s = 0,
                     .hover_current_A = 10};
  return vehicle;
}

PlantState after(double hover_seconds) {
  PlantState state;
  state.hover_seconds_used = hover_seconds;
  state.rotor_rad_s.fill(400);
  return state;
}

TEST(Supply, AnIdealSourceGivesItsAll) { EXPECT_EQ(Supply({}, with_a_pack()).ratio(), 1); }

// 10 A for 180 s are half of 1 Ah.
TEST(Supply, ThePacksCapacityIsUsedUpByTheCurrentOfHover) {
  const Vehicle vehicle = with_a_pack();
  Supply supply(BatteryFlight{}, vehicle);
  supply.sample(whole_seconds(180), after(180), 0.5f, true);
  EXPECT_DOUBLE_EQ(supply.voltage_V(), 12 - 3 * 0.5);
}

TEST(Supply, ACapacityInSecondsOfHoverLastsSoLong) {
  const Vehicle vehicle = with_a_pack();
  BatteryFlight battery;
  battery.capacity_hover_s = 60;
  Supply supply(battery, vehicle);
  supply.sample(whole_seconds(15), after(15), 0.5f, true);
  EXPECT_DOUBLE_EQ(supply.voltage_V(), 12 - 3 * 0.25);
}

}  // namespace
}  // namespace attest
