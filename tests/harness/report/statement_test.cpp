#include "harness/report/statement.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pugixml.hpp>

#include "tests/harness/report/sample_run.hpp"

namespace attest {
namespace {

using testing::HasSubstr;

// Passing, of a suite with these groups.
RunResult run_of(const std::vector<std::string>& passing, const std::vector<std::string>& all) {
  RunResult run;
  run.rates = {Rate::hz(100), Rate::hz(250)};
  for (const std::string& group : all) run.all_groups.push_back("px4-v1.5.5/" + group);
  run.cases_version = "1.0";
  run.golden_version = "1.1";
  for (const std::string& group : passing) {
    run.results.push_back(passed(group, "a", Rate::hz(250)));
  }
  return run;
}

TEST(Statement, NamesWhatConforms) {
  EXPECT_EQ(conformance_statement(run_of({"attitude", "tpa"}, {"attitude", "tpa"})),
            "px4-v1.5.5, numeric, 2 rates, all groups; cases 1.0, golden 1.1");
  EXPECT_THAT(conformance_statement(run_of({"attitude", "tpa"}, {"attitude", "modes", "tpa"})),
              HasSubstr("2 rates, all groups but modes;"));
  EXPECT_THAT(conformance_statement(run_of({"tpa"}, {"attitude", "modes", "tpa"})),
              HasSubstr("2 rates, group tpa;"));
}

TEST(Statement, SaysWhatWasAllowedToFixedPoint) {
  RunResult run = run_of({"tpa"}, {"tpa"});
  run.fraction_bits = 22;
  EXPECT_THAT(conformance_statement(run),
              HasSubstr("px4-v1.5.5, numeric for fixed point with 22 fraction bits, 2 rates"));
  run.level = Level::exact;
  EXPECT_THAT(conformance_statement(run), HasSubstr("px4-v1.5.5, exact, 2 rates"));
}

// At other rates it is not judged, and the statement claims nothing of them.
TEST(Statement, SaysTheFixedStepOfAPort) {
  RunResult run = run_of({"attitude", "tpa"}, {"attitude", "tpa"});
  run.fixed_step = Rate::hz(250);
  run.results.push_back(passed("tpa", "a", Rate::hz(100)));
  run.results.back().verdict = Verdict::unsupported;
  run.results.back().reason = "the port has a fixed step of 250 Hz, and this runs at another rate";
  EXPECT_THAT(conformance_statement(run),
              HasSubstr("px4-v1.5.5, numeric, fixed step of 250 Hz, all groups;"));
  run.results.push_back(passed("tpa", "jitter", Rate::hz(250)));
  run.results.back().verdict = Verdict::unsupported;
  EXPECT_THAT(conformance_statement(run), HasSubstr("fixed step of 250 Hz, all groups but tpa;"));
}

// Neither what is unsupported nor what is expected to fail is conformant.
TEST(Statement, WhatIsCountedApartIsLeftOut) {
  for (const Verdict verdict : {Verdict::unsupported, Verdict::xfail}) {
    RunResult run = run_of({"attitude", "modes", "tpa"}, {"attitude", "modes", "tpa"});
    run.results.push_back(passed("modes", "b", Rate::hz(250)));
    run.results.back().verdict = verdict;
    EXPECT_THAT(conformance_statement(run), HasSubstr("all groups but modes;"));
  }
}

TEST(Statement, EachProfileHasItsOwn) {
  RunResult run = run_of({"attitude", "tpa"}, {"attitude", "tpa"});
  run.all_groups.push_back("px4-v1.3.4/tpa");
  run.results.push_back(passed("tpa", "b", Rate::hz(250)));
  run.results.back().profile = "px4-v1.3.4";
  EXPECT_EQ(conformance_statement(run),
            "px4-v1.3.4, numeric, 2 rates, all groups; px4-v1.5.5, numeric, 2 rates, all groups; "
            "cases 1.0, golden 1.1");
  run.results.back().verdict = Verdict::skip;  // a port need not do the older law
  EXPECT_EQ(conformance_statement(run),
            "px4-v1.5.5, numeric, 2 rates, all groups; cases 1.0, golden 1.1");
}

TEST(Statement, SaysWhyThereIsNone) {
  EXPECT_EQ(conformance_statement(sample_run()),
            "none: 4 groups fail (attitude, flight, mixed, robustness)");
  RunResult run = run_of({"tpa"}, {"tpa"});
  run.stopped_early = true;
  EXPECT_EQ(conformance_statement(run), "none: the run is not complete");
  EXPECT_EQ(conformance_statement(run_of({}, {"tpa"})), "none: no group passes as a whole");
}

TEST(Badge, IsAnSvgThatSaysIt) {
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(badge(passing_run()).c_str()));
  const pugi::xml_node svg = document.child("svg");
  EXPECT_STREQ(svg.attribute("aria-label").value(), "attest: px4-v1.5.5 exact");
  EXPECT_THAT(svg.child("title").text().get(), HasSubstr("px4-v1.5.5, exact, 2 rates"));
  ASSERT_TRUE(document.load_string(badge(sample_run()).c_str()));
  EXPECT_STREQ(document.child("svg").attribute("aria-label").value(), "attest: does not conform");
}

}  // namespace
}  // namespace attest
