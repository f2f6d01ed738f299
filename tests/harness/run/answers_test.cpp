#include "harness/run/answers.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "harness/casefile/stimulus.hpp"
#include "harness/port/builtin.hpp"
#include "harness/run/open_loop.hpp"
#include "tests/harness/casefile/case_files.hpp"

namespace attest {
namespace {

constexpr const char* profile = "px4-v1.5.5";

// What the reference answers to a vehicle that rolls and pitches, 10 ticks of it.
Trace flown(const std::string& body = "[control_state]\nroll_rate = 0.4\npitch_rate = 0.5\n") {
  Trace trace = stimulate(case_of(body), Rate::hz(250));
  EXPECT_FALSE(drive(*open_builtin(), Subject{profile}, trace));
  trace.present = channels_of(Part::mc_att_control);
  return trace;
}

TEST(Answers, OfTheReferenceAreRightToTheLastTick) {
  const Comparison comparison = compare_answers(flown(), profile, Tolerances());
  EXPECT_TRUE(comparison.agrees()) << comparison.mismatch;
  EXPECT_EQ(comparison.ticks, 10u);
}

TEST(Answers, AWrongOneIsFoundAtItsTick) {
  for (const std::size_t tick : {0u, 4u, 9u}) {
    Trace trace = flown();
    trace.samples[tick].out.actuator_controls_0.control[2] += 0.01f;
    const Comparison comparison = compare_answers(trace, profile, Tolerances());
    ASSERT_TRUE(comparison.first);
    EXPECT_EQ(comparison.first->tick, tick);
    EXPECT_EQ(comparison.deviating_ticks, 1u);
  }
}

TEST(Answers, WhatIsNoNumberIsFound) {
  Trace trace = flown();
  trace.samples[7].out.mc_att_ctrl_status.yaw_rate_integ = std::numeric_limits<float>::quiet_NaN();
  const Comparison comparison = compare_answers(trace, profile, Tolerances());
  ASSERT_TRUE(comparison.first);
  EXPECT_EQ(comparison.first->tick, 7u);
  EXPECT_TRUE(comparison.got_non_finite);
}

// The parameters that the port was given are those that the reference is given.
TEST(Answers, ParametersAreThoseOfTheFlight) {
  Trace trace = flown("[parameters]\nMC_ROLL_P = 9\n[control_state]\nq = { roll_deg = 10 }\n");
  EXPECT_TRUE(compare_answers(trace, profile, Tolerances()).agrees());
  trace.parameters.clear();
  EXPECT_FALSE(compare_answers(trace, profile, Tolerances()).agrees());
}

// Thrust passes the gate of the integrals at 0.2: whether it is above is rounding's.
TEST(Answers, TheComparisonEndsWhereRoundingDecides) {
  const char* body =
      "[vehicle_attitude_setpoint]\nthrust = { signal = \"samples\", times_ticks = [0, 6], values "
      "= [0.5, 0.2] }\n";
  Trace trace = flown(body);
  trace.samples[5].out.actuator_controls_0.control[0] += 0.01f;
  EXPECT_EQ(compare_answers(trace, profile, Tolerances()).first->tick, 5u);
  trace = flown(body);
  trace.samples[6].out.actuator_controls_0.control[0] += 0.01f;
  const Comparison comparison = compare_answers(trace, profile, Tolerances());
  EXPECT_TRUE(comparison.agrees());
  EXPECT_EQ(comparison.ticks, 6u);
}

// A port with few bits rounds more, and so more often decides by rounding.
TEST(Answers, FewerBitsEndItFurtherFromADecision) {
  const char* body =
      "[vehicle_attitude_setpoint]\nthrust = { signal = \"samples\", times_ticks = [0, 6], values "
      "= [0.5, 0.2001] }\n";
  EXPECT_EQ(compare_answers(flown(body), profile, Tolerances()).ticks, 10u);
  EXPECT_EQ(compare_answers(flown(body), profile, Tolerances(), 30).ticks, 10u);
  EXPECT_EQ(compare_answers(flown(body), profile, Tolerances(), 22).ticks, 6u);
}

}  // namespace
}  // namespace attest
