// The comparison of reported step times with measured times.
#include "harness/measure/clock_check.hpp"

#include <chrono>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace attest {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

// 1,000 steps in 10 requests.
ClockTotals totals(Nanoseconds reported, Nanoseconds wall, Nanoseconds used) {
  return {10, 1000, reported, Nanoseconds(0), wall, used};
}

TEST(ClockCheck, AcceptsTheWorkOfAttestBetweenTheSteps) {
  EXPECT_EQ(clock_contradiction(totals(1ms, 5ms, 4ms)), "");
  EXPECT_EQ(clock_contradiction(totals(1s, 1s + 5ms, 1s + 5ms)), "");
}

TEST(ClockCheck, AcceptsPreemption) { EXPECT_EQ(clock_contradiction(totals(1ms, 60s, 4ms)), ""); }

TEST(ClockCheck, FindsStepsThatUsedMoreThanTheyReport) {
  EXPECT_THAT(clock_contradiction(totals(71us, 10s, 10s)),
              HasSubstr("its 1000 steps took 0.071 ms, but its process used 1e+04 ms of CPU time"));
}

TEST(ClockCheck, FindsStepsThatAreLongerThanTheAnswers) {
  EXPECT_THAT(clock_contradiction(totals(2s, 1s, 1s)), HasSubstr("its answers took only 1e+03 ms"));
}

TEST(ClockCheck, CountsStepsThatAreMadeTwice) {
  ClockTotals twice = totals(10s, 30s, 30s);
  EXPECT_NE(clock_contradiction(twice), "");
  twice.repeated = 10s;
  EXPECT_EQ(clock_contradiction(twice), "");
}

// A host whose process uses some CPU time between two questions.
class Host final : public PortHost {
 public:
  const Declarations& declarations() const override { return declarations_; }
  std::optional<PortFault> drive(const ModuleUnderTest&, Trace&) override { return {}; }
  Result<Flown> fly(const FlightPlan&) override { return Flown{}; }
  Result<LiveFlight> fly_live(const LivePlan&, const LiveWatch&) override { return LiveFlight(); }
  Result<StepTimes> time_steps(const ModuleUnderTest&, const Trace&, bool) override {
    return StepTimes{};
  }
  bool supports(const std::string&) override { return true; }
  std::optional<Nanoseconds> cpu_time() const override {
    return used_ ? std::optional(*used_ += 1h) : std::nullopt;
  }

  mutable std::optional<Nanoseconds> used_ = 0ns;

 private:
  Declarations declarations_;
};

TEST(ClockCheck, CountsNoMoreCpuTimeThanWallTime) {
  const Host host;
  ClockTotals totals;
  StepTimes times;
  times.steps = {1ns, 2ns};
  TimedRequest(host).end(times, true, totals);
  EXPECT_EQ(totals.requests, 1);
  EXPECT_EQ(totals.steps, 2);
  EXPECT_EQ(totals.reported, 3ns);
  EXPECT_EQ(totals.repeated, 3ns);
  EXPECT_EQ(totals.used, totals.wall);
  EXPECT_LT(totals.wall, 1h);
}

TEST(ClockCheck, TakesImpossibleStepsForMoreThanTheWallTime) {
  const Host host;
  for (const Nanoseconds impossible : {-1ns, Nanoseconds(Nanoseconds::max())}) {
    ClockTotals totals;
    StepTimes times;
    times.steps = {impossible, impossible};
    TimedRequest(host).end(times, false, totals);
    EXPECT_THAT(clock_contradiction(totals), HasSubstr("its answers took only"));
  }
}

TEST(ClockCheck, LeavesOutAPortInTheSameProcess) {
  Host host;
  host.used_.reset();
  ClockTotals totals;
  TimedRequest(host).end({}, false, totals);
  EXPECT_EQ(totals.requests, 0);
}

}  // namespace
}  // namespace attest
