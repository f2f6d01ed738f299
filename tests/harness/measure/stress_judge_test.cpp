// Verdicts on handmade live flights: what fails, what cannot be judged, and in which order.
#include "harness/measure/stress_judge.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/casefile/parse.hpp"
#include "harness/loop/flight.hpp"
#include "harness/port/builtin.hpp"
#include "tests/harness/times.hpp"

namespace attest {
namespace {

using testing::HasSubstr;

const std::filesystem::path tree = ATTEST_SOURCE_DIR;

// A right port in hover for 100 ticks at 250 Hz, each in time.
class StressJudge : public testing::Test {
 protected:
  StressJudge() {
    task_.the_case = *parse_case(tree / "cases/px4-v1.5.5/flight/hover.toml");
    task_.the_case.duration = {0.4, Span::In::seconds};
    task_.the_case.flight->metrics.clear();
    task_.configuration = {Rate::hz(250), PlantConfiguration{"iris", PlantKind::mujoco}};
    task_.vehicle_model = *VehicleModel::load(tree / "models", "iris");
    const auto unit = open_builtin()->create("px4-v1.5.5");
    const Flown flown = *fly(task_.the_case, task_.configuration, *task_.vehicle_model, *unit);
    flight_.unit.samples = flown.trace.samples;
    flight_.unit.changes = flown.trace.parameters;
    for (std::int64_t k = 0; k < 100; ++k) {
      const Nanoseconds release = ms(4 * k);
      flight_.unit.ticks.push_back({k, release, release + ms(4), release, release, release});
      flight_.unit.ticks.back().commanded = release;
    }
    stress_.ticks = stress_.deadlines = 10'000;
  }

  VectorResult outputs() {
    VectorResult result;
    judge_outputs(task_.the_case, Module::mc_att_control, flight_.unit, std::nullopt, result);
    return result;
  }

  VectorResult timing() {
    judge_timing(budget_, stress_);
    return stress_.result;
  }

  // Changes the roll control from that tick on.
  void deviate_from(std::size_t tick) {
    for (std::size_t i = tick; i < flight_.unit.samples.size(); ++i) {
      flight_.unit.samples[i].out.actuator_controls_0.control[0] += 0.1f;
    }
  }

