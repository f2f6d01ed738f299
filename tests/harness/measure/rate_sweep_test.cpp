// The search for the last flight that holds, with a host whose flights the test gives.
#include "harness/measure/rate_sweep.hpp"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/loop/case_timing.hpp"
#include "tests/harness/realtime/flights.hpp"
#include "tests/harness/times.hpp"
#include "tests/harness/verify/given_host.hpp"

namespace attest {
namespace {

using testing::DoubleNear;
using testing::Optional;

constexpr double unbounded = std::numeric_limits<double>::infinity();
constexpr double rounding = 1e-9;

Metric sink_within(double min, double max) {
  Metric metric;
  metric.name = "sinks";
  metric.measure = Measure::sink_m;
  metric.min = min;
  metric.max = max;
  return metric;
}

Flown sinking(float metres) {
  Flown flown;
  flown.trace.samples.resize(2);
  flown.trace.samples[1].in.timestamp = 1000;
  flown.trace.plant.resize(2);
  flown.trace.plant[1].position_m[2] = metres;
  return flown;
}

Flown faulty(PortFault::Kind kind) {
  Flown flown = sinking(0);
  flown.fault = PortFault{kind, 1, "it went wrong"};
  return flown;
}

int hertz_of(const FlightPlan& plan) {
  return static_cast<int>(std::lround(plan.configuration.rate.hertz()));
}

Nanoseconds delay_of(const FlightPlan& plan) {
  return *plan.timing.unit.front().commanded - plan.timing.unit.front().begins;
}

class Sweep : public testing::Test {
 protected:
  Sweep() { case_.flight->metrics = {sink_within(-unbounded, 1)}; }

  RateSweepJob job(const StartHost& start) const {
    HostOptions host;
    host.start = start;
    return {case_, plant_configuration_, rates_, nullptr, host};
  }

  StartHost start() {
    return [this](const HostOptions&, const Course&) -> Result<std::unique_ptr<PortHost>> {
      GivenHost::Answers answers;
      answers.says = declarations_;
      answers.fly = [this](const FlightPlan& plan) {
        plans_.push_back(plan);
        return fly_(plan);
      };
      return std::make_unique<GivenHost>(answers);
    };
  }

  Result<RateSweepResult> run(std::size_t task) {
    RateSweepJob sweep = job(start());
    if (auto opened = sweep.open(); !opened) return tl::unexpected(opened.error());
    auto found = sweep.run(task);
    sweep.close();
    return found;
  }

  void holds_if(const std::function<bool(const FlightPlan&)>& holds) {
    fly_ = [holds](const FlightPlan& plan) { return sinking(holds(plan) ? 0 : 2); };
  }

  // Whether flights that sink by `metres` hold.
  bool holds_sinking(float metres) {
    fly_ = [metres](const FlightPlan&) { return sinking(metres); };
    return *run(0)->lowest_rate_hz > 0;
  }

