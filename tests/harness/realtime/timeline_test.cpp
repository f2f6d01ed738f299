#include "harness/realtime/timeline.hpp"

#include <gtest/gtest.h>

#include "tests/harness/times.hpp"

namespace attest {
namespace {

// A tick per millisecond that starts at its release and computes for 10 us.
std::vector<LiveTick> punctual(int count) {
  std::vector<LiveTick> ticks;
  for (int i = 0; i < count; ++i) {
    LiveTick tick;
    tick.release = tick.start = ms(i);
    tick.deadline = ms(i + 1);
    tick.elapsed = tick.cpu = us(10);
    tick.finish = tick.start + us(10);
    ticks.push_back(tick);
  }
  return ticks;
}

TEST(Timeline, CountsEveryTickOnce) {
  const FlightTimeline timeline = flight_timeline(punctual(1003), {});
  EXPECT_LE(timeline.parts.size(), 400u);
  std::uint64_t ticks = 0;
  for (const TimelinePart& part : timeline.parts) ticks += part.ticks;
  EXPECT_EQ(ticks, 1003u);
  EXPECT_EQ(timeline.worst.size(), 8u);
}

TEST(Timeline, ShowsWhenStepsAreLateAndLong) {
  std::vector<LiveTick> ticks = punctual(1000);
  ticks[500].start += us(200);
  ticks[500].cpu = ticks[500].elapsed = us(1500);
  ticks[500].finish = ticks[500].start + us(1500);
  ticks[500].skipped = 1;
  const FlightTimeline timeline = flight_timeline(ticks, {us(100), us(150)});
  EXPECT_EQ(timeline.worst.front().number, 500u);
  std::size_t parts_with_events = 0;
  for (const TimelinePart& part : timeline.parts) {
    if (part.late + part.skipped + part.overruns + part.late_starts == 0) {
      EXPECT_EQ(part.response, us(10));
      continue;
    }
    ++parts_with_events;
    EXPECT_LE(part.begin, ms(500));
    EXPECT_GT(part.begin, ms(497));
    EXPECT_EQ(part.late, 1u);
    EXPECT_EQ(part.skipped, 1u);
    EXPECT_EQ(part.overruns, 1u);
    EXPECT_EQ(part.late_starts, 1u);
    EXPECT_EQ(part.response, us(1700));
  }
  EXPECT_EQ(parts_with_events, 1u);
}

TEST(Timeline, WithoutATickIsEmpty) { EXPECT_TRUE(flight_timeline({}, {}).parts.empty()); }

}  // namespace
}  // namespace attest
