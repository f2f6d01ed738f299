#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pugixml.hpp>

#include "harness/report/failure_text.hpp"
#include "harness/report/report.hpp"
#include "harness/report/text.hpp"
#include "tests/harness/report/baseline.hpp"
#include "tests/harness/report/sample_run.hpp"

namespace attest {
namespace {

using testing::HasSubstr;

pugi::xml_document parsed(const RunResult& run) {
  pugi::xml_document document;
  const std::string text = junit_report(run);
  const pugi::xml_parse_result done = document.load_string(text.c_str(), pugi::parse_full);
  EXPECT_TRUE(done) << done.description();
  return document;
}

pugi::xml_node testcase(const pugi::xml_document& document, const char* name) {
  const std::string path = std::string("//testcase[@name='") + name + "']";
  return document.select_node(path.c_str()).node();
}

TEST(JunitReport, IsTheReviewedOne) {
  EXPECT_TRUE(is_baseline("junit.xml", junit_report(sample_run())));
  EXPECT_TRUE(is_baseline("junit_pass.xml", junit_report(passing_run())));
}

TEST(JunitReport, CountsAreThoseOfTheElements) {
  const pugi::xml_document document = parsed(sample_run());
  const auto count = [](pugi::xml_node node, const char* path) {
    return static_cast<unsigned>(node.select_nodes(path).size());
  };
  const pugi::xml_node root = document.child("testsuites");
  EXPECT_EQ(root.attribute("tests").as_uint(), count(root, "testsuite/testcase"));
  EXPECT_EQ(root.attribute("failures").as_uint(), count(root, "testsuite/testcase/failure"));
  EXPECT_EQ(root.attribute("errors").as_uint(), count(root, "testsuite/testcase/error"));
  EXPECT_GT(root.attribute("failures").as_uint(), 0U);
  for (const pugi::xml_node suite : root.children("testsuite")) {
    EXPECT_EQ(suite.attribute("tests").as_uint(), count(suite, "testcase"));
    EXPECT_EQ(suite.attribute("failures").as_uint(), count(suite, "testcase/failure"));
    EXPECT_EQ(suite.attribute("errors").as_uint(), count(suite, "testcase/error"));
    EXPECT_EQ(suite.attribute("skipped").as_uint(), count(suite, "testcase/skipped"));
  }
}

TEST(JunitReport, AFailureSaysWhatTheRunLooksLike) {
  std::optional<Diagnosis> diagnosis;
  const auto looks = [&] {
    pugi::xml_document document;
    document.load_string(junit_report(sample_run(), diagnosis).c_str());
    std::size_t count = 0;
    for (const auto& found : document.select_nodes("//failure")) {
      const std::string text = found.node().text().get();
      count += text.find("in this run, it looks like:\n  `yaw-reversed`") != text.npos ? 1 : 0;
    }
    return count;
  };
  EXPECT_EQ(looks(), 0u);
  Suspect suspect;
  suspect.fault = faults::find_fault("yaw-reversed");
  diagnosis.emplace().suspects.push_back(suspect);
  EXPECT_GT(looks(), 0u);
}

TEST(JunitReport, EveryResultIsOneTestcaseOfItsGroup) {
  const RunResult run = sample_run();
  const pugi::xml_document document = parsed(run);
  std::set<std::string> names;
  for (const auto& found : document.select_nodes("//testcase[@classname!='attest.environment']")) {
    EXPECT_STREQ(found.node().attribute("classname").value(),
                 found.node().parent().attribute("name").value());
    names.insert(found.node().attribute("name").value());
  }
  EXPECT_EQ(names.size(), run.results.size());
}

TEST(JunitReport, WhatAPortDidToItselfIsAnError) {
  const pugi::xml_document document = parsed(sample_run());
  EXPECT_STREQ(testcase(document, "yaw_step@250hz").child("failure").attribute("type").value(),
               "fail");
  EXPECT_STREQ(testcase(document, "zero_thrust@250hz").child("failure").attribute("type").value(),
               "non-finite");
  EXPECT_STREQ(testcase(document, "yaw_limit@250hz").child("failure").attribute("type").value(),
               "xpass");
  for (const auto& [name, type] :
       {std::pair("nan_input@3000hz", "crash"), std::pair("inf_input@3000hz", "timeout"),
        std::pair("denormals@3000hz", "protocol")}) {
    EXPECT_STREQ(testcase(document, name).child("error").attribute("type").value(), type);
  }
  for (const char* name : {"rattitude@250hz", "on_threshold@250hz", "yaw_freeze@250hz"}) {
    EXPECT_STRNE(testcase(document, name).child("skipped").attribute("message").value(), "");
  }
  EXPECT_FALSE(testcase(document, "roll_30@250hz").first_child());
}

TEST(JunitReport, TheContentIsTheFailureText) {
  const RunResult run = sample_run();
  const pugi::xml_document document = parsed(run);
  std::size_t compared = 0;
  for (const VectorResult& result : run.results) {
    if (!fails_a_run(result.verdict)) continue;
    const std::string name = result.name + "@" + result.configuration().label();
    const pugi::xml_node node = testcase(document, name.c_str()).first_child();
    EXPECT_EQ(node.text().get(), failure_text(result, run));
    EXPECT_EQ(node.attribute("message").value(), failure_headline(result));
    ++compared;
  }
  EXPECT_EQ(compared, 12U);
}

TEST(JunitReport, HostileWordsComeThroughAsText) {
  const std::string text = junit_report(sample_run());
  EXPECT_EQ(text.find("<script>"), std::string::npos);
  EXPECT_THAT(text, HasSubstr("&lt;/failure&gt;]]&gt;&lt;script&gt;alert(1)"));
  EXPECT_EQ(text.find("&#27;"), std::string::npos) << "XML 1.0 has no such character";
  const pugi::xml_document document = parsed(sample_run());
  EXPECT_THAT(testcase(document, "nan_input@3000hz").child("error").attribute("message").value(),
              HasSubstr("</failure>]]><script>alert(1)</script> \\x1b[2J\\x01 \\xff and a second"));
}

TEST(JunitReport, TimesAreSumsWithoutExponents) {
  RunResult run = passing_run();
  run.results[0].elapsed_s = 1e-7;
  run.results[1].elapsed_s = 12345.5;
  run.results[2].elapsed_s = -1;
  run.results[3].elapsed_s = std::numeric_limits<double>::quiet_NaN();
  run.results[4].elapsed_s = 0.25;
  run.results[5].elapsed_s = 0.25;
  const pugi::xml_document document = parsed(run);
  EXPECT_STREQ(document.child("testsuites").attribute("time").value(), "12346.000000");
  EXPECT_STREQ(testcase(document, "pitch_5@50hz").attribute("time").value(), "0.000000");
  EXPECT_STREQ(testcase(document, "roll_30@250hz").attribute("time").value(), "0.000000");
}

TEST(JunitReport, ErrorsOfTheEnvironmentAreNotLost) {
  RunResult run = passing_run();
  run.errors.push_back(Error{"cannot read", "golden/a.csv", 3, 0});
  const pugi::xml_document document = parsed(run);
  EXPECT_EQ(document.child("testsuites").attribute("errors").as_uint(), 1U);
  EXPECT_STREQ(testcase(document, "error_1").child("error").text().get(),
               "golden/a.csv:3: cannot read");
}

}  // namespace
}  // namespace attest
