#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "controller/cascade/sticks.hpp"
#include "tests/controller/generators.hpp"

namespace attest::cascade {
namespace {

using test::mostly_ordinary_float;
using test::uniform;

RC_GTEST_PROP(CascadeScalarMath, WrapGivesTheSameAngleInOneTurn, ()) {
  const double angle = *uniform(-100, 100);
  const double wrapped = wrap(angle);
  RC_ASSERT(wrapped >= -M_PI - 1e-6);
  RC_ASSERT(wrapped < M_PI + 1e-6);
  RC_ASSERT(std::abs(std::remainder(wrapped - angle, 2 * M_PI)) < 1e-5);
}

TEST(CascadeScalarMath, WrapExcludesPi) { EXPECT_EQ(wrap(3.14159274f), -3.14159274f); }

RC_GTEST_PROP(CascadeScalarMath, StickCurvesAreOddAndEndAtOne, ()) {
  const float stick = *mostly_ordinary_float();
  const float share = *mostly_ordinary_float();
  RC_PRE(!std::isnan(stick) && !std::isnan(share));
  RC_ASSERT(expo(-stick, share) == -expo(stick, share));
  RC_ASSERT(superexpo(-stick, 0.5f, share) == -superexpo(stick, 0.5f, share));
  RC_ASSERT(deadzone(-stick, share) == -deadzone(stick, share));
  for (const float output :
       {expo(stick, share), superexpo(stick, 0.5f, share), deadzone(stick, share)}) {
    RC_ASSERT(std::abs(output) <= 1.0f + 1e-5f);
  }
}

TEST(CascadeScalarMath, StickCurves) {
  EXPECT_NEAR(expo(0.5f, 0.6f), 0.4f * 0.5f + 0.6f * 0.125f, 1e-7f);
  EXPECT_NEAR(superexpo(0.5f, 0.0f, 0.7f), 0.5f * 0.3f / (1 - 0.5f * 0.7f), 1e-7f);
  EXPECT_EQ(deadzone(0.1f, 0.1f), 0.0f);
  EXPECT_NEAR(deadzone(0.55f, 0.1f), 0.5f, 1e-6f);
}

RC_GTEST_PROP(CascadeScalarMath, SlewIsBoundedAndArrives, ()) {
  const double value = *uniform(-1, 1);
  const double target = *uniform(-1, 1);
  const double next = slewed(value, 0.5, 0.02, target);
  RC_ASSERT(std::abs(next - value) <= 0.01 + 1e-12);
  RC_ASSERT(std::abs(next - target) <= std::max(0.0, std::abs(value - target) - 0.01) + 1e-12);
}

TEST(CascadeScalarMath, LowPassMovesByItsShareOfTheDifference) {
  for (const Profile profile : every_profile) {
    LowPass<double> filter;
    EXPECT_NEAR(filter.update(0.03, 0.01, 2.0, traits_of(profile)), 0.5, 1e-12);
    EXPECT_NEAR(filter.update(0.0, 0.0, 2.0, traits_of(profile)), 0.875, 1e-12) << "weight stays";
  }
}

TEST(CascadeScalarMath, LowPassOfV1_14_4RoundsDifferently) {
  LowPass<float> newer{.state = 0.1f, .weight = 0.0f};
  LowPass<float> older = newer;
  newer.update(0.02f, 0.01f, 0.7f, traits_of(Profile::px4_v1_15_4));
  older.update(0.02f, 0.01f, 0.7f, traits_of(Profile::px4_v1_14_4));
  EXPECT_NEAR(newer.state, older.state, 1e-7f);
  EXPECT_NE(newer.state, older.state);
}

// Level, without an unaided heading, in flight with full thrust.
class CascadeSticks : public ::testing::TestWithParam<Profile> {
 protected:
  CascadeSticks() : sticks_(traits_of(GetParam())) {
    parameters_ = default_parameters(attitude_parameters(), GetParam());
    sticks_.set_gains(attitude_unit_gains<double>(parameters_).sticks);
    in_.q_WB = identity<double>();
    in_.sticks = {.roll = 0, .pitch = 0, .yaw = 0, .throttle = 0};
    in_.thrust = {.min = 0.08, .max = 1.0, .hover = 0.5};
    in_.dt_s = 0.004;
    in_.unaided_heading = NAN;
    in_.heading_good = true;
    in_.is_vtol = false;
  }

