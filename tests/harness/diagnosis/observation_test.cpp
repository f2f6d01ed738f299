#include "harness/diagnosis/observation.hpp"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/casefile/stimulus.hpp"
#include "harness/golden/reference.hpp"
#include "tests/harness/casefile/case_files.hpp"

namespace attest {
namespace {

const ModuleUnderTest subject{"px4-v1.5.5"};

// What is observed of a port that gets the samples of the law, changed.
template <typename Change>
Observation observed(std::string_view body, Change change) {
  const Trace law = reference_outputs(subject, stimulate(case_of(body), Rate::hz(250))).value();
  Trace got = law;
  change(law, got);
  return observe(law, outputs_of(got), outputs_of(law), subject, Tolerances());
}

Tally where(const Observed& observed, std::string_view text) {
  for (const Where& one : observed.where) {
    if (one.condition == text) return one.tally;
  }
  return {};
}

const char* const tilting =
    "[control_state]\nroll_rate = 0.3\nq = { tilt_deg = { signal = \"ramp\", from = 0, to = 60, "
    "end_ticks = 9 }, azimuth_deg = 30 }\n[vehicle_attitude_setpoint]\nthrust = 0.8\n";

TEST(Observation, CountsTheValuesThatDeviateByStageAndAxis) {
  const Observation found = observed(tilting, [](const Trace&, Trace& got) {
    got.samples[4].out.vehicle_rates_setpoint.pitch += 1;
  });
  EXPECT_EQ(found.at({Stage::attitude_law, 1}).all.deviating, 1u);
  EXPECT_EQ(found.at({Stage::attitude_law, 1}).all.agreeing, 9u);
  EXPECT_EQ(found.at({Stage::attitude_law, 0}).all.deviating, 0u);
  EXPECT_EQ(found.at({Stage::rate_law, 1}).all.deviating, 0u);
}

TEST(Observation, CountsTheValuesWhereAConditionHolds) {
  const Observation found = observed(tilting, [](const Trace&, Trace& got) {
    for (std::size_t tick = 5; tick < 10; ++tick) {
      got.samples[tick].out.vehicle_rates_setpoint.roll += 1;
    }
  });
  const Observed& roll = found.at({Stage::attitude_law, 0});
  EXPECT_EQ(where(roll, "the tilt error exceeds 30 deg").deviating, 5u);
  EXPECT_EQ(where(roll, "the tilt error exceeds 30 deg").agreeing, 0u);
  EXPECT_EQ(where(roll, "the tilt error exceeds 1 deg").agreeing, 4u);
  EXPECT_EQ(where(roll, "it is the first step").deviating, 0u);
  EXPECT_EQ(where(roll, "actuator_armed.armed is set").deviating, 5u);
}

// An integral that deviates stays so, and the torque has it in the next step.
TEST(Observation, OfAnIntegralOnlyTheChangeCounts) {
  const Observation found = observed(tilting, [](const Trace&, Trace& got) {
    for (std::size_t tick = 3; tick < 10; ++tick) {
      got.samples[tick].out.mc_att_ctrl_status.roll_rate_integ += 0.1f;
      if (tick > 3) got.samples[tick].out.actuator_controls_0.control[0] += 0.1f;
    }
  });
  EXPECT_EQ(found.at({Stage::integrator, 0}).all.deviating, 1u);
  EXPECT_EQ(found.at({Stage::rate_law, 0}).all.deviating, 0u);
}

template <typename Change>
Relations relations_of_roll(Change change) {
  return observed(tilting,
                  [&](const Trace& law, Trace& got) {
                    for (std::size_t tick = 1; tick < 10; ++tick) {
                      got.samples[tick].out.vehicle_rates_setpoint.roll =
                          change(law.samples[tick - 1].out.vehicle_rates_setpoint.roll,
                                 law.samples[tick].out.vehicle_rates_setpoint.roll);
                    }
                  })
      .at({Stage::attitude_law, 0})
      .relations;
}

TEST(Observation, ComparesDeviatingValuesWithTheExpectedOnes) {
  const Relations late = relations_of_roll([](float before, float) { return before; });
  EXPECT_EQ(late.late, late.values);
  EXPECT_GE(late.values, 5u) << "until the rate reaches its limit";
  const Relations reversed = relations_of_roll([](float, float now) { return -now; });
  EXPECT_EQ(reversed.reversed, 9u);
  EXPECT_LT(reversed.late, 9u);
  const Relations zero = relations_of_roll([](float, float) { return 0.0f; });
  EXPECT_EQ(zero.zero, 9u);
  EXPECT_EQ(zero.cleared, 0u);
  const Relations limited =
      relations_of_roll([](float, float now) { return std::clamp(now, -0.1f, 0.1f); });
  EXPECT_EQ(limited.smaller, limited.values);
  EXPECT_FLOAT_EQ(static_cast<float>(limited.smaller_from), 0.1f);
  EXPECT_EQ(limited.smaller_from, limited.smaller_to);
  const Relations half = relations_of_roll([](float, float now) { return now / 2; });
  EXPECT_EQ(half.quotients, 9u);
  EXPECT_NEAR(half.quotient_from, 0.5, 1e-6);
  EXPECT_NEAR(half.quotient_to, 0.5, 1e-6);
}

TEST(Observation, KnowsAPortThatClearsWhatItDoesNotPublish) {
  const char* const stops =
      "[vehicle_control_mode]\nflag_control_rates_enabled = { signal = \"step\", from = 1, to = 0, "
      "at_ticks = 5 }\n[control_state]\nq = { tilt_deg = 20, azimuth_deg = 30 }\n";
  const Observation cleared = observed(stops, [](const Trace& law, Trace& got) {
    for (std::size_t tick = 0; tick < got.samples.size(); ++tick) {
      auto& topic = got.samples[tick].out.actuator_controls_0;
      if (law.samples[tick].out.actuator_controls_0.published == 0) topic.control[1] = 0;
    }
  });
  const Relations& pitch = cleared.at({Stage::rate_law, 1}).relations;
  EXPECT_EQ(pitch.values, 5u);
  EXPECT_EQ(pitch.cleared, 5u);
  EXPECT_EQ(pitch.zero, 0u);
}

}  // namespace
}  // namespace attest
