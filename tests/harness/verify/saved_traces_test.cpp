#include "harness/verify/saved_traces.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/casefile/parse.hpp"
#include "harness/casefile/stimulus.hpp"
#include "harness/golden/recorded.hpp"
#include "harness/trace/csv.hpp"
#include "harness/verify/evaluate.hpp"
#include "tests/harness/core/temporary_directory.hpp"

namespace attest {
namespace {

using testing::StartsWith;

const Case parameters_change =
    *parse_case(ATTEST_SOURCE_DIR "/cases/px4-v1.5.5/parameters/change_in_flight.toml");

class SavingTraces : public testing::Test {
 protected:
  SavingTraces() : result_(result_for(parameters_change, {Rate::hz(250), std::nullopt})) {
    result_.verdict = Verdict::fail;
    trace_.present |= channels_of(Module::mc_att_control, "out/");
  }

  void save(const Trace& got) {
    save_traces(folder_.path(), subject_of(parameters_change), {got, trace_, tolerances_}, result_);
  }
  std::filesystem::path file(const std::string& which) const {
    return folder_.path() / parameters_change.id() / ("250hz." + which + ".csv");
  }

  TemporaryDirectory folder_;
  VectorResult result_;
  Trace trace_ = stimulate(parameters_change, Rate::hz(250));
  Tolerances tolerances_;
};

TEST_F(SavingTraces, AreOfFailuresAndOnlyWithAFolder) {
  EXPECT_TRUE(saves_traces(folder_.path(), result_));
  EXPECT_FALSE(saves_traces("", result_));
  for (const Verdict verdict : {Verdict::pass, Verdict::skip, Verdict::unsupported}) {
    result_.verdict = verdict;
    EXPECT_FALSE(saves_traces(folder_.path(), result_));
  }
}

TEST_F(SavingTraces, OneThatEndsBeforeAParameterChangesIsSavedUpToThere) {
  Trace got = trace_;
  got.keep_first(15);
  got.samples[3].out.actuator_controls_0.control[0] = 0.5f;
  save(got);
  EXPECT_EQ(result_.reason, "");
  const auto read = read_recorded(file("got"));
  ASSERT_TRUE(read) << read.error().to_string();
  EXPECT_EQ(read->trace.samples.size(), 15u);
  EXPECT_EQ(read->trace.samples[3].out.actuator_controls_0.control[0], 0.5f);
  EXPECT_EQ(read->trace.parameters, got.parameters);
  EXPECT_EQ(read_recorded(file("want"))->trace.parameters, trace_.parameters);
}

TEST_F(SavingTraces, TheToleranceOfEachValueIsSaved) {
  trace_.samples[4].out.vehicle_rates_setpoint.roll = 300;  // 1e-5 of it is more than 2e-4
  save(trace_);
  const auto read = read_csv(file("tolerance"), TraceNeed::outputs);
  ASSERT_TRUE(read) << read.error().to_string();
  const double widening = Tolerances().widening(0, 6.5);
  EXPECT_NEAR(read->samples[3].out.vehicle_rates_setpoint.yaw, 2e-4 + widening, 1e-7);
  EXPECT_NEAR(read->samples[4].out.vehicle_rates_setpoint.roll, 3e-3 + widening, 1e-7);
  EXPECT_EQ(read->samples[4].in.timestamp, trace_.samples[4].in.timestamp);
}

TEST_F(SavingTraces, TheLevelEventsHasNoTolerances) {
  tolerances_ = Tolerances(Level::events);
  save(trace_);
  EXPECT_TRUE(std::filesystem::exists(file("got")));
  EXPECT_FALSE(std::filesystem::exists(file("tolerance")));
}

TEST_F(SavingTraces, WithoutOutputsOnlyTheExpectedOneIsSaved) {
  Trace lost = trace_;
  lost.keep_first(0);
  save(lost);
  EXPECT_FALSE(std::filesystem::exists(file("got")));
  EXPECT_TRUE(std::filesystem::exists(file("want")));
}

TEST_F(SavingTraces, AFolderThatCannotBeMadeIsSaidAndTheVerdictStays) {
  folder_.write("px4-v1.5.5", "a file where a folder is needed");
  result_.reason = "differs";
  save(trace_);
  EXPECT_THAT(result_.reason, StartsWith("differs; its traces are not saved: "));
  EXPECT_EQ(result_.verdict, Verdict::fail);
}

}  // namespace
}  // namespace attest
