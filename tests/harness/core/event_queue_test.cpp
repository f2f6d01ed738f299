#include "harness/core/event_queue.hpp"

#include <algorithm>
#include <tuple>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "harness/core/delay_line.hpp"
#include "tests/harness/times.hpp"

namespace attest {
namespace {

TEST(EventQueue, AtOneInstantTheLowerTaskComesFirst) {
  EventQueue event_queue({{ns(5)}, {ns(0), ns(5)}, {ns(5)}});
  std::vector<std::size_t> tasks;
  while (const auto event = event_queue.next()) tasks.push_back(event->task);
  EXPECT_EQ(tasks, (std::vector<std::size_t>{1, 0, 1, 2}));
}

TEST(EventQueue, ATaskWithoutTimesNeverRuns) {
  EventQueue event_queue({{}, {ns(1)}});
  EXPECT_EQ(event_queue.size(0), 0u);
  EXPECT_EQ(event_queue.next()->task, 1u);
  EXPECT_FALSE(event_queue.next());
  EXPECT_FALSE(event_queue.next());
}

RC_GTEST_PROP(EventQueue, GivesEveryTimeOnceInOrder,
              (std::vector<std::vector<std::uint8_t>> counts)) {
  using Entry = std::tuple<Nanoseconds, std::size_t, std::size_t>;
  std::vector<std::vector<Nanoseconds>> times;
  std::vector<Entry> expected;
  for (std::size_t task = 0; task < counts.size(); ++task) {
    std::sort(counts[task].begin(), counts[task].end());
    times.emplace_back();
    for (std::size_t i = 0; i < counts[task].size(); ++i) {
      times.back().push_back(ns(counts[task][i]));
      expected.emplace_back(times.back().back(), task, i);
    }
  }
  std::sort(expected.begin(), expected.end());
  EventQueue event_queue(times);
  std::vector<Entry> got;
  while (const auto event = event_queue.next())
    got.emplace_back(event->time, event->task, event->index);
  RC_ASSERT(got == expected);
}

TEST(DelayLine, AMessageArrivesItsDelayLater) {
  DelayLine<int> line(ns(10), 4);
  line.send(ns(0), 1);
  EXPECT_FALSE(line.receive(ns(9)));
  EXPECT_EQ(line.receive(ns(10)), 1);
  EXPECT_FALSE(line.receive(ns(11)));
}

TEST(DelayLine, WithoutDelayItArrivesAtOnce) {
  DelayLine<int> line(ns(0), 1);
  line.send(ns(7), 1);
  EXPECT_EQ(line.receive(ns(7)), 1);
}

TEST(DelayLine, OfSeveralThatArrivedTheLatestIsSeen) {
  DelayLine<int> line(ns(10), 4);
  line.send(ns(0), 1);
  line.send(ns(2), 2);
  line.send(ns(8), 3);
  EXPECT_EQ(line.receive(ns(12)), 2);
  EXPECT_EQ(line.receive(ns(18)), 3);
}

TEST(DelayLine, AReaderThatIsSlowMissesTheOldOnes) {
  DelayLine<int> line(ns(0), 1);
  for (int i = 0; i < 100; ++i) line.send(ns(i), i);
  EXPECT_EQ(line.receive(ns(99)), 99);
  EXPECT_FALSE(line.receive(ns(100)));
}

}  // namespace
}  // namespace attest
