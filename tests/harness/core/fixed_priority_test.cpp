#include "harness/core/fixed_priority.hpp"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include "harness/core/response_time.hpp"
#include "tests/harness/times.hpp"

namespace attest {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

// Periods and execution times in ms; textbooks give them without a unit. The first task has the
// highest priority.
std::vector<ScheduledTask> rate_monotonic(const std::vector<std::pair<int, int>>& periods) {
  std::vector<ScheduledTask> tasks;
  int priority = 100;
  for (const auto& [period, execution] : periods) {
    ScheduledTask task;
    task.name = std::string(1, static_cast<char>('a' + static_cast<int>(tasks.size())));
    task.rate = Rate::hz(1000, period);
    task.execution = {ms(execution)};
    task.priority = priority--;
    tasks.push_back(task);
  }
  return tasks;
}

std::vector<Nanoseconds> analysed(const std::vector<ScheduledTask>& tasks) {
  std::vector<Nanoseconds> times;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    times.push_back(response_time(tasks, i).value_or(Nanoseconds(-1)));
  }
  return times;
}

std::vector<Nanoseconds> simulated(const std::vector<ScheduledTask>& tasks, Nanoseconds duration) {
  std::vector<Nanoseconds> times;
  const auto all = *simulate(tasks, duration);
  for (const auto& jobs : all) {
    Nanoseconds longest{0};
    for (const TaskJob& job : jobs) longest = std::max(longest, job.response());
    times.push_back(longest);
  }
  return times;
}

struct Published {
  const char* source;
  std::vector<std::pair<int, int>> tasks;  // period, execution
  std::vector<Nanoseconds> responses;
};

const Published published[] = {
    {"Burns and Wellings, Real-Time Systems: 82% of the CPU is too much for the utilisation test",
     {{20, 5}, {40, 10}, {80, 40}},
     {ms(5), ms(15), ms(80)}},
    {"Burns and Wellings, Real-Time Systems", {{7, 3}, {12, 3}, {20, 5}}, {ms(3), ms(6), ms(20)}},
    {"Buttazzo, Hard Real-Time Computing Systems, response time analysis",
     {{4, 1}, {5, 1}, {6, 2}, {11, 1}},
     {ms(1), ms(2), ms(4), ms(10)}},
    {"Lehoczky, Sha and Ding 1989", {{100, 40}, {150, 40}, {350, 100}}, {ms(40), ms(80), ms(300)}},
};

TEST(ResponseTime, IsThatOfPublishedExamples) {
  for (const Published& example : published) {
    EXPECT_EQ(analysed(rate_monotonic(example.tasks)), example.responses) << example.source;
  }
}

TEST(FixedPriority, RespondsAsThePublishedExamplesDo) {
  for (const Published& example : published) {
    EXPECT_EQ(simulated(rate_monotonic(example.tasks), ms(9240)), example.responses)
        << example.source;
  }
}

TEST(ResponseTime, OfATaskThatMissesItsPeriodIsNone) {
  const auto tasks = rate_monotonic({{4, 2}, {6, 3}, {20, 2}});
  EXPECT_THAT(analysed(tasks), ElementsAre(ms(2), Nanoseconds(-1), Nanoseconds(-1)));
}

// Released together at time 0, each task's first job has the longest response (Liu and Layland's
// critical instant). Analysis and simulation must give the same number.
RC_GTEST_PROP(FixedPriority, TheLongestResponseIsTheAnalysed, ()) {
  const auto count = *rc::gen::inRange(1, 6);
  std::vector<std::pair<int, int>> periods;
  for (int i = 0; i < count; ++i) {
    const int period = *rc::gen::inRange(3, 60);
    periods.emplace_back(period, *rc::gen::inRange(1, period / 2 + 1));
  }
  const auto tasks = rate_monotonic(periods);
  RC_PRE(utilisation(tasks, 0) <= 1);
  const auto expected = analysed(tasks);
  const auto got = simulated(tasks, ms(2000));
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    if (expected[i] < Nanoseconds(0)) continue;
    RC_ASSERT(got[i] == expected[i]);
  }
}

