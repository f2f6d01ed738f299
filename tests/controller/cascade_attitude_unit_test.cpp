#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "controller/cascade/attitude_unit.hpp"
#include "tests/controller/generators.hpp"

namespace attest::cascade {
namespace {

// One unit and its input topics: 4 ms a step, level and armed, in position mode.
class CascadeAttitudeUnit : public ::testing::TestWithParam<Profile> {
 protected:
  static constexpr std::uint32_t everything = 0xff;  // except parameter_update
  static constexpr std::uint32_t setpoint_bit = ATTEST_ATTITUDE_UPDATED_VEHICLE_ATTITUDE_SETPOINT;
  static constexpr std::uint32_t mode_bit = ATTEST_ATTITUDE_UPDATED_VEHICLE_CONTROL_MODE;
  static constexpr std::uint32_t status_bit = ATTEST_ATTITUDE_UPDATED_VEHICLE_STATUS;
  static constexpr std::uint32_t parameter_bit = ATTEST_ATTITUDE_UPDATED_PARAMETER_UPDATE;

  CascadeAttitudeUnit() : unit_(GetParam()) {
    in_.timestamp = 5000000;
    in_.vehicle_attitude.q[0] = 1.0f;
    in_.vehicle_attitude.delta_q_reset[0] = 1.0f;
    in_.vehicle_attitude_setpoint.q_d[0] = 1.0f;
    in_.vehicle_attitude_setpoint.thrust_body[2] = -0.5f;
    in_.vehicle_status.armed = 1;
    in_.vehicle_status.is_rotary_wing = 1;
    in_.vehicle_local_position = {.unaided_heading = NAN, .heading_good_for_control = 1};
    in_.vehicle_control_mode.flag_control_attitude_enabled = 1;
  }

  void step(std::uint32_t updated) {
    in_.timestamp += 4000;
    in_.vehicle_attitude.timestamp = in_.timestamp;
    in_.vehicle_attitude.timestamp_sample = in_.timestamp;
    in_.updated = updated;
    unit_.step(in_, out_);
  }

  void send_setpoint(float thrust, std::uint64_t timestamp) {
    in_.vehicle_attitude_setpoint.thrust_body[2] = thrust;
    in_.vehicle_attitude_setpoint.timestamp = timestamp;
  }

  void stabilize(bool stabilized) {
    in_.vehicle_control_mode.flag_control_manual_enabled = stabilized;
  }

  void turn_attitude(double yaw) {
    const Quaternion<double> q = yaw_rotation(yaw);
    for (int i = 0; i < 4; ++i) in_.vehicle_attitude.q[i] = static_cast<float>(q[i]);
  }

  float thrust() const { return out_.vehicle_rates_setpoint.thrust_body[2]; }
  float stick_thrust() const { return -out_.vehicle_attitude_setpoint.thrust_body[2]; }
  bool is_from_v1_16_0() const { return from_v1_16_0.contains(GetParam()); }

