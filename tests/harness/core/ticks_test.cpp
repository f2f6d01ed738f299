#include "harness/core/ticks.hpp"

#include <algorithm>

#include <gmock/gmock.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include "tests/harness/times.hpp"

namespace attest {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TickSchedule any_schedule() {
  TickSchedule schedule;
  schedule.rate = *rc::gen::elementOf(standard_rates());
  schedule.phase = Nanoseconds(*rc::gen::inRange<std::int64_t>(0, 1'000'000'000));
  schedule.jitter = *rc::gen::inRange(0, 1000) / 1000.0;
  schedule.seed = *rc::gen::arbitrary<std::uint64_t>();
  schedule.drops = *rc::gen::container<std::vector<std::int64_t>>(rc::gen::inRange(-5, 205));
  return schedule;
}

TEST(Ticks, AreAtThePeriodsFromThePhaseOn) {
  TickSchedule schedule;
  schedule.phase = ms(1);
  EXPECT_THAT(ticks(schedule, 3), ElementsAre(ms(1), ms(5), ms(9)));
  EXPECT_THAT(ticks(schedule, 0), IsEmpty());
}

TEST(Ticks, LeaveOutTheDropped) {
  TickSchedule schedule;
  schedule.drops = {0, 2, 2, 99};
  EXPECT_THAT(ticks(schedule, 4), ElementsAre(ms(4), ms(12)));
}

RC_GTEST_PROP(Ticks, AreAMicrosecondApart, ()) {
  TickSchedule schedule = any_schedule();
  schedule.heavy_tail = *rc::gen::arbitrary<bool>();
  schedule.drop_every = *rc::gen::elementOf(std::vector<std::int64_t>{0, 2, 7});
  schedule.stall = {ms(*rc::gen::inRange(0, 100)), ms(*rc::gen::inRange(0, 60)),
                    *rc::gen::arbitrary<bool>()};
  const auto times = ticks(schedule, 200);
  RC_ASSERT(std::adjacent_find(times.begin(), times.end(), [](Nanoseconds a, Nanoseconds b) {
              return b < a + Nanoseconds(1000);
            }) == times.end());
}

TEST(Ticks, LeaveOutTheLastOfEachSoMany) {
  TickSchedule schedule;
  schedule.drop_every = 3;
  EXPECT_THAT(ticks(schedule, 6), ElementsAre(ms(0), ms(4), ms(12), ms(16)));
}

TEST(Ticks, ThatAStallHoldsUpAreLateOnceAndThenMissed) {
  TickSchedule schedule;
  schedule.phase = ms(1);
  schedule.stall = {ms(12), ms(10), false};
  EXPECT_THAT(ticks(schedule, 7), ElementsAre(ms(1), ms(5), ms(9), ms(23), ms(35)));
}

TEST(Ticks, ThatAStallHoldsUpMayCatchUpInABurst) {
  TickSchedule schedule;
  schedule.stall = {ms(12), ms(9), true};
  constexpr Nanoseconds apart{400'000};
  EXPECT_THAT(ticks(schedule, 6),
              ElementsAre(ms(0), ms(4), ms(8), ms(21), ms(21) + apart, ms(21) + 2 * apart));
}

TEST(Ticks, HeavyTailsAreLateByMoreThanAPeriodNowAndThen) {
  TickSchedule schedule;
  schedule.jitter = 0.1;
  schedule.heavy_tail = true;
  const auto times = ticks(schedule, 10'000);
  // P(late > l) = 1 / (1 + l / jitter)^2: 83 in 10,000 are late by a period, 27 by 1.83 of them.
  EXPECT_NEAR(static_cast<double>(times.size()), 10'000 - 83 - 20, 60);
  std::size_t gaps = 0;
  for (std::size_t i = 1; i < times.size(); ++i) gaps += times[i] - times[i - 1] > ms(7) ? 1 : 0;
  EXPECT_GT(gaps, 20u);
}

RC_GTEST_PROP(Ticks, AreLateByLessThanTheJitter, ()) {
  TickSchedule schedule = any_schedule();
  schedule.drops.clear();
  const auto times = ticks(schedule, 200);
  const double most = schedule.jitter * schedule.rate.period_s() * 1e9;
  for (std::size_t k = 0; k < times.size(); ++k) {
    const Nanoseconds late =
        times[k] - schedule.phase - schedule.rate.tick(static_cast<std::int64_t>(k));
    RC_ASSERT(late >= Nanoseconds(0));
    RC_ASSERT(static_cast<double>(late.count()) <= most + 1);
  }
}

TEST(Ticks, JitterSpreadsOverItsRange) {
  TickSchedule schedule;
  schedule.jitter = 0.5;
  const auto times = ticks(schedule, 1000);
  std::vector<Nanoseconds> late;
  for (std::size_t k = 0; k < times.size(); ++k) {
    late.push_back(times[k] - schedule.rate.tick(static_cast<std::int64_t>(k)));
  }
  EXPECT_LT(*std::min_element(late.begin(), late.end()), Nanoseconds(50'000));
  EXPECT_GT(*std::max_element(late.begin(), late.end()), Nanoseconds(1'950'000));
}

RC_GTEST_PROP(Ticks, DroppingSomeMovesNoOther, ()) {
  TickSchedule schedule = any_schedule();
  const auto some = ticks(schedule, 200);
  schedule.drops.clear();
  const auto all = ticks(schedule, 200);
  RC_ASSERT(std::includes(all.begin(), all.end(), some.begin(), some.end()));
}

RC_GTEST_PROP(Ticks, TheSameScheduleGivesTheSameTicks, ()) {
  const TickSchedule schedule = any_schedule();
  RC_ASSERT(ticks(schedule, 100) == ticks(schedule, 100));
}

TEST(Ticks, TheSeedIsThatOfTheJitter) {
  TickSchedule schedule;
  schedule.jitter = 0.5;
  const auto one = ticks(schedule, 10);
  schedule.seed = 2;
  EXPECT_NE(ticks(schedule, 10), one);
  schedule.jitter = 0;
  const auto two = ticks(schedule, 10);
  schedule.seed = 1;
  EXPECT_EQ(ticks(schedule, 10), two);
}

}  // namespace
}  // namespace attest
