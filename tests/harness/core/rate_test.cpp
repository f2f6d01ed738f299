#include "harness/core/rate.hpp"

#include <limits>

#include <gmock/gmock.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

namespace attest {
namespace {

using std::chrono::seconds;
using testing::HasSubstr;

Rate parsed(std::string_view text) {
  const auto rate = Rate::parse(text);
  EXPECT_TRUE(rate) << text;
  return rate ? *rate : Rate::hz(1);
}

std::string error_of(std::string_view text) {
  const auto rate = Rate::parse(text);
  EXPECT_FALSE(rate) << text;
  return rate ? "" : rate.error().message;
}

rc::Gen<Rate> any_rate() {
  return rc::gen::apply([](int n, int d) { return Rate::hz(n, d); }, rc::gen::inRange(1, 1'000'000),
                        rc::gen::inRange(1, 1'000));
}

TEST(Rate, ParsesWholeNumbersDecimalsAndFractions) {
  EXPECT_EQ(parsed("250"), Rate::hz(250));
  EXPECT_EQ(parsed("62.5"), Rate::hz(125, 2));
  EXPECT_EQ(parsed("1000/3"), Rate::hz(1000, 3));
  EXPECT_EQ(parsed("2000/6"), Rate::hz(1000, 3));
  EXPECT_EQ(parsed("0.001"), Rate::hz(1, 1000));
  EXPECT_EQ(parsed("1000000"), Rate::hz(1'000'000));
}

TEST(Rate, ParsesItsUnit) {
  EXPECT_EQ(parsed("250hz"), Rate::hz(250));
  EXPECT_EQ(parsed("62.5Hz"), Rate::hz(125, 2));
}

TEST(Rate, RefusesWhatIsNoPositiveNumber) {
  for (const char* text :
       {"",      "0",   "-5", "+5",     "5.",     ".",    "1/0",  "0/1", "/",   "1/",
        "1/2/3", "1e3", "hz", "250khz", "250hz ", " 250", "1.-5", "nan", "inf", "1234567890"}) {
    EXPECT_THAT(error_of(text), HasSubstr("is not a rate")) << text;
  }
}

TEST(Rate, RefusesWhatTimestampsCannotTellApart) {
  EXPECT_THAT(error_of("1000000.1"), HasSubstr("too fast"));
  EXPECT_THAT(error_of("999999999"), HasSubstr("too fast"));
  EXPECT_THAT(error_of("0.0009"), HasSubstr("too slow"));
  EXPECT_THAT(error_of("1/999999999"), HasSubstr("too slow"));
}

TEST(Rate, IsNamedInLowestTerms) {
  EXPECT_EQ(Rate::hz(250).to_string(), "250");
  EXPECT_EQ(Rate::hz(250).label(), "250hz");
  EXPECT_EQ(parsed("62.5").to_string(), "125/2");
  EXPECT_EQ(parsed("62.5").label(), "125_2hz");
}

TEST(Rate, IsOrderedByValue) {
  EXPECT_LT(Rate::hz(1000, 3), Rate::hz(334));
  EXPECT_GT(Rate::hz(1000, 3), Rate::hz(333));
  EXPECT_LT(parsed("999999998/999999999"), Rate::hz(1));
}

RC_GTEST_PROP(Rate, IsReadBackFromItsName, ()) {
  const Rate rate = *any_rate();
  RC_ASSERT(parsed(rate.to_string()) == rate);
}

RC_GTEST_PROP(Rate, NeverDrifts, ()) {
  const Rate rate = Rate::hz(*rc::gen::inRange<std::int64_t>(1, 1'000'001));
  const auto n = *rc::gen::inRange<std::int64_t>(-100'000, 100'000);
  const auto hertz = static_cast<std::int64_t>(rate.hertz());
  RC_ASSERT(rate.tick(hertz * n) == seconds(n));
}

TEST(Rate, TicksAtHalfAndThirdNanosecondsAreRoundedDown) {
  const Rate rate = Rate::hz(333);
  EXPECT_EQ(rate.tick(1).count(), 3'003'003);
  EXPECT_EQ(rate.tick(2).count(), 6'006'006);
  EXPECT_EQ(rate.tick(332).count(), 996'996'996);
  EXPECT_EQ(rate.tick(333 * 86'400), seconds(86'400));
  EXPECT_EQ(rate.tick(-1).count(), -3'003'004);
}

TEST(Rate, TicksAtTheExtremes) {
  // 1e6 ticks at the slowest rate: the longest case.
  EXPECT_EQ(Rate::hz(1, 1000).tick(1'000'000), seconds(1'000'000'000));
  // 285 years of the fastest rate.
  EXPECT_EQ(Rate::hz(1'000'000).tick(9'000'000'000'000'000), seconds(9'000'000'000));
  EXPECT_EQ(parsed("999999999/1000").tick(999'999'999), seconds(1000));
}

RC_GTEST_PROP(Rate, TicksInCountsThoseThatBeginBefore, ()) {
  const Rate rate = *any_rate();
  const Nanoseconds duration(*rc::gen::inRange<std::int64_t>(1, 10'000'000'000));
  const std::int64_t count = rate.ticks_in(duration);
  RC_ASSERT(rate.tick(count) >= duration);
  RC_ASSERT(rate.tick(count - 1) < duration);
}

RC_GTEST_PROP(Rate, TicksInIsTheInverseOfTick, ()) {
  const Rate rate = *any_rate();
  const auto k = *rc::gen::inRange<std::int64_t>(0, 1'000'000);
  RC_ASSERT(rate.ticks_in(rate.tick(k)) == k);
  RC_ASSERT(rate.ticks_in(rate.tick(k) + Nanoseconds(1)) == k + 1);
}

TEST(Rate, NothingBeginsInNoTime) {
  EXPECT_EQ(Rate::hz(1000).ticks_in(Nanoseconds(0)), 0);
  EXPECT_EQ(Rate::hz(1000).ticks_in(seconds(-10)), 0);
  EXPECT_EQ(Rate::hz(1'000'000).ticks_in(Nanoseconds::max()), 9'223'372'036'854'776);
}

TEST(Rate, TheStandardRatesAscend) {
  const auto& rates = standard_rates();
  EXPECT_TRUE(std::is_sorted(rates.begin(), rates.end()));
  EXPECT_EQ(rates.front(), Rate::hz(50));
  EXPECT_EQ(rates.back(), Rate::hz(8000));
}

}  // namespace
}  // namespace attest
