// A simulated flight, by a host whose answers the test gives: verdict, metrics and file.
#include "harness/verify/simulate.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/core/file.hpp"
#include "harness/golden/reference.hpp"
#include "harness/host/file_format.hpp"
#include "harness/loop/case_timing.hpp"
#include "harness/trace/csv.hpp"
#include "tests/harness/core/temporary_directory.hpp"
#include "tests/harness/realtime/flights.hpp"
#include "tests/harness/times.hpp"
#include "tests/harness/verify/given_host.hpp"

namespace attest {
namespace {

using testing::HasSubstr;

// The vehicle sinks by half a metre, and turns with at most 2 rad/s.
Flown two_ticks() {
  Flown flown;
  flown.trace.present = channels_of(Module::mc_att_control);
  flown.trace.samples.resize(2);
  flown.trace.samples[0].in.timestamp = 5'000'000;
  flown.trace.samples[1].in.timestamp = 5'004'000;
  flown.trace.plant.resize(2);
  flown.trace.plant[1].position_m[2] = 0.5f;
  flown.trace.plant[0].rate_rad_s = {2, 0, 0};
  return flown;
}

Metric bounded(const std::string& name, Measure measure, double min, double max) {
  Metric metric;
  metric.name = name;
  metric.measure = measure;
  metric.min = min;
  metric.max = max;
  return metric;
}

Metric holds_height() { return bounded("height", Measure::sink_m, 0, 1); }
Metric sinks_too_far() { return bounded("far", Measure::sink_m, 0, 0.25); }
Metric sinks_too_little() { return bounded("little", Measure::sink_m, 0.75, 1); }
Metric turns_slowly() { return bounded("turns", Measure::peak_rate_rad_s, 0, 3); }

class Simulate : public testing::Test {
 protected:
  Simulate() {
    answers_.fly = [this](const FlightPlan& plan) -> Result<Flown> {
      plans_.push_back(plan);
      return flown_;
    };
  }

  Result<VectorResult> simulated() {
    GivenHost host(answers_);
    auto flight = simulate_flight(case_, plan_, host);
    if (!flight) return tl::unexpected(flight.error());
    if (flight->flown.trace.samples.empty()) return flight->result;
    auto file = AtomicFile::open(out_);
    if (!file) return tl::unexpected(file.error());
    if (auto done = write_trace(*std::move(file), flight->flown.trace); !done) {
      return tl::unexpected(done.error());
    }
    return flight->result;
  }

  Verdict verdict_on(std::vector<Metric> metrics) {
    case_.flight->metrics = std::move(metrics);
    return simulated()->verdict;
  }

  std::string written() const { return *read_file(out_); }

