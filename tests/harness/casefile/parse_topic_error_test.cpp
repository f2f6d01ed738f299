#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/harness/casefile/case_files.hpp"

namespace attest {
namespace {

using testing::HasSubstr;

// The errors of one line, the 7th, in a topic.
std::string error_of(const std::string& topic, const std::string& line) {
  return errors_of("[" + topic + "]\n" + line + "\n");
}

TEST(TopicErrors, UnknownFields) {
  EXPECT_EQ(error_of("vehicle_attitude_setpoint", "thurst = 1"),
            "7:1: unknown key `thurst`; did you mean `thrust`?");
  EXPECT_THAT(errors_of("control_state = 1\n"), HasSubstr("`control_state` must be a table"));
}

TEST(TopicErrors, OfMixerAndBattery) {
  const std::string mixer = "[mixer]\ndefinition = \"R: 4x 10000 10000 10000 0\"\n";
  EXPECT_EQ(errors_of(mixer + "[actuator_controls_0]\n\"control[0]\" = 0.5\n"), "");
  EXPECT_THAT(error_of("mixer", "definition = \"R: 5x 1 1 1 0\""),
              HasSubstr("7:1: mixer: unknown geometry '5x'"));
  EXPECT_THAT(errors_of("[mixer]\n"), HasSubstr("missing key `definition`"));
  EXPECT_THAT(errors_of(mixer + "[control_state]\nroll_rate = 1\n"),
              HasSubstr("8:2: unknown key `control_state`"));
  EXPECT_THAT(errors_of(mixer + "[battery]\n"), HasSubstr("`mixer` is given too; keep one"));
  EXPECT_THAT(errors_of(mixer + "[flight]\n"), HasSubstr("leave [flight] out"));
  EXPECT_THAT(errors_of(mixer + "[parameters]\nMC_ROLL_P = 1\n"),
              HasSubstr("unknown parameter `MC_ROLL_P`"));
  EXPECT_EQ(errors_of("[battery]\nvoltage_v = 11\n[parameters]\nBAT_N_CELLS = 4\n"), "");
  EXPECT_THAT(error_of("battery", "armed = 0.5"), HasSubstr("7:1: is a flag"));
  EXPECT_THAT(error_of("battery", "rate_hz = 50"), HasSubstr("unknown key `rate_hz`"));
  EXPECT_THAT(errors_of("[battery]\n[parameters]\nBAT_N_CELLS = { signal = \"step\", from = 3, to "
                        "= 4, at_ticks = 2 }\n"),
              HasSubstr("8:1: does not change while it runs"));
}

TEST(TopicErrors, Flags) {
  for (const char* value :
       {"0.5", "256", "-1", "nan", "{ signal = \"sine\", amplitude = 1, cycles = 1 }",
        "{ signal = \"step\", from = 0, to = 0.5, at_ticks = 1 }",
        "{ signal = \"samples\", times_ticks = [0, 1], values = [0, 1], linear = true }"}) {
    EXPECT_THAT(error_of("actuator_armed", std::string("armed = ") + value),
                HasSubstr("7:1: is a flag"))
        << value;
  }
  for (const char* value : {"true", "false", "255",
                            "{ signal = \"samples\", times_ticks = [0, 1], values = [0, 4] }"}) {
    EXPECT_EQ(error_of("actuator_armed", std::string("armed = ") + value), "");
  }
}

TEST(TopicErrors, Quaternions) {
  EXPECT_EQ(error_of("control_state", "q = [1, 0, 0]"), "7:1: needs four numbers: [w, x, y, z]");
  EXPECT_THAT(error_of("control_state", "q = 1"), HasSubstr("`q` must be a table"));
  EXPECT_THAT(error_of("control_state", "q = { tilt = 1 }"), HasSubstr("unknown key `tilt`"));
  EXPECT_THAT(error_of("vehicle_attitude_setpoint", "q_d = { sign = 0.5 }"),
              HasSubstr("must be 1 or -1"));
  EXPECT_EQ(error_of("control_state", "\"q[0]\" = 1"), "");
  EXPECT_THAT(error_of("control_state", "q = [1, 0, 0, 0]\n\"q[1]\" = 1"),
              HasSubstr("`q` is given too; keep one"));
}

TEST(TopicErrors, FlightModes) {
  const char* const mode = "vehicle_control_mode";
  EXPECT_EQ(error_of(mode, "flight_mode = \"ACR\""),
            "7:1: unknown flight mode `ACR`; did you mean `ACRO`?");
  EXPECT_THAT(error_of(mode, "flight_mode = 3"), HasSubstr("`flight_mode` must be text"));
  EXPECT_EQ(error_of(mode, "flight_mode = { times_ticks = [0, 5], modes = [\"ACRO\"] }"),
            "7:1: needs one mode a time, at least one");
  EXPECT_THAT(error_of(mode, "flight_mode = { modes = [\"ACRO\"] }"),
              HasSubstr("needs `times_ticks`"));
  EXPECT_THAT(error_of(mode, "flight_mode = { times_ticks = [0], modes = [\"X\"] }"),
              HasSubstr("unknown flight mode `X`"));
  EXPECT_THAT(error_of("battery_status", "flight_mode = \"ACRO\""),
              HasSubstr("unknown key `flight_mode`"));
}

TEST(TopicErrors, Publication) {
  const auto error = [](const std::string& line) { return error_of("battery_status", line); };
  EXPECT_EQ(error("publish = \"always\""), "7:1: must be \"never\" or \"every_tick\"");
  EXPECT_THAT(error("publish = \"never\"\nrate_hz = 50"), HasSubstr("6:2: give one of `publish`"));
  EXPECT_THAT(error("period_s = 1\nrate_hz = 50"), HasSubstr("give one of `publish`"));
  EXPECT_THAT(error("period_ticks = 1\nperiod_s = 1"), HasSubstr("`period_ticks` is given too"));
  EXPECT_THAT(error("phase_ticks = 1"), HasSubstr("a phase needs a period or a rate"));
  EXPECT_THAT(error("publish_at_ticks = [3, 1]"), HasSubstr("must increase"));
  EXPECT_THAT(error("period_ticks = 0"), HasSubstr("7:1: must be positive"));
  EXPECT_THAT(error("period_s = 0"), HasSubstr("7:1: must be positive"));
  EXPECT_THAT(error("period_ticks = 1.5"), HasSubstr("7:1: must be a whole number"));
  EXPECT_THAT(error("rate_hz = 0"), HasSubstr("7:1: `0` is not a rate"));
}

// control_state starts each step, so it has no rate of its own.
TEST(TopicErrors, TheControlStateHasNoPublication) {
  EXPECT_THAT(error_of("control_state", "rate_hz = 50"), HasSubstr("unknown key `rate_hz`"));
  EXPECT_THAT(error_of("control_state", "publish = \"never\""), HasSubstr("unknown key `publish`"));
}

}  // namespace
}  // namespace attest
