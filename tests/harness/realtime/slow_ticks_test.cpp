#include "harness/realtime/slow_ticks.hpp"

#include <gtest/gtest.h>

#include "tests/harness/times.hpp"

namespace attest {
namespace {

void take(LiveTick& tick, Nanoseconds execution) { tick.cpu = tick.elapsed = execution; }

std::vector<LiveTick> quick(std::size_t count) {
  LiveTick tick;
  take(tick, us(1));
  return std::vector<LiveTick>(count, tick);
}

TEST(SlowTicks, AreEmptyWhereAllAreEqual) {
  const SlowTicks slow = slow_ticks(quick(1000), us(1));
  EXPECT_EQ(slow.count, 0u);
  EXPECT_FALSE(slow.rhythm);
}

TEST(SlowTicks, AreTheSlowestFirst) {
  auto ticks = quick(1000);
  take(ticks[10], us(50));
  take(ticks[700], us(300));
  take(ticks[701], us(20));  // not slow enough
  const SlowTicks slow = slow_ticks(ticks, us(1));
  EXPECT_EQ(slow.threshold, us(21));
  ASSERT_EQ(slow.count, 2u);
  EXPECT_EQ(slow.worst[0].tick, 700u);
  EXPECT_EQ(slow.worst[1].tick, 10u);
  EXPECT_FALSE(slow.rhythm);
}

TEST(SlowTicks, AreNotThoseThatWerePreempted) {
  auto ticks = quick(1000);
  for (std::size_t i = 0; i < ticks.size(); i += 100) ticks[i].elapsed = us(300);
  EXPECT_EQ(slow_ticks(ticks, us(1)).count, 0u);
  for (LiveTick& tick : ticks) tick.waited = tick.elapsed > us(1);
  EXPECT_EQ(slow_ticks(ticks, us(1)).count, 10u);
}

TEST(SlowTicks, ThatComeRegularlyAreFoundAmongThoseOfTheMachine) {
  auto ticks = quick(20'000);
  for (std::size_t i = 999; i < ticks.size(); i += 1000) take(ticks[i], us(300));
  take(ticks[5999], us(1));  // one that was quick
  for (const std::size_t i : {17u, 4242u, 11111u, 11112u, 19000u}) take(ticks[i], us(400));
  const SlowTicks slow = slow_ticks(ticks, us(1));
  ASSERT_TRUE(slow.rhythm);
  EXPECT_EQ(slow.rhythm->every, 1000u);
  EXPECT_EQ(slow.rhythm->first, 999u);
  EXPECT_EQ(slow.worst.size(), 8u);
}

}  // namespace
}  // namespace attest
