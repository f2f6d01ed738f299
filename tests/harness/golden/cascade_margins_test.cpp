// Each decision of the cascade's law, from near and from far.
#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "harness/casefile/stimulus.hpp"
#include "harness/golden/margins.hpp"
#include "tests/harness/casefile/case_files.hpp"

namespace attest {
namespace {

// A case that comes too near to one decision at tick 4.
struct Near {
  Decision decision;
  Module module;
  std::string body;
  std::string profile = "px4-v1.16.0";

  friend void PrintTo(const Near& near, std::ostream* out) { *out << name_of(near.decision); }
};

Margins margins_of(Module module, const std::string& body,
                   const std::string& profile = "px4-v1.16.0") {
  const Case the_case = unit_case_of(module, profile, body);
  const auto meter = margin_meter(subject_of(the_case));
  return margins(stimulate(the_case, Rate::hz(250)), *meter);
}

const std::string stabilized =
    "[vehicle_control_mode]\nflag_control_manual_enabled = 1\nflag_control_altitude_enabled = 0\n"
    "flag_control_velocity_enabled = 0\nflag_control_position_enabled = 0\n";

// A signal that is `value` from tick 4 on, and `before` until then.
std::string then(double before, const std::string& value) {
  return fmt::format("{{ signal = \"samples\", times_ticks = [0, 4], values = [{}, {}] }}", before,
                     value);
}

const std::string lowest_throttle = "[manual_control_setpoint]\nthrottle = -1\n";
const std::string unaided = "[vehicle_local_position]\nunaided_heading = ";

// The yaw rate is 2.6179938 rad/s times the stick.
const std::string straight_yaw =
    "[parameters]\nMPC_MAN_Y_TAU = 0\nMPC_MAN_Y_MAX = 150\nMPC_YAW_EXPO = 0\nMPC_HOLD_DZ = 0\n";

const std::vector<Near> near_cases = {
    {Decision::shorter_rotation, Module::attitude_unit,
     "[vehicle_attitude]\nq = { tilt_deg = " + then(0, "179.9999") + " }\n"},
    {Decision::tilt_axis, Module::attitude_unit,
     "[vehicle_attitude]\nq = { azimuth_deg = 30, tilt_deg = " + then(0, "179.99") + " }\n"},
    {Decision::yaw_wrap, Module::attitude_unit,
     "[vehicle_attitude]\nq = { yaw_deg = " + then(0, "179.9999") + " }\n"},
    {Decision::opposite_thrust, Module::attitude_unit,
     "[vehicle_attitude]\nq = { tilt_deg = " + then(0, "179.487172") + " }\n"},
    {Decision::yaw_weight, Module::attitude_unit,
     "[parameters]\nMC_YAW_WEIGHT = " + then(0.4, "1e-4")},
    {Decision::spool_up, Module::attitude_unit,
     "[parameters]\nCOM_SPOOLUP_TIME = 0.516\n[vehicle_status]\narmed_time = -0.5\n"
     "publish_at_ticks = [0, 4]\n"},
    {Decision::lowest_throttle, Module::attitude_unit,
     stabilized + "[manual_control_setpoint]\nthrottle = " + then(0, "-0.9")},
    {Decision::lowest_throttle, Module::attitude_unit,
     stabilized + "[manual_control_setpoint]\nthrottle = " + then(0, "-0.9"), "px4-v1.14.4"},
    {Decision::heading_pole, Module::attitude_unit,
     stabilized + "[vehicle_attitude]\nq = { pitch_deg = " + then(0, "-89.94") + " }\n"},
    {Decision::heading_wrap, Module::attitude_unit,
     stabilized + lowest_throttle + "[vehicle_attitude]\nq = { yaw_deg = " + then(0, "-179.99999") +
         " }\n"},
    {Decision::heading_wrap, Module::attitude_unit,
     stabilized + lowest_throttle + unaided + then(0, "3.1415926")},
    {Decision::convergence, Module::attitude_unit, stabilized + unaided + then(0, "-0.0174532")},
    {Decision::yaw_lock, Module::attitude_unit,
     stabilized + straight_yaw + "[manual_control_setpoint]\nyaw = " + then(0, "4.5534877e-8")},
    {Decision::saturation_flag, Module::rate_unit,
     "[control_allocator_status]\ntorque_setpoint_achieved = 0\n\"unallocated_torque[1]\" = " +
         then(0, "-1.1920929e-7")},
    {Decision::yaw_cutoff, Module::rate_unit,
     "[parameters]\nMC_YAW_TQ_CUTOFF = " + then(2, "1.1920929e-7")},
    {Decision::battery_scale, Module::rate_unit,
     "[parameters]\nMC_BAT_SCALE_EN = 1\n[battery_status]\nscale = " + then(1, "1e-9")},
    {Decision::overflow, Module::rate_unit,
     "[parameters]\nMC_ROLLRATE_P = 1\n[vehicle_angular_velocity]\n\"xyz[0]\" = " +
         then(0, "3.40282e38")},
};

class CascadeMargins : public testing::TestWithParam<Near> {};

TEST_P(CascadeMargins, ACaseThatComesTooNear) {
  const Near& near = GetParam();
  const Margins found = margins_of(near.module, near.body, near.profile);
  EXPECT_FALSE(found.is_safe(near.decision)) << found[near.decision].distance;
  EXPECT_EQ(found[near.decision].tick, 4u);
  for (std::size_t i = 0; i < decision_count; ++i) {
    const auto other = static_cast<Decision>(i);
    if (other == near.decision) continue;
    EXPECT_TRUE(found.is_safe(other)) << name_of(other) << " " << found[other].distance;
  }
}

INSTANTIATE_TEST_SUITE_P(Each, CascadeMargins, testing::ValuesIn(near_cases));

TEST(CascadeMarginsOf, AUnitInCruiseAreSafe) {
  for (const Module module : {Module::attitude_unit, Module::rate_unit}) {
    const Margins found = margins_of(module, "");
    for (std::size_t i = 0; i < decision_count; ++i) {
      EXPECT_TRUE(found.is_safe(static_cast<Decision>(i))) << i;
    }
  }
}

TEST(CascadeMarginsOf, DecisionsWithoutEffectAreNotMeasured) {
  const auto infinite = [](const Margins& found, Decision decision) {
    return std::isinf(found[decision].distance);
  };
  EXPECT_TRUE(infinite(margins_of(Module::attitude_unit, "[parameters]\nMC_YAW_WEIGHT = 0\n"),
                       Decision::yaw_weight));
  EXPECT_TRUE(infinite(margins_of(Module::attitude_unit,
                                  "[parameters]\nMC_YAW_WEIGHT = 0\n[vehicle_attitude]\nq = { "
                                  "yaw_deg = 179.9999 }\n"),
                       Decision::yaw_wrap));
  EXPECT_TRUE(infinite(margins_of(Module::attitude_unit,
                                  stabilized + "[parameters]\nMC_AIRMODE = 2\n"
                                               "[manual_control_setpoint]\nthrottle = -0.9\n"),
                       Decision::lowest_throttle));
  EXPECT_TRUE(infinite(margins_of(Module::attitude_unit, stabilized), Decision::yaw_lock));
  EXPECT_TRUE(infinite(margins_of(Module::attitude_unit, "[vehicle_status]\narmed = 0\n"),
                       Decision::spool_up));
  EXPECT_TRUE(infinite(margins_of(Module::rate_unit,
                                  "[control_allocator_status]\n\"unallocated_torque[0]\" = "
                                  "1.1920929e-7\n"),
                       Decision::saturation_flag));
  EXPECT_TRUE(infinite(margins_of(Module::rate_unit, "[battery_status]\nscale = 1e-9\n"),
                       Decision::battery_scale));
}

// The threshold is FLT_EPSILON, so only a ratio shows how near a value is.
TEST(CascadeMarginsOf, TwiceAnEpsilonIsSafe) {
  const Margins yaw =
      margins_of(Module::attitude_unit,
                 stabilized + straight_yaw + "[manual_control_setpoint]\nyaw = 9.1069754e-8\n");
  EXPECT_NEAR(yaw[Decision::yaw_lock].distance, 1, 1e-3);
  const Margins flags = margins_of(Module::rate_unit,
                                   "[control_allocator_status]\ntorque_setpoint_achieved = 0\n"
                                   "\"unallocated_torque[2]\" = 2.3841858e-7\n"
                                   "[parameters]\nMC_YAW_TQ_CUTOFF = 2.3841858e-7\n");
  EXPECT_NEAR(flags[Decision::saturation_flag].distance, 1, 1e-3);
  EXPECT_NEAR(flags[Decision::yaw_cutoff].distance, 1, 1e-3);
}

// Opposite thrust directions are not tilted, so their arbitrary axis has no effect.
TEST(CascadeMarginsOf, OppositeThrustHasNoAxis) {
  const Margins found = margins_of(
      Module::attitude_unit, "[vehicle_attitude]\nq = { azimuth_deg = 0, tilt_deg = 179.97 }\n");
  EXPECT_TRUE(found.is_safe(Decision::tilt_axis));
  EXPECT_TRUE(found.is_safe(Decision::opposite_thrust));
}

TEST(CascadeMarginsOf, ABatteryEstimateOrAnUnknownProfileDoNotExist) {
  EXPECT_EQ(margin_meter({"px4-v1.16.0", Module::battery_status}), nullptr);
  EXPECT_EQ(margin_meter({"our-law", Module::rate_unit}), nullptr);
  EXPECT_EQ(margin_meter({"px4-v1.16.0"}), nullptr);
}

}  // namespace
}  // namespace attest
