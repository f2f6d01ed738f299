#include "harness/golden/margins.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "harness/casefile/stimulus.hpp"
#include "tests/harness/casefile/case_files.hpp"

namespace attest {
namespace {

Margins margins_of(const Case& the_case) {
  const auto meter = margin_meter(subject_of(the_case));
  return margins(stimulate(the_case, Rate::hz(250)), *meter);
}

Margins margins_of(const std::string& body) { return margins_of(case_of(body)); }

TEST(Margins, LevelFlightIsFarFromMost) {
  const Margins found = margins_of("");
  EXPECT_TRUE(std::isinf(found[Decision::shorter_rotation].distance));
  EXPECT_TRUE(std::isinf(found[Decision::battery_scale].distance));
  EXPECT_NEAR(found[Decision::thrust_gate].distance, 0.3, 1e-6);
  for (std::size_t i = 0; i < decision_count; ++i) {
    EXPECT_TRUE(found.is_safe(static_cast<Decision>(i))) << i;
  }
}

TEST(Margins, TheThrustGate) {
  const Margins found = margins_of(
      "[vehicle_attitude_setpoint]\nthrust = { signal = \"samples\", times_ticks = [0, 4], values "
      "= [0.5, 0.2] }\n");
  EXPECT_FALSE(found.is_safe(Decision::thrust_gate));
  EXPECT_EQ(found[Decision::thrust_gate].tick, 4u);
}

TEST(Margins, OfEachSideOfAThreshold) {
  const Margins found = margins_of(
      "[vehicle_attitude_setpoint]\nthrust = { signal = \"samples\", times_ticks = [0, 4, 6], "
      "values "
      "= [0.5, 0.1, 0.23] }\n");
  EXPECT_NEAR(found.at(Decision::thrust_gate, Side::below).distance, 0.1, 1e-6);
  EXPECT_EQ(found.at(Decision::thrust_gate, Side::below).tick, 4u);
  EXPECT_NEAR(found.at(Decision::thrust_gate, Side::above).distance, 0.03, 1e-6);
  EXPECT_EQ(found.at(Decision::thrust_gate, Side::above).tick, 6u);
  EXPECT_EQ(found[Decision::thrust_gate].tick, 6u);
}

Margins mixer_margins_of(const std::string& controls) {
  const std::string definition = "R: 4x 10000 10000 10000 0";
  return margins_of(
      case_of("[mixer]\ndefinition = \"" + definition + "\"\n[actuator_controls_0]\n" + controls));
}

TEST(Margins, OfAMixerWithinItsLimits) {
  const Margins found = mixer_margins_of("\"control[3]\" = 0.75\n");
  EXPECT_NEAR(found[Decision::mixer_limit].distance, 0.25, 1e-9);
  EXPECT_NEAR(found[Decision::mixer_yaw].distance, 0.25, 1e-9);
  EXPECT_TRUE(std::isinf(found[Decision::mixer_branch].distance));
}

// With roll alone, one end is beyond its limit by 0.4 - 0.3, and the other has room for 0.3.
TEST(Margins, AMixersBranchIsTheExcessAgainstTheRoom) {
  const Margins found = mixer_margins_of("\"control[0]\" = 0.5656854\n\"control[3]\" = 0.3\n");
  EXPECT_NEAR(found.at(Decision::mixer_branch, Side::below).distance, 0.2, 1e-6);
  EXPECT_FALSE(found.at(Decision::mixer_branch, Side::above).is_measured());
}

// Roll is fitted so that the lowest rotor is at its limit. Rounding decides whether it is beyond.
TEST(Margins, AMixerThatFitsRollIsAtTheLimitOfYaw) {
  const Margins found = mixer_margins_of("\"control[0]\" = 0.5\n\"control[3]\" = 0.3\n");
  EXPECT_FALSE(found.is_safe(Decision::mixer_yaw));
  const Margins yawed =
      mixer_margins_of("\"control[0]\" = 0.5\n\"control[2]\" = 0.05\n\"control[3]\" = 0.3\n");
  EXPECT_TRUE(yawed.is_safe(Decision::mixer_yaw));
}

// A gate counts only if it can flip the decision: while another gate is shut, it may be near.
TEST(Margins, AGateBehindAShutOneIsNoDecision) {
  const std::string near =
      "[parameters]\nMC_ROLLRATE_P = 0.3\nMC_ROLLRATE_D = 0\nMC_ROLLRATE_I = 0.1\n"
      "[vehicle_control_mode]\nflight_mode = \"OFFBOARD_RATES\"\n"
      "[vehicle_rates_setpoint]\nroll = 1.0000001\n";
  EXPECT_FALSE(margins_of(near + "thrust = 0.6\n").is_safe(Decision::integrator_gate));
  EXPECT_TRUE(margins_of(near + "thrust = 0.25\n").is_safe(Decision::integrator_gate));
}

TEST(Margins, TheTiltAxisAndTheYawWrap) {
  const Margins found = margins_of("[control_state]\nq = { tilt_deg = 179.99 }\n");
  EXPECT_NEAR(found[Decision::tilt_axis].distance, 0.01 * 3.14159265 / 180, 1e-6);
  EXPECT_FALSE(found.is_safe(Decision::tilt_axis));
  EXPECT_FALSE(margins_of("[vehicle_attitude_setpoint]\nq_d = { yaw_deg = 180 }\n")
                   .is_safe(Decision::yaw_wrap));
}

TEST(Margins, QuaternionsAreOfNorm1) {
  EXPECT_FALSE(
      margins_of("[control_state]\nq = { norm = 1.001 }\n").is_safe(Decision::quaternion_norm));
  EXPECT_TRUE(margins_of("[control_state]\nq = [0, 0, 0, 0]\n").is_safe(Decision::quaternion_norm));
}

TEST(Margins, SticksAndTheRecovery) {
  EXPECT_FALSE(margins_of("[parameters]\nMC_RATT_TH = 0.5\n[manual_control_setpoint]\nx = -0.5\n")
                   .is_safe(Decision::rattitude));
  EXPECT_FALSE(margins_of("[parameters]\nVT_OPT_RECOV_EN = 1\n[control_state]\nq = { tilt_deg = "
                          "30.0000001 }\n")
                   .is_safe(Decision::recovery_begin));
  const std::string recovering =
      "[parameters]\nVT_OPT_RECOV_EN = 1\n[control_state]\nq = { tilt_deg = ";
  const Margins side = margins_of(recovering + "40, azimuth_deg = 90.001 }\n");
  EXPECT_NEAR(side[Decision::recovery_side].distance, 0.001 * 3.14159265 / 180, 1e-6);
  EXPECT_FALSE(margins_of(recovering + "179.99 }\n").is_safe(Decision::tilt_axis));
  EXPECT_TRUE(margins_of("[parameters]\nVT_OPT_RECOV_EN = 1\n[control_state]\nq = [0, 1, 0, 0]\n")
                  .is_safe(Decision::tilt_axis));
}

// The law does not say what the tilt is. Ports have NaN or pi.
TEST(Margins, ARecoveryWithNanIsOnTheThreshold) {
  const Margins nan =
      margins_of("[parameters]\nVT_OPT_RECOV_EN = 1\n[control_state]\nq = [nan, 0, 0, 0]\n");
  EXPECT_FALSE(nan.is_safe(Decision::recovery_begin));
}

// 750 LSB of 20 bits are more than the margin that floats need; 750 LSB of 40 bits are less.
TEST(Margins, OfAPortInFixedPointAreAtLeastSomeOfItsLastBits) {
  EXPECT_EQ(least_margin(Decision::integrator_gate, std::nullopt), 1e-5);
  EXPECT_DOUBLE_EQ(least_margin(Decision::integrator_gate, 20), 750.0 / (1 << 20));
  EXPECT_EQ(least_margin(Decision::integrator_gate, 40), 1e-5);
}

}  // namespace
}  // namespace attest
