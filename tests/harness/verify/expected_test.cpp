#include "harness/verify/expected.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/harness/core/temporary_directory.hpp"

namespace attest {
namespace {

using testing::HasSubstr;

CaseResult result_of(const std::string& name, Verdict verdict, const Rate& rate = Rate::hz(250)) {
  CaseResult result;
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
    const auto expected = ExpectedFailures::read(directory_.write("expected.toml", text));
    EXPECT_TRUE(expected) << expected.error().to_string();
    RunResult run = run_;
    expected->apply(complete, run);
    return run;
  }
  std::string error_of(const std::string& text) {
    const auto expected = ExpectedFailures::read(directory_.write("expected.toml", text));
    return expected ? "" : expected.error().to_string();
  }

  TemporaryDirectory directory_;
  RunResult run_ = [] {
    RunResult run;
    run.results = {result_of("a", Verdict::pass), result_of("b", Verdict::fail),
                   result_of("b", Verdict::crash, Rate::hz(50)),
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
       {"*", "?*", "**", "*/*", "*@*", "[!x]*", "px4-*", "px4-v1.3.4/*", "px4-v1.5.5/*@*"}) {
    EXPECT_THAT(error_of("[expected]\n\"" + pattern + "\" = \"known\"\n"),
                HasSubstr(":2:1: `" + pattern + "` would excuse every case"));
  }
  for (const std::string pattern : {"px4-v1.5.5/tpa/*", "*/tpa/*", "*latch*", "*/slow@50hz"}) {
    EXPECT_EQ(error_of("[expected]\n\"" + pattern + "\" = \"known\"\n"), "");
  }
}

TEST_F(Expected, WhatIsWrittenIsReadAndExcusesTheRun) {
  EXPECT_THAT(expected_failures_of(run_), HasSubstr("'px4-v1.5.5/tpa/b@50hz'"));
  run_.all_configurations = true;
  const std::string text = expected_failures_of(run_);
  EXPECT_THAT(text, HasSubstr("'px4-v1.5.5/tpa/b@*' = 'fail: say why"));
  EXPECT_FALSE(applied(text).failed());
}

TEST_F(Expected, OneConfigurationThatFailsIsWrittenByItself) {
  run_.results.push_back(result_of("b", Verdict::pass, Rate::hz(1000)));
  EXPECT_THAT(expected_failures_of(run_), HasSubstr("'px4-v1.5.5/tpa/b@50hz' = 'crash"));
}

}  // namespace
}  // namespace attest
