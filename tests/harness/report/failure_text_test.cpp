#include "harness/report/failure_text.hpp"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/harness/report/sample_run.hpp"

namespace attest {
namespace {

using testing::HasSubstr;
using testing::Not;

VectorResult failing(Deviation first) {
  VectorResult result = passed("attitude", "roll_30", Rate::hz(250));
  result.verdict = Verdict::fail;
  result.reason = "outputs differ";
  result.deviating_ticks = 2;
  result.first = first;
  return result;
}

TEST(FailureText, TellsWhatIsWrongWhereAndHowToRunItAgain) {
  const VectorResult result =
      failing(deviation("out/vehicle_rates_setpoint.roll", 17, -1.5F, -1, 0.125));
  const RunResult run = passing_run();
  RunResult numeric = run;
  numeric.level = Level::numeric;
  numeric.port = "lib:./mine.so";
  EXPECT_EQ(
      failure_text(result, numeric),
      "px4-v1.5.5/attitude/roll_30@250hz\n"
      "  fail: outputs differ\n"
      "  first at tick 17, timestamp 68000 us, in out/vehicle_rates_setpoint.roll [rad/s]\n"
      "    got   -1.5  0xbfc00000\n"
      "    want  -1    0xbf800000\n"
      "    off by 0.5 (4194304 ulp), allowed 0.125: 4.00 times the tolerance\n"
      "  look first at the attitude law: no output of an earlier stage deviates up to this tick\n"
      "  2 of 500 ticks deviate\n"
      "  case:      cases/px4-v1.5.5/attitude/roll_30.toml\n"
      "  golden:    golden/px4-v1.5.5/attitude/roll_30.csv\n"
      "  reproduce: attest run --port lib:./mine.so --filter "
      "'px4-v1.5.5/attitude/roll_30@250hz'");
}

TEST(FailureText, TheShortestDecimalIsThatOfFloat32) {
  const VectorResult result =
      failing(deviation("out/vehicle_rates_setpoint.roll", 0, 0.1F, 0.10000001F, 0));
  const std::string text = failure_text(result, passing_run());
  EXPECT_THAT(text, HasSubstr("got   0.1         0x3dcccccd\n"));
  EXPECT_THAT(text, HasSubstr("want  0.10000001  0x3dccccce\n"));
  EXPECT_THAT(text, HasSubstr("off by 7.45e-09 (1 ulp); the exact level allows no other bits\n"));
}

TEST(FailureText, ZerosOfBothSignsAreDistinguished) {
  const VectorResult result =
      failing(deviation("out/vehicle_rates_setpoint.roll", 0, -0.0F, 0.0F, 0));
  const std::string text = failure_text(result, passing_run());
  EXPECT_THAT(text, HasSubstr("got   -0  0x80000000\n    want  0   0x00000000\n"));
}

TEST(FailureText, AFlagHasNeitherBitsNorADistance) {
  const VectorResult result = failing(deviation("out/actuator_controls_0.published", 3, 0, 1, 0));
  const std::string text = failure_text(result, passing_run());
  EXPECT_THAT(text, HasSubstr("in out/actuator_controls_0.published\n    got   0\n    want  1\n"));
  EXPECT_THAT(text, Not(HasSubstr("off by")));
  EXPECT_THAT(text, HasSubstr("look first at the actuators"));
}

TEST(FailureText, HasAllStagesThatCanBeWrong) {
  Deviation first = deviation("out/actuator_controls_0.control[0]", 3, 0, 1, 0);
  first.stages = only(Stage::rate_law) | only(Stage::integrator);
  EXPECT_THAT(failure_text(failing(first), passing_run()),
              HasSubstr("  look first at the rate law or the integrator: no output of an earlier"));
  first.stages |= only(Stage::sticks);
  EXPECT_THAT(failure_headline(failing(first)),
              HasSubstr("(sticks, the rate law or the integrator)"));
}

TEST(FailureText, NanIsSaidInWordsNotAsADifference) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const RunResult run = passing_run();
  const char* channel = "out/mc_att_ctrl_status.yaw_rate_integ";
  const std::string got = failure_text(failing(deviation(channel, 0, nan, 1, 0)), run);
  EXPECT_THAT(got, HasSubstr("got   nan  0x7fc00000\n"));
  EXPECT_THAT(got, HasSubstr("not a finite number where the reference has one"));
  EXPECT_THAT(got, Not(HasSubstr("off by")));
  const std::string want = failure_text(failing(deviation(channel, 0, 1, nan, 0)), run);
  EXPECT_THAT(want, HasSubstr("the reference is not finite here"));
}

TEST(FailureText, ACrashSaysNothingAboutTicks) {
  VectorResult result = passed("attitude", "roll_30", Rate::hz(1000, 3));
  result.verdict = Verdict::crash;
  result.ticks = 0;
  EXPECT_EQ(failure_text(result, passing_run()),
            "px4-v1.5.5/attitude/roll_30@1000_3hz\n"
            "  crash: the port's process died\n"
            "  case:      cases/px4-v1.5.5/attitude/roll_30.toml\n"
            "  reproduce: attest run --port builtin --filter "
            "'px4-v1.5.5/attitude/roll_30@1000_3hz' --level exact\n"
            "  debug:     the same with --in-process, under a debugger");
}

TEST(FailureText, WordsOfAPortStayOnTheirLine) {
  VectorResult result = passed("attitude", "roll_30", Rate::hz(250));
  result.verdict = Verdict::protocol;
  result.reason = "line one\nPASS all is well\x1b[2J";
  EXPECT_THAT(failure_text(result, passing_run()),
              HasSubstr("  protocol: line one PASS all is well\\x1b[2J\n"));
}

TEST(FindingText, OfAFlightWhoseOutputsAreRightForTheirInputsBlamesNoStage) {
  Deviation first = deviation("out/vehicle_rates_setpoint.roll", 17, -1.5F, -1, 0.125);
  first.stages = only(Stage::input);
  EXPECT_THAT(finding_text(failing(first), Level::numeric),
              HasSubstr("  each output agrees with the reference's for the same inputs: small"));
  EXPECT_THAT(failure_headline(failing(first)), HasSubstr("want -1 (flight as a whole)"));
}

TEST(FindingText, IsTheDifferenceWithoutTheCase) {
  const VectorResult result = failing(deviation("out/actuator_controls_0.published", 3, 0, 1, 0));
  EXPECT_EQ(
      finding_text(result, Level::numeric),
      "  first at tick 3, timestamp 12000 us, in out/actuator_controls_0.published\n"
      "    got   0\n"
      "    want  1\n"
      "  look first at the actuators: no output of an earlier stage deviates up to this tick\n"
      "  2 of 500 ticks deviate\n");
  EXPECT_THAT(finding_text(result, Level::numeric, true), Not(HasSubstr("look first at")));
  EXPECT_EQ(finding_text(passed("attitude", "roll_30", Rate::hz(250)), Level::numeric), "");
}

TEST(FailureHeadline, IsOneLineWithTheFirstDeviation) {
  EXPECT_EQ(
      failure_headline(failing(deviation("out/vehicle_rates_setpoint.roll", 17, -1.5F, -1, 0))),
      "outputs differ; first at tick 17: out/vehicle_rates_setpoint.roll got -1.5, want -1 "
      "(attitude law)");
}

TEST(FailureHeadline, SpeaksForEveryVerdictWithoutAReason) {
  for (int i = 0; i < verdict_count; ++i) {
    VectorResult result = passed("attitude", "roll_30", Rate::hz(250));
    result.verdict = static_cast<Verdict>(i);
    EXPECT_GE(failure_headline(result).size(), 7U) << name_of(result.verdict);
  }
}

TEST(ReproduceCommand, QuotesThePort) {
  EXPECT_THAT(reproduce_command(passed("attitude", "roll_30", Rate::hz(250)), sample_run()),
              HasSubstr("--port 'lib:./it'\\''s mine.so' --filter"));
}

TEST(FailureText, TheCommandThatReproducesItHasTheSuiteThatWasNamed) {
  RunResult run = sample_run();
  run.suite_folder = "my suite";
  EXPECT_THAT(reproduce_command(passed("attitude", "roll_30", Rate::hz(250)), run),
              testing::StartsWith("attest --suite 'my suite' run --port"));
}

}  // namespace
}  // namespace attest
