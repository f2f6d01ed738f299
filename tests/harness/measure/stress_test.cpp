#include "harness/measure/stress.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/casefile/parse.hpp"
#include "harness/core/json_text.hpp"
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

Result<StressResult> stressed(const std::string& port, const StressTask& task = hover_task()) {
  return only(run_stress(
      task, HostOptions{port}, [] { return false; }, [](const StressProgress&) {}));
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
  EXPECT_THAT(crash->result.reason, HasSubstr("the process "));
  EXPECT_EQ(stressed(test_port("step_fails"))->result.verdict, Verdict::fail);
  EXPECT_EQ(stressed(test_port("refuses_profile"))->result.verdict, Verdict::skip);
  EXPECT_FALSE(stressed("lib:no_such_library.so"));
}

TEST(Stress, APortThatHangsAnywhereHasAVerdict) {
  StressTask task = hover_task();
  task.timeout = std::chrono::milliseconds(300);
  for (const char* port : {"hangs_in_load", "hangs_in_create"}) {
    const auto stress = stressed(test_port(port), task);
    ASSERT_TRUE(stress) << stress.error().to_string();
    EXPECT_EQ(stress->result.verdict, Verdict::timeout);
    EXPECT_EQ(stress->result.reason,
              port == std::string("hangs_in_load")
                  ? "no answer within 0.3 s, when it was loaded and created"
                  : "no answer in create() within 0.3 s, when it was loaded and created");
  }
  for (const char* port : {"hang", "hangs_in_destroy"}) {
    const auto stress = stressed(test_port(port), task);
    ASSERT_TRUE(stress) << stress.error().to_string();
    EXPECT_EQ(stress->result.verdict, Verdict::timeout) << stress->result.reason;
    EXPECT_THAT(stress->result.reason, HasSubstr("the port did not return in "));
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
  StressTask task = hover_task();
  task.port.profiles = {task.the_case.profile};
  const auto stress = stressed(test_port("refuses_profile"), task);
  ASSERT_TRUE(stress) << stress.error().to_string();
  EXPECT_EQ(stress->result.verdict, Verdict::protocol);
  EXPECT_THAT(stress->result.reason, HasSubstr("it made a unit when the port was asked first"));
}

// A measured flight without a step, so its outputs cannot be judged.
StressMeasurement measured_flight() {
  StressMeasurement measured;
  measured.flight.emplace();
  measured.stress.ticks = 75;
  measured.stress.deadlines = 100;
  measured.stress.wall = ms(250);
  return measured;
}

// The port shares the process that measures, and could set this verdict.
TEST(JudgeLive, AVerdictOfTheMeasurementIsNotBelieved) {
  StressMeasurement measured;
  measured.stress.result.verdict = Verdict::pass;
  measured.stress.result.name = "another";
  const auto stress = only(judge_live(hover_task(), std::move(measured)));
  ASSERT_TRUE(stress) << stress.error().to_string();
  EXPECT_EQ(stress->result.verdict, Verdict::skip);
  EXPECT_EQ(stress->result.name, "hover");
}

TEST(JudgeLive, OutputsAndTimingAreJudgedTogether) {
  StressTask task = hover_task();
  task.the_case.flight->realtime = {500, 100, 50};
  StressMeasurement measured = measured_flight();
  measured.stress.overruns = 1;
  const auto stress = only(judge_live(task, std::move(measured)));
  ASSERT_TRUE(stress) << stress.error().to_string();
  EXPECT_EQ(stress->result.verdict, Verdict::fail);
  EXPECT_THAT(stress->result.reason,
              StartsWith("1 overruns of the execution time of 50 us: 10000"));
  EXPECT_THAT(stress->result.reason, HasSubstr("outputs not judged: no step finished"));
  EXPECT_EQ(stress->result.ticks, 75u);
  EXPECT_DOUBLE_EQ(stress->result.elapsed_s, 0.25);
}

TEST(JudgeLive, AFaultOfThePortIsTheVerdict) {
  StressMeasurement measured = measured_flight();
  measured.flight->unit.fault =
      PortFault{PortFault::Kind::protocol, 3, "it wrote beyond its struct"};
  measured.stress.overruns = 1;
  const auto stress = only(judge_live(hover_task(), std::move(measured)));
  ASSERT_TRUE(stress) << stress.error().to_string();
  EXPECT_EQ(stress->result.verdict, Verdict::protocol);
  EXPECT_EQ(stress->result.reason, "it wrote beyond its struct");
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
  EXPECT_FALSE(judge_live(task, measured_flight()));
}

TEST(StressJson, IsReadAsItWasWritten) {
  StressResult stress;
  stress.result.profile = "px4-v1.5.5";
  stress.result.group = "flight";
  stress.result.name = "hover";
  stress.result.rate = Rate::hz(333);
  stress.result.plant_configuration = PlantConfiguration{"iris", PlantKind::ode};
  const auto ns = [](std::int64_t count) { return Nanoseconds(count); };
  stress.execution = {1, ns(2), ns(7), ns(3), ns(4), ns(5), ns(6), {{ns(2), ns(8), 1}}};
  stress.response = {1, ns(2), ns(7), ns(3), {}, {}, {}, {}};
  stress.deadlines = 10;
  stress.misses = {1, 2, 3, 4, 5};
  stress.waiting_steps = 6;
  stress.unit_usage = {ns(1), 2, 3, 4, 5};
  stress.privileges = {{"mlockall", false, "no \xff"}};
  stress.slow = {ns(20), 2, {{7, ns(300), ns(290)}}, Rhythm{1000, 7, 1e-5}};
  const nlohmann::json json = to_json(stress);
  const std::string text = text_of(json);
  const auto read = stress_from_json(nlohmann::json::parse(text));
  ASSERT_TRUE(read) << read.error().to_string();
  EXPECT_EQ(read->misses, stress.misses);
  EXPECT_FALSE(json["response_time"].contains("p90_ns"));
  nlohmann::json expected = nlohmann::json::parse(text);
  EXPECT_EQ(to_json(*read), expected);
}

TEST(StressJson, ThatIsNotWholeIsRefused) {
  const nlohmann::json whole = to_json(StressResult{});
  EXPECT_FALSE(stress_from_json(nlohmann::json()));
  for (const auto& [key, value] : whole.items()) {
    if (key == "deadline_misses") continue;  // the sum of two others
    nlohmann::json broken = whole;
    broken.erase(key);
    EXPECT_FALSE(stress_from_json(broken)) << key;
    broken[key] = "?";
    EXPECT_FALSE(stress_from_json(broken)) << key;
  }
}

}  // namespace
}  // namespace attest
