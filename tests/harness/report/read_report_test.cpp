#include "harness/report/read_report.hpp"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/report/report.hpp"
#include "tests/harness/core/temporary_directory.hpp"
#include "tests/harness/report/sample_run.hpp"

namespace attest {
namespace {

using testing::HasSubstr;

class ReadReport : public testing::Test {
 protected:
  Result<RunResult> read(const std::string& text) {
    std::ofstream(path_) << text;
    return read_report(path_.string());
  }
  std::string error_of(const std::string& text) {
    const auto run = read(text);
    return run ? "" : run.error().to_string();
  }

  // The report of `run`, read and written again.
  std::string again(const RunResult& run) {
    auto read_back = read(json_report(run));
    if (!read_back) return read_back.error().to_string();
    read_back->suite = run.suite;
    return json_report(*read_back);
  }

 private:
  TemporaryDirectory directory_;
  std::filesystem::path path_ = directory_.path() / "report.json";
};

TEST_F(ReadReport, IsTheInverseOfJsonReport) {
  EXPECT_EQ(again(sample_run()), json_report(sample_run()));
  RunResult run = passing_run();
  EXPECT_EQ(again(run), json_report(run));
  run.selection = "--group tpa";
  run.shard = {2, 3};
  run.all_configurations = true;
  run.parameters = {{0, "MC_ROLL_P", 6.1f}};
  run.timing = "late.json";
  run.fraction_bits = 22;
  run.fixed_step = Rate::hz(1000, 3);
  run.lacks = *Lacks::parse(std::vector<std::string>{"sticks", "MC_YAW_FF=0.25"});
  run.suite_reference = "acme 1.2";
  run.limits.own_process = false;
  EXPECT_EQ(again(run), json_report(run));
}

TEST_F(ReadReport, OtherFilesAreErrors) {
  EXPECT_THAT(read_report("/nowhere/report.json").error().to_string(), HasSubstr("/nowhere"));
  for (const char* text : {"[]", "{}", "{\"schema\": \"attest-stress-1\"}"}) {
    EXPECT_THAT(error_of(text), HasSubstr("is no report of `attest run --json`")) << text;
  }
  EXPECT_THAT(error_of("no JSON"), HasSubstr(":1:2: is not JSON from here on"));
}

TEST_F(ReadReport, AMalformedMemberIsNamed) {
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = json_report(sample_run());
    return error_of(text.replace(text.find(from), from.size(), to));
  };
  EXPECT_THAT(with("\"date\"", "\"day\""), HasSubstr("`date` is missing"));
  EXPECT_THAT(with("\"level\": \"numeric\"", "\"level\": \"lax\""), HasSubstr("lax"));
  EXPECT_THAT(with("\"verdict\": \"", "\"verdict\": \"un"), HasSubstr("there is no verdict `un"));
  EXPECT_THAT(with("\"errors\": [", "\"errors\": null, \"x\": ["),
              HasSubstr("`errors` is not a list"));
  EXPECT_THAT(with("\"tick\": ", "\"tick\": -"), HasSubstr("`tick` is not a count"));
}

TEST_F(ReadReport, NumbersThatContradictTheResultsAreErrors) {
  const auto with = [&](const RunResult& run, const std::string& from, const std::string& to) {
    std::string text = json_report(run);
    return error_of(text.replace(text.find(from), from.size(), to));
  };
  EXPECT_THAT(with(sample_run(), "\"fail\": 7", "\"fail\": 6"),
              HasSubstr("report.json: contradicts itself: its totals have 6 fail, its results 7"));
  EXPECT_THAT(
      with(sample_run(), "\"verdict\": \"fail\"", "\"verdict\": \"pass\""),
      HasSubstr("contradicts itself: px4-v1.5.5/attitude/yaw_step@100hz has the verdict pass, "
                "but has a deviation"));
  EXPECT_THAT(with(sample_run(), "\"vectors\": 21", "\"vectors\": 19"),
              HasSubstr("19 vectors were selected, but it has 20 results"));
  EXPECT_THAT(with(passing_run(), "\"vectors\": 6", "\"vectors\": 7"),
              HasSubstr("contradicts itself: 7 vectors were selected, but it has 6 results"));
  RunResult stopped = passing_run();
  stopped.stopped_early = true;
  EXPECT_EQ(with(stopped, "\"vectors\": 6", "\"vectors\": 7"), "");
}

TEST_F(ReadReport, WhatAPortLacksMustBeSettled) {
  RunResult run = passing_run();
  run.results[0].silent = {"rate_unit/rate_ctrl_status"};
  EXPECT_THAT(error_of(json_report(run)),
              HasSubstr("no vector failed because rate_unit/rate_ctrl_status is not published"));
  run.results[1].silent = run.results[0].silent;
  run.results[1].verdict = Verdict::fail;
  EXPECT_EQ(error_of(json_report(run)), "");

  run = passing_run();
  run.results[0].lacking = {"sticks"};
  EXPECT_THAT(error_of(json_report(run)), HasSubstr("lacks features, but is not unsupported"));
  run.results[0].verdict = Verdict::unsupported;
  EXPECT_THAT(error_of(json_report(run)), HasSubstr("which `port` does not have"));
  run.lacks = *Lacks::parse(std::vector<std::string>{"sticks"});
  EXPECT_EQ(error_of(json_report(run)), "");
}

}  // namespace
}  // namespace attest