RC_GTEST_PROP(FixedPriority, NoJobRunsBeforeItsReleaseNorLessThanItsExecution, ()) {
  auto tasks = rate_monotonic({{7, 2}, {11, 3}, {30, 4}});
  for (ScheduledTask& task : tasks) task.phase = ms(*rc::gen::inRange(0, 30));
  tasks[1].execution = {ms(1), ms(3), ms(2)};
  const auto jobs = *simulate(tasks, ms(500));
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    for (std::size_t j = 0; j < jobs[i].size(); ++j) {
      const TaskJob& job = jobs[i][j];
      RC_ASSERT(job.start >= job.release);
      RC_ASSERT(job.finish - job.start >= tasks[i].execution[j % tasks[i].execution.size()]);
      if (j > 0) RC_ASSERT(job.start >= jobs[i][j - 1].finish);
    }
  }
}

TEST(FixedPriority, AHigherTaskPreempts) {
  auto tasks = rate_monotonic({{10, 2}, {100, 5}});
  tasks[0].phase = ms(3);
  const auto jobs = *simulate(tasks, ms(20));
  ASSERT_EQ(jobs[1].size(), 1u);
  EXPECT_EQ(jobs[1][0].start, ms(0));
  EXPECT_EQ(jobs[1][0].finish, ms(7));
  ASSERT_EQ(jobs[0].size(), 2u);
  EXPECT_EQ(jobs[0][1].start, ms(13));
}

TEST(FixedPriority, TwoCpusDoNotDisturbEachOther) {
  auto tasks = rate_monotonic({{10, 6}, {10, 6}});
  EXPECT_FALSE(simulate(tasks, ms(100)));
  tasks[1].cpu = 1;
  tasks[1].priority = tasks[0].priority;
  EXPECT_THAT(simulated(tasks, ms(100)), ElementsAre(ms(6), ms(6)));
}

TEST(FixedPriority, WhatCannotBeScheduledIsRefused) {
  auto tasks = rate_monotonic({{10, 6}, {20, 10}});
  EXPECT_THAT(simulate(tasks, ms(100)).error().message, HasSubstr("110.0%"));
  tasks[0].execution = {ms(1)};
  tasks[1].priority = tasks[0].priority;
  EXPECT_THAT(simulate(tasks, ms(100)).error().message, HasSubstr("same priority 100 on CPU 0"));
}

// The releases of a rate that is no whole number of nanoseconds do not drift.
TEST(FixedPriority, ReleasesAreThoseOfTheRate) {
  auto tasks = rate_monotonic({{3, 1}});
  tasks[0].rate = Rate::hz(333);
  const auto jobs = *simulate(tasks, std::chrono::seconds(10));
  ASSERT_EQ(jobs[0].size(), 3330u);
  EXPECT_EQ(jobs[0].back().release, Rate::hz(333).tick(3329));
}

// An estimator `a` that releases `b`.
std::vector<ScheduledTask> triggered(int b_priority, int b_cpu) {
  auto tasks = rate_monotonic({{10, 3}, {10, 2}, {7, 1}});
  tasks[1].released_by = 0;
  tasks[1].priority = b_priority;
  tasks[1].cpu = b_cpu;
  return tasks;
}

TEST(FixedPriority, ATaskIsReleasedWhenAnotherFinishes) {
  for (const int cpu : {0, 1}) {
    // `c` runs from 0 to 1 and from 7 to 8; `a` with phase 1 from 1 to 4.
    auto tasks = triggered(150, cpu);
    tasks[0].phase = ms(1);
    tasks[2].priority = 200;
    const auto jobs = *simulate(tasks, ms(10));
    ASSERT_EQ(jobs[1].size(), 1u) << cpu;
    EXPECT_EQ(jobs[1][0].release, ms(4)) << cpu;
    EXPECT_EQ(jobs[1][0].start, ms(4)) << cpu;
    EXPECT_EQ(jobs[1][0].finish, ms(6)) << cpu;
  }
}

