// Reports for the pages of GitHub and GitLab.
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/report/github.hpp"
#include "harness/report/report.hpp"
#include "tests/harness/report/baseline.hpp"
#include "tests/harness/report/sample_run.hpp"

namespace attest {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

std::size_t lines_that_start(const std::string& text, const std::string& begin) {
  std::size_t count = text.starts_with(begin) ? 1 : 0;
  for (std::size_t at = 0; (at = text.find("\n" + begin, at)) != std::string::npos; ++at) ++count;
  return count;
}

TEST(GithubAnnotations, AreAtMostTenAndOneThatCountsTheRest) {
  const RunResult run = sample_run();
  const std::string text = github_annotations(run);
  EXPECT_TRUE(is_baseline("github_annotations.txt", text));
  RunResult no_errors = run;
  no_errors.errors.clear();
  EXPECT_EQ(lines_that_start(github_annotations(no_errors), "::error "), annotations_shown);
  EXPECT_EQ(lines_that_start(text, "::warning "), 1u);
  EXPECT_THAT(text, HasSubstr("2 more failing vectors are not shown here"));
}

TEST(GithubAnnotations, TheFirstOfEachGroupComesFirst) {
  const std::string text = github_annotations(sample_run());
  for (const char* group : {"attitude", "mixed", "robustness", "flight"}) {
    EXPECT_LT(text.find(std::string("px4-v1.5.5/") + group), text.find("pitch_step")) << group;
  }
}

TEST(GithubAnnotations, WordsOfAPortAreNoCommands) {
  RunResult run = passing_run();
  run.results.front().verdict = Verdict::crash;
  run.results.front().reason = "100%\r\n::set-output name=x::y";
  const std::string text = github_annotations(run);
  EXPECT_EQ(lines_that_start(text, "::"), 1u);
  EXPECT_THAT(text, HasSubstr("100%25"));
  EXPECT_EQ(github_annotations(passing_run()), "");
}

TEST(WithoutCommands, TheTextCannotEndThePart) {
  const std::string text = without_commands("::error::x\n");
  const std::size_t end = text.rfind("\n::", text.size() - 2) + 1;
  EXPECT_THAT(text, StartsWith("::stop-commands::"));
  EXPECT_EQ(text.substr(17, 64), text.substr(end + 2, 64));
  EXPECT_EQ(text.find(text.substr(end)), end);
  EXPECT_NE(without_commands("a").substr(17, 64), without_commands("b").substr(17, 64));
}

TEST(GithubSummary, IsTheSummaryAsPreformattedText) {
  RunResult run = sample_run();
  run.results.front().reason = "```\n# a heading";
  const std::string text = github_summary(run, 1.2, {});
  EXPECT_THAT(text, StartsWith("### attest: FAIL\n\n"));
  EXPECT_THAT(text, HasSubstr("\nFAIL "));
  EXPECT_THAT(text, Not(HasSubstr("\n# a heading")));
  EXPECT_THAT(github_summary(passing_run(), 1.2, {}), HasSubstr("### attest: PASS"));
}

TEST(GithubSummary, HasATableOfGroupsAndRates) {
  RunResult run = sample_run();
  const std::string text = github_summary(run, 1.2, {});
  EXPECT_THAT(text, HasSubstr("\n| group | 100 | 250 | 1000/3 | 3000 | total |\n"
                              "|---|---:|---:|---:|---:|---:|\n"
                              "| attitude | \u274c 1/2 |"));
  for (VectorResult& result : run.results) result.group = "a|<b>\n# c";
  EXPECT_THAT(github_summary(run, 1.2, {}), HasSubstr("\n| a\\|\\<b>"));
}

TEST(CodeQuality, HasEachFailingCaseOnce) {
  const std::string text = code_quality_report(sample_run(), {});
  EXPECT_TRUE(is_baseline("code_quality.json", text));
  std::set<std::string> fingerprints;
  for (const json& entry : json::parse(text)) {
    EXPECT_TRUE(fingerprints.insert(entry["fingerprint"]).second);
    EXPECT_THAT(entry["location"]["path"].get<std::string>(), StartsWith("cases/px4-v1.5.5/"));
    EXPECT_EQ(entry["location"]["lines"]["begin"], 1);
  }
  EXPECT_EQ(code_quality_report(passing_run(), {}), "[]\n");
}

}  // namespace
}  // namespace attest
