#include "harness/compare/gross.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/harness/compare/sample_trace.hpp"

namespace attest {
namespace {

using testing::HasSubstr;

const char* const roll_rate = "out/vehicle_rates_setpoint.roll";
const char* const pitch_torque = "out/actuator_controls_0.control[1]";
const char* const yaw_integral = "out/mc_att_ctrl_status.yaw_rate_integ";

// A constant trace, in which these three values are not zero.
Trace constant(double rate, double control, double integrated) {
  Trace trace = sample_trace(20);
  for (std::size_t tick = 0; tick < 20; ++tick) {
    set(trace, tick, roll_rate, rate);
    set(trace, tick, pitch_torque, control);
    set(trace, tick, yaw_integral, integrated);
  }
  return trace;
}

bool agree(const Trace& got, const Trace& want) {
  return compare(got, want, Tolerances(Level::events)).agrees();
}

TEST(Gross, TolerancesAreTheFloorOrHalfTheSize) {
  const Tolerances tolerances = gross_tolerances();
  const auto agrees = [&](const Trace& got, const Trace& want) {
    return compare(got, want, tolerances).agrees();
  };
  const Trace want = constant(2, 0.4, 0.2), small = constant(0, 0, 0);
  EXPECT_TRUE(agrees(constant(2.9, 0.5, 0.25), want));
  EXPECT_FALSE(agrees(constant(3.1, 0.4, 0.2), want));
  EXPECT_FALSE(agrees(constant(2, -0.4, 0.2), want));
  EXPECT_TRUE(agrees(constant(0.09, 0.04, 0.019), small));
  EXPECT_FALSE(agrees(constant(0, 0, 0.021), small));
}

TEST(Gross, AnotherSignOrSizeIsNoCoarseNumber) {
  const Trace want = constant(2, 0.4, 0.2);
  EXPECT_TRUE(agree(constant(2.5, 0.5, 0.25), want));
  EXPECT_FALSE(agree(constant(-2, 0.4, 0.2), want));
  EXPECT_FALSE(agree(constant(2, -0.4, 0.2), want));
  EXPECT_FALSE(agree(constant(2, 0.4, -0.2), want));
  EXPECT_FALSE(agree(constant(4, 0.4, 0.2), want));
  EXPECT_FALSE(agree(constant(200, 0.4, 0.2), want));
  EXPECT_FALSE(agree(constant(0, 0.4, 0.2), want));
  const Comparison negated = compare(constant(2, -0.4, 0.2), want, Tolerances(Level::events));
  ASSERT_TRUE(negated.first);
  EXPECT_EQ(negated.first->tick, 1u);
  EXPECT_EQ(negated.first->channel, channel(pitch_torque));
  EXPECT_THAT(negated.event, HasSubstr("control[1] is -0.4, expected 0.15 to 0.65 at this level"));
}

TEST(Gross, SmallValuesMayHaveAnySign) {
  EXPECT_TRUE(agree(constant(-0.05, -0.02, -0.01), constant(0.05, 0.02, 0.01)));
}

// A step, and a peak of one tick.
TEST(Gross, ATickLateIsRight) {
  Trace want = constant(0, 0.4, 0.2), late = want;
  for (std::size_t tick = 8; tick < 20; ++tick) set(want, tick, roll_rate, -6);
  for (std::size_t tick = 9; tick < 20; ++tick) set(late, tick, roll_rate, -6);
  set(want, 4, pitch_torque, 0.9);
  set(late, 5, pitch_torque, 0.9);
  EXPECT_FALSE(first_gross_difference(late, want));
  set(late, 9, roll_rate, 0);
  ASSERT_TRUE(first_gross_difference(late, want));
  EXPECT_EQ(first_gross_difference(late, want)->tick, 9u);
}

TEST(Gross, WhatIsNotPublishedIsNotCompared) {
  Trace want = constant(2, 0.4, 0.2);
  for (std::size_t tick = 0; tick < 20; ++tick) {
    set(want, tick, "out/vehicle_rates_setpoint.published", 0);
  }
  EXPECT_FALSE(first_gross_difference(constant(-2, 0.4, 0.2), want));
  EXPECT_TRUE(first_gross_difference(constant(2, -0.4, 0.2), want));
}

TEST(Gross, NearAHalfTurnEitherWayIsRight) {
  Trace want = constant(2, 0.4, 0.2), got = constant(-2, 0.4, 0.2);
  for (Trace* trace : {&want, &got}) {
    for (Sample& sample : trace->samples) {
      sample.in.control_state.q[0] = std::cos(1.55f);
      sample.in.control_state.q[1] = std::sin(1.55f);
    }
  }
  EXPECT_FALSE(first_gross_difference(got, want));
  // In rates mode there is no attitude error, so no half turn.
  for (Sample& sample : want.samples) {
    sample.in.vehicle_control_mode.flag_control_attitude_enabled = 0;
  }
  EXPECT_TRUE(first_gross_difference(got, want));
}

TEST(Gross, NoNumberIsNonFiniteAtThisLevelToo) {
  const Trace want = constant(2, 0.4, 0.2);
  const Comparison nans = compare(constant(2, 0.4, nan), want, Tolerances(Level::events));
  EXPECT_TRUE(nans.got_non_finite);
  ASSERT_TRUE(nans.first);
  EXPECT_EQ(nans.first->tick, 0u);
  EXPECT_EQ(nans.event, "mc_att_ctrl_status.yaw_rate_integ is not finite");
}

TEST(Gross, WhereTheReferenceIsNotFiniteOneTickLaterIsRight) {
  Trace want = constant(2, 0.4, 0.2), got = want;
  set(want, 7, pitch_torque, nan);
  set(got, 8, pitch_torque, nan);
  EXPECT_FALSE(first_non_finite_event(got, want));
  set(got, 9, pitch_torque, nan);
  ASSERT_TRUE(first_non_finite_event(got, want));
  EXPECT_EQ(first_non_finite_event(got, want)->tick, 9u);
}

// A port may turn the other way, a tick sooner or later.
TEST(Gross, AroundAHalfTurnAnyValueIsAccepted) {
  Trace want = constant(2, 0.4, 0.2);
  for (std::size_t tick : {std::size_t{8}, std::size_t{9}}) {
    set(want, tick, "in/updated.vehicle_attitude_setpoint", 1);
    set(want, tick, "in/vehicle_attitude_setpoint.q_d[0]", tick == 8 ? 0 : 1);
    set(want, tick, "in/vehicle_attitude_setpoint.q_d[3]", tick == 8 ? 1 : 0);
  }
  for (std::size_t tick = 6; tick <= 10; ++tick) {
    Trace got = want;
    set(got, tick, roll_rate, -2);
    EXPECT_EQ(first_gross_difference(got, want).has_value(), tick < 7 || tick > 9) << tick;
  }
}

}  // namespace
}  // namespace attest