TEST(FixedPriority, AReleaseAtTheEndIsNoReleaseAndTheOrderOfTheCpusIsNone) {
  auto tasks = triggered(50, 0);
  tasks[0].cpu = 1;  // CPU 1 releases a task of CPU 0
  const auto jobs = *simulate(tasks, ms(13));
  ASSERT_EQ(jobs[1].size(), 1u);
  EXPECT_EQ(jobs[1][0].release, ms(3));
  EXPECT_EQ(simulate(tasks, ms(14))->at(1).size(), 2u);
}

TEST(FixedPriority, OfTwoReadyAtTheInstantOfAReleaseTheHigherRuns) {
  auto tasks = triggered(50, 0);
  tasks[2].phase = ms(3);  // when `a` finishes
  const auto jobs = *simulate(tasks, ms(9));
  EXPECT_EQ(jobs[2][0].start, ms(3));
  EXPECT_EQ(jobs[1][0].release, ms(3));
  EXPECT_EQ(jobs[1][0].start, ms(4));
}

TEST(ResponseTime, OfATaskThatAnotherReleasesCountsFromThere) {
  // `c` (1 every 7) is above both: the estimator's response is 4, its jitter 1.
  auto tasks = triggered(50, 0);
  tasks[2].priority = 200;
  EXPECT_THAT(analysed(tasks), ElementsAre(ms(4), ms(6), ms(1)));
  // Above the estimator it delays that by one job at most.
  tasks[1].priority = 150;
  EXPECT_THAT(analysed(tasks), ElementsAre(ms(6), ms(3), ms(1)));
}

RC_GTEST_PROP(FixedPriority, WithATriggerNoResponseIsLongerThanTheAnalysed, ()) {
  std::vector<std::pair<int, int>> periods;
  for (int i = 0; i < 4; ++i) {
    const int period = *rc::gen::inRange(4, 60);
    periods.emplace_back(period, *rc::gen::inRange(1, period / 3 + 1));
  }
  auto tasks = rate_monotonic(periods);
  const auto by = *rc::gen::inRange<std::size_t>(0, 4);
  const auto released = (by + *rc::gen::inRange<std::size_t>(1, 4)) % 4;
  tasks[released].released_by = by;
  tasks[released].rate = tasks[by].rate;
  tasks[by].cpu = *rc::gen::inRange(0, 2);
  tasks[by].execution.push_back(ms(1));
  for (ScheduledTask& task : tasks) task.phase = ms(*rc::gen::inRange(0, 20));
  RC_PRE(utilisation(tasks, 0) <= 1);
  const auto expected = analysed(tasks);
  const auto got = simulated(tasks, ms(2000));
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    if (expected[i] >= Nanoseconds(0)) RC_ASSERT(got[i] <= expected[i]);
  }
}

TEST(ScheduledTask, TheWorstExecutionIsTheLongest) {
  ScheduledTask task;
  task.execution = {ms(1), ms(3), ms(2)};
  EXPECT_EQ(task.worst_execution(), ms(3));
}

// `a` on the other CPU has a response of 3 or 4 ms, so `b` is released every 9 to 11 ms. Within 10
// ms of a release of the lowest task, it may be released twice.
TEST(ResponseTime, AHigherTaskThatMayBeLateDisturbsTwice) {
  auto tasks = triggered(150, 0);
  tasks[0].cpu = tasks[2].cpu = 1;
  tasks[2].priority = 200;
  ScheduledTask lowest = tasks[1];
  lowest.released_by.reset();
  lowest.rate = Rate::hz(25);
  lowest.execution = {ms(8)};
  lowest.priority = 1;
  tasks.push_back(lowest);
  EXPECT_EQ(response_time(tasks, 3), ms(12));
  tasks[2].execution = {ms(0)};  // the response of `a` is always 3 ms
  EXPECT_EQ(response_time(tasks, 3), ms(10));
}

}  // namespace
}  // namespace attest