  AttitudeSetpoint<double> step() {
    sticks_.set_restart(false);
    return sticks_.update(in_);
  }
  void face(double heading) { in_.q_WB = yaw_rotation(heading); }
  double yaw_of(const AttitudeSetpoint<double>& setpoint) const {
    return heading(setpoint.q_WD, traits_of(GetParam()));
  }

  Parameters parameters_{};
  Sticks<double> sticks_;
  StickInput<double> in_{};
};

class CascadeSticksOfV1_16_0 : public CascadeSticks {};
class CascadeSticksUntilV1_15_4 : public CascadeSticks {};
INSTANTIATE_TEST_SUITE_P(Every, CascadeSticks, ::testing::ValuesIn(every_profile),
                         [](const auto& which) { return std::to_string(which.index); });
INSTANTIATE_TEST_SUITE_P(Newest, CascadeSticksOfV1_16_0, ::testing::Values(Profile::px4_v1_16_0));
INSTANTIATE_TEST_SUITE_P(Older, CascadeSticksUntilV1_15_4,
                         ::testing::Values(Profile::px4_v1_15_4, Profile::px4_v1_14_4));

TEST_P(CascadeSticks, ForwardStickPitchesDown) {
  in_.sticks.pitch = 0.5f;
  const Vector3<double> thrust_axis = z_axis(step().q_WD);
  EXPECT_NEAR(std::atan2(thrust_axis[0], thrust_axis[2]), -0.5 * radians(35.0), 1e-6);
  EXPECT_NEAR(thrust_axis[1], 0.0, 1e-12);
}

TEST_P(CascadeSticks, BothSticksTogetherGiveNoMoreTiltThanOne) {
  in_.sticks.roll = in_.sticks.pitch = 1.0f;
  EXPECT_NEAR(std::acos(z_axis(step().q_WD)[2]), radians(35.0), 1e-6);
}

TEST_P(CascadeSticks, TiltIsFilteredUntilReleased) {
  parameters_.mc_man_tilt_tau = 0.012f;
  sticks_.set_gains(attitude_unit_gains<double>(parameters_).sticks);
  in_.sticks.roll = 1.0f;
  EXPECT_NEAR(std::acos(z_axis(step().q_WD)[2]), radians(35.0) / 4, 1e-6);
  sticks_.release(in_.q_WB, NAN, true);
  EXPECT_NEAR(std::acos(z_axis(step().q_WD)[2]), radians(35.0) / 4, 1e-6);
}

TEST_P(CascadeSticks, AVtolTiltsInTheDirectionThatItHasNow) {
  in_.is_vtol = true;
  in_.sticks.roll = 1.0f;
  EXPECT_NEAR(z_axis(step().q_WD)[1], -std::sin(radians(35.0)), 1e-6);
  face(M_PI / 2);  // the yaw setpoint stays north
  EXPECT_NEAR(z_axis(step().q_WD)[0], std::sin(radians(35.0)), 1e-6);
}

TEST_P(CascadeSticks, ThrottleMeetsItsCurve) {
  const auto thrust_at = [this](float throttle) {
    in_.sticks.throttle = throttle;
    return -step().thrust_B[2];
  };
  EXPECT_NEAR(thrust_at(-1.0f), 0.08, 1e-6);
  EXPECT_NEAR(thrust_at(0.0f), 0.5, 1e-6);
  EXPECT_NEAR(thrust_at(0.5f), 0.75, 1e-6);
  EXPECT_NEAR(thrust_at(1.0f), 1.0, 1e-6);
  parameters_.mpc_thr_curve = 1;
  sticks_.set_gains(attitude_unit_gains<double>(parameters_).sticks);
  EXPECT_NEAR(thrust_at(0.0f), 0.54, 1e-6);
}

TEST_P(CascadeSticks, SpoolUpLimitsThrustFromV1_15_4On) {
  in_.thrust.max = 0.1;
  EXPECT_NEAR(-step().thrust_B[2], GetParam() == Profile::px4_v1_14_4 ? 0.5 : 0.1, 1e-6);
}

TEST_P(CascadeSticks, HugeThrottleOfV1_14_4IsHoverThrust) {
  in_.sticks.throttle = 1e30f;
  EXPECT_NEAR(-step().thrust_B[2], GetParam() == Profile::px4_v1_14_4 ? 0.5 : 1.0, 1e-6);
}

TEST_P(CascadeSticks, TheLowestThrottleFollowsTheHeading) {
  step();
  face(1.0);
  in_.sticks.throttle = -1.0f;
  EXPECT_NEAR(yaw_of(step()), 1.0, 1e-6);
  parameters_.mc_airmode = 2;
  sticks_.set_gains(attitude_unit_gains<double>(parameters_).sticks);
  face(2.0);
  EXPECT_NEAR(yaw_of(step()), 1.0, 1e-6) << "MC_AIRMODE 2 holds yaw";
}

TEST_P(CascadeSticks, EstimatorResetTurnsTheHeldYaw) {
  step();
  sticks_.reset_heading(yaw_rotation(0.3));
  EXPECT_NEAR(yaw_of(step()), 0.3, 1e-6);
}

TEST_P(CascadeSticksOfV1_16_0, ACentredYawStickHoldsTheHeading) {
  in_.sticks.yaw = 1.0f;
  EXPECT_GT(step().yaw_rate, 0.0);
  face(1.0);
  EXPECT_NEAR(yaw_of(step()), 1.0, 1e-6) << "while turning the setpoint follows";
  in_.sticks.yaw = 0.05f;  // in the deadzone
  AttitudeSetpoint<double> setpoint;
  for (int i = 0; i < 500; ++i) setpoint = step();
  EXPECT_LT(setpoint.yaw_rate, 1e-6);
  face(1.5);
  EXPECT_NEAR(yaw_of(step()), 1.0, 1e-6);
}

TEST_P(CascadeSticksOfV1_16_0, TheYawRateIsFiltered) {
  in_.sticks.yaw = 1.0f;
  EXPECT_NEAR(step().yaw_rate, radians(150.0) * 0.004 / (0.004 + 0.08), 1e-6);
}

TEST_P(CascadeSticksOfV1_16_0, TheFirstStepTurnsNorth) {
  face(1.0);
  EXPECT_NEAR(yaw_of(step()), 0.0, 1e-6);
  sticks_.release(in_.q_WB, NAN, false);
  EXPECT_NEAR(yaw_of(step()), 1.0, 1e-6) << "after another mode it holds the heading";
}

TEST_P(CascadeSticksOfV1_16_0, ABadHeadingIsNotHeld) {
  in_.heading_good = false;
  face(1.0);
  EXPECT_NEAR(yaw_of(step()), 1.0, 1e-6);
}

// A slow drift against the gyros is taken into the yaw setpoint only while the heading converges.
TEST_P(CascadeSticksOfV1_16_0, TheYawSetpointFollowsAConvergingHeading) {
  in_.unaided_heading = 0.0;
  step();
  face(0.1);  // jumps by more than 1 deg
  EXPECT_NEAR(yaw_of(step()), 0.1, 1e-6);
  face(0.15);
  EXPECT_NEAR(yaw_of(step()), 0.15, 1e-6);
  in_.unaided_heading = 0.15 - 0.001;  // converged: the heading is held from here
  step();
  face(0.151);
  EXPECT_NEAR(yaw_of(step()), 0.15, 1e-6) << "a small drift is held";
}

TEST_P(CascadeSticksOfV1_16_0, HoverThrustIsTheEstimateUnlessTheCurveIs2) {
  in_.thrust.hover = 0.4;
  EXPECT_NEAR(-step().thrust_B[2], 0.4, 1e-6);
  parameters_.mpc_thr_curve = 2;
  sticks_.set_gains(attitude_unit_gains<double>(parameters_).sticks);
  EXPECT_NEAR(-step().thrust_B[2], 0.5, 1e-6);
}

TEST_P(CascadeSticksUntilV1_15_4, TheYawStickIsIntegrated) {
  in_.sticks.yaw = 0.5f;
  EXPECT_NEAR(step().yaw_rate, 0.5 * radians(150.0), 1e-6);
  EXPECT_NEAR(yaw_of(step()), 2 * 0.004 * 0.5 * radians(150.0), 1e-6);
}

TEST_P(CascadeSticksUntilV1_15_4, ARestartTakesTheHeading) {
  face(1.0);
  sticks_.set_restart(true);
  EXPECT_NEAR(yaw_of(sticks_.update(in_)), 1.0, 1e-6);
}

TEST_P(CascadeSticksUntilV1_15_4, TiltFilterIsKeptWhileTheUnitDoesNotRun) {
  parameters_.mc_man_tilt_tau = 0.012f;
  sticks_.set_gains(attitude_unit_gains<double>(parameters_).sticks);
  in_.sticks.roll = 1.0f;
  step();
  sticks_.release(in_.q_WB, NAN, false);
  EXPECT_NEAR(std::acos(z_axis(step().q_WD)[2]), radians(35.0) * (1 - 0.75 * 0.75), 1e-6);
}

}  // namespace
}  // namespace attest::cascade
