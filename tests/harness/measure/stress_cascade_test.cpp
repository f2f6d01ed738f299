// Live flights of the cascade: which units are judged, and by what.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/casefile/parse.hpp"
#include "harness/host/port_process.hpp"
#include "harness/measure/stress.hpp"
#include "tests/harness/measure/one_tick_flight.hpp"
#include "tests/harness/times.hpp"

namespace attest {
namespace {

using testing::HasSubstr;

const std::filesystem::path source = ATTEST_SOURCE_DIR;

ModuleSet both_units() { return only(Module::attitude_unit) | only(Module::rate_unit); }

StressTask cascade_task(const char* name = "hover.toml") {
  StressTask task;
  task.the_case = *parse_case(source / "cases/px4-v1.16.0/flight" / name);
  task.the_case.duration = {0.5, Span::In::seconds};
  // Budgets that hold on any machine: verdicts on timing are tested in stress_judge_test.
  task.the_case.flight->realtime = {1e6, 1e9, std::nullopt};
  task.configuration = {LoopRate(Rate::hz(100), Rate::hz(500)),
                        PlantConfiguration{"iris", PlantKind::mujoco}};
  task.vehicle_model = *VehicleModel::load(source / "models", "iris");
  task.live.fifo = false;
  task.live.unit_cpu = task.live.plant_cpu = usable_cpus().front();
  task.idle_duration = std::chrono::milliseconds(20);
  task.port.modules = both_units();
  return task;
}

StressResults stressed(const std::string& port, StressTask task) {
  HostOptions host{port};
  task.port = *prepare_port(host, {task.the_case.profile});
  auto results = run_stress(
      task, host, [] { return false; }, [](const StressProgress&) {});
  if (!results) throw std::runtime_error(results.error().to_string());
  return *std::move(results);
}

TEST(StressCascade, BothUnitsHaveAResult) {
  const StressResults results = stressed("builtin", cascade_task());
  ASSERT_EQ(results.size(), 2u);
  EXPECT_EQ(results[0].module, Module::rate_unit);
  EXPECT_EQ(results[0].deadlines, 250u);
  EXPECT_EQ(results[1].module, Module::attitude_unit);
  EXPECT_EQ(results[1].deadlines, 50u);
  EXPECT_EQ(results[1].unit_rate(), Rate::hz(100));
  for (const StressResult& stress : results) {
    EXPECT_FALSE(fails_a_run(stress.result.verdict)) << stress.result.reason;
    EXPECT_EQ(stress.result.ticks, stress.ticks);
    EXPECT_EQ(stress.result.deviating_ticks, 0u);
    EXPECT_FALSE(stress.result.first);
  }
}

TEST(StressCascade, OnlyTheWrongUnitFails) {
  constexpr std::size_t rate_unit = 0, attitude_unit = 1;
  const struct {
    const char* port;
    std::size_t wrong, right;
  } faults[] = {{"fault:cascade-error-is-angle", attitude_unit, rate_unit},
                {"fault:cascade-d-reversed", rate_unit, attitude_unit}};
  for (const auto& [port, wrong, right] : faults) {
    const StressResults results = stressed(port, cascade_task("tilt_step_30.toml"));
    ASSERT_EQ(results.size(), 2u);
    EXPECT_EQ(results[wrong].result.verdict, Verdict::fail) << port;
    EXPECT_FALSE(fails_a_run(results[right].result.verdict)) << results[right].result.reason;
  }
}

// A port could leave out a unit, and fly with that of the reference.
TEST(StressCascade, APortWhoseModulesChangeBreaksTheRules) {
  StressTask task = cascade_task();
  HostOptions host;
  task.port = *prepare_port(host, {"px4-v1.16.0"});
  task.port.modules = host.said->modules = only(Module::rate_unit);
  const auto results = run_stress(
      task, host, [] { return false; }, [](const StressProgress&) {});
  ASSERT_TRUE(results) << results.error().to_string();
  ASSERT_EQ(results->size(), 1u);
  EXPECT_EQ(results->front().result.verdict, Verdict::protocol);
}

// Without a step, so the outputs cannot be judged.
LiveFlight flight_without_a_step() {
  LiveFlight flight;
  flight.attitude_unit.emplace();
  return flight;
}

TEST(JudgeLiveCascade, AUnitOfTheReferenceIsNotJudged) {
  StressTask task = cascade_task();
  for (const Module module : {Module::rate_unit, Module::attitude_unit}) {
    task.port.modules = only(module);
    LiveFlight flight = flight_without_a_step();
    flight.plant.divergence = Divergence{ms(100), "it fell"};
    const auto results = judge_live(task, {}, std::move(flight));
    ASSERT_TRUE(results) << results.error().to_string();
    ASSERT_EQ(results->size(), 1u);
    EXPECT_EQ(results->front().module, module);
    EXPECT_THAT(results->front().result.reason, HasSubstr("the flight ended at 0.100 s"));
  }
}

TEST(JudgeLiveCascade, TheEndOfTheFlightCountsOnceForTheRateUnit) {
  LiveFlight flight = flight_without_a_step();
  flight.plant.divergence = Divergence{ms(100), "it fell"};
  const auto results = judge_live(cascade_task(), {}, std::move(flight));
  ASSERT_EQ(results->size(), 2u);
  EXPECT_THAT(results->at(0).result.reason, HasSubstr("the flight ended at 0.100 s"));
  EXPECT_THAT(results->at(1).result.reason, testing::Not(HasSubstr("the flight ended")));
}

TEST(JudgeLiveCascade, AFaultOfOneUnitEndsTheFlightOfTheOther) {
  LiveFlight flight = flight_without_a_step();
  flight.attitude_unit->fault =
      PortFault{PortFault::Kind::protocol, 3, "it wrote beyond its struct"};
  const auto results = judge_live(cascade_task(), {}, std::move(flight));
  ASSERT_EQ(results->size(), 2u);
  EXPECT_EQ(results->at(0).result.verdict, Verdict::skip);
  EXPECT_THAT(results->at(0).result.reason,
              HasSubstr("ended at a fault of the other unit: it wrote beyond"));
  EXPECT_EQ(results->at(1).result.verdict, Verdict::protocol);
}

TEST(JudgeLiveCascade, TheTimesOfBothUnitsAreWritten) {
  const StressTask task = cascade_task();
  LiveFlight flight = one_tick_flight(us(4));
  flight.attitude_unit.emplace().ticks = {one_tick(us(3))};
  const auto read = written_times(task, std::move(flight));
  ASSERT_TRUE(read) << read.error().to_string();
  EXPECT_EQ(read->configuration, task.configuration);
  EXPECT_EQ(read->ticks.unit, (LoopTiming{{us(1), us(2), us(4)}}));
  EXPECT_EQ(read->ticks.attitude_unit, (LoopTiming{{us(1), us(2), us(3)}}));
}

}  // namespace
}  // namespace attest
