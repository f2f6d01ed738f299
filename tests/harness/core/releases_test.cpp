#include <optional>

#include <gmock/gmock.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include "harness/core/ticks.hpp"
#include "tests/harness/times.hpp"

namespace attest {
namespace {

using testing::Optional;

ReleaseSchedule periodic(const Rate& rate, Nanoseconds phase) {
  ReleaseSchedule schedule;
  schedule.rate = rate;
  schedule.phase = phase;
  return schedule;
}

TEST(Releases, ThereAreNoneWithoutRateAndTimes) {
  EXPECT_EQ(ReleaseSchedule{}.latest(ms(1000)), std::nullopt);
}

TEST(Releases, OneAtTheTimeOfATickIsSeenByIt) {
  const ReleaseSchedule schedule = periodic(Rate::hz(50), ms(5));
  EXPECT_EQ(schedule.latest(ms(5) - ns(1)), std::nullopt);
  EXPECT_THAT(schedule.latest(ms(5)), Optional(ms(5)));
  EXPECT_THAT(schedule.latest(ms(25) - ns(1)), Optional(ms(5)));
  EXPECT_THAT(schedule.latest(ms(25)), Optional(ms(25)));
  EXPECT_THAT(schedule.latest(ms(1004)), Optional(ms(985)));
}

TEST(Releases, AtGivenTimes) {
  ReleaseSchedule schedule;
  schedule.times = {ms(3), ms(7)};
  EXPECT_EQ(schedule.latest(ms(3) - ns(1)), std::nullopt);
  EXPECT_THAT(schedule.latest(ms(3)), Optional(ms(3)));
  EXPECT_THAT(schedule.latest(ms(7) - ns(1)), Optional(ms(3)));
  EXPECT_THAT(schedule.latest(ms(7)), Optional(ms(7)));
  EXPECT_THAT(schedule.latest(ms(1'000'000)), Optional(ms(7)));
}

TEST(Releases, AFasterTopicShowsItsLatestSample) {
  EXPECT_THAT(periodic(Rate::hz(1000), ns(0)).latest(ms(4) + ns(5)), Optional(ms(4)));
}

RC_GTEST_PROP(Releases, TheLatestIsTheLastThatIsNotInTheFuture, ()) {
  const Rate rate = *rc::gen::elementOf(standard_rates());
  const Nanoseconds phase(*rc::gen::inRange<std::int64_t>(0, 100'000'000));
  const auto k = *rc::gen::inRange<std::int64_t>(0, 100'000);
  const ReleaseSchedule schedule = periodic(rate, phase);
  RC_ASSERT(schedule.latest(phase + rate.tick(k)) == phase + rate.tick(k));
  RC_ASSERT(schedule.latest(phase + rate.tick(k + 1) - ns(1)) == phase + rate.tick(k));
}

// At 333 Hz no tick but every 333rd is a whole number of nanoseconds: a release that was computed
// another way would come a nanosecond before or after its tick.
RC_GTEST_PROP(Releases, CountedInTicksAreThoseTicks, ()) {
  const Rate rate = *rc::gen::elementOf(standard_rates());
  ReleaseSchedule schedule;
  schedule.rate = rate;
  schedule.first = *rc::gen::inRange<std::int64_t>(0, 50);
  schedule.every = *rc::gen::inRange<std::int64_t>(1, 50);
  const auto i = *rc::gen::inRange<std::int64_t>(0, 1000);
  const std::int64_t tick = schedule.first + i * schedule.every;
  RC_ASSERT(schedule.latest(rate.tick(tick)) == rate.tick(tick));
  const auto before = schedule.latest(rate.tick(tick) - ns(1));
  if (i == 0) {
    RC_ASSERT(!before);
  } else {
    RC_ASSERT(before == rate.tick(tick - schedule.every));
  }
}

}  // namespace
}  // namespace attest
