#include "harness/report/statement.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pugixml.hpp>

#include "tests/harness/report/sample_run.hpp"

namespace attest {
namespace {

using testing::HasSubstr;

// A run of the released suite: a case at two rates of each of these groups, all of which pass.
RunResult run_of(const std::vector<std::string>& groups) {
  RunResult run;
  run.rates = {Rate::hz(100), Rate::hz(250)};
  run.cases_version = "1.0";
  run.golden_version = "1.1";
  run.suite_sha256 = std::string(64, 'a');
  run.suite_is_released = true;
  run.port = "builtin";
  run.port_modules = only(Module::mc_att_control);
  run.date = "2026-03-31";
  run.limits.barrier = {true, true};
  for (const std::string& group : groups) {
    for (const LoopRate& rate : run.rates) {
      run.suite["px4-v1.5.5/" + group][rate] = 1;
      run.results.push_back(passed(group, "a", rate));
    }
  }
  return run;
}

TEST(Statement, NamesWhatConformsAndToWhat) {
  RunResult run = run_of({"attitude", "tpa"});
  EXPECT_EQ(conformance_statement(run),
            "conformant: px4-v1.5.5, numeric, 2 rates, all groups; cases 1.0, golden 1.1 "
            "(released suite aaaaaaaaaaaa), port builtin, 2026-03-31");
  run.port = "lib:./mine.so";
  run.port_sha256 = std::string(64, 'b');
  EXPECT_THAT(conformance_statement(run), HasSubstr(", port bbbbbbbbbbbb, 2026-03-31"));
  EXPECT_THAT(conformance_statement(run_of({"mixer", "tpa"})),
              HasSubstr("2 rates, all groups, with mixer;"));
}

TEST(Statement, OfAPartSaysWhatIsMissing) {
  RunResult run = run_of({"attitude", "modes", "tpa"});
  run.results[2].verdict = Verdict::unsupported;
  EXPECT_THAT(conformance_statement(run),
              HasSubstr("partial: px4-v1.5.5, numeric, 2 rates, groups attitude, tpa and parts of "
                        "modes (because: 1 vector unsupported (modes)); cases"));
  run.suite_is_released = false;
  EXPECT_THAT(conformance_statement(run), HasSubstr("(because: custom suite; 1 vector"));
  EXPECT_THAT(conformance_statement(run), HasSubstr("(custom suite aaaaaaaaaaaa)"));
}

TEST(Statement, CountsManyPartsOfGroups) {
  const std::vector<std::string> groups{"arming", "attitude", "modes", "rates"};
  RunResult run = run_of(groups);
  const std::vector<VectorResult> passed = run.results;
  for (VectorResult result : passed) {
    result.verdict = Verdict::unsupported;
    run.results.push_back(result);
  }
  EXPECT_THAT(conformance_statement(run), HasSubstr("2 rates, parts of 4 groups (because: "));
}

TEST(Statement, SaysWhatWasAllowedToFixedPoint) {
  RunResult run = run_of({"tpa"});
  run.fraction_bits = 22;
  EXPECT_THAT(conformance_statement(run),
              HasSubstr("px4-v1.5.5, numeric for fixed point with 22 fraction bits, 2 rates"));
  run.level = Level::exact;
  EXPECT_THAT(conformance_statement(run), HasSubstr("px4-v1.5.5, exact, 2 rates"));
  run.level = Level::events;
  EXPECT_THAT(conformance_statement(run), HasSubstr("px4-v1.5.5, events, 2 rates"));
  run.results.front().compared = Level::numeric;  // a flight, or a module without events
  EXPECT_THAT(conformance_statement(run),
              HasSubstr("px4-v1.5.5, events for fixed point with 22 fraction bits, 2 rates"));
}

TEST(Statement, SaysTheFixedStepOfAPort) {
  RunResult run = run_of({"tpa"});
  run.fixed_step = Rate::hz(250);
  run.results.front().verdict = Verdict::unsupported;
  EXPECT_THAT(conformance_statement(run),
              HasSubstr("partial: px4-v1.5.5, numeric, fixed step of 250 Hz, all groups "
                        "(because: fixed step of 250 Hz)"));
}

TEST(Statement, AtTheLevelEventsHasAnotherWord) {
  RunResult run = run_of({"tpa"});
  run.level = Level::events;
  EXPECT_THAT(conformance_statement(run),
              HasSubstr("events agree: px4-v1.5.5, events, 2 rates, all groups; cases"));
}

TEST(Statement, SaysWhyThereIsNone) {
  EXPECT_THAT(conformance_statement(sample_run()),
              HasSubstr("none: px4-v1.5.5, 4 groups fail (attitude, flight, mixed, robustness)"));
  RunResult run = run_of({"tpa"});
  run.stopped_early = true;
  EXPECT_EQ(conformance_statement(run), "none: the run is not complete");
  EXPECT_EQ(conformance_statement(run_of({})), "none: no vector passed");
}

TEST(Badge, IsAnSvgThatSaysIt) {
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(badge(passing_run()).c_str()));
  const pugi::xml_node svg = document.child("svg");
  EXPECT_STREQ(svg.attribute("aria-label").value(), "attest: px4-v1.5.5 exact");
  EXPECT_THAT(svg.child("title").text().get(), HasSubstr("px4-v1.5.5, exact, 2 rates"));
  EXPECT_STREQ(svg.find_child_by_attribute("fill", "#3a7d34").name(), "rect");
  RunResult part = passing_run();
  part.suite_is_released = false;
  ASSERT_TRUE(document.load_string(badge(part).c_str()));
  const pugi::xml_node amber = document.child("svg");
  EXPECT_STREQ(amber.attribute("aria-label").value(), "attest: px4-v1.5.5 exact, partial");
  EXPECT_FALSE(amber.find_child_by_attribute("fill", "#3a7d34"));
  RunResult of_events = passing_run();
  of_events.level = Level::events;
  ASSERT_TRUE(document.load_string(badge(of_events).c_str()));
  const pugi::xml_node events = document.child("svg");
  EXPECT_STREQ(events.attribute("aria-label").value(), "attest: px4-v1.5.5 events agree");
  EXPECT_FALSE(events.find_child_by_attribute("fill", "#3a7d34"));
  ASSERT_TRUE(document.load_string(badge(sample_run()).c_str()));
  EXPECT_STREQ(document.child("svg").attribute("aria-label").value(), "attest: does not conform");
}

}  // namespace
}  // namespace attest
