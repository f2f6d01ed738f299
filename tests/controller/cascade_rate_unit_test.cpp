#include <cmath>

#include <gtest/gtest.h>

#include "controller/cascade/rate_unit.hpp"

namespace attest::cascade {
namespace {

// One unit and its input topics: 1 ms a step, armed and in flight, rates from outside.
class CascadeRateUnit : public ::testing::TestWithParam<Profile> {
 protected:
  static constexpr std::uint32_t everything = 0x7f;  // except parameter_update
  static constexpr std::uint32_t setpoint_bit = ATTEST_RATE_UPDATED_VEHICLE_RATES_SETPOINT;
  static constexpr std::uint32_t sticks_bit = ATTEST_RATE_UPDATED_MANUAL_CONTROL_SETPOINT;
  static constexpr std::uint32_t mode_bit = ATTEST_RATE_UPDATED_VEHICLE_CONTROL_MODE;
  static constexpr std::uint32_t land_bit = ATTEST_RATE_UPDATED_VEHICLE_LAND_DETECTED;
  static constexpr std::uint32_t allocator_bit = ATTEST_RATE_UPDATED_CONTROL_ALLOCATOR_STATUS;
  static constexpr std::uint32_t battery_bit = ATTEST_RATE_UPDATED_BATTERY_STATUS;
  static constexpr std::uint32_t parameter_bit = ATTEST_RATE_UPDATED_PARAMETER_UPDATE;

  CascadeRateUnit() : unit_(GetParam()) {
    in_.timestamp = 5000000;
    in_.vehicle_rates_setpoint.roll = 0.5f;
    in_.vehicle_rates_setpoint.thrust_body[2] = -0.6f;
    in_.vehicle_control_mode.flag_armed = 1;
    in_.vehicle_control_mode.flag_control_rates_enabled = 1;
    in_.vehicle_status.is_rotary_wing = 1;
  }

  void step(std::uint32_t updated) {
    in_.timestamp += 1000;
    in_.vehicle_angular_velocity.timestamp_sample = in_.timestamp;
    in_.updated = updated;
    unit_.step(in_, out_);
  }

  void fly_acro() { in_.vehicle_control_mode.flag_control_manual_enabled = 1; }

  float torque(int axis) const { return out_.vehicle_torque_setpoint.xyz[axis]; }
  float thrust() const { return out_.vehicle_thrust_setpoint.xyz[2]; }
  float integral() const { return out_.rate_ctrl_status.rollspeed_integ; }
  bool filters_yaw() const { return traits_of(GetParam()).filters_yaw_torque; }

