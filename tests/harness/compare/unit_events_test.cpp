// The level events for the units of v1.14 to v1.18.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/compare/events.hpp"

namespace attest {
namespace {

using testing::HasSubstr;

constexpr std::size_t unit_ticks = 20;

Trace of_unit(Module module) {
  Trace trace;
  trace.present = channels_of(module);
  trace.samples.resize(unit_ticks);
  for (std::size_t tick = 0; tick < unit_ticks; ++tick) {
    trace.samples[tick].in.timestamp = 4000 * (tick + 1);
  }
  return trace;
}

// The integral of roll rises at each tick, by `step`.
Trace rate_trace(float step) {
  Trace trace = of_unit(Module::rate_unit);
  float integral = 0;
  for (Sample& sample : trace.samples) {
    attest_rate_outputs& out = sample.rate_out;
    out.vehicle_torque_setpoint.published = out.vehicle_thrust_setpoint.published = 1;
    out.rate_ctrl_status.published = 1;
    out.vehicle_torque_setpoint.xyz[0] = 0.4F;
    out.vehicle_thrust_setpoint.xyz[2] = -0.5F;
    out.rate_ctrl_status.rollspeed_integ = integral += step;
  }
  return trace;
}

// Level, with a setpoint `angle_rad` of roll away.
Trace attitude_trace(float angle_rad) {
  Trace trace = of_unit(Module::attitude_unit);
  trace.samples[0].attitude_in.updated = ATTEST_ATTITUDE_UPDATED_VEHICLE_ATTITUDE_SETPOINT;
  for (Sample& sample : trace.samples) {
    sample.attitude_in.vehicle_attitude.q[0] = 1;
    sample.attitude_in.vehicle_attitude_setpoint.q_d[0] = std::cos(angle_rad / 2);
    sample.attitude_in.vehicle_attitude_setpoint.q_d[1] = std::sin(angle_rad / 2);
    sample.attitude_out.vehicle_rates_setpoint.published = 1;
    sample.attitude_out.vehicle_rates_setpoint.roll = 2;
  }
  return trace;
}

Comparison by_events(const Trace& got, const Trace& want) {
  return compare(got, want, Tolerances(Level::events));
}

TEST(UnitEvents, AreThoseOfTheUnitsOnly) {
  for (const Module module : {Module::mc_att_control, Module::attitude_unit, Module::rate_unit}) {
    EXPECT_TRUE(has_events(module)) << name_of(module);
  }
  EXPECT_FALSE(has_events(Module::mixer));
  EXPECT_FALSE(has_events(Module::battery_status));
}

// The values differ by less than their bounds.
TEST(UnitEvents, AnIntegralThatRisesMayNotFall) {
  const Trace want = rate_trace(1e-5F);
  EXPECT_TRUE(by_events(rate_trace(1.4e-5F), want).agrees());
  EXPECT_THAT(by_events(rate_trace(-1e-5F), want).event,
              HasSubstr("rollspeed_integ is not rising, expected rising within a tick"));
  EXPECT_THAT(by_events(rate_trace(0), want).event, HasSubstr("not rising, expected rising"));
  EXPECT_THAT(by_events(want, rate_trace(0)).event, HasSubstr("rising, expected not rising"));
  EXPECT_THAT(by_events(rate_trace(-1e-5F), rate_trace(0)).event,
              HasSubstr("falling, expected not falling"));
}

TEST(UnitEvents, ATopicIsPublishedAtMostATickLater) {
  Trace want = rate_trace(0), got = want;
  want.samples[8].rate_out.vehicle_rates_setpoint.published = 1;
  got.samples[9].rate_out.vehicle_rates_setpoint.published = 1;
  EXPECT_TRUE(by_events(got, want).agrees());
  got.samples[9].rate_out.vehicle_rates_setpoint.published = 0;
  EXPECT_THAT(by_events(got, want).event, HasSubstr("is not published, expected published"));
}

TEST(UnitEvents, ANaNOfThrustIsPassedOn) {
  Trace want = rate_trace(0);
  for (std::size_t tick = 8; tick < 12; ++tick) {
    want.samples[tick].rate_out.vehicle_thrust_setpoint.xyz[2] = std::nanf("");
  }
  EXPECT_TRUE(by_events(want, want).agrees());
  EXPECT_THAT(by_events(rate_trace(0), want).event, HasSubstr("is finite, expected not finite"));
}

TEST(UnitEvents, ValuesHaveTheSignAndSizeOfTheReference) {
  Trace got = rate_trace(0);
  for (Sample& sample : got.samples) sample.rate_out.vehicle_torque_setpoint.xyz[0] = -0.4F;
  EXPECT_THAT(by_events(got, rate_trace(0)).event,
              HasSubstr("vehicle_torque_setpoint.xyz[0] is -0.4, expected 0.15 to 0.65"));
}

// With the rate unit, the bounds hold at each attitude: it has none.
TEST(UnitEvents, NearAHalfTurnTheAttitudeUnitMayTurnEitherWay) {
  for (const bool is_near : {true, false}) {
    const Trace want = attitude_trace(is_near ? 3.1F : 1.0F);
    Trace got = want;
    for (Sample& sample : got.samples) sample.attitude_out.vehicle_rates_setpoint.roll = -2;
    EXPECT_EQ(by_events(got, want).agrees(), is_near);
  }
}

}  // namespace
}  // namespace attest
