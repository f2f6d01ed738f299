#include "controller/mc_att_control/mc_att_control.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/controller/generators.hpp"

namespace attest::mc_att_control {
namespace {

constexpr std::uint32_t everything = 0xff;  // except parameter_update

// One controller and its input topics: 4 ms a step, level and armed in attitude mode.
class McAttControlTest : public ::testing::Test {
 protected:
  McAttControlTest() {
    in_.control_state.q[0] = 1.0f;
    in_.vehicle_attitude_setpoint.q_d[0] = 1.0f;
    in_.vehicle_attitude_setpoint.thrust = 0.5f;
    in_.vehicle_control_mode.flag_control_manual_enabled = 1;
    in_.vehicle_control_mode.flag_control_attitude_enabled = 1;
    in_.vehicle_control_mode.flag_control_rates_enabled = 1;
    in_.vehicle_status.is_rotary_wing = 1;
    in_.actuator_armed.armed = 1;
  }

  void step(std::uint32_t updated) {
    in_.timestamp += 4000;
    in_.updated = updated;
    control_.step(in_, out_);
  }

  void set_mode(bool attitude, bool manual) {
    in_.vehicle_control_mode.flag_control_attitude_enabled = attitude;
    in_.vehicle_control_mode.flag_control_manual_enabled = manual;
  }

  float thrust() const { return out_.actuator_controls_0.control[3]; }