  RateUnit<float> unit_;
  attest_rate_inputs in_{};
  attest_rate_outputs out_{};
};

INSTANTIATE_TEST_SUITE_P(Every, CascadeRateUnit, ::testing::ValuesIn(every_profile),
                         [](const auto& which) { return std::to_string(which.index); });

TEST(CascadeRateStep, TimeIsClamped) {
  using Stages = RateStepStages<float>;
  EXPECT_EQ(Stages::step_time(1001000, 1000000), 1000.0f * 1e-6f);
  EXPECT_EQ(Stages::step_time(1000100, 1000000), 0.000125f);
  EXPECT_EQ(Stages::step_time(1000000, 0), 0.02f);
}

TEST_P(CascadeRateUnit, PublishesOnlyWhileItControlsRates) {
  step(everything);
  EXPECT_EQ(out_.vehicle_torque_setpoint.published, 1);
  EXPECT_EQ(out_.vehicle_thrust_setpoint.published, 1);
  EXPECT_EQ(out_.rate_ctrl_status.published, 1);
  EXPECT_EQ(out_.vehicle_rates_setpoint.published, 0);
  EXPECT_NEAR(torque(0), 0.15f * 0.5f, 1e-6f);
  EXPECT_EQ(thrust(), -0.6f);
  in_.vehicle_control_mode.flag_control_rates_enabled = 0;
  step(mode_bit);
  EXPECT_EQ(out_.vehicle_torque_setpoint.published, 0);
  EXPECT_EQ(out_.vehicle_thrust_setpoint.published, 0);
  EXPECT_EQ(out_.rate_ctrl_status.published, 0);
}

TEST_P(CascadeRateUnit, DisarmedStartsEveryStepFromAnIntegralOfZero) {
  for (int i = 0; i < 3; ++i) step(everything);
  const float flown = integral();
  in_.vehicle_control_mode.flag_armed = 0;
  step(mode_bit);
  const float once = integral();
  EXPECT_LT(once, flown);
  EXPECT_GT(once, 0.0f) << "this step's update still runs";
  step(0);
  EXPECT_EQ(integral(), once);
}

TEST_P(CascadeRateUnit, FixedWingStartsFromAnIntegralOfZeroToo) {
  step(everything);
  in_.vehicle_status.is_rotary_wing = 0;
  step(everything);
  const float once = integral();
  step(0);
  EXPECT_EQ(integral(), once);
}

TEST_P(CascadeRateUnit, BeforeTheFirstStatusItIsARotaryWing) {
  step(everything & ~std::uint32_t{ATTEST_RATE_UPDATED_VEHICLE_STATUS});
  const float once = integral();
  step(0);
  EXPECT_GT(integral(), once);
}

TEST_P(CascadeRateUnit, LandedFreezesTheIntegral) {
  step(everything);
  step(0);
  const float flown = integral();
  in_.vehicle_land_detected.maybe_landed = 1;
  step(land_bit);
  EXPECT_EQ(integral(), flown);
}

TEST_P(CascadeRateUnit, BeforeTheFirstLandSampleItCountsAsLanded) {
  step(everything & ~land_bit);
  EXPECT_EQ(integral(), 0.0f);
}

TEST_P(CascadeRateUnit, APendingSetpointIsLatchedLater) {
  fly_acro();
  step(everything & ~sticks_bit);
  EXPECT_EQ(thrust(), 0.0f);
  in_.vehicle_control_mode.flag_control_attitude_enabled = 1;
  step(mode_bit);
  EXPECT_EQ(thrust(), -0.6f);
}

TEST_P(CascadeRateUnit, OwnSetpointReplacesAPendingExternalOne) {
  fly_acro();
  in_.manual_control_setpoint.throttle = 0.0f;
  step(everything);
  in_.vehicle_control_mode.flag_control_manual_enabled = 0;
  step(mode_bit);
  EXPECT_EQ(thrust(), -0.5f);
  step(setpoint_bit);
  EXPECT_EQ(thrust(), -0.6f);
}

TEST_P(CascadeRateUnit, SaturationIsLatchedWhileRatesAreControlled) {
  in_.control_allocator_status.unallocated_torque[0] = 0.1f;
  in_.vehicle_control_mode.flag_control_rates_enabled = 0;
  step(everything);
  in_.vehicle_control_mode.flag_control_rates_enabled = 1;
  step(mode_bit);
  EXPECT_EQ(integral(), 0.0f);
  in_.control_allocator_status.torque_setpoint_achieved = 1;
  step(allocator_bit);
  EXPECT_GT(integral(), 0.0f);
}

TEST_P(CascadeRateUnit, ARateThatIsNotFiniteHoldsTheMeasuredOne) {
  in_.vehicle_rates_setpoint.roll = NAN;
  in_.vehicle_angular_velocity.xyz[0] = 0.3f;
  step(everything);
  EXPECT_EQ(torque(0), 0.0f);
  in_.vehicle_angular_velocity.xyz[0] = 0.1f;
  step(0);
  EXPECT_NEAR(torque(0), 0.15f * 0.2f, 1e-4f) << "the rate at latching, not the newest";
}

TEST_P(CascadeRateUnit, AcroNeedsANewStickSample) {
  fly_acro();
  in_.manual_control_setpoint = {.roll = 1.0f, .pitch = 0.5f, .yaw = -1.0f, .throttle = 1.0f};
  step(everything);
  const auto& rates = out_.vehicle_rates_setpoint;
  EXPECT_EQ(rates.published, 1);
  const bool older = GetParam() == Profile::px4_v1_14_4;
  EXPECT_NEAR(rates.roll, radians(older ? 720.0f : 100.0f), 1e-4f);
  EXPECT_NEAR(rates.yaw, -radians(older ? 540.0f : 100.0f), 1e-4f);
  EXPECT_EQ(rates.thrust_body[2], -1.0f);
  if (!older) {
    EXPECT_NEAR(rates.pitch, -0.5f * radians(100.0f), 1e-6f);
  }
  step(0);
  EXPECT_EQ(rates.published, 0);
  EXPECT_EQ(thrust(), -1.0f);
}

TEST_P(CascadeRateUnit, AcroIsPublishedWithoutTheRatesFlag) {
  fly_acro();
  in_.vehicle_control_mode.flag_control_rates_enabled = 0;
  step(everything);
  EXPECT_EQ(out_.vehicle_rates_setpoint.published, 1);
  EXPECT_EQ(out_.vehicle_torque_setpoint.published, 0);
}

// The low-pass of v1.16.0 never loses a NaN, and the guard makes it 0.
TEST_P(CascadeRateUnit, ANaNStaysInTheYawTorqueOfV1_16_0) {
  in_.vehicle_rates_setpoint.yaw = 0.5f;
  step(everything);
  EXPECT_GT(torque(2), 0.0f);
  in_.vehicle_angular_velocity.xyz[0] = in_.vehicle_angular_velocity.xyz[2] = NAN;
  step(0);
  EXPECT_EQ(torque(0), 0.0f);
  EXPECT_EQ(torque(2), 0.0f);
  in_.vehicle_angular_velocity.xyz[0] = in_.vehicle_angular_velocity.xyz[2] = 0.0f;
  for (int i = 0; i < 100; ++i) step(0);
  EXPECT_GT(torque(0), 0.0f);
  EXPECT_EQ(torque(2) == 0.0f, filters_yaw());
}

TEST_P(CascadeRateUnit, YawTorqueIsFilteredInV1_16_0) {
  in_.vehicle_rates_setpoint.yaw = 0.5f;
  step(everything);
  step(0);
  EXPECT_LT(filters_yaw() ? torque(2) : 0.0f, 0.5f * 0.1f);
  for (int i = 0; i < 1000; ++i) step(0);
  EXPECT_GT(torque(2), 0.1f);
}

TEST_P(CascadeRateUnit, ThrustIsNotGuarded) {
  in_.vehicle_rates_setpoint.thrust_body[2] = NAN;
  step(everything);
  EXPECT_TRUE(std::isnan(thrust()));
}

TEST_P(CascadeRateUnit, BatteryScalesTorqueAndThrust) {
  unit_.set_parameter("MC_BAT_SCALE_EN", 1.0f);
  in_.battery_status = {.scale = 1.2f, .connected = 1};
  step(everything);
  EXPECT_NEAR(torque(0), 1.2f * 0.15f * 0.5f, 1e-6f);
  EXPECT_NEAR(thrust(), 1.2f * -0.6f, 1e-6f);
  in_.battery_status = {.scale = 2.0f, .connected = 0};
  step(battery_bit);
  EXPECT_NEAR(thrust(), 1.2f * -0.6f, 1e-6f) << "the old scale stays";
  in_.battery_status.connected = 1;
  step(battery_bit);
  EXPECT_EQ(thrust(), -1.0f) << "clamped";
}

TEST_P(CascadeRateUnit, ABatterySampleWaitsForTheScaling) {
  in_.battery_status = {.scale = 1.2f, .connected = 1};
  in_.vehicle_rates_setpoint.thrust_body[2] = -1.5f;
  step(everything);
  EXPECT_EQ(thrust(), -1.5f) << "not clamped";
  unit_.set_parameter("MC_BAT_SCALE_EN", 1.0f);
  step(parameter_bit);
  EXPECT_EQ(thrust(), -1.0f);
}

}  // namespace
}  // namespace attest::cascade
