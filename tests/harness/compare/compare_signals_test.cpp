// Samples at equal times, and the time by which one trace lags behind another.
#include "harness/compare/compare_signals.hpp"

#include <cmath>
#include <limits>
#include <random>

#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

#include "tests/harness/core/temporary_directory.hpp"

namespace attest {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::uint64_t period_us = 4000;
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

// A signal sampled from 1 s on.
TimedSignal sampled(const std::string& name, const std::vector<float>& values,
                    std::uint64_t begin_us = 1'000'000) {
  TimedSignal signal{name, {}, values};
  for (std::size_t i = 0; i < values.size(); ++i) {
    signal.times_us.push_back(begin_us + i * period_us);
  }
  return signal;
}

TimedSignals only(TimedSignal signal) { return {"a", {std::move(signal)}, {}}; }

SignalsComparison compared(const TimedSignals& got, const TimedSignals& want, double others = 0,
                           std::int64_t shift_us = 0) {
  return compare_signals(got, want, Tolerances(Level::numeric), others, shift_us);
}

TEST(CompareSignals, ComparesSamplesAtEqualTimes) {
  const auto got = only(sampled("x", {1, 2, 3}));
  const auto want = only(sampled("x", {2, 3, 4}, 1'000'000 + period_us));
  const auto found = compared(got, want);
  ASSERT_EQ(found.signals.size(), 1u);
  EXPECT_EQ(found.signals[0].compared, 2u);
  EXPECT_EQ(found.signals[0].only_got, 1u);
  EXPECT_EQ(found.signals[0].only_want, 1u);
  EXPECT_TRUE(found.agrees());
}

TEST(CompareSignals, KeepsTheFirstAndTheWorstDeviation) {
  const auto found =
      compared(only(sampled("x", {1, 2.5f, 3, 9})), only(sampled("x", {1, 2, 3, 4})));
  const SignalComparison& signal = found.signals[0];
  EXPECT_EQ(signal.deviating, 2u);
  EXPECT_EQ(signal.first->time_us, 1'000'000 + period_us);
  EXPECT_EQ(signal.worst->got, 9);
  EXPECT_FALSE(found.agrees());
}

TEST(CompareSignals, OutputsHaveTheToleranceOfTheLevelAndOthersTheGivenOne) {
  const std::string output = "vehicle_rates_setpoint.roll";
  const auto agrees = [](const std::string& name, float got, double others) {
    return compared(only(sampled(name, {got})), only(sampled(name, {1})), others).agrees();
  };
  EXPECT_TRUE(agrees(output, 1.0001f, 0));
  EXPECT_FALSE(agrees(output, 1.001f, 1));
  EXPECT_FALSE(agrees("x", 1.0001f, 0));
  EXPECT_TRUE(agrees("x", 1.0001f, 1e-3));
}

TEST(CompareSignals, NanEqualsNanOnly) {
  EXPECT_TRUE(compared(only(sampled("x", {nan})), only(sampled("x", {nan}))).agrees());
  EXPECT_FALSE(compared(only(sampled("x", {nan})), only(sampled("x", {1})), 1e9).agrees());
  EXPECT_FALSE(compared(only(sampled("x", {1})), only(sampled("x", {nan})), 1e9).agrees());
}

TEST(CompareSignals, InfinityEqualsItselfOnly) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const std::string output = "vehicle_rates_setpoint.roll";  // with a relative tolerance
  const auto agrees = [&](float got, float want) {
    return compared(only(sampled(output, {got})), only(sampled(output, {want}))).agrees();
  };
  EXPECT_TRUE(agrees(infinity, infinity));
  EXPECT_FALSE(agrees(1, infinity));
  EXPECT_FALSE(agrees(infinity, 1));
  EXPECT_FALSE(agrees(-infinity, infinity));
  EXPECT_FALSE(agrees(nan, infinity));
}

TEST(CompareSignals, NanIsTheWorstDeviation) {
  const auto found = compared(only(sampled("x", {9, nan, 99})), only(sampled("x", {1, 1, 1})));
  EXPECT_TRUE(std::isnan(found.signals[0].worst->got));
}