  TemporaryDirectory directory_;
  std::filesystem::path out_ = directory_.write("flown.csv", "of the flight before");
  Case case_ = test::hover_case(0.008);
  FlightPlan plan_{{Rate::hz(250), PlantConfiguration{"iris", PlantKind::ode}},
                   case_timing(case_, Rate::hz(250))};
  Flown flown_ = two_ticks();
  GivenHost::Answers answers_;
  std::vector<FlightPlan> plans_;
};

TEST_F(Simulate, AFlightWithinItsBoundsPasses) {
  case_.flight->metrics = {holds_height(), turns_slowly()};
  const auto result = simulated();
  ASSERT_TRUE(result) << result.error().to_string();
  EXPECT_EQ(result->verdict, Verdict::pass);
  EXPECT_EQ(result->id(), "px4-v1.5.5/flight/hover@250hz-iris-ode");
  EXPECT_EQ(result->ticks, 2u);
}

TEST_F(Simulate, AFlightWithoutMetricsPasses) { EXPECT_EQ(verdict_on({}), Verdict::pass); }

TEST_F(Simulate, OneMetricBeyondItsBoundsFailsWhereverItStands) {
  EXPECT_EQ(verdict_on({sinks_too_far()}), Verdict::fail);
  EXPECT_EQ(verdict_on({sinks_too_little()}), Verdict::fail);
  EXPECT_EQ(verdict_on({sinks_too_far(), holds_height(), turns_slowly()}), Verdict::fail);
  EXPECT_EQ(verdict_on({holds_height(), sinks_too_little(), turns_slowly()}), Verdict::fail);
  EXPECT_EQ(verdict_on({holds_height(), turns_slowly(), sinks_too_far()}), Verdict::fail);
}

TEST_F(Simulate, NotesTheFirstOutputThatDeviates) {
  const ModuleUnderTest controller{"px4-v1.5.5", Module::mc_att_control};
  SimulatedFlight flight;
  flight.flown.trace = *reference_outputs(controller, two_ticks().trace);
  Declarations port;
  ASSERT_TRUE(note_deviations(case_, port, flight));
  EXPECT_FALSE(flight.result.first);

  flight.flown.trace.samples[1].out.mc_att_ctrl_status.roll_rate_integ += 0.5f;
  ASSERT_TRUE(note_deviations(case_, port, flight));
  ASSERT_TRUE(flight.result.first);
  EXPECT_EQ(flight.result.first->tick, 1u);
  EXPECT_EQ(channels()[flight.result.first->channel].name,
            "out/mc_att_ctrl_status.roll_rate_integ");
  EXPECT_EQ(flight.result.verdict, Verdict::pass);

  port.lacks.outputs = channels_of(controller.module, "out/mc_att_ctrl_status.");
  ASSERT_TRUE(note_deviations(case_, port, flight));
  EXPECT_FALSE(flight.result.first);
}

TEST_F(Simulate, AMetricThatIsNoNumberFails) {
  flown_.trace.plant[1].position_m[2] = NAN;
  EXPECT_EQ(verdict_on({holds_height(), turns_slowly()}), Verdict::fail);
}

TEST_F(Simulate, EachMetricIsReportedWithItsBounds) {
  case_.flight->metrics = {sinks_too_far(), turns_slowly()};
  const auto result = simulated();
  ASSERT_EQ(result->metrics.size(), 2u);
  const MetricResult &sink = result->metrics[0], &turn = result->metrics[1];
  EXPECT_EQ(sink.name, "far");
  EXPECT_EQ(sink.measure, Measure::sink_m);
  EXPECT_EQ(sink.value, 0.5);
  EXPECT_EQ(sink.min, 0);
  EXPECT_EQ(sink.max, 0.25);
  EXPECT_FALSE(sink.within());
  EXPECT_EQ(turn.name, "turns");
  EXPECT_EQ(turn.value, 2);
  EXPECT_EQ(turn.max, 3);
  EXPECT_TRUE(turn.within());
}

TEST_F(Simulate, TheFlownTraceIsWrittenWithTheTruth) {
  ASSERT_TRUE(simulated());
  EXPECT_THAT(written(), HasSubstr("plant/"));
  const auto read = read_csv(out_, TraceNeed::inputs_and_outputs);
  ASSERT_TRUE(read) << read.error().to_string();
  ASSERT_EQ(read->samples.size(), 2u);
  EXPECT_EQ(read->samples[1].in.timestamp, 5'004'000u);
}

TEST_F(Simulate, AFlightThatEndsEarlyFailsWithoutMetricsAndIsWritten) {
  case_.flight->metrics = {holds_height()};
  flown_.divergence = Divergence{ms(8), "it fell"};
  const auto result = simulated();
  ASSERT_TRUE(result) << result.error().to_string();
  EXPECT_EQ(result->verdict, Verdict::fail);
  EXPECT_EQ(result->reason, "the flight ended at 0.008 s (tick 2): it fell");
  EXPECT_EQ(result->ticks, 2u);
  EXPECT_TRUE(result->metrics.empty());
  EXPECT_THAT(written(), HasSubstr("plant/"));
}

TEST_F(Simulate, WhenThePortGoesWrongTheFileIsNotTouched) {
  case_.flight->metrics = {holds_height()};
  flown_.fault = PortFault{PortFault::Kind::timeout, 1, "no answer"};
  const auto result = simulated();
  ASSERT_TRUE(result) << result.error().to_string();
  EXPECT_EQ(result->verdict, Verdict::timeout);
  EXPECT_EQ(result->reason, "no answer");
  EXPECT_TRUE(result->metrics.empty());
  EXPECT_EQ(written(), "of the flight before");
}

TEST_F(Simulate, ThePlanIsFlownAsItIs) {
  plan_.timing.unit.back().begins += us(70);
  ASSERT_TRUE(simulated());
  ASSERT_EQ(plans_.size(), 1u);
  EXPECT_EQ(plans_[0].configuration, plan_.configuration);
  EXPECT_EQ(plans_[0].timing, plan_.timing);
  EXPECT_FALSE(plans_[0].from_one_period_on);
}

TEST_F(Simulate, APortThatDeclinesTheGroupIsNotFlown) {
  answers_.says.unsupported_groups = {"flight"};
  EXPECT_EQ(simulated()->verdict, Verdict::unsupported);
  EXPECT_TRUE(plans_.empty());
  EXPECT_EQ(written(), "of the flight before");
}

TEST_F(Simulate, APortWithAFixedStepFliesAtItsOwnTimesOnlyFromOnePeriodOn) {
  answers_.says.fixed_step = Rate::hz(500);
  EXPECT_EQ(simulated()->verdict, Verdict::unsupported);
  answers_.says.fixed_step = Rate::hz(250);
  const FlightTiming in_time = plan_.timing;
  plan_.timing.unit.back().begins += us(70);
  EXPECT_EQ(simulated()->verdict, Verdict::unsupported);
  EXPECT_TRUE(plans_.empty());
  plan_.timing = in_time;
  EXPECT_EQ(simulated()->verdict, Verdict::pass);
  ASSERT_EQ(plans_.size(), 1u);
  EXPECT_TRUE(plans_[0].from_one_period_on);
}

TEST_F(Simulate, WhatCannotBeFlownOrWrittenIsAnError) {
  out_ = directory_.path() / "no_such_folder" / "flown.csv";
  EXPECT_FALSE(simulated());
  answers_.fly = [](const FlightPlan&) { return fail("no such rotor"); };
  const auto result = simulated();
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().message, "no such rotor");
}

}  // namespace
}  // namespace attest
