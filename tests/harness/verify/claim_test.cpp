#include "harness/verify/claim.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace attest {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const char* const the_profile = "px4-v1.5.5";

VectorResult result_of(const std::string& group, const LoopRate& rate,
                       Verdict verdict = Verdict::pass) {
  VectorResult result;
  result.profile = the_profile;
  result.group = group;
  result.name = "a";
  result.rate = rate;
  result.verdict = verdict;
  return result;
}

// A run of these groups, one case at two rates in each, all of which pass.
RunResult complete_run(const std::vector<std::string>& groups) {
  RunResult run;
  run.suite_is_released = true;
  run.port_modules = only(Module::mc_att_control) | only(Module::mixer);
  run.rates = {Rate::hz(100), Rate::hz(250)};
  for (const std::string& group : groups) {
    for (const LoopRate& rate : run.rates) {
      run.suite[the_profile + ("/" + group)][rate] = 1;
      run.results.push_back(result_of(group, rate));
    }
  }
  return run;
}

Claim only_claim(const RunResult& run) {
  const auto claims = claims_of(run);
  EXPECT_EQ(claims.size(), 1u);
  return claims.empty() ? Claim{} : claims.front();
}

TEST(Claim, TheReleasedSuiteAsAWholeConforms) {
  const RunResult run = complete_run({"attitude", "tpa"});
  const Claim claim = only_claim(run);
  EXPECT_TRUE(claim.conforms());
  EXPECT_TRUE(claim.has_all_groups);
  EXPECT_THAT(claim.whole, ElementsAre("attitude", "tpa"));
  EXPECT_EQ(standing_of(run), Standing::conformant);
}

TEST(Claim, AnotherSuiteIsCustom) {
  RunResult run = complete_run({"attitude"});
  run.suite_is_released = false;
  EXPECT_THAT(only_claim(run).missing, ElementsAre("custom suite"));
  EXPECT_EQ(standing_of(run), Standing::partial);
}

TEST(Claim, WhatWasNotRunIsMissing) {
  RunResult run = complete_run({"attitude", "modes", "tpa"});
  std::erase_if(run.results, [](const VectorResult& result) { return result.group == "modes"; });
  run.selection = "--group attitude --group tpa";
  EXPECT_THAT(only_claim(run).missing, ElementsAre("only --group attitude --group tpa",
                                                   "no vector of modes", "2 vectors not run"));
  run = complete_run({"attitude", "tpa"});
  run.rates = {Rate::hz(250)};
  std::erase_if(run.results,
                [](const VectorResult& result) { return result.rate == Rate::hz(100); });
  EXPECT_THAT(only_claim(run).missing, ElementsAre("no vector at 100 Hz", "2 vectors not run"));
  EXPECT_TRUE(only_claim(run).has_all_groups) << "at the rates of the run";
}

TEST(Claim, AGroupOfWhichSomeCasesWereLeftOutIsNotWhole) {
  RunResult run = complete_run({"attitude", "tpa"});
  run.suite["px4-v1.5.5/tpa"][Rate::hz(250)] = 2;
  const Claim claim = only_claim(run);
  EXPECT_THAT(claim.whole, ElementsAre("attitude"));
  EXPECT_THAT(claim.in_part, ElementsAre("tpa"));
  EXPECT_FALSE(claim.has_all_groups);
  EXPECT_THAT(claim.missing, ElementsAre("1 vector not run"));
}

TEST(Claim, WhatIsCountedApartIsMissing) {
  for (const auto& [verdict, said] : {std::pair{Verdict::unsupported, "1 vector unsupported (tpa)"},
                                      {Verdict::skip, "1 vector skipped (tpa)"},
                                      {Verdict::xfail, "1 expected failure (tpa)"}}) {
    RunResult run = complete_run({"attitude", "tpa"});
    run.results.back().verdict = verdict;
    EXPECT_THAT(only_claim(run).missing, ElementsAre(said));
    EXPECT_THAT(only_claim(run).in_part, ElementsAre("tpa"));
    EXPECT_EQ(standing_of(run), Standing::partial);
  }
}

// At other levels these cases have no verdict. At the exact level none of them may be skipped.
TEST(Claim, CasesOfTheExactLevelMayBeSkippedAtAnother) {
  RunResult run = complete_run({"attitude", "tpa"});
  run.results.back().verdict = Verdict::skip;
  run.results.back().exact_only = true;
  EXPECT_TRUE(only_claim(run).conforms());
  run.level = Level::exact;
  EXPECT_FALSE(only_claim(run).conforms());
}

// The text can come from the port.
TEST(Claim, TheReasonDoesNotExcuseASkip) {
  RunResult run = complete_run({"attitude", "tpa"});
  run.results.back().verdict = Verdict::skip;
  run.results.back().reason = exact_level_only;
  EXPECT_THAT(only_claim(run).missing, ElementsAre("1 vector skipped (tpa)"));
  EXPECT_EQ(standing_of(run), Standing::partial);
}

TEST(Claim, AGroupOfWhichNoOutputWasComparedIsMissing) {
  RunResult run = complete_run({"attitude", "tpa"});
  for (VectorResult& result : run.results) {
    if (result.group != "tpa") continue;
    result.verdict = Verdict::skip;
    result.exact_only = true;
  }
  EXPECT_THAT(only_claim(run).missing, ElementsAre("no output compared of tpa"));
  EXPECT_EQ(standing_of(run), Standing::partial);
}

