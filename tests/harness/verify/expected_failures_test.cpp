#include "harness/verify/expected_failures.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/harness/core/temporary_directory.hpp"

namespace attest {
namespace {

using testing::HasSubstr;

VectorResult result_of(const std::string& name, Verdict verdict, const Rate& rate = Rate::hz(250)) {
  VectorResult result;
  result.profile = "px4-v1.5.5";
  result.group = "tpa";
  result.name = name;
  result.rate = rate;
  result.verdict = verdict;
  return result;
}

class Expected : public testing::Test {
 protected:
  RunResult applied(const std::string& text, bool complete = true) {
    const auto expected = ExpectedFailures::read(directory_.write("expected.toml", text), suite_);
    EXPECT_TRUE(expected) << expected.error().to_string();
    RunResult run = run_;
    expected->apply(complete, run);
    return run;
  }
  std::string error_of(const std::string& text) {
    const auto expected = ExpectedFailures::read(directory_.write("expected.toml", text), suite_);
    return expected ? "" : expected.error().to_string();
  }

  TemporaryDirectory directory_;
  std::vector<std::string> suite_ = {"px4-v1.5.5/tpa/a@50hz", "px4-v1.5.5/tpa/b@250hz",
                                     "px4-v1.5.5/mixer/x_latch@250hz", "px4-v1.3.4/tpa/a@250hz",
                                     "px4-v1.3.4/mixer/slow@50hz"};
  RunResult run_ = [] {
    RunResult run;
    run.results = {result_of("a", Verdict::pass), result_of("b", Verdict::fail),
                   result_of("b", Verdict::non_finite, Rate::hz(50)),
                   result_of("c", Verdict::unsupported)};
    return run;
  }();
};

TEST_F(Expected, AFailureThatIsListedDoesNotFailTheRun) {
  const RunResult run = applied("[expected]\n\"px4-v1.5.5/tpa/b@*\" = \"known\"\n");
  EXPECT_EQ(run.results[1].verdict, Verdict::xfail);
  EXPECT_EQ(run.results[2].verdict, Verdict::xfail);
  EXPECT_EQ(run.results[1].reason, "known");
  EXPECT_FALSE(run.failed());
}

TEST_F(Expected, APassThatIsListedFailsTheRun) {
  const RunResult run = applied("[expected]\n\"px4-v1.5.5/tpa/a\" = \"known\"\n");
  EXPECT_EQ(run.results[0].verdict, Verdict::xpass);
  EXPECT_TRUE(run.failed());
}

TEST_F(Expected, WhatIsCountedApartStays) {
  const RunResult run = applied("[expected]\n\"px4-v1.5.5/tpa/c\" = \"known\"\n");
  EXPECT_EQ(run.results[3].verdict, Verdict::unsupported);
}

TEST_F(Expected, AnEntryThatNamesNothingIsAnErrorOfACompleteRun) {
  const std::string text = "[expected]\n\"px4-v1.5.5/tpa/d\" = \"known\"\n";
  ASSERT_EQ(applied(text).errors.size(), 1u);
  EXPECT_THAT(applied(text).errors[0].to_string(), HasSubstr("`px4-v1.5.5/tpa/d` is no case"));
  EXPECT_TRUE(applied(text, false).errors.empty());
}

TEST_F(Expected, BadFilesAreRefusedWithTheirLine) {
  EXPECT_THAT(error_of("[expected]\n\"a\" = \"\"\n"),
              HasSubstr("expected.toml:2:1: needs a reason"));
  EXPECT_THAT(error_of("[expected]\n\"a\" = 3\n"), HasSubstr("must be text"));
  EXPECT_THAT(error_of("[expcted]\n"), HasSubstr("expcted"));
}

TEST_F(Expected, APatternThatExcusesEverythingIsRefused) {
  for (const std::string pattern :
       {"*", "?*", "**", "*/*", "*@*", "[!x]*", "px4-*", "px4-v1.3.4/*", "px4-v1.5.5/*@*", "*hz",
        "*0hz", "px4-v1.5.5/[a-z]*", "*/[!q]*"}) {
    EXPECT_THAT(error_of("[expected]\n\"" + pattern + "\" = \"known\"\n"),
                HasSubstr(":2:1: `" + pattern + "` would excuse every case of px4-"))
        << pattern;
  }
  for (const std::string pattern :
       {"px4-v1.5.5/tpa/*", "*/tpa/*", "*latch*", "*/slow@50hz", "px4-v1.5.5/[a-l]*"}) {
    EXPECT_EQ(error_of("[expected]\n\"" + pattern + "\" = \"known\"\n"), "");
  }
}

TEST_F(Expected, AGroupMayBeTheOnlyOneOfTheSuite) {
  suite_ = {"px4-v1.5.5/tpa/a@50hz", "px4-v1.5.5/tpa/b@250hz"};
  EXPECT_EQ(error_of("[expected]\n\"px4-v1.5.5/tpa/*\" = \"known\"\n"), "");
  EXPECT_NE(error_of("[expected]\n\"px4-v1.5.5/*\" = \"known\"\n"), "");
}

TEST_F(Expected, AnEntryExcusesTheVerdictsThatItNames) {
  run_.results = {result_of("b", Verdict::crash), result_of("b", Verdict::fail, Rate::hz(50)),
                  result_of("b", Verdict::timeout, Rate::hz(100))};
  RunResult run = applied("[expected]\n\"px4-v1.5.5/tpa/b@*\" = \"known\"\n");
  EXPECT_EQ(run.results[0].verdict, Verdict::crash);
  EXPECT_EQ(run.results[0].reason,
            "the list of expected failures excuses fail, non-finite here, not crash");
  EXPECT_EQ(run.results[1].verdict, Verdict::xfail);
  EXPECT_EQ(run.results[2].verdict, Verdict::timeout);
  run = applied("[expected]\n\"px4-v1.5.5/tpa/b@*\" = \"crash, timeout: known\"\n");
  EXPECT_EQ(run.results[0].verdict, Verdict::xfail);
  EXPECT_EQ(run.results[0].reason, "crash, timeout: known");
  EXPECT_EQ(run.results[1].verdict, Verdict::fail);
  EXPECT_EQ(run.results[2].verdict, Verdict::xfail);
  run = applied(
      "[expected]\n\"px4-v1.5.5/tpa/b@*\" = \"crash: known\"\n"
      "\"px4-v1.5.5/tpa/b@50hz\" = \"fail: known\"\n");
  EXPECT_EQ(run.results[0].verdict, Verdict::xfail);
  EXPECT_EQ(run.results[1].verdict, Verdict::xfail);
}

TEST_F(Expected, AReasonWithOtherWordsBeforeAColonNamesNoVerdict) {
  for (const char* reason :
       {"skip: known", "see: known", "fail, see: known", "crash", "xpass: x"}) {
    const RunResult run =
        applied(std::string("[expected]\n\"px4-v1.5.5/tpa/b@*\" = \"") + reason + "\"\n");
    EXPECT_EQ(run.results[1].verdict, Verdict::xfail) << reason;
    EXPECT_EQ(run.results[2].verdict, Verdict::xfail) << reason;
  }
}

TEST_F(Expected, WhatIsWrittenIsReadAndExcusesTheRun) {
  EXPECT_THAT(expected_failures_of(run_), HasSubstr("'px4-v1.5.5/tpa/b@50hz'"));
  run_.all_configurations = true;
  const std::string text = expected_failures_of(run_);
  EXPECT_THAT(text, HasSubstr("'px4-v1.5.5/tpa/b@*' = 'fail, non-finite: say why"));
  EXPECT_FALSE(applied(text).failed());
}

// The shards of a run can have a list. A new list that is made from their merged reports excuses
// the same verdicts.
TEST_F(Expected, AnExpectedFailureIsWrittenWithTheVerdictsThatWereExcused) {
  run_.results = {result_of("b", Verdict::crash)};
  run_.results[0].reason = "died at tick 20";
  RunResult merged = applied("[expected]\n\"px4-v1.5.5/tpa/b@*\" = \"crash, timeout: known\"\n");
  ASSERT_EQ(merged.results[0].verdict, Verdict::xfail);
  merged.all_configurations = true;
  const std::string text = expected_failures_of(merged);
  EXPECT_THAT(text, HasSubstr("'px4-v1.5.5/tpa/b@*' = 'crash, timeout: say why"));
  EXPECT_FALSE(applied(text).failed());
}

TEST_F(Expected, OneConfigurationThatFailsIsWrittenByItself) {
  run_.results.push_back(result_of("b", Verdict::pass, Rate::hz(1000)));
  EXPECT_THAT(expected_failures_of(run_), HasSubstr("'px4-v1.5.5/tpa/b@50hz' = 'non-finite: say"));
}

}  // namespace
}  // namespace attest
