#include "harness/compare/misrecording.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/harness/compare/sample_trace.hpp"

namespace attest {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr std::size_t trace_ticks = 12;
const char* const axes[] = {"roll", "pitch", "yaw"};

// Three axes that move in their own way.
Trace moving() {
  Trace trace = sample_trace(trace_ticks);
  for (std::size_t tick = 0; tick < trace_ticks; ++tick) {
    const auto t = static_cast<double>(tick);
    set(trace, tick, "out/vehicle_rates_setpoint.roll", 0.1 + 0.01 * t * t);
    set(trace, tick, "out/vehicle_rates_setpoint.pitch", -0.3 + 0.02 * t);
    set(trace, tick, "out/vehicle_rates_setpoint.yaw", 0.5 - 0.03 * t);
  }
  return trace;
}

Trace with_rates_times(double factor) {
  Trace trace = moving();
  for (std::size_t tick = 0; tick < trace_ticks; ++tick) {
    for (const char* axis : axes) {
      const std::string name = std::string("out/vehicle_rates_setpoint.") + axis;
      set(trace, tick, name, factor * value_of(channels()[channel(name)], trace.samples[tick]));
    }
  }
  return trace;
}

TEST(Misrecording, AnotherUnitIsNamed) {
  EXPECT_THAT(misrecording(with_rates_times(57.29578), moving()),
              AllOf(HasSubstr("out/vehicle_rates_setpoint.roll"), HasSubstr("in degrees")));
  EXPECT_THAT(misrecording(with_rates_times(1 / 57.29578), moving()), HasSubstr("divided by 57.3"));
  EXPECT_THAT(misrecording(with_rates_times(1000), moving()), HasSubstr("1000 times"));
  EXPECT_THAT(misrecording(with_rates_times(-1), moving()), HasSubstr("the other sign"));
  EXPECT_EQ(misrecording(with_rates_times(1.1), moving()), "");
  EXPECT_EQ(misrecording(moving(), moving()), "");
}

TEST(Misrecording, ExchangedAxesAreNamed) {
  Trace got = moving();
  for (Sample& sample : got.samples) {
    std::swap(sample.out.vehicle_rates_setpoint.roll, sample.out.vehicle_rates_setpoint.yaw);
  }
  EXPECT_EQ(misrecording(got, moving()),
            "out/vehicle_rates_setpoint.roll has the values expected of "
            "out/vehicle_rates_setpoint.yaw, out/vehicle_rates_setpoint.yaw has the values "
            "expected of out/vehicle_rates_setpoint.roll");
}

TEST(Misrecording, ShiftedAndReversedRowsAreNamed) {
  const Trace want = moving();
  Trace late = want, early = want, reversed = want;
  for (std::size_t tick = 0; tick < trace_ticks; ++tick) {
    late.samples[tick].copy_outputs(want.samples[tick == 0 ? 0 : tick - 1]);
    early.samples[tick].copy_outputs(want.samples[tick + 1 == trace_ticks ? tick : tick + 1]);
    reversed.samples[tick].copy_outputs(want.samples[trace_ticks - 1 - tick]);
  }
  EXPECT_THAT(misrecording(late, want), HasSubstr("looks a tick late"));
  EXPECT_THAT(misrecording(early, want), HasSubstr("looks a tick early"));
  EXPECT_THAT(misrecording(reversed, want), HasSubstr("the rows look reversed"));
}

TEST(Misrecording, AWrongValueIsNoMisrecording) {
  Trace got = with_rates_times(57.29578);
  set(got, 7, "out/vehicle_rates_setpoint.yaw", 0.1);
  EXPECT_EQ(misrecording(got, moving()), "");
}

}  // namespace
}  // namespace attest
