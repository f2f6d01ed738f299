#include <tuple>

#include <gtest/gtest.h>

#include "harness/trace/csv.hpp"
#include "tests/harness/core/temporary_directory.hpp"

namespace attest {
namespace {

// The first rows of a recorded trace of the original mixer (hexarotor x).
constexpr std::string_view recorded =
    "roll,pitch,yaw,thrust,delta_out_max,out[0],out[1],out[2],out[3],out[4],out[5],lower_limit,"
    "upper_limit,yaw_limit\n"
    "-0.17471729,1.663724,0.65914774,0.91745275,0,0.302702308,-1,1,-1,0.198113203,-1,1,1,1\n"
    "0.24177188,0.23538092,1.575626,0.93697256,0,-0.898926616,1,0.234080553,-0.133007288,"
    "0.682375908,-0.581302524,0,1,1\n";

class MixerCsv : public testing::Test {
 protected:
  std::string error_of(std::string_view text) {
    const auto trace = read_csv(directory_.write("6x.csv", text), TraceNeed::outputs);
    if (trace) return "";
    return trace.error().to_string().substr(directory_.path().string().size() + 1);
  }

  TemporaryDirectory directory_;
};

TEST_F(MixerCsv, ReadsARecordedTrace) {
  const auto trace = read_csv(directory_.write("6x.csv", recorded), TraceNeed::inputs_and_outputs);
  ASSERT_TRUE(trace) << trace.error().to_string();
  EXPECT_EQ(trace->source, (directory_.path() / "6x.csv").string());
  EXPECT_EQ(module_of(trace->present), Module::mixer);
  EXPECT_EQ((trace->present & channels_of(Module::mixer, "out/actuator_outputs")).count(), 6u);
  ASSERT_EQ(trace->samples.size(), 2u);
  EXPECT_LT(trace->samples[0].in.timestamp, trace->samples[1].in.timestamp);
  const auto& [in, out] = std::tie(trace->samples[1].mixer_in, trace->samples[1].mixer_out);
  EXPECT_EQ(in.actuator_controls_0.control[0], 0.24177188f);
  EXPECT_EQ(in.actuator_controls_0.control[3], 0.93697256f);
  EXPECT_EQ(in.mixer.delta_out_max, 0.0f);
  EXPECT_EQ(out.actuator_outputs.output[5], -0.581302524f);
  EXPECT_EQ(out.actuator_outputs.output[6], 0.0f);
  EXPECT_EQ(out.multirotor_motor_limits.lower_limit, 0);
  EXPECT_EQ(out.multirotor_motor_limits.yaw, 1);
}

TEST_F(MixerCsv, NamesErrorsByPlace) {
  constexpr std::string_view four = "roll,pitch,yaw,thrust,delta_out_max,out[0],out[1],out[2],";
  const std::string header = std::string(four) + "out[3],lower_limit,upper_limit,yaw_limit\n";
  EXPECT_EQ(error_of(header + "1,2,3,4,0,1,1,1,x,0,0,0\n"),
            "6x.csv:2:17: `x` is not a number for out[3]; write a decimal number, nan, inf or "
            "-inf");
  EXPECT_EQ(error_of(header + "1,2,3,4,0,1,1,1,1,0,0,-1\n"),
            "6x.csv:2:23: `-1` is not a flag for yaw_limit; write an integer from 0 to 255");
  EXPECT_EQ(error_of(header + "1,2\n"),
            "6x.csv:2:4: row has 2 of 12 cells, yaw is missing; complete or remove the row");
  EXPECT_EQ(error_of(header), "6x.csv:2: no rows; a trace has a row for each tick");
  EXPECT_EQ(error_of(std::string(four) + "out[4],lower_limit,upper_limit,yaw_limit\n"),
            "6x.csv:1: no column out[3]; add it");
  EXPECT_EQ(error_of(std::string(four) + "lower_limit,upper_limit,yaw_limit\n"),
            "6x.csv:1: 3 out[] columns; a mixer has 4, 6 or 8 rotors");
  EXPECT_EQ(error_of(std::string(four) + "out[3],lower_limit,upper_limit\n"),
            "6x.csv:1: no column yaw_limit; add it");
  EXPECT_EQ(error_of("rolll,pitch\n"),
            "6x.csv:1:1: unknown column `rolll` in a mixer trace; did you mean `roll`?");
  EXPECT_EQ(error_of("roll,pitch,roll\n"), "6x.csv:1:12: repeated column `roll`; remove one");
  EXPECT_EQ(error_of(""), "6x.csv:1:1: no header; the first line must name the columns");
  EXPECT_EQ(read_csv("/missing", TraceNeed::inputs).error().to_string(),
            "/missing: cannot open the file: No such file or directory");
}

TEST_F(MixerCsv, TruncationAtAnyByteReadsOrFails) {
  for (std::size_t size = 0; size <= recorded.size(); ++size) {
    const auto trace = read_csv(directory_.write("a", recorded.substr(0, size)), TraceNeed::inputs);
    if (!trace) {
      EXPECT_GE(trace.error().line, 1);
    }
  }
}

}  // namespace
}  // namespace attest
