#include "harness/measure/stress.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/casefile/parse.hpp"
#include "harness/measure/stress_json.hpp"
#include "tests/harness/core/temporary_directory.hpp"
#include "tests/harness/measure/one_tick_flight.hpp"
#include "tests/harness/times.hpp"
#include "tests/harness/verify/small_suite.hpp"

namespace attest {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

const std::filesystem::path source = ATTEST_SOURCE_DIR;

StressTask hover_task() {
  StressTask task;
  task.the_case = *parse_case(source / "cases/px4-v1.5.5/flight/hover.toml");
  task.the_case.duration = {0.3, Span::In::seconds};
  // Budgets that hold on any machine: verdicts on timing are tested in stress_judge_test.
  task.the_case.flight->realtime = {1e6, 1e9, std::nullopt};
  task.configuration = {Rate::hz(250), PlantConfiguration{"iris", PlantKind::mujoco}};
  task.vehicle_model = *VehicleModel::load(source / "models", "iris");
  task.live.fifo = false;
  task.live.unit_cpu = task.live.plant_cpu = usable_cpus().front();
  task.idle_duration = std::chrono::milliseconds(20);
  return task;
}

Result<StressResult> only(Result<StressResults> results) {
  if (!results) return tl::unexpected(results.error());
  EXPECT_EQ(results->size(), 1u);
  return results->front();
}

Result<StressResult> stressed(const HostOptions& host, const StressTask& task = hover_task()) {
  return only(run_stress(
      task, host, [] { return false; }, [](const StressProgress&) {}));
}
Result<StressResult> stressed(const std::string& port, const StressTask& task = hover_task()) {
  return stressed(HostOptions{port}, task);
}

TEST(Stress, ARightPortIsJudgedByItsOutputsToo) {
  const auto stress = stressed("builtin");
  ASSERT_TRUE(stress) << stress.error().to_string();
  // On a machine that cannot step the plant in time there is no verdict.
  if (stress->result.verdict == Verdict::skip) GTEST_SKIP() << stress->result.reason;
  EXPECT_EQ(stress->result.verdict, Verdict::pass) << stress->result.reason;
  EXPECT_EQ(stress->deadlines, 75u);
  EXPECT_EQ(stress->ticks + stress->misses.skipped, 75u);
  EXPECT_EQ(stress->execution.count, stress->ticks);
  EXPECT_EQ(stress->response.count, stress->ticks);
  EXPECT_FALSE(stress->response.p99);  // of 75 steps
  EXPECT_FALSE(stress->response.buckets.empty());
  EXPECT_GT(stress->idle.count, 0u);
}

TEST(Stress, AWrongPortFailsWhateverItsTiming) {
  const auto flip = stressed(test_port("sign_flip"));
  ASSERT_TRUE(flip) << flip.error().to_string();
  EXPECT_EQ(flip->result.verdict, Verdict::fail);
  ASSERT_TRUE(flip->result.first);
}

TEST(Stress, APortWithAFixedStepIsNotPassed) {
  for (const char* port : {"fixed_step", "fixed_step_gain_off"}) {
    StressTask task = hover_task();
    task.port = *describe_port(host_of(test_port(port)));
    const auto stress = stressed(test_port(port), task);
    ASSERT_TRUE(stress) << stress.error().to_string();
    EXPECT_EQ(stress->result.verdict, Verdict::skip) << stress->result.reason;
    EXPECT_THAT(stress->result.reason, HasSubstr("outputs not judged: a fixed step"));
    EXPECT_EQ(stress->deadlines, 75u);
  }
}

TEST(Stress, APortThatDiesHasAVerdict) {
  const auto crash = stressed(test_port("crash"));
  ASSERT_TRUE(crash) << crash.error().to_string();
  EXPECT_EQ(crash->result.verdict, Verdict::crash);
  EXPECT_THAT(crash->result.reason, HasSubstr("the port's process "));
  EXPECT_THAT(crash->result.reason, HasSubstr(" in step() at tick 20"));
  EXPECT_EQ(stressed(test_port("step_fails"))->result.verdict, Verdict::fail);
  EXPECT_EQ(stressed(test_port("refuses_profile"))->result.verdict, Verdict::skip);
  EXPECT_FALSE(stressed("lib:no_such_library.so"));
}

TEST(Stress, APortThatHangsAnywhereHasAVerdict) {
  for (const auto& [port, where] : {std::pair("hangs_in_load", ", when it was loaded"),
                                    {"hangs_in_create", " in create()"},
                                    {"hang", " in step() at tick 20"},
                                    {"hangs_in_destroy", " in destroy()"}}) {
    HostOptions host{test_port(port)};
    host.timeout_s = 0.3;
    const auto stress = stressed(host);
    ASSERT_TRUE(stress) << stress.error().to_string();
    EXPECT_EQ(stress->result.verdict, Verdict::timeout);
    EXPECT_EQ(stress->result.reason, std::string("no answer within 0.3 s of CPU time") + where);
  }
}

TEST(Stress, APortThatDeclinesTheFlightIsNotStarted) {
  StressTask other_step = hover_task(), other_group = hover_task();
  other_step.port.fixed_step = Rate::hz(500);
  other_group.port.unsupported_groups = {"flight"};
  for (const StressTask& task : {other_step, other_group}) {
    const auto stress = stressed("lib:nowhere.so", task);
    ASSERT_TRUE(stress) << stress.error().to_string();
    EXPECT_EQ(stress->result.verdict, Verdict::unsupported);
    EXPECT_EQ(stress->result.id(), "px4-v1.5.5/flight/hover@250hz-iris-mujoco");
  }
}

TEST(Stress, APortThatDoesNotSupportTheProfileIsSkipped) {
  const auto stress = stressed(test_port("refuses_profile"));
  ASSERT_TRUE(stress) << stress.error().to_string();
  EXPECT_EQ(stress->result.verdict, Verdict::skip);
  EXPECT_EQ(stress->result.reason, "the port does not support profile px4-v1.5.5");
}

TEST(Stress, APortThatMadeAUnitBeforeMustMakeOneAgain) {
  HostOptions host{test_port("refuses_profile")};
  ASSERT_TRUE(prepare_port(host));
  host.said->profiles = {"px4-v1.5.5"};
  const auto stress = stressed(host);
  ASSERT_TRUE(stress) << stress.error().to_string();
  EXPECT_EQ(stress->result.verdict, Verdict::protocol);
  EXPECT_THAT(stress->result.reason, HasSubstr("it made a unit when the port was asked first"));
}

// 75 ticks and 25 skipped releases in a quarter of a second. Without samples the outputs cannot be
// judged.
LiveFlight flight_without_samples() {
  LiveFlight flight;
  flight.unit.ticks.resize(75);
  for (LiveTick& tick : flight.unit.ticks) tick.deadline = ms(4);
  flight.unit.ticks.back().begins = ms(250);
  flight.unit.skipped = 25;
  return flight;
}

TEST(JudgeLive, OutputsAndTimingAreJudgedTogether) {
  StressTask task = hover_task();
  task.the_case.flight->realtime = {500, 100, 50};
  LiveFlight flight = flight_without_samples();
  flight.unit.ticks[7].elapsed = flight.unit.ticks[7].cpu = us(51);
  const auto stress = only(judge_live(task, {}, std::move(flight)));
  ASSERT_TRUE(stress) << stress.error().to_string();
  EXPECT_EQ(stress->result.verdict, Verdict::fail);
  EXPECT_THAT(stress->result.reason,
              StartsWith("1 overruns of the execution time of 50 us: 10000"));
  EXPECT_THAT(stress->result.reason, HasSubstr("outputs not judged: no step finished"));
  EXPECT_EQ(stress->result.ticks, 75u);
  EXPECT_DOUBLE_EQ(stress->result.elapsed_s, 0.25);
}

TEST(JudgeLive, AFaultOfThePortIsTheVerdict) {
  for (const bool in_step : {false, true}) {
    LiveFlight flight = flight_without_samples();
    (in_step ? flight.unit.fault : flight.fault) =
        PortFault{PortFault::Kind::protocol, 3, "it wrote beyond its struct"};
    const auto stress = only(judge_live(hover_task(), {}, std::move(flight)));
    ASSERT_TRUE(stress) << stress.error().to_string();
    EXPECT_EQ(stress->result.verdict, Verdict::protocol);
    EXPECT_EQ(stress->result.reason, "it wrote beyond its struct");
  }
}

TEST(JudgeLive, WritesTheTimesOfTheFlightWhereTheTaskSaysSo) {
  const StressTask task = hover_task();
  const auto read = written_times(task, one_tick_flight(us(3)));
  ASSERT_TRUE(read) << read.error().to_string();
  EXPECT_EQ(read->case_id, "px4-v1.5.5/flight/hover");
  EXPECT_EQ(read->case_sha256, task.the_case.sha256);
  EXPECT_EQ(read->configuration, task.configuration);
  EXPECT_DOUBLE_EQ(read->duration_s, 0.3);
  EXPECT_EQ(read->ticks, (LoopTiming{{us(1), us(2), us(3)}}));
}

TEST(JudgeLive, TimesThatCannotBeWrittenAreAnError) {
  StressTask task = hover_task();
  task.record_timing = std::make_shared<AtomicFile>(*AtomicFile::open("/dev/full"));
  EXPECT_FALSE(judge_live(task, {}, flight_without_samples()));
}

TEST(StressJson, HasThePercentilesThatThereAreAndTheUnits) {
  StressResult stress;
  const auto ns = [](std::int64_t count) { return Nanoseconds(count); };
  stress.response = {1, ns(2), ns(7), ns(3), {}, {}, {}, {{ns(2), ns(8), 1}}};
  stress.misses = {1, 2, 3, 4, 5};
  stress.slow = {ns(20), 2, {{7, ns(300), ns(290)}}, Rhythm{1000, 7, 1e-5}};
  const nlohmann::json json = to_json(stress);
  EXPECT_EQ(json["response_time"],
            nlohmann::json::parse(R"({"count": 1, "min_ns": 2, "max_ns": 7, "median_ns": 3,
                                      "buckets": [{"from_ns": 2, "below_ns": 8, "count": 1}]})"));
  EXPECT_EQ(json["deadline_misses"], 3);
  EXPECT_EQ(json["slow_steps"]["rhythm"]["every_steps"], 1000);
}

}  // namespace
}  // namespace attest