TEST(CompareSignals, TheSignOfZeroCountsAtTheLevelExactOnly) {
  const auto agrees = [](const std::string& name, Level level, double others) {
    const auto got = only(sampled(name, {-0.0f})), want = only(sampled(name, {0.0f}));
    return compare_signals(got, want, Tolerances(level), others).agrees();
  };
  for (const char* name : {"vehicle_rates_setpoint.roll", "x"}) {
    EXPECT_FALSE(agrees(name, Level::exact, 0));
    EXPECT_TRUE(agrees(name, Level::numeric, 0));
  }
  EXPECT_TRUE(agrees("x", Level::exact, 1e-3));
}

TEST(CompareSignals, SignalsWithoutACommonTimestampDoNotAgree) {
  const auto found = compared(only(sampled("x", {1, 2})), only(sampled("x", {1, 2}, 999'999)));
  EXPECT_EQ(found.signals[0].compared, 0u);
  EXPECT_FALSE(found.signals[0].agrees());
  EXPECT_EQ(found.deviating_signals(), 1u);
}

TEST(CompareSignals, ListsWhatOnlyOneHasAndNothingInCommonIsNoAgreement) {
  const auto found = compared(only(sampled("a", {1})), only(sampled("b", {1})));
  EXPECT_THAT(found.only_in_got, ElementsAre("a"));
  EXPECT_THAT(found.only_in_want, ElementsAre("b"));
  EXPECT_FALSE(found.agrees());
}

// A smooth random signal: a sum of sines.
std::vector<float> smooth(unsigned seed, std::size_t count, std::ptrdiff_t delay) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> frequency(0.2, 3), phase(0, 6.28);
  std::vector<float> values(count, 0);
  for (int wave = 0; wave < 4; ++wave) {
    const double f = frequency(random), p = phase(random);
    for (std::size_t i = 0; i < count; ++i) {
      const double t = 0.004 * static_cast<double>(static_cast<std::ptrdiff_t>(i) - delay);
      values[i] += static_cast<float>(std::sin(6.283185307 * f * t + p));
    }
  }
  return values;
}

RC_GTEST_PROP(EstimateShift, FindsTheDelayOfACopy, ()) {
  const auto seed = *rc::gen::arbitrary<unsigned>();
  const auto delay = *rc::gen::inRange<std::ptrdiff_t>(-200, 201);
  const auto got = only(sampled("x", smooth(seed, 1000, delay)));
  const auto want = only(sampled("x", smooth(seed, 1000, 0)));
  const auto shift = estimate_shift(got, want);
  if (delay == 0) {
    RC_ASSERT(!shift);
  } else {
    RC_ASSERT(shift.has_value());
    RC_ASSERT(shift->us == delay * static_cast<std::ptrdiff_t>(period_us));
    RC_ASSERT(compared(got, want, 1e-4, shift->us).agrees());
  }
}

TEST(EstimateShift, NoiseAndConstantsHaveNone) {
  std::mt19937 random(1);
  std::normal_distribution<float> noise;
  std::vector<float> a, b;
  for (int i = 0; i < 1000; ++i) {
    a.push_back(noise(random));
    b.push_back(noise(random));
  }
  EXPECT_FALSE(estimate_shift(only(sampled("x", a)), only(sampled("x", b))));
  const std::vector<float> ones(100, 1), twos(100, 2);
  EXPECT_FALSE(estimate_shift(only(sampled("x", ones)), only(sampled("x", twos))));
}

TEST(TimedSignals, CsvOfAnyOriginNeedsATimeOnly) {
  TemporaryDirectory directory;
  const auto error = [&](const char* text) {
    const auto read = signals_of_csv(directory.write("a.csv", text));
    return read ? "" : read.error().message;
  };
  EXPECT_THAT(error("x,y\n1,2\n"), HasSubstr("no column timestamp"));
  EXPECT_THAT(error("timestamp\n1\n"), HasSubstr("no sample of a signal"));
  EXPECT_THAT(error("timestamp,x\n1,a\n"), HasSubstr("`a` is not a number"));
  const auto read = signals_of_csv(
      directory.write("a.csv",
                      "timestamp,in/vehicle_rates_setpoint.roll,plant/rotor_speed[0],b\n"
                      "1,2,3,4\n1,5,6,7\n2,8,9,10\n"));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->all[0].name, "b");
  EXPECT_EQ(read->all[1].name, "rotor_speed.value[0]");
  EXPECT_EQ(read->all[2].name, "vehicle_rates_setpoint[1].roll");
  EXPECT_THAT(read->all[0].values, ElementsAre(4, 10));
  EXPECT_THAT(read->notes, ElementsAre(HasSubstr("1 row left out")));
}

}  // namespace
}  // namespace attest
