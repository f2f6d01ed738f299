#include "harness/report/terminal.hpp"

#include <limits>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/report/report.hpp"
#include "harness/report/statement.hpp"
#include "tests/harness/report/baseline.hpp"
#include "tests/harness/report/sample_run.hpp"

namespace attest {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

constexpr double wall_s = 1.24;

std::string summary(const RunResult& run) { return render_summary(run, wall_s, {}); }

TEST(Summary, IsTheReviewedOne) {
  const RunResult run = sample_run();
  EXPECT_TRUE(is_baseline("summary.txt", render_summary(run, wall_s, {}, {}, true)));
  EXPECT_TRUE(is_baseline("summary_colour.txt",
                          render_summary(run, wall_s, {.colour = true, .width = 40})));
  EXPECT_TRUE(is_baseline("summary_pass.txt", summary(passing_run())));
}

TEST(Summary, WithoutColourHasNoEscapeCodes) {
  EXPECT_THAT(summary(sample_run()), Not(HasSubstr("\x1b")));
}

TEST(Summary, TheLastLineIsTheConformanceStatement) {
  RunResult run = passing_run();
  EXPECT_THAT(
      summary(run),
      EndsWith("\nPASS 6 vectors passed, 0 failed (px4-v1.5.5, exact, 2 rates) in 1.2 s\n"));
  run.results[0].verdict = Verdict::skip;
  run.results[1].verdict = Verdict::xfail;
  EXPECT_THAT(summary(run),
              EndsWith("\nPASS 4 vectors passed, 0 failed; 1 skip, 1 xfail (px4-v1.5.5, exact, 2 "
                       "rates) in 1.2 s\n"));
  run.results[0].exact_only = true;
  run.results[1].verdict = Verdict::unsupported;
  run.results[1].applies = false;
  EXPECT_THAT(summary(run),
              HasSubstr("\nPASS 4 vectors passed, 0 failed; 1 need --level exact, 1 do "
                        "not apply to this port (px4-v1.5.5, "));
  run.results[2].verdict = Verdict::crash;
  run.stopped_early = true;
  run.selected = 8;
  EXPECT_THAT(
      summary(run),
      EndsWith("\nFAIL 1 of 6 vectors failed (1 crash), 3 passed; 1 need --level exact, 1 do "
               "not apply to this port (px4-v1.5.5, exact, 2 rates) in 1.2 s; stopped "
               "early, 2 of 8 vectors not run\n"));
}

// No cell of a group of which vectors were left out is one of a pass, nor is the badge green.
TEST(Summary, ARunThatWasStoppedIsNoPass) {
  RunResult run = passing_run();
  run.stopped_early = true;
  run.selected = 9;
  const VectorResult& one = run.results.front();
  run.not_run = {{one.profile, one.group, one.rate, 2}, {one.profile, "mixer", one.rate, 1}};
  const std::string text = summary(run);
  EXPECT_THAT(text, HasSubstr("\nSTOPPED 6 vectors passed, 0 failed (px4-v1.5.5, exact, 2 rates)"));
  EXPECT_THAT(text, EndsWith("; stopped early, 3 of 9 vectors not run\n"));
  EXPECT_THAT(text, testing::ContainsRegex("\n  attitude +[0-9]+[*] +[0-9]+ +[0-9]+ STOPPED\n"));
  EXPECT_THAT(text, HasSubstr("*: stopped before all were run"));
  EXPECT_THAT(badge(run), HasSubstr(">stopped<"));
  EXPECT_THAT(badge(run), Not(HasSubstr("#3a7d34")));
  // Also a group of which no vector was run.
  EXPECT_THAT(junit_report(run), HasSubstr("2 vectors not run: the run was stopped"));
  EXPECT_THAT(junit_report(run), HasSubstr("testsuite name=\"px4-v1.5.5.mixer\""));
  EXPECT_THAT(json_report(run), HasSubstr("\"not_run\""));
  run.results.front().verdict = Verdict::fail;
  EXPECT_THAT(summary(run), HasSubstr("\nFAIL 1 of 6 vectors failed, 5 passed"));
}

TEST(Summary, VectorsThatDoNotApplyAreCountedTogether) {
  RunResult run = passing_run();
  const auto left_out = [&](std::size_t index, Verdict verdict, bool applies, const char* reason) {
    run.results[index].verdict = verdict;
    run.results[index].applies = applies;
    run.results[index].reason = reason;
  };
  left_out(0, Verdict::unsupported, false, "the port has no module mixer");
  left_out(1, Verdict::unsupported, false, "the port makes no module attitude_law of profile a");
  left_out(2, Verdict::unsupported, true, "the port has no module, it says");
  left_out(3, Verdict::skip, false, "the port does not support profile px4-v1.16.0");
  EXPECT_THAT(
      summary(run),
      HasSubstr("as conformant:\n"
                "  3 do not apply to this port, which need not have all modules and profiles:\n"
                "      1: the port has no module mixer\n"
                "      1: the port makes no module attitude_law of profile a\n"
                "      1: the port does not support profile px4-v1.16.0\n"
                "  1 unsupported: the port has no module, it says\n"));
  EXPECT_THAT(summary(run), HasSubstr("; 3 do not apply to this port, 1 unsupported ("));
}

TEST(Summary, TheClaimForEachProfileHasALine) {
  RunResult run = passing_run();
  EXPECT_THAT(summary(run), HasSubstr("\nconformance: conformant: px4-v1.5.5, exact, 2 rates"));
  run.results[0].profile = "px4-v1.3.4";
  EXPECT_THAT(summary(run),
              HasSubstr("\nconformance:\n"
                        "  conformant: px4-v1.3.4, exact, 2 rates, all groups\n"
                        "  partial: px4-v1.5.5, exact, 2 rates, parts of attitude (because: 1 "
                        "vector not run)\n"
                        "  cases "));
}

TEST(Summary, AnErrorIsNoPass) {
  RunResult run = passing_run();
  run.errors.push_back(Error{"cannot read", "golden/a.csv", 3, 0});
  EXPECT_THAT(summary(run), HasSubstr("\nerror: golden/a.csv:3: cannot read\n"));
  EXPECT_THAT(summary(run), HasSubstr("\nFAIL 1 error; 6 vectors passed, 0 failed"));
}

TEST(Summary, EqualErrorsAreShownOnceAndAtMostTwenty) {
  RunResult run = passing_run();
  for (int i = 0; i < 22; ++i) {
    for (int rate = 0; rate < 11; ++rate) {
      run.errors.push_back(Error{fmt::format("no golden {:02}", i), "", 0, 0});
    }
  }
  const std::string text = summary(run);
  EXPECT_THAT(text,
              HasSubstr("\nerror: no golden 00 (11 times)\nerror: no golden 01 (11 times)\n"));
  EXPECT_THAT(text, HasSubstr("\nerror: no golden 19 (11 times)\nand 2 other errors; see --json"));
  EXPECT_THAT(text, HasSubstr("\nFAIL 242 errors; "));
}

TEST(Summary, NothingThatPassedIsNoPass) {
  RunResult run = passing_run();
  for (VectorResult& result : run.results) result.verdict = Verdict::unsupported;
  EXPECT_THAT(summary(run), HasSubstr("\nNONE 0 vectors passed, 0 failed; 6 unsupported"));
  run.results[0].verdict = Verdict::xfail;
  EXPECT_THAT(summary(run), HasSubstr("\nNONE 0 vectors passed, 0 failed; 1 xfail, 5 unsupported"));
  run.results.clear();
  EXPECT_THAT(summary(run), HasSubstr("\nNONE 0 vectors passed, 0 failed (exact, 2 rates)"));
}

TEST(Summary, ACaseThatFailsEquallyAtSeveralRatesIsShownOnce) {
  RunResult run = passing_run();
  for (VectorResult& result : run.results) result.verdict = Verdict::fail;
  run.results[1].verdict = Verdict::crash;
  const std::string text = render_summary(run, wall_s, {}, {}, true);
  EXPECT_THAT(text, HasSubstr("roll_30@50hz\n"));
  EXPECT_THAT(text, Not(HasSubstr("roll_30@250hz\n")));
  EXPECT_THAT(text, HasSubstr("  also at 250 Hz: --filter 'px4-v1.5.5/attitude/roll_30@*'\n"));
  EXPECT_THAT(text, HasSubstr("pitch_5@50hz\n  fail: "));
  EXPECT_THAT(text, HasSubstr("pitch_5@250hz\n  crash: "));
}

// A case for each verdict and first stage, in the order of the law; the others are counted.
TEST(Summary, ShowsACaseOfEachFinding) {
  RunResult run = passing_run();
  run.results.clear();
  const auto add = [&](const std::string& group, const std::string& name, const char* channel) {
    VectorResult result = passed(group, name, run.rates.front());
    result.verdict = Verdict::fail;
    result.first = deviation(channel, 3, 1, 0, 1e-4);
    run.results.push_back(result);
  };
  for (const char* name : {"one", "two", "three"}) {
    add("late", name, "out/actuator_controls_0.control[0]");
    add("early", name, "out/vehicle_rates_setpoint.roll");
    add("more", name, "out/vehicle_rates_setpoint.pitch");
  }
  run.whys["px4-v1.5.5/early/one"] = "A small roll.";
  const std::string text = summary(run);
  EXPECT_LT(text.find("early/one@50hz\n"), text.find("late/one@50hz\n"));
  EXPECT_THAT(text, HasSubstr("  it tests:  A small roll.\n"));
  EXPECT_THAT(text, HasSubstr("\n  5 other cases, too: 3 in more, 2 in early\n"));
  EXPECT_THAT(text, Not(HasSubstr("more/one@50hz\n")));
  EXPECT_THAT(text, HasSubstr("\n9 of 9 cases failed, such as px4-v1.5.5/late/one, "));
  EXPECT_THAT(text, HasSubstr("px4-v1.5.5/early/three\n"));
  const std::string all = render_summary(run, wall_s, {}, {}, true);
  for (const char* name : {"early/one", "early/two", "more/three", "late/three"}) {
    EXPECT_THAT(all, HasSubstr(std::string("px4-v1.5.5/") + name + "@50hz\n  fail: "));
  }
  EXPECT_THAT(all, Not(HasSubstr("other cases")));
}

TEST(Summary, StartsWithTheFailureThatHidesOthers) {
  RunResult run = sample_run();
  const std::string text = summary(run);
  EXPECT_LT(text.find("\n  crash: "), text.find("\n  fail: "));
}

TEST(Summary, ShowsTheCaseThatTellsMost) {
  RunResult run = passing_run();
  for (VectorResult& result : run.results) result.verdict = Verdict::fail;
  Diagnosis diagnosis;
  diagnosis.specific_case = "px4-v1.5.5/attitude/yaw_step";
  const std::string text = render_summary(run, wall_s, {}, diagnosis);
  EXPECT_THAT(text, HasSubstr("yaw_step@50hz\n  fail: "));
  EXPECT_THAT(text, Not(HasSubstr("pitch_5@50hz\n  fail: ")));
}

// Seven profiles at eleven rates are too many tables for two screens.
TEST(Summary, SeveralProfilesShareATable) {
  RunResult run = passing_run();
  run.results[0].profile = "px4-v1.3.4";
  EXPECT_THAT(summary(run), HasSubstr("\nvectors by group and profile\n"
                                      "  group     px4-v1.3.4  px4-v1.5.5  total\n"));
  run.results[0].verdict = Verdict::fail;
  run.results[1].group = "tpa";
  EXPECT_THAT(summary(run),
              HasSubstr("\nvectors by group and profile; groups without a failure are "
                        "left out\n  group     px4-v1.3.4  px4-v1.5.5  total\n"
                        "  attitude         0/1           4    4/5\n"
                        "  total "));
  EXPECT_THAT(render_summary(run, wall_s, {}, {}, true), HasSubstr("px4-v1.3.4: vectors by group"));
}

TEST(Summary, CountsTheStagesThatDifferFirst) {
  EXPECT_THAT(
      summary(sample_run()),
      HasSubstr("\nfirst stage to differ: attitude law in 5 vectors, rate law in 1 vector, "));
}

TEST(Summary, ReasonsOfWhatIsCountedApartAreAggregated) {
  RunResult run = passing_run();
  for (VectorResult& result : run.results) {
    result.verdict = Verdict::skip;
    result.reason = "no profile";
  }
  run.results.push_back(passed("mixed", "d", Rate::hz(50)));
  run.results.back().verdict = Verdict::skip;
  run.results.back().reason = "no profile";
  EXPECT_THAT(summary(run), HasSubstr("  7 skip: no profile\n"
                                      "      px4-v1.5.5/attitude/pitch_5, "
                                      "px4-v1.5.5/attitude/roll_30, "
                                      "px4-v1.5.5/attitude/yaw_step and 1 more\n"));
}

TEST(Headroom, NamesTheTightestFirst) {
  RunResult run = passing_run();
  run.level = Level::numeric;
  const std::size_t control =
      *find_channel(Module::mc_att_control, "out/actuator_controls_0.control[0]");
  const std::size_t rate = *find_channel(Module::mc_att_control, "out/vehicle_rates_setpoint.yaw");
  run.results[0].tightest = Headroom{30, 4, control};
  run.results[1].tightest = Headroom{20, 5, control};
  run.results[2].tightest = Headroom{7.26, 6, rate};
  run.results[3].tightest = Headroom{1, 7, rate};
  run.results[3].verdict = Verdict::fail;  // its headroom does not count
  EXPECT_THAT(render_summary(run, wall_s, {}, {}, true),
              HasSubstr("\n  rates      7.3x on out/vehicle_rates_setpoint.yaw in "
                        "px4-v1.5.5/attitude/roll_30@50hz at tick 6\n"
                        "  controls   20.0x on out/actuator_controls_0.control[0] in "
                        "px4-v1.5.5/attitude/pitch_5@250hz at tick 5\n\n"));
}

TEST(Headroom, IsUnboundedWhenEveryValueAgrees) {
  RunResult run = passing_run();
  EXPECT_THAT(summary(run), Not(HasSubstr("headroom"))) << "the exact level has none";
  run.level = Level::numeric;
  EXPECT_THAT(summary(run), HasSubstr("every value that passed agrees to the bit"));
  run.results[0].tightest = Headroom{std::numeric_limits<double>::infinity(), 0, 0};
  EXPECT_THAT(summary(run), HasSubstr("every value that passed agrees to the bit"));
}

TEST(Colour, OnlyOnATerminalThatCanAndMay) {
  EXPECT_TRUE(wants_colour(true, nullptr, "xterm-256color"));
  EXPECT_TRUE(wants_colour(true, "", "xterm"));
  EXPECT_FALSE(wants_colour(true, "1", "xterm"));
  EXPECT_FALSE(wants_colour(true, "0", "xterm")) << "any value of NO_COLOR counts";
  EXPECT_FALSE(wants_colour(true, nullptr, "dumb"));
  EXPECT_FALSE(wants_colour(true, nullptr, nullptr));
  EXPECT_FALSE(wants_colour(false, nullptr, "xterm"));
}

TEST(Colour, AFileHasNeitherColourNorWidth) {
  std::FILE* file = std::tmpfile();
  ASSERT_NE(file, nullptr);
  const TerminalStyle style = terminal_style(file);
  EXPECT_FALSE(style.colour);
  EXPECT_EQ(style.width, 0);
  std::fclose(file);
}

// A port that does not support a profile has only skips there.
TEST(Summary, NamesTheProfilesThatRan) {
  RunResult run = passing_run();
  VectorResult skipped = run.results.front();
  skipped.profile = "px4-v1.3.4";
  skipped.verdict = Verdict::skip;
  run.results.push_back(skipped);
  EXPECT_THAT(summary(run), HasSubstr("(px4-v1.5.5, "));
}

}  // namespace
}  // namespace attest
