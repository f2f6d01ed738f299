// A law alone gives the bits of the unit around it. The units agree with recordings of the
// firmware, so these are the judge of the laws, too.
#include "controller/cascade/pure_laws.hpp"

#include <array>
#include <random>

#include <gtest/gtest.h>

#include "controller/mc_att_control/pure_laws.hpp"

namespace attest {
namespace {

using Q = std::array<float, 4>;
using V = std::array<float, 3>;

class Random {
 public:
  float within(float most) { return std::uniform_real_distribution(-most, most)(engine_); }
  V vector(float most) { return {within(most), within(most), within(most)}; }
  // Of norm 1.
  Q attitude() {
    const Q q{within(1), within(1), within(1), within(1)};
    const float norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    return {q[0] / norm, q[1] / norm, q[2] / norm, q[3] / norm};
  }

 private:
  std::mt19937 engine_{1};
};

template <typename Array, std::size_t n>
void copy(const Array& from, float (&to)[n]) {
  std::copy(from.begin(), from.end(), to);
}

V rates_of(const auto& setpoint) { return {setpoint.roll, setpoint.pitch, setpoint.yaw}; }

V radians_of(float roll_deg, float pitch_deg, float yaw_deg, auto radians) {
  return {radians(roll_deg), radians(pitch_deg), radians(yaw_deg)};
}

// Both laws of v1.14 and later, with the default parameters of their units.
class PureLawsOfUnits {
 public:
  explicit PureLawsOfUnits(cascade::Profile profile)
      : attitude_unit_(profile), attitude_law_(profile), rate_unit_(profile), rate_law_(profile) {
    unit_in_.updated = ~0u;
    unit_in_.vehicle_control_mode.flag_control_attitude_enabled = 1;
    unit_in_.vehicle_status.is_rotary_wing = 1;
    rate_in_.updated = ~0u;
    rate_in_.vehicle_control_mode = {1, 0, 1, 1};
    rate_in_.vehicle_status.is_rotary_wing = 1;
    const bool is_tame = profile <= cascade::Profile::px4_v1_17;  // MC_ROLL_P since v1.17
    auto& gains = law_in_.attitude_gains;
    copy(V{is_tame ? 4.0f : 6.5f, is_tame ? 4.0f : 6.5f, 2.8f}, gains.p);
    copy(radians_of(220, 220, 200, cascade::radians<float>), gains.rate_max);
    gains.yaw_weight = 0.4f;
    gains.ref_w_n = 50;
    gains.ref_ff_max = cascade::radians(100.0f);
    auto& rate_gains = rate_law_in_.rate_gains;
    copy(V{0.15f, 0.15f, 0.2f}, rate_gains.p);
    copy(V{0.2f, 0.2f, 0.1f}, rate_gains.i);
    copy(V{0.003f, 0.003f, 0}, rate_gains.d);
    copy(V{0.3f, 0.3f, 0.3f}, rate_gains.integral_max);
  }

  void step_attitude() {
    time_us_ += 4000;
    const Q q = random_.attitude(), q_d = random_.attitude();
    const float yaw_rate = random_.within(2);
    auto& attitude = unit_in_.vehicle_attitude;
    attitude.timestamp = attitude.timestamp_sample = unit_in_.timestamp = time_us_;
    copy(q, attitude.q);
    copy(q, law_in_.vehicle_attitude.q);
    unit_in_.vehicle_attitude_setpoint.timestamp = time_us_;
    law_in_.vehicle_attitude_setpoint.timestamp = time_us_;
    copy(q_d, unit_in_.vehicle_attitude_setpoint.q_d);
    copy(q_d, law_in_.vehicle_attitude_setpoint.q_d);
    unit_in_.vehicle_attitude_setpoint.yaw_sp_move_rate = yaw_rate;
    law_in_.vehicle_attitude_setpoint.yaw_sp_move_rate = yaw_rate;
    attest_attitude_outputs unit_out{};
    attest_attitude_law_outputs law_out{};
    attitude_unit_.step(unit_in_, unit_out);
    attitude_law_.step(law_in_, law_out);
    EXPECT_EQ(rates_of(law_out.vehicle_rates_setpoint), rates_of(unit_out.vehicle_rates_setpoint));
  }

  // Not the torque of yaw, which the unit filters since v1.16.
  void step_rates() {
    time_us_ += 1000;
    auto& gyro = rate_in_.vehicle_angular_velocity;
    gyro.timestamp_sample = rate_in_.timestamp = time_us_;
    copy(random_.vector(5), gyro.xyz);
    copy(random_.vector(50), gyro.xyz_derivative);
    std::copy_n(gyro.xyz, 3, rate_law_in_.vehicle_angular_velocity.xyz);
    std::copy_n(gyro.xyz_derivative, 3, rate_law_in_.vehicle_angular_velocity.xyz_derivative);
    const V sp = random_.vector(5), unallocated = random_.vector(1);
    rate_in_.vehicle_rates_setpoint = {sp[0], sp[1], sp[2], {0, 0, -0.5f}};
    rate_law_in_.vehicle_rates_setpoint = {sp[0], sp[1], sp[2], 0.5f};
    copy(unallocated, rate_in_.control_allocator_status.unallocated_torque);
    for (std::size_t i = 0; i < 3; ++i) {
      rate_law_in_.saturation.positive[i] = unallocated[i] > 0;
      rate_law_in_.saturation.negative[i] = unallocated[i] < 0;
    }
    rate_in_.vehicle_land_detected = {0, random_.within(1) > 0.5f};
    rate_law_in_.law = {dt_s_, rate_in_.vehicle_land_detected.landed, 0};
    dt_s_ = 5000.0f * 1e-6f;  // with the time of step_attitude()
    attest_rate_outputs unit_out{};
    attest_rate_law_outputs law_out{};
    rate_unit_.step(rate_in_, unit_out);
    rate_law_.step(rate_law_in_, law_out);
    EXPECT_EQ(law_out.vehicle_torque_setpoint.xyz[0], unit_out.vehicle_torque_setpoint.xyz[0]);
    EXPECT_EQ(law_out.vehicle_torque_setpoint.xyz[1], unit_out.vehicle_torque_setpoint.xyz[1]);
    EXPECT_EQ(law_out.rate_ctrl_status.yawspeed_integ, unit_out.rate_ctrl_status.yawspeed_integ);
  }

