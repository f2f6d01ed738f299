// The trace that is written for the slowest step, from handmade times.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/casefile/stimulus.hpp"
#include "harness/host/in_process_host.hpp"
#include "harness/measure/vector_times.hpp"
#include "harness/trace/csv.hpp"
#include "harness/verify/evaluate.hpp"
#include "tests/harness/casefile/case_files.hpp"
#include "tests/harness/core/temporary_directory.hpp"
#include "tests/harness/times.hpp"
#include "tests/harness/verify/given_host.hpp"

namespace attest {
namespace {

std::vector<double> values(const Sample& sample, std::string_view prefix) {
  std::vector<double> values;
  for (std::size_t i = 0; i < channels().size(); ++i) {
    if (!channels_of(Module::mc_att_control, prefix)[i]) continue;
    values.push_back(value_of(channels()[i], sample));
  }
  return values;
}

// Two parameters change: one at tick 3, one at tick 4.
class WriteSlowest : public testing::Test {
 protected:
  WriteSlowest() {
    moving_.the_case = case_of(
        "[parameters]\n"
        "MC_PITCHRATE_P = { signal = \"step\", from = 0.125, to = 0.25, at_ticks = 3 }\n"
        "MC_ROLLRATE_P = { signal = \"step\", from = 0.125, to = 0.5, at_ticks = 4 }\n"
        "[control_state]\n"
        "pitch_rate = { signal = \"step\", from = 0, to = 0.5, at_ticks = 2 }\n");
    SelectedCase level{case_of(""), {}};
    level.the_case.name = "level";
    cases_ = {level, moving_};
    times_.vectors = {timed(level, Rate::hz(100), {us(1), us(7)}), VectorTimes{},
                      timed(moving_, Rate::hz(100), {us(8), us(1)}),
                      timed(moving_, Rate::hz(250), {us(1), us(2), us(1), us(9), us(3)})};
  }

  static VectorTimes timed(const SelectedCase& selected, const Rate& rate,
                           std::vector<Nanoseconds> steps) {
    return {result_for(selected.the_case, {rate, {}}), std::move(steps), {}};
  }

  Result<void> write(const StartHost& start = {}) {
    HostOptions here;
    here.in_process = true;
    here.start = start;
    auto file = AtomicFile::open(file_);
    if (!file) return tl::unexpected(file.error());
    return write_slowest(times_, cases_, here, *std::move(file));
  }

  Trace written() {
    const auto done = write();
    EXPECT_TRUE(done) << done.error().to_string();
    auto read = read_csv(file_, TraceNeed::inputs_and_outputs);
    EXPECT_TRUE(read) << read.error().to_string();
    return read ? *std::move(read) : Trace{};
  }

  SelectedCase moving_;
  std::vector<SelectedCase> cases_;
  CorpusTimes times_;
  TemporaryDirectory directory_;
  std::filesystem::path file_ = directory_.path() / "worst.csv";
};

TEST_F(WriteSlowest, WritesTheVectorUpToItsSlowestStep) {
  const Trace trace = written();
  const Trace inputs = stimulate(moving_.the_case, Rate::hz(250));
  ASSERT_EQ(trace.samples.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(values(trace.samples[i], "in/"), values(inputs.samples[i], "in/")) << i;
  }
}

TEST_F(WriteSlowest, TheParametersThatChangeAtTheSlowestStepAreIncluded) {
  const std::vector<ParameterChange> up_to_tick_3 = {
      {0, "MC_PITCHRATE_P", 0.125f}, {0, "MC_ROLLRATE_P", 0.125f}, {3, "MC_PITCHRATE_P", 0.25f}};
  EXPECT_EQ(written().parameters, up_to_tick_3);
}

TEST_F(WriteSlowest, WritesWhatThePortAnswers) {
  Trace answered = stimulate(moving_.the_case, Rate::hz(250));
  ASSERT_FALSE((*open_in_process_host("builtin"))->drive({"px4-v1.5.5"}, answered));
  const Trace trace = written();
  ASSERT_EQ(trace.samples.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(values(trace.samples[i], "out/"), values(answered.samples[i], "out/")) << i;
  }
  EXPECT_NE(trace.samples[3].out.actuator_controls_0.control[1], 0);
}

TEST_F(WriteSlowest, WritesTheChannelsOfItsUnit) {
  const SelectedCase rate{unit_case_of(Module::rate_unit, "px4-v1.16.0", ""), {}};
  cases_ = {rate};
  times_.vectors = {timed(rate, Rate::hz(250), {us(1), us(2)})};
  const Trace trace = written();
  EXPECT_TRUE(trace.present == channels_of(Module::rate_unit));
  ASSERT_EQ(trace.samples.size(), 2u);
  EXPECT_NE(trace.samples[1].rate_out.vehicle_torque_setpoint.published, 0);
}

TEST_F(WriteSlowest, NothingThatWasTimedIsAnError) {
  times_.vectors = {VectorTimes{}};
  EXPECT_FALSE(write());
  EXPECT_FALSE(std::filesystem::exists(file_));
}

TEST_F(WriteSlowest, APortThatGoesWrongNowIsAnError) {
  const auto done = write([](const HostOptions&, const Course&) {
    GivenHost::Answers answers;
    answers.drive = [](const ModuleUnderTest&, Trace&) {
      return PortFault{PortFault::Kind::crash, 2, "it died"};
    };
    return std::make_unique<GivenHost>(answers);
  });
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().message, "it died");
  EXPECT_FALSE(std::filesystem::exists(file_));
}

TEST_F(WriteSlowest, AFileThatCannotBeWrittenIsAnError) {
  file_ = directory_.path() / "no_such_folder" / "worst.csv";
  EXPECT_FALSE(write());
}

}  // namespace
}  // namespace attest
