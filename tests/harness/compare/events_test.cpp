#include "harness/compare/events.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/harness/compare/sample_trace.hpp"

namespace attest {
namespace {

const char* const integral = "out/mc_att_ctrl_status.yaw_rate_integ";
const char* const rates_published = "out/vehicle_rates_setpoint.published";

// Integrals move by 1e-4 a tick between ticks `from` and `to`.
Trace moving(std::size_t from, std::size_t to) {
  Trace trace = sample_trace(20);
  double value = 0;
  for (std::size_t tick = 0; tick < 20; ++tick) {
    for (const char* still :
         {"out/mc_att_ctrl_status.roll_rate_integ", "out/mc_att_ctrl_status.pitch_rate_integ"}) {
      set(trace, tick, still, 0);
    }
    if (tick >= from && tick < to) value += 1e-4;
    set(trace, tick, integral, value);
    for (const char* axis : {"[0]", "[1]", "[2]"}) {
      set(trace, tick, std::string("out/actuator_controls_0.control") + axis, 0.1);
    }
    set(trace, tick, "out/actuator_controls_0.control[3]", 0.5);
  }
  return trace;
}

TEST(Events, AreTheSameATickLater) {
  EXPECT_FALSE(first_event_difference(moving(5, 12), moving(5, 12)));
  EXPECT_FALSE(first_event_difference(moving(6, 12), moving(5, 12)));
  EXPECT_FALSE(first_event_difference(moving(4, 13), moving(5, 12)));
}

// A port that is one tick late publishes nothing at the first tick.
TEST(Events, TheFirstAndTheLastTickMayBeEither) {
  Trace got = moving(5, 12);
  set(got, 0, rates_published, 0);
  set(got, 19, rates_published, 0);
  EXPECT_FALSE(first_event_difference(got, moving(5, 12)));
}

TEST(Events, TwoTicksLaterAreOthers) {
  const auto late = first_event_difference(moving(7, 12), moving(5, 12));
  ASSERT_TRUE(late);
  EXPECT_EQ(late->tick, 5u);
  EXPECT_EQ(late->channel, channel(integral));
  EXPECT_EQ(late->what,
            "mc_att_ctrl_status.yaw_rate_integ is still, expected moving within a tick");
  EXPECT_TRUE(first_event_difference(moving(5, 14), moving(5, 12)));
}

TEST(Events, AMissingPulseOfOneTickIsSeen) {
  EXPECT_TRUE(first_event_difference(moving(20, 20), moving(8, 9)));
  EXPECT_TRUE(first_event_difference(moving(8, 9), moving(20, 20)));
}

TEST(Events, ValuesDoNotMatter) {
  Trace got = moving(5, 12);
  for (std::size_t tick = 0; tick < 20; ++tick) {
    set(got, tick, "out/vehicle_rates_setpoint.roll", 3);
    set(got, tick, "out/actuator_controls_0.control[1]", -0.3);
  }
  EXPECT_FALSE(first_event_difference(got, moving(5, 12)));
}

TEST(Events, PublicationSaturationAndFiniteness) {
  const Trace want = moving(5, 12);
  Trace got = want;
  set(got, 3, rates_published, 0);
  EXPECT_TRUE(first_event_difference(got, want));
  got = want;
  for (std::size_t tick = 8; tick < 20; ++tick) {
    set(got, tick, "out/actuator_controls_0.control[0]", -0.6);
  }
  ASSERT_TRUE(first_event_difference(got, want));
  EXPECT_THAT(first_event_difference(got, want)->what, testing::HasSubstr("beyond the thrust"));
  got = want;
  set(got, 3, "out/vehicle_rates_setpoint.yaw", nan);
  EXPECT_TRUE(first_event_difference(got, want));
}

TEST(Events, AreALevelOfCompare) {
  Trace got = moving(6, 12);
  const char* const rate = "out/vehicle_rates_setpoint.roll";
  const Channel& of_roll = channels()[channel(rate)];
  set(got, 15, rate, value_of(of_roll, got.samples[15]) + 0.05);
  EXPECT_TRUE(compare(got, moving(5, 12), Tolerances(Level::events)).agrees());
  const Comparison late = compare(moving(8, 12), moving(5, 12), Tolerances(Level::events));
  ASSERT_TRUE(late.first);
  EXPECT_EQ(late.first->tick, 5u);
  EXPECT_THAT(late.event, testing::HasSubstr("expected moving"));
}

// Values of a topic that is not published have no meaning, nor has the step from them.
TEST(Events, AStepFromAnUnpublishedTickIsNoEvent) {
  const char* const status_published = "out/mc_att_ctrl_status.published";
  Trace want = moving(20, 20), got = want;
  set(want, 7, status_published, 0);
  set(got, 8, status_published, 0);
  set(got, 8, integral, 0.2);
  EXPECT_FALSE(first_event_difference(got, want));
  want = got = moving(20, 20);
  set(got, 8, integral, 0.2);
  EXPECT_TRUE(first_event_difference(got, want)) << "published, the step is an event";
}

// The distance to the edge is smaller than the difference between right ports.
TEST(Events, WhatIsTooNearToItsEdgeToTellAgreesWithEither) {
  Trace want = moving(20, 20), got = want;
  for (std::size_t tick = 6; tick < 14; ++tick) {
    set(want, tick, "out/actuator_controls_0.control[0]", 0.51);
    set(got, tick, "out/actuator_controls_0.control[0]", 0.5005);
  }
  EXPECT_FALSE(first_event_difference(got, want));
  EXPECT_FALSE(first_event_difference(want, got));
  for (std::size_t tick = 6; tick < 14; ++tick) {
    set(got, tick, "out/actuator_controls_0.control[0]", 0.49);
  }
  EXPECT_TRUE(first_event_difference(got, want));
}

}  // namespace
}  // namespace attest
