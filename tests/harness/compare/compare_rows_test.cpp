#include "harness/compare/compare_rows.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/harness/compare/sample_trace.hpp"

namespace attest {
namespace {

constexpr double whole = 1e9;
const char* const yaw = "out/vehicle_rates_setpoint.yaw";

// The part of a flight that a golden keeps: every third tick, without in/updated.
Trace rows_of(const Trace& flown) {
  Trace rows;
  rows.present = flown.present & ~channels_of(Module::mc_att_control, "in/updated.");
  for (std::size_t tick = 0; tick < flown.samples.size(); tick += 3) {
    rows.samples.push_back(flown.samples[tick]);
    rows.samples.back().in.updated = 0;
  }
  return rows;
}

TEST(CompareRows, AgreesWithItself) {
  const Trace flown = sample_trace(10);
  const Comparison comparison = compare_rows(flown, rows_of(flown), whole, Tolerances());
  EXPECT_FALSE(comparison.first);
  EXPECT_TRUE(comparison.mismatch.empty());
  EXPECT_EQ(comparison.ticks, 4u);
}

TEST(CompareRows, NamesTheTickOfTheFlight) {
  Trace flown = sample_trace(10);
  const Trace golden = rows_of(flown);
  set(flown, 6, yaw, 5);
  const Comparison comparison = compare_rows(flown, golden, whole, Tolerances());
  ASSERT_TRUE(comparison.first);
  EXPECT_EQ(comparison.first->tick, 6u);
  EXPECT_EQ(comparison.first->channel, channel(yaw));
  EXPECT_EQ(comparison.deviating_ticks, 1u);
}

TEST(CompareRows, EndsAtTheHorizon) {
  Trace flown = sample_trace(10);
  const Trace golden = rows_of(flown);
  set(flown, 6, yaw, 5);  // 24 ms after the first
  EXPECT_FALSE(compare_rows(flown, golden, 0.023, Tolerances()).first);
  EXPECT_TRUE(compare_rows(flown, golden, 0.024, Tolerances()).first);
}

TEST(CompareRows, AFlightThatEndedEarlyIsComparedAsFarAsItWent) {
  Trace flown = sample_trace(10);
  const Trace golden = rows_of(flown);
  flown.samples.resize(5);
  const Comparison comparison = compare_rows(flown, golden, whole, Tolerances());
  EXPECT_FALSE(comparison.first);
  EXPECT_EQ(comparison.ticks, 2u);
  flown.samples.clear();
  EXPECT_EQ(compare_rows(flown, golden, whole, Tolerances()).ticks, 0u);
}

TEST(CompareRows, ARowBetweenTicksIsAMismatch) {
  const Trace flown = sample_trace(10);
  Trace golden = rows_of(flown);
  ++golden.samples[2].in.timestamp;
  const Comparison comparison = compare_rows(flown, golden, whole, Tolerances());
  EXPECT_THAT(comparison.mismatch, testing::HasSubstr("a row at 28001 us"));
}

// The tolerance widens with the tilt error to the setpoint in force, which was published long
// before.
TEST(CompareRows, KnowsTheSetpointInForce) {
  Trace flown = sample_trace(10);
  for (std::size_t tick = 0; tick < 10; ++tick) {
    set(flown, tick, "in/control_state.q[0]", 0.002);
    set(flown, tick, "in/control_state.q[1]", 1);
  }
  const Trace golden = rows_of(flown);
  const double was = flown.samples[6].out.vehicle_rates_setpoint.roll;
  set(flown, 6, "out/vehicle_rates_setpoint.roll", was + 4e-4);
  const Comparison comparison = compare_rows(flown, golden, whole, Tolerances());
  EXPECT_FALSE(comparison.first);
  ASSERT_TRUE(comparison.tightest);
  EXPECT_EQ(comparison.tightest->tick, 6u);
}

// Nearly upside down at first, where the tolerance is wide; then a setpoint that is met.
TEST(CompareRows, ARowHasItsOwnSetpoint) {
  Trace flown = sample_trace(10);
  for (std::size_t tick = 0; tick < 5; ++tick) {
    set(flown, tick, "in/vehicle_attitude_setpoint.q_d[0]", 0.002);
    set(flown, tick, "in/vehicle_attitude_setpoint.q_d[1]", 1);
  }
  const Trace golden = rows_of(flown);
  const char* const roll = "out/vehicle_rates_setpoint.roll";
  set(flown, 3, roll, value_of(channels()[channel(roll)], flown.samples[3]) + 4e-4);
  EXPECT_FALSE(compare_rows(flown, golden, whole, Tolerances()).first);
  set(flown, 6, roll, value_of(channels()[channel(roll)], flown.samples[6]) + 4e-4);
  const Comparison comparison = compare_rows(flown, golden, whole, Tolerances());
  ASSERT_TRUE(comparison.first);
  EXPECT_EQ(comparison.first->tick, 6u);
}

}  // namespace
}  // namespace attest
