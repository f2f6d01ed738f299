#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/report/report.hpp"
#include "tests/harness/report/baseline.hpp"
#include "tests/harness/report/sample_run.hpp"

namespace attest {
namespace {

using nlohmann::json;

TEST(JsonReport, IsTheReviewedOne) {
  EXPECT_TRUE(is_baseline("report.json", json_report(sample_run())));
  EXPECT_TRUE(is_baseline("report_pass.json", json_report(passing_run())));
}

TEST(JsonReport, DoesNotDependOnTimes) {
  RunResult slow = sample_run();
  for (VectorResult& result : slow.results) result.elapsed_s += 1;
  EXPECT_EQ(json_report(slow), json_report(sample_run()));
  EXPECT_THAT(json_report(slow), testing::Not(testing::HasSubstr("elapsed")));
}

TEST(JsonReport, TotalsAddUpAndNameEveryVerdict) {
  const json report = json::parse(json_report(sample_run()));
  EXPECT_EQ(report["totals"].size(), static_cast<std::size_t>(verdict_count));
  std::size_t sum = 0;
  for (const auto& [verdict, count] : report["totals"].items()) {
    EXPECT_GT(count.get<std::size_t>(), 0U) << verdict << ": the sample shows every verdict";
    sum += count.get<std::size_t>();
  }
  EXPECT_EQ(sum, report["results"].size());
}

TEST(JsonReport, ConformantIsWhatTheRunSays) {
  EXPECT_EQ(json::parse(json_report(passing_run()))["conformant"], true);
  EXPECT_EQ(json::parse(json_report(sample_run()))["conformant"], false);
  EXPECT_EQ(json::parse(json_report(RunResult{}))["conformant"], false);
}

TEST(JsonReport, SurvivesBytesThatAreNotUtf8) {
  RunResult run = passing_run();
  run.port_name += "\xff";
  run.errors.push_back(Error{"\xc3", "\x80", 0, 0});
  EXPECT_EQ(json::parse(json_report(run))["port"]["name"], "reference\xef\xbf\xbd");
}

}  // namespace
}  // namespace attest
