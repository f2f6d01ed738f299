#include "controller/actuation/battery_status.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/controller/generators.hpp"

namespace attest::actuation {
namespace {

using test::mostly_ordinary_float;

constexpr int cells = 3;

BatterySample at_rest(float cell_V) { return {cell_V * cells, 0.0f, 0.0f, false}; }

// Steps until the initial state of the filter has no effect.
float settled(BatteryStatus& battery, const BatterySample& sample) {
  float scale = 0;
  for (int i = 0; i < 3000; ++i) scale = battery.update(sample);
  return scale;
}

TEST(BatteryStatus, FullCellsNeedNoScaling) {
  BatteryStatus battery({.cell_count = cells});
  EXPECT_NEAR(settled(battery, at_rest(4.05f)), 1.0f, 1e-6f);
  EXPECT_NEAR(battery.remaining(), 1.0f, 1e-5f);
}

TEST(BatteryStatus, EmptyCellsScaleByTheRatioOfVoltages) {
  BatteryStatus battery({.cell_count = cells});
  EXPECT_NEAR(settled(battery, at_rest(3.4f)), 4.05f / 3.4f, 1e-5f);
}

TEST(BatteryStatus, StartsFullAndTakesAHundredthOfEachSample) {
  BatteryStatus battery({.cell_count = cells});
  battery.update(at_rest(3.4f));
  EXPECT_NEAR(battery.remaining(), 0.99f, 1e-5f);
}

TEST(BatteryStatus, LoadIsAddedBackWhenArmed) {
  BatteryStatus armed({.cell_count = cells});
  settled(armed, {3.5f * cells, 0.0f, 1.0f, true});
  EXPECT_NEAR(armed.remaining(), (3.5f + 0.3f - 3.4f) / 0.65f, 1e-4f);
  BatteryStatus disarmed({.cell_count = cells});
  settled(disarmed, {3.5f * cells, 0.0f, 1.0f, false});
  EXPECT_NEAR(disarmed.remaining(), (3.5f - 3.4f) / 0.65f, 1e-4f);
}

TEST(BatteryStatus, KnownResistanceReplacesTheThrottleModel) {
  BatteryStatus battery({.cell_count = cells, .internal_resistance_ohm = 0.01f});
  settled(battery, {3.6f * cells, 20.0f, 1.0f, true});
  EXPECT_NEAR(battery.remaining(), (3.6f + 0.2f - 3.4f) / 0.65f, 1e-4f);
}

TEST(BatteryStatus, SamplesThatAreNotFiniteAreLeftOut) {
  BatteryStatus battery({.cell_count = cells});
  BatteryStatus undisturbed({.cell_count = cells});
  const BatterySample sample = at_rest(3.6f);
  for (const float voltage_V : {NAN, INFINITY, -INFINITY}) {
    battery.update(sample);
    battery.update({voltage_V, 0.0f, 0.0f, false});
    undisturbed.update(sample);
    EXPECT_EQ(battery.update(sample), undisturbed.update(sample));
  }
}

TEST(BatteryStatus, UnpluggedPackIsNotScaled) {
  const BatteryOptions almost_no_voltage{.cell_count = cells, .empty_cell_V = 0.1f};
  BatteryStatus plugged_in(almost_no_voltage);
  EXPECT_GT(settled(plugged_in, {2.2f, 0.0f, 0.0f, false}), 1.0f);
  BatteryStatus unplugged(almost_no_voltage);
  EXPECT_EQ(settled(unplugged, {2.0f, 0.0f, 0.0f, false}), 1.0f);
}

TEST(BatteryStatus, WithoutANumberOfCellsTheScaleStays1) {
  BatteryStatus battery(BatteryOptions{});
  EXPECT_EQ(settled(battery, {9.0f, 5.0f, 0.8f, true}), 1.0f);
}

TEST(BatteryStatus, ParametersAreTheOptions) {
  BatteryOptions options;
  for (const BatteryParameter& parameter : battery_parameters()) {
    EXPECT_TRUE(set_battery_parameter(options, parameter.name, parameter.default_value));
  }
  EXPECT_EQ(options.cell_count, BatteryOptions{}.cell_count);
  EXPECT_EQ(options.internal_resistance_ohm, std::nullopt);
  EXPECT_TRUE(set_battery_parameter(options, "BAT_R_INTERNAL", 0));
  EXPECT_EQ(options.internal_resistance_ohm, 0.0f);
  for (const float count : {-1.0f, 2.5f, 101.0f, NAN}) {
    EXPECT_FALSE(set_battery_parameter(options, "BAT_N_CELLS", count)) << count;
  }
  EXPECT_FALSE(set_battery_parameter(options, "BAT_CELLS", 3));
}

RC_GTEST_PROP(BatteryStatus, ScaleIsAlwaysUsable, ()) {
  BatteryStatus battery({.cell_count = cells});
  for (int sample = 0; sample < 20; ++sample) {
    const float scale = battery.update({*mostly_ordinary_float() * 15.0f, *mostly_ordinary_float(),
                                        *mostly_ordinary_float(), *rc::gen::arbitrary<bool>()});
    RC_ASSERT(scale >= 1.0f);
    RC_ASSERT(scale <= 1.3f);
  }
}

}  // namespace
}  // namespace attest::actuation
