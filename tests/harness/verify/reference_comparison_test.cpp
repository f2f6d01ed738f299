#include "harness/verify/reference_comparison.hpp"

#include <limits>
#include <optional>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "harness/casefile/stimulus.hpp"
#include "harness/loop/open_loop.hpp"
#include "harness/port/builtin.hpp"
#include "tests/harness/casefile/case_files.hpp"

namespace attest {
namespace {

constexpr const char* profile = "px4-v1.5.5";

// 10 ticks of the reference's outputs for a vehicle that rolls and pitches.
Trace flown(const std::string& body = "[control_state]\nroll_rate = 0.4\npitch_rate = 0.5\n") {
  Trace trace = stimulate(case_of(body), Rate::hz(250));
  EXPECT_FALSE(drive(*open_builtin(), ModuleUnderTest{profile}, trace));
  trace.present = channels_of(Module::mc_att_control);
  return trace;
}

ReferenceComparison answers_of(const Trace& trace, std::optional<int> fraction_bits = {}) {
  auto answers = compare_with_reference(trace, profile, Tolerances(), fraction_bits);
  EXPECT_TRUE(answers) << answers.error().to_string();
  return answers ? *answers : ReferenceComparison();
}

Comparison compared(const Trace& trace) { return answers_of(trace).comparison; }

// Thrust passes the integrator's gate at 0.2. Near the gate, rounding decides.
Trace flown_over_the_gate(double thrust) {
  return flown(
      fmt::format("[vehicle_attitude_setpoint]\nthrust = {{ signal = \"samples\", times_ticks = "
                  "[0, 6], values = [0.5, {}] }}\n",
                  thrust));
}

TEST(ReferenceComparison, OfTheReferenceAreRightToTheLastTick) {
  const Comparison comparison = compared(flown());
  EXPECT_TRUE(comparison.agrees()) << comparison.mismatch;
  EXPECT_EQ(comparison.ticks, 10u);
}

TEST(ReferenceComparison, AWrongOneIsFoundAtItsTick) {
  for (const std::size_t tick : {0u, 4u, 9u}) {
    Trace trace = flown();
    trace.samples[tick].out.actuator_controls_0.control[2] += 0.01f;
    const Comparison comparison = compared(trace);
    ASSERT_TRUE(comparison.first);
    EXPECT_EQ(comparison.first->tick, tick);
    EXPECT_EQ(comparison.deviating_ticks, 1u);
  }
}

TEST(ReferenceComparison, WhatIsNoNumberIsFound) {
  Trace trace = flown();
  trace.samples[7].out.mc_att_ctrl_status.yaw_rate_integ = std::numeric_limits<float>::quiet_NaN();
  const Comparison comparison = compared(trace);
  ASSERT_TRUE(comparison.first);
  EXPECT_EQ(comparison.first->tick, 7u);
  EXPECT_TRUE(comparison.got_non_finite);
}

// The reference receives the same parameters as the port.
TEST(ReferenceComparison, ParametersAreThoseOfTheFlight) {
  Trace trace = flown("[parameters]\nMC_ROLL_P = 9\n[control_state]\nq = { roll_deg = 10 }\n");
  EXPECT_TRUE(compared(trace).agrees());
  trace.parameters.clear();
  EXPECT_FALSE(compared(trace).agrees());
}

TEST(ReferenceComparison, WhereRoundingDecidesADeviationIsUndecided) {
  EXPECT_FALSE(answers_of(flown_over_the_gate(0.2)).undecided);
  EXPECT_EQ(compared(flown_over_the_gate(0.2)).ticks, 10u);
  for (const std::size_t tick : {6u, 8u}) {
    Trace trace = flown_over_the_gate(0.2);
    trace.samples[tick].out.actuator_controls_0.control[0] += 0.01f;
    const ReferenceComparison answers = answers_of(trace);
    EXPECT_TRUE(answers.comparison.agrees());
    EXPECT_EQ(answers.comparison.ticks, 6u);
    ASSERT_TRUE(answers.undecided);
    EXPECT_EQ(answers.undecided->decision, Decision::thrust_gate);
    EXPECT_EQ(answers.undecided->tick, 6u);
    EXPECT_EQ(answers.undecided->deviating_tick, tick);
  }
}

TEST(ReferenceComparison, ADeviationBeforeThatIsWrong) {
  Trace trace = flown_over_the_gate(0.2);
  for (const std::size_t tick : {5u, 8u}) {
    trace.samples[tick].out.actuator_controls_0.control[0] += 0.01f;
  }
  const ReferenceComparison answers = answers_of(trace);
  EXPECT_FALSE(answers.undecided);
  ASSERT_TRUE(answers.comparison.first);
  EXPECT_EQ(answers.comparison.first->tick, 5u);
}

TEST(ReferenceComparison, WhatIsNoNumberIsWrongWhereRoundingDecidesToo) {
  Trace trace = flown_over_the_gate(0.2);
  trace.samples[8].out.actuator_controls_0.control[0] = std::numeric_limits<float>::infinity();
  const ReferenceComparison answers = answers_of(trace);
  EXPECT_FALSE(answers.undecided);
  EXPECT_TRUE(answers.comparison.got_non_finite);
}

// A port with few bits rounds more, so rounding decides more often.
TEST(ReferenceComparison, FewerBitsDecideByRoundingFurtherFromADecision) {
  Trace trace = flown_over_the_gate(0.2001);
  trace.samples[8].out.actuator_controls_0.control[0] += 0.01f;
  EXPECT_FALSE(answers_of(trace).undecided);
  EXPECT_FALSE(answers_of(trace, 30).undecided);
  EXPECT_TRUE(answers_of(trace, 22).undecided);
}

// A setpoint at half a turn of yaw: rounding decides which way the vehicle turns.
TEST(ReferenceComparison, RoundingDecidesInTheUnitsOfTheCascade) {
  const Case half_turn =
      unit_case_of(Module::attitude_unit, "px4-v1.16.0",
                   "[vehicle_attitude_setpoint]\nq_d = { yaw_deg = { signal = "
                   "\"samples\", times_ticks = [0, 6], values = [30, 180] } }\n");
  Trace trace = stimulate(half_turn, Rate::hz(250));
  ASSERT_FALSE(drive(*open_builtin(), subject_of(half_turn), trace));
  trace.present = channels_of(Module::attitude_unit);
  trace.samples[7].attitude_out.vehicle_rates_setpoint.yaw *= -1;
  const auto answers = compare_with_reference(trace, "px4-v1.16.0", Tolerances());
  ASSERT_TRUE(answers && answers->undecided);
  EXPECT_EQ(answers->undecided->decision, Decision::yaw_wrap);
  EXPECT_EQ(answers->undecided->tick, 6u);
  trace.samples[5].attitude_out.vehicle_rates_setpoint.yaw *= -1;
  EXPECT_FALSE(compare_with_reference(trace, "px4-v1.16.0", Tolerances())->undecided);
}

TEST(ReferenceComparison, TheReferenceMustHaveTheProfile) {
  EXPECT_FALSE(compare_with_reference(flown(), "px4-v9.9.9", Tolerances()));
}

}  // namespace
}  // namespace attest