 private:
  Random random_;
  std::uint64_t time_us_ = 5000000;
  float dt_s_ = 0.02f;  // the unit's limit, for its first step
  cascade::AttitudeUnit<float> attitude_unit_;
  cascade::PureAttitudeLaw<float> attitude_law_;
  cascade::RateUnit<float> rate_unit_;
  cascade::PureRateLaw<float> rate_law_;
  attest_attitude_inputs unit_in_{};
  attest_attitude_law_inputs law_in_{};
  attest_rate_inputs rate_in_{};
  attest_rate_law_inputs rate_law_in_{};
};

TEST(PureLaws, AreThoseOfTheUnitsOfTheCascade) {
  for (const cascade::Profile profile : cascade::every_profile) {
    PureLawsOfUnits both(profile);
    for (int i = 0; i < 300; ++i) {
      both.step_attitude();
      both.step_rates();
    }
  }
}

// Both laws of v1.5.5 and v1.3.4 in a row, as the controller runs them, with its default
// parameters.
class PureLawsOfController {
 public:
  explicit PureLawsOfController(mc_att_control::Profile profile)
      : controller_(profile), attitude_law_(profile), rate_law_(profile) {
    in_.updated = ~0u & ~std::uint32_t{ATTEST_UPDATED_BATTERY_STATUS};
    in_.vehicle_control_mode.flag_control_attitude_enabled = 1;
    in_.vehicle_control_mode.flag_control_rates_enabled = 1;
    in_.actuator_armed.armed = 1;
    in_.vehicle_status.is_rotary_wing = 1;
    const auto p = mc_att_control::default_parameters();
    const auto gains = mc_att_control::compute_gains<float>(p);
    auto& attitude = law_in_.attitude_gains;
    auto& rate = rate_law_in_.rate_gains;
    for (int i = 0; i < 3; ++i) {
      attitude.p[i] = gains.attitude.proportional_1_s[i];
      attitude.rate_max[i] = gains.attitude.rate_max_rad_s[i];
      rate.p[i] = gains.rate.proportional[i];
      rate.i[i] = gains.rate.integral[i];
      rate.d[i] = gains.rate.derivative[i];
      rate.ff[i] = gains.rate.feed_forward[i];
    }
    attitude.yaw_ff = gains.attitude.yaw_feed_forward;
    rate.tpa_break = gains.rate.tpa_break;
    rate.tpa_slope = gains.rate.tpa_slope;
  }

  void step() {
    in_.timestamp += 4000;
    const Q q = random_.attitude(), q_d = random_.attitude();
    const V rates = random_.vector(2);
    copy(q, in_.control_state.q);
    copy(q, law_in_.vehicle_attitude.q);
    copy(q_d, in_.vehicle_attitude_setpoint.q_d);
    copy(q_d, law_in_.vehicle_attitude_setpoint.q_d);
    in_.control_state.roll_rate = rates[0];
    in_.control_state.pitch_rate = rates[1];
    in_.control_state.yaw_rate = rates[2];
    copy(rates, rate_law_in_.vehicle_angular_velocity.xyz);
    in_.vehicle_attitude_setpoint.thrust = 0.6f;
    in_.vehicle_attitude_setpoint.yaw_sp_move_rate = random_.within(1);
    law_in_.vehicle_attitude_setpoint.yaw_sp_move_rate =
        in_.vehicle_attitude_setpoint.yaw_sp_move_rate;
    attest_outputs out{};
    attest_attitude_law_outputs rates_out{};
    attest_rate_law_outputs torque_out{};
    controller_.step(in_, out);
    attitude_law_.step(law_in_, rates_out);
    const V sp = rates_of(rates_out.vehicle_rates_setpoint);
    EXPECT_EQ(sp, rates_of(out.vehicle_rates_setpoint));
    rate_law_in_.vehicle_rates_setpoint = {sp[0], sp[1], sp[2], 0.6f};
    rate_law_in_.law.dt = 4000.0f / 1000000.0f;
    rate_law_.step(rate_law_in_, torque_out);
    copy(rates, rate_law_in_.previous.rates);
    copy(sp, rate_law_in_.previous.rates_sp);
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(torque_out.vehicle_torque_setpoint.xyz[i], out.actuator_controls_0.control[i]);
    }
  }

 private:
  Random random_;
  mc_att_control::McAttControl<float> controller_;
  mc_att_control::PureAttitudeLaw<float> attitude_law_;
  mc_att_control::PureRateLaw<float> rate_law_;
  attest_inputs in_{};
  attest_attitude_law_inputs law_in_{};
  attest_rate_law_inputs rate_law_in_{};
};

TEST(PureLaws, AreThoseOfTheControllerOfV1_5_5) {
  for (const mc_att_control::Profile profile : mc_att_control::every_profile) {
    PureLawsOfController both(profile);
    for (int i = 0; i < 300; ++i) both.step();
  }
}

}  // namespace
}  // namespace attest
