#include "harness/realtime/slow_ticks.hpp"

#include <gtest/gtest.h>

#include "tests/harness/times.hpp"

namespace attest {
namespace {

std::vector<LiveTick> quick(std::size_t count) {
  return std::vector<LiveTick>(count, LiveTick{{}, {}, us(1), us(1), 0});
}

TEST(SlowTicks, AreNoneWhereAllAreAlike) {
  const SlowTicks slow = slow_ticks(quick(1000), us(1));
  EXPECT_EQ(slow.count, 0u);
  EXPECT_FALSE(slow.every);
}

TEST(SlowTicks, AreTheSlowestFirst) {
  auto ticks = quick(1000);
  ticks[10].execution = us(50);
  ticks[700].execution = us(300);
  ticks[701].execution = us(20);  // not slow enough
  const SlowTicks slow = slow_ticks(ticks, us(1));
  EXPECT_EQ(slow.threshold, us(21));
  ASSERT_EQ(slow.count, 2u);
  EXPECT_EQ(slow.worst[0].tick, 700u);
  EXPECT_EQ(slow.worst[1].tick, 10u);
  EXPECT_FALSE(slow.every);
}

TEST(SlowTicks, ThatComeRegularlyAreFoundAmongThoseOfTheMachine) {
  auto ticks = quick(20'000);
  for (std::size_t i = 999; i < ticks.size(); i += 1000) ticks[i].execution = us(300);
  ticks[5999].execution = us(1);  // one that was quick
  for (const std::size_t i : {17u, 4242u, 11111u, 11112u, 19000u}) ticks[i].execution = us(400);
  const SlowTicks slow = slow_ticks(ticks, us(1));
  EXPECT_EQ(slow.every, 1000u);
  EXPECT_EQ(slow.first_regular, 999u);
  EXPECT_EQ(slow.worst.size(), 8u);
}

TEST(SlowTicks, ThatAreManyHaveTheirRhythmToo) {
  auto ticks = quick(100'000);
  for (std::size_t i = 0; i < ticks.size(); i += 100) ticks[i].execution = us(300);
  const SlowTicks slow = slow_ticks(ticks, us(1));
  EXPECT_EQ(slow.count, 1000u);
  EXPECT_EQ(slow.every, 100u);
}

TEST(SlowTicks, AtRandomHaveNone) {
  auto ticks = quick(20'000);
  std::size_t at = 1;
  for (int i = 0; i < 30; ++i) {
    at = at * 7919 % 20'011;
    ticks[at % ticks.size()].execution = us(300);
  }
  EXPECT_FALSE(slow_ticks(ticks, us(1)).every);
}

}  // namespace
}  // namespace attest