  AttitudeUnit<float> unit_;
  attest_attitude_inputs in_{};
  attest_attitude_outputs out_{};
};

INSTANTIATE_TEST_SUITE_P(Every, CascadeAttitudeUnit, ::testing::ValuesIn(every_profile),
                         [](const auto& which) { return std::to_string(which.index); });

TEST(CascadeAttitudeStep, TimeIsClamped) {
  using Stages = AttitudeStepStages<float>;
  EXPECT_EQ(Stages::step_time(1004000, 1000000), 4000.0f * 1e-6f);
  EXPECT_EQ(Stages::step_time(1000000, 1000000), 0.0002f);
  EXPECT_EQ(Stages::step_time(1000000, 0), 0.02f);
  EXPECT_EQ(Stages::step_time(999999, 1000000), 0.02f) << "unsigned: time that goes back";
}

TEST_P(CascadeAttitudeUnit, PublishesRatesOnlyWhileItControlsTheAttitude) {
  step(everything);
  EXPECT_EQ(out_.vehicle_rates_setpoint.published, 1);
  EXPECT_EQ(out_.vehicle_attitude_setpoint.published, 0);
  in_.vehicle_status.in_transition_mode = 1;
  step(status_bit);
  EXPECT_EQ(out_.vehicle_rates_setpoint.published, 0);
  in_.vehicle_status.is_vtol_tailsitter = 1;
  step(status_bit);
  EXPECT_EQ(out_.vehicle_rates_setpoint.published, 1);
  in_.vehicle_control_mode.flag_control_attitude_enabled = 0;
  step(mode_bit);
  EXPECT_EQ(out_.vehicle_rates_setpoint.published, 0);
}

TEST_P(CascadeAttitudeUnit, BeforeTheFirstStatusItIsARotaryWing) {
  step(everything & ~status_bit);
  EXPECT_EQ(out_.vehicle_rates_setpoint.published, 1);
}

TEST_P(CascadeAttitudeUnit, APendingSetpointIsLatchedLater) {
  in_.vehicle_control_mode.flag_control_attitude_enabled = 0;
  send_setpoint(-0.7f, in_.timestamp);
  step(everything);
  in_.vehicle_control_mode.flag_control_attitude_enabled = 1;
  step(mode_bit);
  EXPECT_EQ(thrust(), -0.7f);
}

TEST_P(CascadeAttitudeUnit, ASetpointThatIsNotNewerIsDropped) {
  send_setpoint(-0.7f, 5000000);
  step(everything);
  send_setpoint(-0.6f, 5000000);
  step(setpoint_bit);
  EXPECT_EQ(thrust(), -0.7f);
  send_setpoint(-0.6f, 5000001);
  step(setpoint_bit);
  EXPECT_EQ(thrust(), -0.6f);
}

TEST_P(CascadeAttitudeUnit, OwnSetpointReplacesAPendingExternalOne) {
  stabilize(true);
  in_.vehicle_attitude_setpoint.timestamp = 1000;
  step(everything);
  in_.vehicle_attitude_setpoint.timestamp = in_.timestamp + 1000000;
  step(setpoint_bit);
  EXPECT_EQ(out_.vehicle_attitude_setpoint.published, 1);
  // v1.14.4 latches ahead of the sticks, and the sticks then set the setpoint again.
  EXPECT_EQ(thrust(), out_.vehicle_attitude_setpoint.thrust_body[2]);
}

// From v1.15.4 on the sticks' setpoint passes through its topic and is dropped if it is not newer
// than the last one. In v1.14.4 the law flies it directly.
TEST_P(CascadeAttitudeUnit, OwnSetpointIsDroppedBehindALaterOneFromV1_15_4On) {
  send_setpoint(-0.9f, in_.timestamp + 1000000);
  step(everything);
  stabilize(true);
  step(mode_bit);
  const bool dropped = GetParam() != Profile::px4_v1_14_4;
  EXPECT_EQ(thrust() == -0.9f, dropped);
}

TEST_P(CascadeAttitudeUnit, OnlyV1_14_4LatchesWhileItDoesNotRun) {
  in_.vehicle_control_mode.flag_control_attitude_enabled = 0;
  send_setpoint(-0.7f, 5000000);
  step(everything);
  send_setpoint(-0.6f, 4000000);  // older
  step(setpoint_bit);
  in_.vehicle_control_mode.flag_control_attitude_enabled = 1;
  step(mode_bit);
  EXPECT_EQ(thrust(), GetParam() == Profile::px4_v1_14_4 ? -0.7f : -0.6f);
}

TEST_P(CascadeAttitudeUnit, TopicsAreLatchedOnlyWhenUpdated) {
  step(everything);
  in_.vehicle_control_mode.flag_control_attitude_enabled = 0;
  step(0);
  EXPECT_EQ(out_.vehicle_rates_setpoint.published, 1);
}

TEST_P(CascadeAttitudeUnit, AResetOfTheEstimatorTurnsAnOlderSetpointOnly) {
  const auto yaw_rate_after_reset = [this](std::uint64_t setpoint_timestamp) {
    unit_ = AttitudeUnit<float>(GetParam());
    turn_attitude(0.0);
    in_.vehicle_attitude.quat_reset_counter = 0;
    in_.vehicle_attitude_setpoint.timestamp = setpoint_timestamp;
    step(everything);
    turn_attitude(0.3);
    for (int i = 0; i < 4; ++i) in_.vehicle_attitude.delta_q_reset[i] = in_.vehicle_attitude.q[i];
    in_.vehicle_attitude.quat_reset_counter = 1;
    step(0);
    return out_.vehicle_rates_setpoint.yaw;
  };
  EXPECT_NEAR(yaw_rate_after_reset(1000), 0.0f, 1e-5f);
  EXPECT_LT(yaw_rate_after_reset(1000000000), -0.5f);
}

TEST_P(CascadeAttitudeUnit, AutotuneAddsItsRatesForASecond) {
  in_.autotune_attitude_control_status.rate_sp[0] = 9.0f;  // beyond the limit
  const bool is_from_v1_17 = from_v1_17.contains(GetParam());
  in_.autotune_attitude_control_status.state = is_from_v1_17 ? 9 : 4;
  in_.autotune_attitude_control_status.timestamp = in_.timestamp;
  step(everything);
  EXPECT_EQ(out_.vehicle_rates_setpoint.roll, 9.0f);
  for (int i = 0; i < 250; ++i) step(0);
  EXPECT_EQ(out_.vehicle_rates_setpoint.roll, 0.0f);
  in_.autotune_attitude_control_status.timestamp = in_.timestamp;
  in_.autotune_attitude_control_status.state = is_from_v1_17 ? 4 : 3;
  step(everything);
  EXPECT_EQ(out_.vehicle_rates_setpoint.roll, 0.0f);
}

TEST_P(CascadeAttitudeUnit, ParametersHoldFromCreationOnOrFromTheirBit) {
  turn_attitude(0.1);
  EXPECT_TRUE(unit_.set_parameter("MC_YAW_P", 0.0f));
  step(everything);
  EXPECT_NEAR(out_.vehicle_rates_setpoint.yaw, 0.0f, 1e-6f);
  EXPECT_TRUE(unit_.set_parameter("MC_YAW_P", 1.0f));
  step(0);
  EXPECT_NEAR(out_.vehicle_rates_setpoint.yaw, 0.0f, 1e-6f);
  step(parameter_bit);
  EXPECT_NEAR(out_.vehicle_rates_setpoint.yaw, -0.1f, 1e-3f);
}

TEST_P(CascadeAttitudeUnit, SticksAreFollowedInStabilizedModeOnly) {
  stabilize(true);
  step(everything);
  EXPECT_EQ(out_.vehicle_attitude_setpoint.published, 1);
  in_.vehicle_control_mode.flag_control_altitude_enabled = 1;
  step(mode_bit);
  EXPECT_EQ(out_.vehicle_attitude_setpoint.published, 0);
}

// Thrust rises by half of its range in a second, once the motors had time to spool up.
TEST_P(CascadeAttitudeUnit, ThrustWaitsForTheSpoolUp) {
  stabilize(true);
  in_.vehicle_status.armed_time = in_.timestamp;
  step(everything);
  step(0);
  const bool limited = GetParam() != Profile::px4_v1_14_4;
  EXPECT_NEAR(stick_thrust(), limited ? 0.0f : 0.5f, 1e-6f);
  in_.timestamp += 1000000;
  step(status_bit);  // the limit moves after its use
  step(0);
  EXPECT_NEAR(stick_thrust(), limited ? 0.02f * 0.5f : 0.5f, 1e-6f);
}

TEST_P(CascadeAttitudeUnit, TheLowestThrustWaitsForTheTakeOffFromV1_15_4On) {
  const bool waits = GetParam() != Profile::px4_v1_14_4;
  stabilize(true);
  in_.manual_control_setpoint.throttle = -1.0f;
  in_.vehicle_land_detected.landed = 1;
  step(everything);
  for (int i = 0; i < 100; ++i) step(0);
  EXPECT_NEAR(stick_thrust(), waits ? 0.0f : 0.08f, 1e-6f);
  in_.vehicle_land_detected.landed = 0;
  step(everything);
  for (int i = 0; i < 100; ++i) step(0);
  EXPECT_NEAR(stick_thrust(), waits ? 100 * 0.004f * 0.05f : 0.08f, 1e-5f);
  for (int i = 0; i < 1000; ++i) step(0);
  EXPECT_NEAR(stick_thrust(), 0.08f, 1e-6f);
}

TEST_P(CascadeAttitudeUnit, FollowsTheHoverEstimateFromV1_16_0On) {
  stabilize(true);
  in_.hover_thrust_estimate = {.hover_thrust = 0.3f, .valid = 1};
  for (int i = 0; i < 2000; ++i) step(everything);
  EXPECT_NEAR(stick_thrust(), is_from_v1_16_0() ? 0.3f : 0.5f, 1e-5f);
  in_.hover_thrust_estimate.valid = 0;
  for (int i = 0; i < 2000; ++i) step(everything);
  EXPECT_NEAR(stick_thrust(), 0.5f, 1e-5f) << "MPC_THR_HOVER while not valid";
}

// Until v1.15.4 sticks that take over start from the heading. In v1.16.0 too, except in the first
// step.
TEST_P(CascadeAttitudeUnit, SticksThatTakeOverHoldTheHeading) {
  turn_attitude(1.0);
  step(everything);
  stabilize(true);
  step(mode_bit);
  EXPECT_NEAR(out_.vehicle_attitude_setpoint.q_d[3], std::sin(0.5f), 1e-6f);
}

// NaN passes a clamp, so it is allowed.
RC_GTEST_PROP(CascadeAttitudeLimits, HoldForAnySetpoint, ()) {
  AttitudeUnit<float> unit(every_profile[*rc::gen::inRange<std::size_t>(0, every_profile.size())]);
  attest_attitude_inputs in{};
  attest_attitude_outputs out{};
  in.vehicle_attitude.q[0] = 1.0f;
  in.vehicle_status.is_rotary_wing = 1;
  in.vehicle_control_mode.flag_control_attitude_enabled = 1;
  for (int i = 0; i < 20; ++i) {
    in.timestamp += 4000;
    in.updated = 0x7f;  // every topic but autotune
    in.vehicle_attitude_setpoint.timestamp = in.timestamp;
    for (float& component : in.vehicle_attitude_setpoint.q_d) {
      component = *test::mostly_ordinary_float();
    }
    in.vehicle_attitude_setpoint.yaw_sp_move_rate = *test::mostly_ordinary_float();
    unit.step(in, out);
    const auto& rates = out.vehicle_rates_setpoint;
    RC_ASSERT(!(std::abs(rates.roll) > radians(220.0f)));
    RC_ASSERT(!(std::abs(rates.pitch) > radians(220.0f)));
    RC_ASSERT(!(std::abs(rates.yaw) > radians(200.0f)));
  }
}

}  // namespace
}  // namespace attest::cascade