  StressTask task_;
  LiveFlight flight_;
  StressResult stress_;
  RealtimeBudget budget_{500, 100, 50};
};

TEST_F(StressJudge, OutputsThatAgreePass) {
  const VectorResult result = outputs();
  EXPECT_EQ(result.verdict, Verdict::pass) << result.reason;
  EXPECT_EQ(result.ticks, 100u);
}

TEST_F(StressJudge, AThreadThatUsedMoreThanItsStepsHasAWrongClock) {
  const std::vector<LiveTick> ticks(100, LiveTick{.elapsed = ms(1)});
  stress_.unit_usage.cpu = ms(320);
  judge_clock({}, ticks, stress_);
  EXPECT_EQ(stress_.result.verdict, Verdict::pass);
  stress_.unit_usage.cpu = ms(321);
  judge_clock({.spin = ms(1)}, ticks, stress_);
  EXPECT_EQ(stress_.result.verdict, Verdict::pass);
  judge_clock({}, ticks, stress_);
  EXPECT_EQ(stress_.result.verdict, Verdict::protocol);
  EXPECT_THAT(stress_.result.reason, HasSubstr("100 steps took 100 ms, but their thread used 321"));
}

TEST_F(StressJudge, OutputsThatDeviateFail) {
  deviate_from(10);
  const VectorResult result = outputs();
  EXPECT_EQ(result.verdict, Verdict::fail);
  EXPECT_EQ(result.first->tick, 10u);
}

TEST_F(StressJudge, OutputsAfterADecisionAtItsThresholdAreNotJudged) {
  for (std::size_t i = 50; i < 60; ++i) {
    flight_.unit.samples[i].in.vehicle_attitude_setpoint.thrust = 0.2f;
    flight_.unit.samples[i].in.updated |= ATTEST_UPDATED_VEHICLE_ATTITUDE_SETPOINT;
  }
  const auto samples = flight_.unit.samples;
  deviate_from(70);
  const VectorResult after = outputs();
  EXPECT_EQ(after.verdict, Verdict::skip);
  EXPECT_THAT(after.reason, HasSubstr("too near to a decision (thrust gate)"));
  flight_.unit.samples = samples;
  deviate_from(10);
  EXPECT_EQ(outputs().verdict, Verdict::fail);
}

TEST_F(StressJudge, OutputsThatAreNotFiniteFailAtAThresholdToo) {
  flight_.unit.samples[50].in.vehicle_attitude_setpoint.thrust = 0.2f;
  flight_.unit.samples[70].out.actuator_controls_0.control[0] = NAN;
  EXPECT_EQ(outputs().verdict, Verdict::non_finite);
}

TEST_F(StressJudge, OutputsThatWereNotKeptAreNotJudged) {
  flight_.unit.samples.resize(60);
  const auto samples = flight_.unit.samples;
  const VectorResult some = outputs();
  EXPECT_EQ(some.verdict, Verdict::skip);
  EXPECT_THAT(some.reason, HasSubstr("the first 60 of 100 ticks only"));
  flight_.unit.samples = samples;
  deviate_from(10);
  EXPECT_EQ(outputs().verdict, Verdict::fail);
  flight_.unit.samples.clear();
  EXPECT_EQ(outputs().verdict, Verdict::skip);
}

TEST_F(StressJudge, AFlightThatTheReferenceKeepsFails) {
  flight_.plant.divergence = Divergence{ms(300), "it fell"};
  VectorResult result;
  add_skip(result, "outputs not judged");
  judge_flight_end(task_, flight_, result);
  EXPECT_EQ(result.verdict, Verdict::fail);
  EXPECT_EQ(result.reason,
            "the flight ended at 0.300 s: it fell; the reference does not lose the vehicle at the "
            "same times; "
            "outputs not judged");
}

TEST_F(StressJudge, AFlightThatTheReferenceLosesTooIsNotJudged) {
  task_.the_case.flight->start.rate_rad_s = {200, 0, 0};  // above what a plant can have
  flight_.plant.divergence = Divergence{ms(300), "it fell"};
  VectorResult result;
  add_skip(result, "outputs not judged");
  judge_flight_end(task_, flight_, result);
  EXPECT_EQ(result.verdict, Verdict::skip);
  EXPECT_THAT(result.reason, HasSubstr("the reference loses the vehicle too"));
}

TEST_F(StressJudge, AFlightThatEndsWithRightOutputsIsNotJudged) {
  flight_.plant.divergence = Divergence{ms(300), "it fell"};
  VectorResult result = outputs();
  judge_flight_end(task_, flight_, result);
  EXPECT_EQ(result.verdict, Verdict::skip);
}

TEST_F(StressJudge, TimingWithinTheBudgetPasses) {
  stress_.misses = {3, 2, 5, 100, 100};
  stress_.overruns = 5;
  stress_.plant_steps = 100;
  stress_.plant_late_steps = 1;
  EXPECT_EQ(timing().verdict, Verdict::pass) << stress_.result.reason;
}

TEST_F(StressJudge, OverrunsAndMissesAndLateStartsOfThePortFail) {
  stress_.overruns = 6;
  EXPECT_THAT(timing().reason, HasSubstr("6 overruns of the execution time of 50 us: 600 per"));
  EXPECT_EQ(stress_.result.verdict, Verdict::fail);
  stress_.result = {};
  stress_.overruns = 0;
  stress_.misses = {5, 5, 6, 0, 0};
  EXPECT_THAT(timing().reason, HasSubstr("6 of 10 deadline misses are caused by the port"));
  EXPECT_EQ(stress_.result.verdict, Verdict::fail);
  stress_.result = {};
  stress_.misses = {0, 0, 0, 101, 101};
  EXPECT_THAT(timing().reason, HasSubstr("101 of 10000 steps start more than 100 us after"));
  EXPECT_EQ(stress_.result.verdict, Verdict::fail);
}

TEST_F(StressJudge, WhatTheMachineMissesIsNotJudged) {
  stress_.misses = {5, 5, 5, 0, 0};
  EXPECT_EQ(timing().verdict, Verdict::skip);
  stress_.result = {};
  stress_.misses = {0, 0, 0, 101, 100};
  EXPECT_THAT(timing().reason,
              HasSubstr("101 of 10000 steps start more than 100 us after their release, budget 1%; "
                        "100 of them because the step before runs too long"));
  EXPECT_EQ(stress_.result.verdict, Verdict::skip);
  stress_.result = {};
  stress_.misses = {};
  stress_.plant_steps = 100;
  stress_.plant_late_steps = 2;
  EXPECT_EQ(timing().verdict, Verdict::skip);
}

TEST_F(StressJudge, AFaultOfThePortIsJudgedOnAMachineThatIsLateToo) {
  stress_.plant_steps = 100;
  stress_.plant_late_steps = 50;
  stress_.misses = {5000, 0, 2000, 5000, 2000};
  EXPECT_EQ(timing().verdict, Verdict::fail);
}

TEST_F(StressJudge, TimingIsJudgedWhereOutputsAreNot) {
  add_skip(stress_.result, "outputs not judged");
  EXPECT_EQ(timing().verdict, Verdict::skip);
  stress_.overruns = 6;
  EXPECT_EQ(timing().verdict, Verdict::fail);
  EXPECT_THAT(stress_.result.reason, testing::EndsWith("; outputs not judged"));
}

TEST_F(StressJudge, OutputsThatFailKeepTheirVerdict) {
  deviate_from(10);
  stress_.result = outputs();
  stress_.misses = {50, 50, 0, 0, 0};
  EXPECT_EQ(timing().verdict, Verdict::fail);
  EXPECT_THAT(stress_.result.reason, testing::StartsWith("outputs differ from the reference's; "));
}

}  // namespace
}  // namespace attest
