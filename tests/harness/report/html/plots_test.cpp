#include "harness/report/html/plots.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/report/html/plot_data.hpp"
#include "harness/verify/saved_traces.hpp"
#include "tests/harness/core/temporary_directory.hpp"
#include "tests/harness/report/sample_run.hpp"

namespace attest {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr std::size_t unlimited = 1'000'000;

VectorResult failed(const std::string& group, const std::string& name, int rate_hz) {
  VectorResult result = passed(group, name, Rate::hz(rate_hz));
  result.verdict = Verdict::fail;
  result.first = deviation("out/vehicle_rates_setpoint.yaw", 2, 1.5f, 0.5f, 2e-4);
  result.deviating_ticks = 1;
  return result;
}

std::vector<std::string> ids(const std::vector<const VectorResult*>& results) {
  std::vector<std::string> out;
  for (const VectorResult* result : results) out.push_back(result->id());
  return out;
}

TEST(VectorsToPlot, AreTheFirstFailureOfEachGroupAndRate) {
  RunResult run;
  run.results = {passed("attitude", "a", Rate::hz(250)), failed("attitude", "b", 250),
                 failed("attitude", "c", 250), failed("attitude", "c", 500),
                 failed("tpa", "d", 500)};
  run.results.push_back(failed("mixer", "e", 250));
  run.results.back().first.reset();  // a crash has no deviation
  EXPECT_THAT(ids(vectors_to_plot(run)),
              ElementsAre("px4-v1.5.5/attitude/b@250hz", "px4-v1.5.5/attitude/c@500hz",
                          "px4-v1.5.5/tpa/d@500hz"));
}

TEST(VectorsToPlot, TheNamedCaseIsTheFirstToBeTaken) {
  RunResult run;
  run.results = {failed("attitude", "a", 250), failed("attitude", "b", 250),
                 failed("attitude", "b", 500), failed("tpa", "c", 250)};
  EXPECT_THAT(ids(vectors_to_plot(run, "px4-v1.5.5/attitude/b", 1)),
              ElementsAre("px4-v1.5.5/attitude/b@250hz"));
  EXPECT_THAT(ids(vectors_to_plot(run, "px4-v1.5.5/attitude/b")), testing::SizeIs(4));
}

TEST(VectorsToPlot, EveryGroupHasOneBeforeAGroupHasTwo) {
  RunResult run;
  run.results = {failed("attitude", "a", 250), failed("attitude", "a", 500),
                 failed("tpa", "b", 250), failed("tpa", "b", 500)};
  EXPECT_THAT(ids(vectors_to_plot(run, {}, 3)),
              ElementsAre("px4-v1.5.5/attitude/a@250hz", "px4-v1.5.5/attitude/a@500hz",
                          "px4-v1.5.5/tpa/b@250hz"));
  EXPECT_THAT(ids(vectors_to_plot(run, {}, 2)),
              ElementsAre("px4-v1.5.5/attitude/a@250hz", "px4-v1.5.5/tpa/b@250hz"));
}

// A run whose two vectors fail with 1.5 instead of 0.5 at tick 2, and their saved traces.
class Plots : public testing::Test {
 protected:
  Plots() {
    run_.results = {failed("attitude", "a", 250), failed("tpa", "b", 250)};
    Trace want;
    want.source = "a test";
    want.present = channels_of(Module::mc_att_control);
    for (std::uint64_t tick = 0; tick < 5; ++tick) {
      Sample& sample = want.samples.emplace_back();
      sample.in.timestamp = 1000 + 4000 * tick;
      sample.out.vehicle_rates_setpoint.yaw = 0.5f;
    }
    Trace got = want;
    got.samples[2].out.vehicle_rates_setpoint.yaw = 1.5f;
    for (VectorResult& result : run_.results) {
      save_traces(folder_.path(), {result.profile}, {got, want, Tolerances()}, result);
      EXPECT_EQ(result.reason, "");
    }
  }

  nlohmann::json plots() const {
    return nlohmann::json::parse(plots_json(run_, folder_.path(), unlimited));
  }

  TemporaryDirectory folder_;
  RunResult run_;
};

TEST_F(Plots, HaveTheDeviatingSignalsAtAllTicks) {
  const auto vector = plots().at("px4-v1.5.5/attitude/a@250hz");
  EXPECT_EQ(vector.at("ticks"), 5);
  EXPECT_EQ(vector.at("repeated"), true);
  ASSERT_EQ(vector.at("signals").size(), 1u);
  const auto& signal = vector.at("signals")[0];
  EXPECT_EQ(signal.at("name"), "out/vehicle_rates_setpoint.yaw [rad/s]");
  EXPECT_EQ(signal.at("stage"), "attitude law");
  EXPECT_EQ(signal.at("deviating"), 1);
  EXPECT_EQ(signal.at("first_tick"), 2);
  EXPECT_EQ(signal.at("got"), base64(std::vector<float>{0.5f, 0.5f, 1.5f, 0.5f, 0.5f}));
  EXPECT_EQ(signal.at("want"), base64(std::vector<float>(5, 0.5f)));
  EXPECT_EQ(signal.at("time"), base64(std::vector<float>{0, 0.004f, 0.008f, 0.012f, 0.016f}));
  EXPECT_FLOAT_EQ(signal.at("allowed").get<float>(), 2e-4f);
}

TEST_F(Plots, SayWhenThePortDidNotRepeatItsOutputs) {
  run_.results[0].first->got = 1.25;
  EXPECT_EQ(plots().at("px4-v1.5.5/attitude/a@250hz").at("repeated"), false);
}

TEST_F(Plots, StayWithinTheirBytes) {
  const std::size_t both = plots_json(run_, folder_.path(), unlimited).size();
  EXPECT_LE(plots_json(run_, folder_.path(), both).size(), both);
  const std::string one = plots_json(run_, folder_.path(), both - 1);
  EXPECT_LT(one.size(), both);
  EXPECT_THAT(one, Not(HasSubstr("tpa")));
  EXPECT_THAT(one, HasSubstr("attitude/a@250hz"));
  EXPECT_EQ(plots_json(run_, folder_.path(), 10), "{}");
}

TEST_F(Plots, AreAbsentWithoutTraces) {
  EXPECT_EQ(plots_json(run_, "", unlimited), "{}");
  EXPECT_EQ(plots_json(run_, folder_.path() / "none", unlimited), "{}");
}

TEST_F(Plots, CannotEndTheirScript) {
  run_.results = {failed("attitude", "</script><!--", 250)};
  Trace trace;
  trace.present = channels_of(Module::mc_att_control);
  trace.samples.emplace_back();
  std::filesystem::create_directories(folder_.path() / run_.results[0].case_id());
  save_traces(folder_.path(), {"px4-v1.5.5"}, {trace, trace, Tolerances()}, run_.results[0]);
  const std::string text = plots_json(run_, folder_.path(), unlimited);
  EXPECT_THAT(text, HasSubstr("\\u003c/script>\\u003c!--"));
  EXPECT_THAT(text, Not(HasSubstr("<")));
}

}  // namespace
}  // namespace attest