// Faults of the catalogue pass at this level.
TEST(Claim, AtTheEventsLevelTheEventsAgree) {
  RunResult run = complete_run({"attitude", "tpa"});
  run.level = Level::events;
  EXPECT_TRUE(only_claim(run).is_complete());
  EXPECT_FALSE(only_claim(run).conforms());
  EXPECT_EQ(standing_of(run), Standing::events_agree);
  run.results.back().verdict = Verdict::unsupported;
  EXPECT_EQ(standing_of(run), Standing::partial);
}

TEST(Claim, ModulesAreOptional) {
  RunResult run = complete_run({"attitude", "battery_status", "mixer"});
  EXPECT_THAT(only_claim(run).modules, ElementsAre("battery_status", "mixer"));
  run.results.back().verdict = Verdict::unsupported;
  EXPECT_TRUE(only_claim(run).conforms());
  EXPECT_THAT(only_claim(run).modules, ElementsAre("battery_status"));
  run.results.back().verdict = Verdict::fail;
  EXPECT_FALSE(only_claim(run).conforms()) << "a module that is there has to be right";
}

// A port that is a law alone.
TEST(Claim, WithoutAnyUnitItIsAboutTheModules) {
  RunResult run = complete_run({"attitude", "attitude_law", "mixer"});
  run.port_modules = only(Module::attitude_law) | only(Module::mixer);
  for (VectorResult& result : run.results) {
    if (result.group == "attitude") result.verdict = Verdict::unsupported;
  }
  EXPECT_TRUE(only_claim(run).conforms());
  EXPECT_TRUE(only_claim(run).is_of_modules);
  EXPECT_THAT(only_claim(run).modules, ElementsAre("attitude_law", "mixer"));
  EXPECT_EQ(standing_of(run), Standing::conformant);

  run.results.back().verdict = Verdict::skip;
  EXPECT_THAT(only_claim(run).missing, ElementsAre("only a part of mixer"));
  EXPECT_EQ(standing_of(run), Standing::partial);
  const VectorResult last = run.results.back();
  run.results.pop_back();  // at one of two rates
  run.rates = {Rate::hz(100)};
  EXPECT_THAT(only_claim(run).missing, ElementsAre("only a part of mixer"));
  run.results.push_back(last);
  run.results.back().verdict = Verdict::pass;

  run.suite_is_released = false;
  EXPECT_THAT(only_claim(run).missing, ElementsAre("custom suite"));
  run.suite_is_released = true;

  run.port_modules |= only(Module::mc_att_control);
  EXPECT_FALSE(only_claim(run).is_of_modules) << "the port declares a unit, so all of it counts";
  EXPECT_FALSE(only_claim(run).conforms());
}

TEST(Claim, AFixedStepIsPartialAndNamesOnlyItself) {
  RunResult run = complete_run({"attitude"});
  run.fixed_step = Rate::hz(250);
  run.results.front().verdict = Verdict::unsupported;
  EXPECT_THAT(only_claim(run).missing, ElementsAre("fixed step of 250 Hz"));
  EXPECT_TRUE(only_claim(run).has_all_groups);
  run.results.back().verdict = Verdict::unsupported;
  run.results.push_back(result_of("attitude", Rate::hz(250)));
  EXPECT_THAT(only_claim(run).missing, Contains(HasSubstr("1 vector unsupported")));
}

TEST(Claim, AModuleWithoutCasesAtAFixedStepIsNotClaimed) {
  RunResult run = complete_run({"attitude", "mixer"});
  run.fixed_step = Rate::hz(250);
  run.suite[the_profile + std::string("/mixer")].erase(Rate::hz(250));
  run.results.pop_back();  // the mixer at 250 Hz
  run.results.back().verdict = Verdict::unsupported;
  EXPECT_THAT(only_claim(run).whole, ElementsAre("attitude"));
  EXPECT_THAT(only_claim(run).modules, IsEmpty());
}

TEST(Claim, EachProfileHasItsOwn) {
  RunResult run = complete_run({"tpa"});
  run.suite["px4-v1.3.4/tpa"][Rate::hz(250)] = 1;
  run.results.push_back(result_of("tpa", Rate::hz(250), Verdict::skip));
  run.results.back().profile = "px4-v1.3.4";
  EXPECT_TRUE(only_claim(run).conforms()) << "a port need not do the other law";
  run.results.back().verdict = Verdict::fail;
  const auto claims = claims_of(run);
  ASSERT_EQ(claims.size(), 2u);
  EXPECT_THAT(claims[0].failing, ElementsAre("tpa"));
  EXPECT_TRUE(claims[1].conforms());
  EXPECT_EQ(standing_of(run), Standing::none) << "the run failed";
}

TEST(Claim, ARunThatEndedEarlyOrHadErrorsHasNoStanding) {
  RunResult run = complete_run({"tpa"});
  run.stopped_early = true;
  EXPECT_EQ(standing_of(run), Standing::none);
  run = complete_run({"tpa"});
  run.errors.push_back(Error{"cannot read", "", 0, 0});
  EXPECT_EQ(standing_of(run), Standing::none);
  EXPECT_EQ(standing_of(RunResult{}), Standing::none);
  EXPECT_THAT(claims_of(RunResult{}), IsEmpty());
}

TEST(Claim, ManyGroupsAreCounted) {
  RunResult run = complete_run({"attitude", "modes", "rates", "tailsitter", "timing", "tpa"});
  std::erase_if(run.results, [](const VectorResult& result) { return result.group != "tpa"; });
  EXPECT_THAT(only_claim(run).missing, ElementsAre("no vector of 5 groups", "10 vectors not run"));
}

TEST(Claim, RecordedTimesAreNotTheCases) {
  RunResult run = complete_run({"flight"});
  run.timing = "late.json";
  EXPECT_THAT(only_claim(run).missing, ElementsAre("at recorded times"));
}

}  // namespace
}  // namespace attest