  McAttControl<float> control_{Profile::px4_v1_5_5};
  attest_inputs in_{};
  attest_outputs out_{};
};

TEST_F(McAttControlTest, LevelGivesThrustAndNothingElse) {
  step(everything);
  EXPECT_EQ(out_.vehicle_rates_setpoint.published, 1);
  EXPECT_EQ(out_.actuator_controls_0.published, 1);
  EXPECT_EQ(out_.mc_att_ctrl_status.published, 1);
  EXPECT_EQ(thrust(), 0.5f);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(out_.actuator_controls_0.control[i], 0.0f);
}

TEST_F(McAttControlTest, TopicsAreLatchedOnlyWhenUpdated) {
  step(everything);
  in_.vehicle_attitude_setpoint.thrust = 0.7f;
  step(0);
  EXPECT_EQ(thrust(), 0.5f);
  step(ATTEST_UPDATED_VEHICLE_ATTITUDE_SETPOINT);
  EXPECT_EQ(thrust(), 0.7f);
}

TEST_F(McAttControlTest, AttitudeSetpointWaitsForAttitudeMode) {
  step(everything);
  set_mode(false, true);
  in_.vehicle_attitude_setpoint.thrust = 0.7f;
  in_.vehicle_attitude_setpoint.landing_gear = 1.0f;
  step(ATTEST_UPDATED_VEHICLE_CONTROL_MODE | ATTEST_UPDATED_VEHICLE_ATTITUDE_SETPOINT);
  EXPECT_EQ(out_.actuator_controls_0.control[7], 0.0f);
  set_mode(true, true);
  step(ATTEST_UPDATED_VEHICLE_CONTROL_MODE);
  EXPECT_EQ(thrust(), 0.7f);
  EXPECT_EQ(out_.actuator_controls_0.control[7], 1.0f);
}

TEST_F(McAttControlTest, OwnRatesSetpointSupersedesAPendingOne) {
  in_.vehicle_rates_setpoint = {1.0f, 0.0f, 0.0f, 0.9f};
  step(everything);
  set_mode(false, false);
  step(ATTEST_UPDATED_VEHICLE_CONTROL_MODE);
  EXPECT_EQ(out_.vehicle_rates_setpoint.published, 0);
  EXPECT_EQ(thrust(), 0.5f);
  step(ATTEST_UPDATED_VEHICLE_RATES_SETPOINT);
  EXPECT_EQ(thrust(), 0.9f);
}

TEST_F(McAttControlTest, RattitudeStaysInRatesUntilTheModeIsUpdated) {
  in_.vehicle_control_mode.flag_control_rattitude_enabled = 1;
  in_.manual_control_setpoint = {0.0f, 1.5f, 0.3f, 0.0f};
  step(everything);
  EXPECT_EQ(thrust(), 0.3f);
  in_.manual_control_setpoint.y = 0.0f;
  step(ATTEST_UPDATED_MANUAL_CONTROL_SETPOINT);
  EXPECT_EQ(thrust(), 0.3f);
  step(ATTEST_UPDATED_VEHICLE_CONTROL_MODE);
  EXPECT_EQ(thrust(), 0.5f);
}

TEST_F(McAttControlTest, AcroFollowsTheSticks) {
  set_mode(false, true);
  in_.manual_control_setpoint = {0.5f, -1.0f, NAN, 0.25f};
  step(everything);
  EXPECT_FLOAT_EQ(out_.vehicle_rates_setpoint.roll, -6.2831853f);
  EXPECT_FLOAT_EQ(out_.vehicle_rates_setpoint.pitch, -3.1415927f);
  EXPECT_FLOAT_EQ(out_.vehicle_rates_setpoint.yaw, 1.5707963f);
  EXPECT_EQ(thrust(), 0.9f) << "a NaN throttle";
}

TEST_F(McAttControlTest, BeforeVehicleStatusOnlyTheIntegralsAreKnown) {
  step(everything & ~std::uint32_t{ATTEST_UPDATED_VEHICLE_STATUS});
  EXPECT_EQ(out_.vehicle_rates_setpoint.published, 0);
  EXPECT_EQ(out_.actuator_controls_0.published, 0);
  EXPECT_EQ(out_.mc_att_ctrl_status.published, 1);
}

TEST_F(McAttControlTest, OutputsKeepTheirValuesWhileNotPublished) {
  step(everything);
  in_.vehicle_control_mode.flag_control_rates_enabled = 0;
  step(ATTEST_UPDATED_VEHICLE_CONTROL_MODE);
  EXPECT_EQ(out_.actuator_controls_0.published, 0);
  EXPECT_EQ(out_.mc_att_ctrl_status.published, 0);
  EXPECT_EQ(thrust(), 0.5f);
}

TEST_F(McAttControlTest, BreakerCutsTheActuators) {
  EXPECT_TRUE(control_.set_parameter("CBRK_RATE_CTRL", rate_control_breaker_key));
  step(everything);
  EXPECT_EQ(out_.actuator_controls_0.published, 0);
  EXPECT_EQ(out_.mc_att_ctrl_status.published, 1);
}

TEST_F(McAttControlTest, ParametersTakeEffectWithTheirUpdate) {
  in_.control_state.q[0] = std::cos(0.05f);
  in_.control_state.q[1] = std::sin(0.05f);
  step(everything);
  const float before = out_.vehicle_rates_setpoint.roll;
  EXPECT_NEAR(before, -0.65f, 1e-5f);
  control_.set_parameter("MC_ROLL_P", 13.0f);
  step(0);
  EXPECT_EQ(out_.vehicle_rates_setpoint.roll, before);
  step(ATTEST_UPDATED_PARAMETER_UPDATE);
  EXPECT_NEAR(out_.vehicle_rates_setpoint.roll, -1.3f, 1e-5f);
}

TEST_F(McAttControlTest, BatteryScalesAllFourControls) {
  control_.set_parameter("MC_BAT_SCALE_EN", 1.0f);
  in_.battery_status.scale = 1.2f;
  step(everything);
  EXPECT_FLOAT_EQ(thrust(), 0.6f);
  in_.battery_status.scale = -1.0f;
  step(ATTEST_UPDATED_BATTERY_STATUS);
  EXPECT_EQ(thrust(), 0.5f);
}

TEST_F(McAttControlTest, StepsLastBetweenTwoAndTwentyMilliseconds) {
  in_.vehicle_rates_setpoint = {0.1f, 0.0f, 0.0f, 0.5f};
  set_mode(false, false);
  step(everything);
  const float first = out_.mc_att_ctrl_status.roll_rate_integ;
  EXPECT_NEAR(first, 0.05f * 0.1f * 0.004f, 1e-9f);
  in_.timestamp += 1000000;
  step(0);
  const float second = out_.mc_att_ctrl_status.roll_rate_integ;
  EXPECT_NEAR(second - first, 0.05f * 0.1f * 0.02f, 1e-9f);
  in_.timestamp -= 3999;
  step(0);
  EXPECT_NEAR(out_.mc_att_ctrl_status.roll_rate_integ - second, 0.05f * 0.1f * 0.002f, 1e-9f);
}

// For any inputs, the actuator controls are finite and the integrals are bounded.
RC_GTEST_PROP(McAttControl, GarbageNeverReachesTheMotors, (bool newer)) {
  McAttControl<float> control(newer ? Profile::px4_v1_5_5 : Profile::px4_v1_3_4);
  attest_outputs out{};
  std::uint64_t now_us = 0;
  for (int step = 0; step < 20; ++step) {
    const attest_inputs in = *test::any_step(now_us);
    now_us = in.timestamp;
    control.step(in, out);
    for (int i = 0; i < 4; ++i) RC_ASSERT(std::isfinite(out.actuator_controls_0.control[i]));
    RC_ASSERT(std::abs(out.mc_att_ctrl_status.roll_rate_integ) < integral_limit);
    RC_ASSERT(std::abs(out.mc_att_ctrl_status.pitch_rate_integ) < integral_limit);
    RC_ASSERT(std::abs(out.mc_att_ctrl_status.yaw_rate_integ) < integral_limit);
  }
}

// The law has no hidden state: the same inputs give the same bits.
RC_GTEST_PROP(McAttControl, TwoInstancesAgree, ()) {
  McAttControl<float> one(Profile::px4_v1_5_5);
  McAttControl<float> other(Profile::px4_v1_5_5);
  attest_outputs out_one{};
  attest_outputs out_other{};
  for (int step = 0; step < 10; ++step) {
    const attest_inputs in = *test::any_step(1000);
    one.step(in, out_one);
    other.step(in, out_other);
    for (int i = 0; i < 8; ++i) {
      const float a = out_one.actuator_controls_0.control[i];
      const float b = out_other.actuator_controls_0.control[i];
      RC_ASSERT(a == b || (std::isnan(a) && std::isnan(b)));
    }
  }
}

}  // namespace
}  // namespace attest::mc_att_control