  Case case_ = test::hover_case(0.02);
  PlantConfiguration plant_configuration_{"iris", PlantKind::ode};
  std::vector<LoopRate> rates_ = {Rate::hz(250), Rate::hz(500)};
  Declarations declarations_;
  std::function<Result<Flown>(const FlightPlan&)> fly_;
  std::vector<FlightPlan> plans_;
};

TEST_F(Sweep, HasATaskForTheRateAndOneForTheDelayAtEachRate) { EXPECT_EQ(job({}).size(), 3u); }

TEST_F(Sweep, TheLowestRateIsTheLastThatHolds) {
  for (const int lowest : {3, 137, 166, 799, 800, 801, 1000}) {
    holds_if([&](const FlightPlan& plan) { return hertz_of(plan) >= lowest; });
    const auto found = run(0);
    ASSERT_TRUE(found) << found.error().to_string();
    EXPECT_EQ(found->result.verdict, Verdict::pass);
    EXPECT_EQ(found->lowest_rate_hz, lowest);
    EXPECT_FALSE(found->largest_delay_ms);
  }
}

TEST_F(Sweep, EachFlightOfTheSearchIsKeptWithItsMetrics) {
  holds_if([](const FlightPlan& plan) { return hertz_of(plan) >= 137; });
  const auto found = run(0);
  ASSERT_TRUE(found) << found.error().to_string();
  ASSERT_EQ(found->trials.size(), plans_.size());
  for (std::size_t i = 0; i < plans_.size(); ++i) {
    const RateSweepTrial& trial = found->trials[i];
    EXPECT_EQ(trial.rate_hz, hertz_of(plans_[i]));
    EXPECT_EQ(trial.holds, trial.rate_hz >= 137);
    EXPECT_EQ(trial.values, std::vector<double>{trial.holds ? 0.0 : 2.0});
  }
}

TEST_F(Sweep, TheLargestDelayIsTheLastThatHolds) {
  for (const std::int64_t largest_us : {0, 100, 1900, 2000, 2100, 7300}) {
    holds_if([&](const FlightPlan& plan) { return delay_of(plan) <= us(largest_us); });
    const auto found = run(1);
    ASSERT_TRUE(found) << found.error().to_string();
    EXPECT_EQ(found->result.verdict, Verdict::pass);
    EXPECT_THAT(found->largest_delay_ms,
                Optional(DoubleNear(static_cast<double>(largest_us) / 1000, rounding)));
    EXPECT_FALSE(found->lowest_rate_hz);
  }
}

TEST_F(Sweep, TheLargestDelayIsThatOfTheTasksOwnRate) {
  holds_if([](const FlightPlan& plan) {
    return delay_of(plan) <= us(hertz_of(plan) == 250 ? 7300 : 2100);
  });
  const auto at_250 = run(1), at_500 = run(2);
  EXPECT_THAT(at_250->largest_delay_ms, Optional(DoubleNear(7.3, rounding)));
  EXPECT_EQ(at_250->result.id(), "px4-v1.5.5/flight/hover@250hz-iris-ode");
  EXPECT_THAT(at_500->largest_delay_ms, Optional(DoubleNear(2.1, rounding)));
  EXPECT_EQ(at_500->result.id(), "px4-v1.5.5/flight/hover@500hz-iris-ode");
}

TEST_F(Sweep, TheDelayIsOfTheMotorCommandsBeyondTheCasesOwn) {
  case_.flight->actuator_delay = {0.003, Span::In::seconds};
  holds_if([](const FlightPlan& plan) { return delay_of(plan) <= us(3000 + 700); });
  EXPECT_THAT(run(1)->largest_delay_ms, Optional(DoubleNear(0.7, rounding)));
  ASSERT_FALSE(plans_.empty());
  for (FlightPlan& plan : plans_) {
    const Nanoseconds added = delay_of(plan) - ms(3);
    for (LoopTick& tick : plan.timing.unit) *tick.commanded -= added;
    EXPECT_EQ(plan.timing.unit, case_timing(case_, Rate::hz(250)));
  }
}

TEST_F(Sweep, TheLowestRateIsSearchedAtTheTimesOfTheCaseOnItsPlant) {
  case_.flight->actuator_delay = {0.003, Span::In::seconds};
  holds_if([](const FlightPlan& plan) { return hertz_of(plan) >= 400; });
  EXPECT_EQ(run(0)->lowest_rate_hz, 400);
  ASSERT_FALSE(plans_.empty());
  for (const FlightPlan& plan : plans_) {
    EXPECT_EQ(plan.timing.unit, case_timing(case_, plan.configuration.rate.motor_unit));
    EXPECT_EQ(plan.configuration.plant_configuration, plant_configuration_);
    EXPECT_FALSE(plan.from_one_period_on);
  }
}

TEST_F(Sweep, WhatHoldsBeyondAFlightThatDoesNotIsNotLookedFor) {
  holds_if([](const FlightPlan& plan) { return hertz_of(plan) >= 500 || hertz_of(plan) < 100; });
  EXPECT_EQ(run(0)->lowest_rate_hz, 500);
  holds_if(
      [](const FlightPlan& plan) { return delay_of(plan) <= us(500) || delay_of(plan) > ms(9); });
  EXPECT_THAT(run(1)->largest_delay_ms, Optional(DoubleNear(0.5, rounding)));
}

TEST_F(Sweep, FlightsThatAlwaysHoldEndTheSearchAtItsLimits) {
  holds_if([](const FlightPlan&) { return true; });
  EXPECT_EQ(run(0)->lowest_rate_hz, 2);
  EXPECT_THAT(run(1)->largest_delay_ms, Optional(DoubleNear(500, rounding)));
}

TEST_F(Sweep, NothingThatHoldsIsAFigureBelowZero) {
  holds_if([](const FlightPlan&) { return false; });
  for (const std::size_t task : {0u, 1u}) {
    const auto found = run(task);
    EXPECT_EQ(found->result.verdict, Verdict::pass);
    EXPECT_LT(*(task == 0 ? found->lowest_rate_hz : found->largest_delay_ms), 0);
  }
}

TEST_F(Sweep, AFlightWithAMetricThatIsNoNumberDoesNotHold) {
  EXPECT_FALSE(holds_sinking(NAN));
  case_.flight->metrics = {sink_within(-1, unbounded)};
  EXPECT_FALSE(holds_sinking(NAN));
}

TEST_F(Sweep, AFlightHoldsWithinTheBoundsOfEachMetric) {
  for (const bool lower_first : {false, true}) {
    case_.flight->metrics = {sink_within(-unbounded, 1), sink_within(0.5, unbounded)};
    if (lower_first) std::swap(case_.flight->metrics[0], case_.flight->metrics[1]);
    EXPECT_FALSE(holds_sinking(0.25f));
    EXPECT_TRUE(holds_sinking(0.5f));
    EXPECT_TRUE(holds_sinking(1));
    EXPECT_FALSE(holds_sinking(1.25f));
  }
}

TEST_F(Sweep, AFlightThatEndsEarlyDoesNotHold) {
  fly_ = [](const FlightPlan& plan) {
    Flown flown = sinking(0);
    if (hertz_of(plan) < 300) flown.divergence = Divergence{ms(10), "it fell"};
    return flown;
  };
  const auto found = run(0);
  EXPECT_EQ(found->lowest_rate_hz, 300);
  EXPECT_EQ(found->result.verdict, Verdict::pass);
}

TEST_F(Sweep, APortThatGoesWrongHasAVerdictAndNoFigure) {
  fly_ = [](const FlightPlan& plan) {
    const bool wrong = hertz_of(plan) < 600 && (hertz_of(plan) != 250 || delay_of(plan) > ms(3));
    return wrong ? faulty(PortFault::Kind::crash) : sinking(0);
  };
  for (const std::size_t task : {0u, 1u}) {
    plans_.clear();
    const auto found = run(task);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->result.verdict, Verdict::crash);
    EXPECT_EQ(found->result.reason, "it went wrong");
    EXPECT_LT(*(task == 0 ? found->lowest_rate_hz : found->largest_delay_ms), 0);
    // 1000, 800, 640 and 512 Hz; 0, 2 and 4 ms: no other flight is requested.
    EXPECT_EQ(plans_.size(), task == 0 ? 4u : 3u);
  }
}

TEST_F(Sweep, AFlightThatCannotBeSetUpIsAnError) {
  fly_ = [](const FlightPlan&) { return fail("no such rotor"); };
  for (const std::size_t task : {0u, 1u}) {
    const auto found = run(task);
    ASSERT_FALSE(found);
    EXPECT_EQ(found.error().message, "no such rotor");
  }
}

TEST_F(Sweep, APortThatDeclinesTheGroupIsNotFlown) {
  declarations_.unsupported_groups = {"flight"};
  const auto found = run(0);
  EXPECT_EQ(found->result.verdict, Verdict::unsupported);
  EXPECT_LT(*found->lowest_rate_hz, 0);
  EXPECT_TRUE(plans_.empty());
}

TEST_F(Sweep, APortWithAFixedStepFliesAtItsRateOnlyFromOnePeriodOn) {
  declarations_.fixed_step = Rate::hz(500);
  holds_if([](const FlightPlan& plan) { return delay_of(plan) <= ms(1); });
  EXPECT_EQ(run(0)->result.verdict, Verdict::unsupported);
  EXPECT_EQ(run(1)->result.verdict, Verdict::unsupported);
  EXPECT_TRUE(plans_.empty());
  const auto at_its_rate = run(2);
  EXPECT_EQ(at_its_rate->result.verdict, Verdict::pass);
  EXPECT_THAT(at_its_rate->largest_delay_ms, Optional(DoubleNear(1, rounding)));
  ASSERT_FALSE(plans_.empty());
  for (const FlightPlan& plan : plans_) EXPECT_TRUE(plan.from_one_period_on);
}

TEST_F(Sweep, TheHostIsStartedForTheCaseAndSpentWithIt) {
  bool is_spent = false;
  std::string course;
  RateSweepJob sweep = job([&](const HostOptions&, const Course& given) {
    course = given.the_case->id();
    GivenHost::Answers answers;
    answers.is_spent = [&] { return is_spent; };
    return std::make_unique<GivenHost>(answers);
  });
  ASSERT_TRUE(sweep.open());
  EXPECT_EQ(course, case_.id());
  EXPECT_FALSE(sweep.is_spent());
  is_spent = true;
  EXPECT_TRUE(sweep.is_spent());
}

TEST_F(Sweep, AHostThatCannotBeStartedIsAnError) {
  const auto opened =
      job([](const HostOptions&, const Course&) { return fail("no such port"); }).open();
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().message, "no such port");
}

