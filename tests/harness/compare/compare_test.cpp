#include "harness/compare/compare.hpp"

#include <bit>
#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/harness/compare/sample_trace.hpp"

namespace attest {
namespace {

using testing::HasSubstr;

constexpr const char* roll = "out/vehicle_rates_setpoint.roll";
constexpr const char* published = "out/actuator_controls_0.published";
constexpr double inf = std::numeric_limits<double>::infinity();

// One tick whose roll rate setpoint is `got` where it should be `want`.
Comparison compare_roll(double got, double want, Level level) {
  Trace traces[2] = {sample_trace(1), sample_trace(1)};
  set(traces[0], 0, roll, got);
  set(traces[1], 0, roll, want);
  return compare(traces[0], traces[1], Tolerances(level));
}

TEST(Compare, ReportsTheFirstOfSeveralDeviations) {
  const Trace want = sample_trace(5);
  Trace got = want;
  set(got, 4, roll, 9);
  set(got, 2, "out/mc_att_ctrl_status.roll_rate_integ", 9);
  set(got, 2, "out/vehicle_rates_setpoint.yaw", 9);
  const Comparison comparison = compare(got, want, Tolerances());
  ASSERT_TRUE(comparison.first);
  EXPECT_EQ(comparison.first->tick, 2u);
  EXPECT_EQ(comparison.first->timestamp_us, 12000u);
  EXPECT_EQ(comparison.first->channel, channel("out/vehicle_rates_setpoint.yaw"));
  EXPECT_EQ(comparison.first->got, 9);
  EXPECT_EQ(comparison.deviating_ticks, 2u);
  EXPECT_EQ(comparison.ticks, 5u);
  EXPECT_FALSE(comparison.agrees());
}

TEST(Compare, TheWorstDeviationIsTheLargestForItsTolerance) {
  const Trace want = sample_trace(5);
  Trace got = want;
  constexpr const char* integral = "out/mc_att_ctrl_status.roll_rate_integ";
  set(got, 1, roll, 8);
  set(got, 2, roll, 9);
  set(got, 3, integral, 7);  // its tolerance is a tenth
  set(got, 4, roll, inf);
  const Comparison numeric = compare(got, want, Tolerances());
  ASSERT_TRUE(numeric.worst);
  EXPECT_EQ(numeric.worst->tick, 3u);
  EXPECT_EQ(numeric.worst->channel, channel(integral));
  EXPECT_EQ(numeric.first->tick, 1u);
  const Comparison exact = compare(got, want, Tolerances(Level::exact));
  ASSERT_TRUE(exact.worst);
  EXPECT_EQ(exact.worst->tick, 2u);  // the most ulp
  EXPECT_FALSE(compare(want, want, Tolerances()).worst);
}

TEST(Compare, TheExactLevelSeesOneBit) {
  const double next = std::nextafter(0.5f, 1.0f);
  EXPECT_TRUE(compare_roll(next, 0.5, Level::numeric).agrees());
  const Comparison exact = compare_roll(next, 0.5, Level::exact);
  ASSERT_TRUE(exact.first);
  EXPECT_EQ(exact.first->ulp, 1);
  EXPECT_EQ(exact.first->tolerance, 0);
}

TEST(Compare, TheSignOfZeroIsABitAndNoDifference) {
  const Comparison numeric = compare_roll(-0.0, 0.0, Level::numeric);
  EXPECT_TRUE(numeric.agrees());
  ASSERT_TRUE(numeric.tightest);
  EXPECT_EQ(numeric.tightest->ratio, inf);
  const Comparison exact = compare_roll(-0.0, 0.0, Level::exact);
  ASSERT_TRUE(exact.first);
  EXPECT_EQ(exact.first->ulp, 1);
  EXPECT_TRUE(std::signbit(exact.first->got));
}

TEST(Compare, UlpCountAcrossZero) {
  const float smallest = std::numeric_limits<float>::denorm_min();
  const Comparison comparison = compare_roll(-smallest, smallest, Level::exact);
  ASSERT_TRUE(comparison.first);
  EXPECT_EQ(comparison.first->ulp, 3);
}

TEST(Compare, AnyNanIsAnyOther) {
  const float other = std::bit_cast<float>(0xffc00123u);
  for (const Level level : {Level::exact, Level::numeric}) {
    EXPECT_TRUE(compare_roll(other, nan, level).agrees());
    EXPECT_TRUE(compare_roll(inf, inf, level).agrees());
  }
}

TEST(Compare, NonFiniteValuesAreNeverWithinATolerance) {
  Tolerances wide;
  wide.set("", {1e30, 1e30});
  const double pairs[][2] = {{nan, 0}, {0, nan}, {inf, 0}, {0, inf}, {inf, -inf}, {nan, inf}};
  for (const auto& [got, want] : pairs) {
    Trace traces[2] = {sample_trace(1), sample_trace(1)};
    set(traces[0], 0, roll, got);
    set(traces[1], 0, roll, want);
    const Comparison comparison = compare(traces[0], traces[1], wide);
    EXPECT_TRUE(comparison.first) << got << " for " << want;
    EXPECT_EQ(comparison.got_non_finite, !std::isfinite(got) && std::isfinite(want));
  }
}

TEST(Compare, PublicationIsComparedAsTruth) {
  const Trace want = sample_trace(2);
  Trace got = want;
  set(got, 1, published, 255);
  EXPECT_TRUE(compare(got, want, Tolerances(Level::exact)).agrees());
  set(got, 1, published, 0);
  for (const Level level : {Level::exact, Level::numeric}) {
    const Comparison comparison = compare(got, want, Tolerances(level));
    ASSERT_TRUE(comparison.first);
    EXPECT_EQ(comparison.first->channel, channel(published));
    EXPECT_EQ(comparison.first->want, 1);
  }
}

TEST(Compare, ATruncatedTraceIsAMismatch) {
  const Trace want = sample_trace(3);
  for (const std::size_t ticks : {0u, 2u, 4u}) {
    const Comparison comparison = compare(sample_trace(ticks), want, Tolerances());
    EXPECT_FALSE(comparison.agrees());
    EXPECT_FALSE(comparison.first);
    EXPECT_THAT(comparison.mismatch, HasSubstr("ticks, expected 3"));
  }
}

TEST(Compare, TicksAtOtherTimesAreAMismatch) {
  const Trace want = sample_trace(3);
  Trace got = want;
  got.samples[1].in.timestamp = 8001;
  EXPECT_THAT(compare(got, want, Tolerances()).mismatch,
              HasSubstr("tick 1 is at 8001 us, expected at 8000 us"));
}

TEST(Compare, OnlyWhatWasRecordedIsCompared) {
  Trace want = sample_trace(1);
  Trace got = want;
  set(got, 0, roll, 9);
  want.present.reset(channel(roll));
  EXPECT_TRUE(compare(got, want, Tolerances(Level::exact)).agrees());
  want.present &= channels_of(Module::mc_att_control, "in/");
  EXPECT_THAT(compare(got, want, Tolerances()).mismatch, HasSubstr("nothing to compare"));
}

TEST(Compare, WhatTheOtherDidNotRecordIsAMismatch) {
  const Trace want = sample_trace(1);
  Trace got = want;
  got.present.reset(channel(roll));
  EXPECT_THAT(compare(got, want, Tolerances()).mismatch,
              HasSubstr("got lacks out/vehicle_rates_setpoint.roll, which want has"));
  got.present.reset(channel("out/vehicle_rates_setpoint.yaw"));
  EXPECT_EQ(
      compare(got, want, Tolerances()).mismatch,
      "got lacks out/vehicle_rates_setpoint.roll, out/vehicle_rates_setpoint.yaw, which want has");
}

TEST(Compare, WhatOnlyTheJudgedTraceHasIsNamed) {
  const Trace got = sample_trace(1);
  Trace want = got;
  EXPECT_TRUE(compare(got, want, Tolerances()).only_got.none());
  want.present.reset(channel(roll));
  const Comparison comparison = compare(got, want, Tolerances());
  EXPECT_TRUE(comparison.agrees());
  EXPECT_EQ(comparison.only_got, ChannelSet().set(channel(roll)));
}

TEST(Compare, HeadroomIsOfTheValueNearestToItsTolerance) {
  const Trace want = sample_trace(3);
  Trace got = want;
  EXPECT_FALSE(compare(got, want, Tolerances()).tightest);
  Tolerances tolerances;
  tolerances.set("", {0.5, 0});
  set(got, 1, roll, static_cast<double>(want.samples[1].out.vehicle_rates_setpoint.roll) + 0.25);
  set(got, 2, roll, static_cast<double>(want.samples[2].out.vehicle_rates_setpoint.roll) + 0.125);
  const Comparison comparison = compare(got, want, tolerances);
  ASSERT_TRUE(comparison.tightest);
  // The tolerance of a rate is 1e-6 wider even at a level attitude.
  EXPECT_NEAR(comparison.tightest->ratio, 2, 1e-5);
  EXPECT_EQ(comparison.tightest->tick, 1u);
  EXPECT_EQ(comparison.tightest->channel, channel(roll));
}

TEST(Compare, NonFiniteAfterAnotherDeviationIsSaid) {
  const Trace want = sample_trace(5);
  Trace got = want;
  set(got, 1, "out/vehicle_rates_setpoint.roll", 7);
  EXPECT_FALSE(compare(got, want, Tolerances()).got_non_finite);
  set(got, 3, "out/mc_att_ctrl_status.roll_rate_integ", nan);
  const Comparison comparison = compare(got, want, Tolerances());
  EXPECT_TRUE(comparison.got_non_finite);
  EXPECT_EQ(comparison.first->tick, 1u);
}

// A golden of a flight has rows of some ticks.
TEST(FirstNonFinite, IsFoundBetweenTheRows) {
  const Trace flown = sample_trace(9);
  Trace rows = flown;
  rows.samples = {flown.samples[0], flown.samples[4], flown.samples[8]};
  EXPECT_FALSE(first_non_finite(flown, rows));
  Trace got = flown;
  set(got, 6, "out/mc_att_ctrl_status.roll_rate_integ", nan);
  const auto found = first_non_finite(got, rows);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->tick, 6u);
  EXPECT_EQ(found->channel, channel("out/mc_att_ctrl_status.roll_rate_integ"));
  EXPECT_DOUBLE_EQ(found->want, value_of(channels()[found->channel], flown.samples[4]));
  set(rows, 1, "out/mc_att_ctrl_status.roll_rate_integ", nan);
  EXPECT_FALSE(first_non_finite(got, rows)) << "the reference is not finite in this channel";
}

TEST(Compare, TheRelativeToleranceIsOfTheSize) {
  const char* const name = "out/vehicle_rates_setpoint.roll";
  Tolerances tolerances;
  tolerances.set("vehicle_rates_setpoint.roll", {1e-6, 0.01});
  for (const double value : {-10.0, 10.0}) {
    Trace want = sample_trace(3), got = want;
    set(want, 1, name, value);
    set(got, 1, name, value * 1.009);
    EXPECT_TRUE(compare(got, want, tolerances).agrees()) << value;
    set(got, 1, name, value * 1.011);
    EXPECT_FALSE(compare(got, want, tolerances).agrees()) << value;
  }
}

TEST(Both, TheFirstIsTheEarlierAndTheWorstIsTheLarger) {
  Comparison rate, attitude;
  rate.ticks = 8;
  rate.deviating_ticks = 2;
  rate.first = Deviation{7, 1700, 0, 1, 2, 0, 0.5};
  rate.worst = Deviation{7, 1700, 0, 1, 9, 0, 0.5};
  rate.tightest = Headroom{3, 1, 0};
  attitude.ticks = 2;
  attitude.deviating_ticks = 1;
  attitude.first = Deviation{1, 1600, 0, 1, 2, 0, 0.5};
  attitude.worst = Deviation{1, 1600, 0, 1, 2, 0, 0.5};
  attitude.tightest = Headroom{5, 0, 0};
  for (const Comparison& all : {both(rate, attitude), both(attitude, rate)}) {
    EXPECT_EQ(all.ticks, 10u);
    EXPECT_EQ(all.deviating_ticks, 3u);
    EXPECT_EQ(all.first->timestamp_us, 1600u);
    EXPECT_EQ(all.worst->timestamp_us, 1700u);
    EXPECT_EQ(all.tightest->ratio, 3);
    EXPECT_FALSE(all.got_non_finite);
  }
  // Both units step at the same time.
  attitude.first->timestamp_us = rate.first->timestamp_us;
  rate.first->channel = *find_channel(Module::rate_unit, "out/vehicle_torque_setpoint.xyz[0]");
  attitude.first->channel = *find_channel(Module::attitude_unit, "out/vehicle_rates_setpoint.yaw");
  for (const Comparison& all : {both(rate, attitude), both(attitude, rate)}) {
    EXPECT_EQ(all.first->channel, attitude.first->channel);
  }
  attitude.got_non_finite = true;
  EXPECT_TRUE(both(rate, attitude).got_non_finite);
}

}  // namespace
}  // namespace attest
