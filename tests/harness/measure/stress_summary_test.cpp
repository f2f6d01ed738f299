// The summary of a live flight with handmade ticks and counters.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/measure/stress.hpp"
#include "tests/harness/times.hpp"

namespace attest {
namespace {

// A step at 1 kHz that began at its release.
LiveTick step_that_took(Nanoseconds elapsed, Nanoseconds cpu, bool waited = false) {
  LiveTick tick;
  tick.deadline = ms(1);
  tick.finish = tick.elapsed = elapsed;
  tick.cpu = cpu;
  tick.waited = waited;
  return tick;
}

StressResult summary_of(const LiveFlight& flight, const RealtimeBudget& budget) {
  StressResult stress;
  summarise(flight, flight.unit, Rate::hz(1000), budget, stress);
  return stress;
}

StressResult summary_of_step(const LiveTick& tick, std::optional<double> execution_us) {
  LiveFlight flight;
  flight.unit.ticks = {tick};
  return summary_of(flight, {500, 100, execution_us});
}

TEST(StressSummary, AStepThatWasPreemptedOverrunsByItsCpuTimeOnly) {
  EXPECT_EQ(summary_of_step(step_that_took(us(900), us(40)), 50).overruns, 0u);
  EXPECT_EQ(summary_of_step(step_that_took(us(900), us(60)), 50).overruns, 1u);
}

TEST(StressSummary, AStepThatWaitedOverrunsByItsElapsedTime) {
  const StressResult stress = summary_of_step(step_that_took(us(900), us(40), true), 50);
  EXPECT_EQ(stress.overruns, 1u);
  EXPECT_EQ(stress.waiting_steps, 1u);
  EXPECT_EQ(summary_of_step(step_that_took(us(30), us(20), true), 50).overruns, 0u);
}

TEST(StressSummary, AnOverrunIsAboveTheBudget) {
  EXPECT_EQ(summary_of_step(step_that_took(us(50), us(50)), 50).overruns, 0u);
  EXPECT_EQ(summary_of_step(step_that_took(ns(50'001), ns(50'001)), 50).overruns, 1u);
  EXPECT_EQ(summary_of_step(step_that_took(us(900), us(900)), std::nullopt).overruns, 0u);
  EXPECT_EQ(summary_of_step(step_that_took(us(900), us(900)), 1e300).overruns, 0u);
}

TEST(StressSummary, ATimeThatThePortCountsIsItsExecutionTime) {
  LiveTick tick = step_that_took(us(900), us(800));
  tick.counted = us(40);
  EXPECT_EQ(summary_of_step(tick, 50).overruns, 0u);
  EXPECT_EQ(summary_of_step(tick, 50).execution.max, us(40));
  tick.counted = us(60);
  EXPECT_EQ(summary_of_step(tick, 50).overruns, 1u);
}

TEST(StressSummary, EachStepThatOverrunsOrWaitsIsCounted) {
  LiveFlight flight;
  flight.unit.ticks = {step_that_took(us(60), us(60)), step_that_took(us(10), us(10)),
                       step_that_took(us(70), us(70)), step_that_took(us(20), us(5), true)};
  const StressResult stress = summary_of(flight, {500, 100, 50});
  EXPECT_EQ(stress.ticks, 4u);
  EXPECT_EQ(stress.overruns, 2u);
  EXPECT_EQ(stress.waiting_steps, 1u);
}

TEST(StressSummary, DeadlinesAreThoseOfStepsAndOfAllSkippedReleases) {
  LiveFlight flight;
  LiveTick late = step_that_took(us(2500), us(10));
  late.skipped = 1;
  flight.unit.ticks = {late, step_that_took(us(10), us(10))};
  flight.unit.skipped = 4;  // three of them before the first tick
  const StressResult stress = summary_of(flight, {500, 100, {}});
  EXPECT_EQ(stress.ticks, 2u);
  EXPECT_EQ(stress.deadlines, 6u);
  EXPECT_EQ(stress.misses.skipped, 4u);
  EXPECT_EQ(stress.misses.late, 1u);
}

TEST(StressSummary, StartsLaterThanTheBudgetOfTheLatencyAreCounted) {
  LiveFlight flight;
  for (const Nanoseconds latency : {us(100), ns(100'001), us(300)}) {
    LiveTick tick;
    tick.start = tick.finish = latency;
    tick.deadline = ms(1);
    flight.unit.ticks.push_back(tick);
  }
  EXPECT_EQ(summary_of(flight, {500, 100, {}}).misses.late_starts, 2u);
}

TEST(StressSummary, EachTimeIsReportedUnderItsName) {
  LiveFlight flight;
  LiveTick tick;
  tick.release = ns(100);
  tick.start = ns(111);
  tick.elapsed = tick.cpu = ns(12);
  tick.finish = ns(130);
  tick.sampled = ns(116);
  flight.unit.ticks = {tick};
  flight.plant.latency.add(ns(15));
  const StressResult stress = summary_of(flight, {});
  EXPECT_EQ(stress.latency.max, ns(11));
  EXPECT_EQ(stress.execution.max, ns(12));
  EXPECT_EQ(stress.response.max, ns(30));
  EXPECT_EQ(stress.age.max, ns(14));
  EXPECT_EQ(stress.plant.max, ns(15));
  EXPECT_EQ(stress.plant_steps, 1u);
}

TEST(StressSummary, BeforeTheFirstSampleItsAgeCountsFromTimeZero) {
  LiveFlight flight;
  flight.unit.ticks.resize(1);
  flight.unit.ticks[0].sampled = Nanoseconds(-1);
  flight.unit.ticks[0].finish = ns(130);
  EXPECT_EQ(summary_of(flight, {}).age.max, ns(130));
}

TEST(StressSummary, TheLongestGapIsBetweenNeighbours) {
  LiveFlight flight;
  for (const Nanoseconds begins : {ms(0), ms(1), ms(4), ms(5)}) {
    flight.unit.ticks.emplace_back().begins = begins;
  }
  EXPECT_EQ(summary_of(flight, {}).longest_gap, ms(3));
}

TEST(StressSummary, CountersOfUnitAndPlantAreDistinguished) {
  LiveFlight flight;
  flight.unit.ticks.resize(1);
  flight.unit.ticks[0].begins = ms(400);
  flight.unit.usage.allocations = 1;
  flight.plant.usage.allocations = 2;
  flight.plant.latency.add(ns(15), 93);
  flight.plant.late_steps = 7;
  flight.privileges = {{"mlockall", false, "no"}};
  const StressResult stress = summary_of(flight, {});
  EXPECT_EQ(stress.unit_usage.allocations, 1);
  EXPECT_EQ(stress.plant_usage.allocations, 2);
  EXPECT_EQ(stress.plant_steps, 100u);
  EXPECT_EQ(stress.plant_late_steps, 7u);
  EXPECT_EQ(stress.wall, ms(400));
  EXPECT_EQ(stress.privileges.size(), 1u);
}

Percentiles percentiles_of_count(int count) {
  Histogram histogram;
  for (int i = 1; i <= count; ++i) histogram.add(us(i));
  return percentiles_of(histogram);
}

TEST(StressPercentiles, AreThereFromTenSamplesBeyondThemOn) {
  EXPECT_FALSE(percentiles_of_count(19).median);
  EXPECT_TRUE(percentiles_of_count(20).median);
  EXPECT_FALSE(percentiles_of_count(99).p90);
  EXPECT_TRUE(percentiles_of_count(100).p90);
  EXPECT_FALSE(percentiles_of_count(999).p99);
  EXPECT_TRUE(percentiles_of_count(1000).p99);
  EXPECT_FALSE(percentiles_of_count(9999).p999);
  EXPECT_TRUE(percentiles_of_count(10'000).p999);
}

TEST(StressPercentiles, AreThoseOfTheirNames) {
  const Percentiles all = percentiles_of_count(10'000);
  const auto about = [](Nanoseconds time) {
    const auto count = static_cast<double>(time.count());
    return testing::DoubleNear(count, 0.02 * count);
  };
  const auto number = [](std::optional<Nanoseconds> time) {
    return static_cast<double>(time.value_or(Nanoseconds(0)).count());
  };
  EXPECT_EQ(all.count, 10'000u);
  EXPECT_EQ(all.min, us(1));
  EXPECT_EQ(all.max, us(10'000));
  EXPECT_THAT(number(all.median), about(us(5000)));
  EXPECT_THAT(number(all.p90), about(us(9000)));
  EXPECT_THAT(number(all.p99), about(us(9900)));
  EXPECT_THAT(number(all.p999), about(us(9990)));
  EXPECT_FALSE(all.buckets.empty());
}

TEST(StressPerMillion, IsOfTheDeadlines) {
  StressResult stress;
  EXPECT_EQ(stress.per_million(5), 0);
  stress.ticks = 5000;
  stress.deadlines = 10'000;
  EXPECT_EQ(stress.per_million(5), 500);
}

}  // namespace
}  // namespace attest