TEST(SweepCodec, AResultIsReadAsItWasWritten) {
  RateSweepResult rate, delay;
  rate.result.profile = delay.result.profile = "px4-v1.5.5";
  rate.result.group = delay.result.group = "flight";
  rate.result.name = delay.result.name = "hover";
  rate.result.verdict = Verdict::crash;
  rate.result.reason = "it went wrong";
  rate.lowest_rate_hz = -1;
  rate.trials = {{333, 0.1, {0.25, 4.9e-324, unbounded}, false}, {20, 0, {}, false}};
  delay.largest_delay_ms = 7.3;
  using SweepCodec = Codec<RateSweepResult>;
  const auto rate_read = SweepCodec::decode(SweepCodec::encode(rate));
  ASSERT_TRUE(rate_read) << rate_read.error().to_string();
  EXPECT_EQ(rate_read->result.verdict, Verdict::crash);
  EXPECT_EQ(rate_read->result.reason, "it went wrong");
  EXPECT_EQ(rate_read->lowest_rate_hz, -1);
  EXPECT_FALSE(rate_read->largest_delay_ms);
  ASSERT_EQ(rate_read->trials.size(), 2u);
  EXPECT_EQ(rate_read->trials[0].rate_hz, 333);
  EXPECT_EQ(rate_read->trials[0].delay_ms, 0.1);
  EXPECT_EQ(rate_read->trials[0].values, rate.trials[0].values);
  EXPECT_FALSE(rate_read->trials[0].holds);
  EXPECT_TRUE(rate_read->trials[1].values.empty());
  const auto delay_read = SweepCodec::decode(SweepCodec::encode(delay));
  ASSERT_TRUE(delay_read) << delay_read.error().to_string();
  EXPECT_EQ(delay_read->result.id(), delay.result.id());
  EXPECT_EQ(delay_read->largest_delay_ms, 7.3);
  EXPECT_FALSE(delay_read->lowest_rate_hz);
}

TEST(SweepCodec, AnErrorStaysAnError) {
  using SweepCodec = Codec<RateSweepResult>;
  const auto read = SweepCodec::decode(SweepCodec::encode(fail("no such rotor")));
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().message, "no such rotor");
}

}  // namespace
}  // namespace attest
