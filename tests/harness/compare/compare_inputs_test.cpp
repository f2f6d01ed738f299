#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/compare/input_difference.hpp"
#include "tests/harness/compare/sample_trace.hpp"

namespace attest {
namespace {

using testing::Field;
using testing::Optional;

// The first difference is at this tick.
auto at_tick(std::size_t tick) { return Optional(Field(&InputDifference::tick, tick)); }

TEST(FirstInputDifference, ThereIsNoneBetweenTheSame) {
  const Trace trace = sample_trace(3);
  EXPECT_EQ(first_input_difference(trace, trace), std::nullopt);
}

TEST(FirstInputDifference, SeesEveryInput) {
  for (const Channel& what : channels()) {
    Trace a = sample_trace(3);
    a.present = channels_of(what.module);
    if (what.module != Module::mc_att_control) a.samples.assign(3, Sample{});
    Trace b = a;
    const double value = value_of(what, a.samples[1]);
    set_value(what, b.samples[1], what.type == ChannelType::bit ? 1 - value : value + 1);
    const auto found = first_input_difference(a, b);
    if (what.is_output()) {
      EXPECT_EQ(found, std::nullopt) << what.name;
    } else {
      EXPECT_THAT(found, at_tick(1)) << what.name;
    }
  }
}

TEST(FirstInputDifference, IsOfBits) {
  Trace a = sample_trace(2), b = a;
  set(a, 1, "in/manual_control_setpoint.x", -0.0);
  EXPECT_THAT(first_input_difference(a, b), at_tick(1));
  set(a, 1, "in/manual_control_setpoint.x", nan);
  set(b, 1, "in/manual_control_setpoint.x", -nan);
  EXPECT_EQ(first_input_difference(a, b), std::nullopt);
}

TEST(FirstInputDifference, ALongerTraceDiffersWhereTheOtherEnds) {
  EXPECT_THAT(first_input_difference(sample_trace(2), sample_trace(3)), at_tick(2));
  EXPECT_THAT(first_input_difference(sample_trace(3), sample_trace(0)), at_tick(0));
}

TEST(FirstInputDifference, SeesParametersInForce) {
  Trace a = sample_trace(4), b = a;
  a.parameters = {{0, "MC_ROLL_P", 5}, {2, "MC_ROLL_P", 6}};
  EXPECT_THAT(first_input_difference(a, b), at_tick(0));
  b.parameters = {{0, "MC_ROLL_P", 5}};
  EXPECT_THAT(first_input_difference(a, b), at_tick(2));
  b.parameters = {{0, "MC_ROLL_P", 5}, {2, "MC_PITCH_P", 6}};
  EXPECT_THAT(first_input_difference(a, b), at_tick(2));
  // The same values set again, or in another order, are no difference.
  a.parameters = {{0, "MC_ROLL_P", 5}, {0, "MC_PITCH_P", 6}};
  b.parameters = {{0, "MC_PITCH_P", 6}, {0, "MC_ROLL_P", 5}, {2, "MC_ROLL_P", 5}};
  EXPECT_EQ(first_input_difference(a, b), std::nullopt);
}

}  // namespace
}  // namespace attest
