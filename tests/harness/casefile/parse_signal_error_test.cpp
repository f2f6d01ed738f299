#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/harness/casefile/case_files.hpp"

namespace attest {
namespace {

using testing::AllOf;
using testing::HasSubstr;

// The errors of a signal, which stands in line 7.
std::string error_of(const std::string& signal) {
  return errors_of("[control_state]\nroll_rate = " + signal + "\n");
}

TEST(SignalErrors, Kinds) {
  EXPECT_THAT(error_of("{ signal = \"sin\", amplitude = 1, cycles = 1 }"),
              AllOf(HasSubstr("7:15: unknown signal `sin`; did you mean `sine`?"),
                    HasSubstr("constant, step, ramp, sine, chirp, random_walk, samples")));
  EXPECT_THAT(error_of("{ value = 1 }"), HasSubstr("missing key `signal`"));
  EXPECT_THAT(error_of("\"1\""), HasSubstr("7:1: `roll_rate` must be a number, found text"));
  EXPECT_THAT(error_of("[1, 2]"), HasSubstr("must be a number, found an array"));
}

TEST(SignalErrors, RequiredKeys) {
  EXPECT_THAT(error_of("{ signal = \"constant\" }"), HasSubstr("missing key `value`"));
  EXPECT_THAT(error_of("{ signal = \"step\", to = 1, at_s = 1 }"), HasSubstr("missing key `from`"));
  EXPECT_THAT(error_of("{ signal = \"step\", from = 0, to = 1 }"),
              HasSubstr("7:1: needs `at_ticks` (of the unit's loop) or `at_s`"));
  EXPECT_THAT(error_of("{ signal = \"ramp\", from = 0, to = 1 }"), HasSubstr("needs `end_ticks`"));
  EXPECT_THAT(error_of("{ signal = \"sine\", amplitude = 1 }"),
              HasSubstr("needs `cycles` (over the whole case) or `frequency_hz`"));
  EXPECT_THAT(error_of("{ signal = \"chirp\", amplitude = 1, from_hz = 1 }"),
              HasSubstr("needs `to_cycles` (over the whole case) or `to_hz`"));
  EXPECT_THAT(error_of("{ signal = \"random_walk\", step = 1, min = 0, max = 1 }"),
              HasSubstr("missing key `seed`"));
}

TEST(SignalErrors, KeysOfAnotherSignal) {
  EXPECT_THAT(error_of("{ signal = \"step\", from = 0, to = 1, at_s = 1, amplitude = 2 }"),
              HasSubstr("unknown key `amplitude`"));
}

TEST(SignalErrors, OneUnitOfTime) {
  EXPECT_THAT(error_of("{ signal = \"step\", from = 0, to = 1, at_ticks = 1, at_s = 1 }"),
              HasSubstr("`at_ticks` is given too; keep one of them"));
  EXPECT_THAT(error_of("{ signal = \"sine\", amplitude = 1, cycles = 1, frequency_hz = 1 }"),
              HasSubstr("`frequency_hz` is given too"));
}

TEST(SignalErrors, TimesAreInRange) {
  const auto step_at = [](const std::string& at) {
    return error_of("{ signal = \"step\", from = 0, to = 1, " + at + " }");
  };
  EXPECT_EQ(step_at("at_ticks = 1000000"), "");
  EXPECT_THAT(step_at("at_ticks = 1000001"), HasSubstr("must be a time from 0 up to 1000000"));
  EXPECT_THAT(step_at("at_ticks = -0.5"), HasSubstr("must be a time from 0"));
  EXPECT_THAT(step_at("at_s = 1e10"), HasSubstr("must be a time from 0 up to 1000000000"));
  EXPECT_THAT(step_at("at_s = nan"), HasSubstr("must be a time from 0"));
}

TEST(SignalErrors, Ramp) {
  EXPECT_THAT(error_of("{ signal = \"ramp\", from = 0, to = 1, start_ticks = 5, end_ticks = 5 }"),
              HasSubstr("the ramp must end after its start"));
  EXPECT_THAT(error_of("{ signal = \"ramp\", from = 0, to = 1, end_ticks = 0 }"),
              HasSubstr("the ramp must end after its start"));
}

TEST(SignalErrors, RandomWalk) {
  const auto walk = [](const std::string& rest) {
    return error_of("{ signal = \"random_walk\", seed = 1, step = 1, " + rest + " }");
  };
  EXPECT_THAT(walk("min = 1, max = 1, start = 1"), HasSubstr("must be above `min`"));
  EXPECT_THAT(walk("min = 1, max = 2"), HasSubstr("must lie between `min` and `max`"));
  EXPECT_THAT(walk("min = -1, max = 2, every_ticks = 0"), HasSubstr("must be at least 1e-6"));
  EXPECT_THAT(walk("min = -1, max = 2, every_s = 1e-9"), HasSubstr("must be at least 1e-6"));
}

TEST(SignalErrors, Samples) {
  const auto samples = [](const std::string& rest) {
    return error_of("{ signal = \"samples\", " + rest + " }");
  };
  EXPECT_THAT(samples("times_ticks = [0, 5], values = [1]"), HasSubstr("has 1 values for 2 times"));
  EXPECT_THAT(samples("times_ticks = [], values = []"), HasSubstr("has 0 values for 0 times"));
  EXPECT_THAT(samples("times_ticks = [5, 5], values = [1, 2]"), HasSubstr("must increase"));
  EXPECT_THAT(samples("times_s = [-0.5, 1], values = [1, 2]"), HasSubstr("must be a time from 0"));
  EXPECT_THAT(samples("times_s = [0, nan], values = [1, 2]"), HasSubstr("must increase"));
  EXPECT_THAT(samples("values = [1]"), HasSubstr("needs `times_ticks`"));
  EXPECT_THAT(samples("times_s = [0], values = [1], linear = 1"),
              HasSubstr("`linear` must be true or false"));
}

TEST(SignalErrors, AnAttitudeHasAnglesOfOneKind) {
  const auto error_of_q = [](const std::string& angles) {
    return errors_of("[control_state]\nq = { " + angles + " }\n");
  };
  EXPECT_EQ(error_of_q("roll_deg = 10, pitch_deg = 20, yaw_deg = 30, sign = -1, norm = 2"), "");
  EXPECT_EQ(error_of_q("tilt_deg = 10, azimuth_deg = 20, yaw_deg = 30"), "");
  EXPECT_EQ(error_of_q("roll_deg = 10, tilt_deg = 20"),
            "7:22: `roll_deg` is given too: an attitude has roll and pitch, or tilt and azimuth");
  EXPECT_THAT(error_of_q("azimuth_deg = 10, pitch_deg = 20"),
              HasSubstr("7:7: `pitch_deg` is given too: an attitude has roll and pitch"));
}

}  // namespace
}  // namespace attest
