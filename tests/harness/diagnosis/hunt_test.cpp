#include "harness/diagnosis/hunt.hpp"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/port/profiles.hpp"
#include "harness/trace/output_topics.hpp"
#include "tests/harness/diagnosis/hunted.hpp"

namespace attest {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

std::optional<PortFault> unchanged(const ModuleUnderTest&, Trace&) { return std::nullopt; }

// ---- findings -----------------------------------------------------------------------------------

TEST(Hunt, TheReferenceHasNoFinding) {
  HuntOptions options = of_rate_unit();
  options.level = Level::exact;
  const HuntRun run = found_by(options, changed_host(unchanged));
  EXPECT_THAT(run.findings, IsEmpty());
  EXPECT_THAT(run.ended_early, IsEmpty());
  EXPECT_EQ(run.progress.trials, 128u);
  EXPECT_GT(run.progress.steps, 5'000u);
}

TEST(Hunt, RoundingIsNoFinding) {
  std::vector<ModuleUnderTest> subjects;
  for (const char* profile : {"px4-v1.5.5", "px4-v1.16.0"}) {
    for (const ModuleInfo& info : modules()) {
      const bool has_it = contains(find_profile(profile)->modules, info.module);
      if (has_it && info.module != Module::mixer) subjects.push_back({profile, info.module});
    }
  }
  HostOptions host = changed_host(unchanged, Precision::binary64);
  host.port = "builtin";  // more trials
  const HuntRun run = found_by(hunted(subjects), host);
  EXPECT_THAT(names_of(run), IsEmpty());
  EXPECT_GT(run.progress.steps, 5'000u);
}

// ---- the end ------------------------------------------------------------------------------------

TEST(Hunt, EndsAfterTheRoundThatReachesTheSteps) {
  HuntOptions options = of_rate_unit();
  std::vector<std::size_t> steps;
  options.on_round = [&](const HuntProgress& progress) { steps.push_back(progress.steps); };
  options.least_steps = 40'000;
  const HuntRun run = found_by(options, changed_host(unchanged));
  ASSERT_FALSE(steps.empty());
  EXPECT_GE(steps.back(), options.least_steps);
  steps.pop_back();
  for (const std::size_t before : steps) EXPECT_LT(before, options.least_steps);
  EXPECT_EQ(run.progress.trials, 128 * (steps.size() + 1));
}

TEST(Hunt, EndsWhenThePortHangsAgainAndAgain) {
  HuntOptions options = of_rate_unit();
  options.least_steps = 1'000'000'000;
  int rounds = 0;
  options.is_over = [&] { return ++rounds == 20; };
  const HuntRun run = found_by(options, changed_host([](const ModuleUnderTest&, Trace&) {
                                 return PortFault{PortFault::Kind::timeout, 0, "no answer"};
                               }));
  EXPECT_LT(rounds, 20);
  EXPECT_THAT(run.ended_early, HasSubstr("did not answer in time in 8 trials"));
  ASSERT_THAT(run.findings, SizeIs(1));
  EXPECT_EQ(run.findings[0].failure.verdict, Verdict::timeout);
}

TEST(Hunt, AnInterruptKeepsWhatWasFound) {
  HuntOptions options = of_rate_unit();
  options.least_steps = 1'000'000'000;
  bool is_interrupted = false;
  options.on_round = [&](const HuntProgress&) { is_interrupted = true; };
  options.workers.stop = [&] { return is_interrupted; };
  options.on_end = [&] { is_interrupted = false; };
  const HuntRun run = found_by(options, fault_host("cascade-d-reversed"));
  EXPECT_EQ(run.ended_early, "interrupted");
  EXPECT_THAT(names_of(run), ElementsAre("cascade_d_reversed"));
  EXPECT_EQ(run.progress.trials, 128u);
}

TEST(Hunt, FailFastEndsAtTheFirstFinding) {
  HuntOptions options = of_rate_unit();
  options.least_steps = 40'000;
  options.fail_fast = true;
  const HuntRun run = found_by(options, fault_host("cascade-d-reversed"));
  EXPECT_EQ(run.progress.trials, 128u);
  EXPECT_EQ(run.ended_early, "at the first finding");
  EXPECT_THAT(names_of(run), ElementsAre("cascade_d_reversed"));
  const HuntRun right = found_by(options, changed_host(unchanged));
  EXPECT_THAT(right.ended_early, IsEmpty());
  EXPECT_GE(right.progress.steps, options.least_steps);
}

// ---- cases that a hunt begins with --------------------------------------------------------------

// Inputs with a roll rate that no trial has by chance.
HuntInputs marked(float rate_rad_s) {
  HuntTarget target;
  target.subject = {"px4-v1.16.0", Module::rate_unit};
  HuntInputs inputs = make_trial(target, 7, 3, {});
  inputs.subject = target.subject;
  for (HuntTick& tick : inputs.ticks) {
    tick.sample.rate_in.vehicle_angular_velocity.xyz[0] = rate_rad_s;
  }
  return inputs;
}

bool is_marked(const Trace& trace, float rate_rad_s) {
  return std::ranges::all_of(trace.samples, [&](const Sample& sample) {
    return sample.rate_in.vehicle_angular_velocity.xyz[0] == rate_rad_s;
  });
}

TEST(Hunt, BeginsWithEachInputOfACaseUnchanged) {
  HuntOptions options = of_rate_unit();
  constexpr int count = 200;  // more than a round
  for (int i = 0; i < count; ++i) options.first.push_back(marked(0.001F * static_cast<float>(i)));
  int trials = 0, found = 0;
  const HuntRun run = found_by(options, changed_host([&](const ModuleUnderTest&, Trace& trace) {
                                 if (trials < count) {
                                   found += is_marked(trace, 0.001F * static_cast<float>(trials));
                                 }
                                 ++trials;
                                 return std::nullopt;
                               }));
  EXPECT_EQ(found, count);
  EXPECT_EQ(run.progress.trials, 256u);
}

TEST(Hunt, VariesTheInputsOfCases) {
  HuntOptions options = of_rate_unit();
  options.first = {marked(0.123F)};
  std::size_t varied = 0;
  (void)found_by(options, changed_host([&](const ModuleUnderTest&, Trace& trace) {
                   varied += std::ranges::any_of(trace.samples, [](const Sample& sample) {
                     return sample.rate_in.vehicle_angular_velocity.xyz[0] == 0.123F;
                   });
                   return std::nullopt;
                 }));
  EXPECT_GT(varied, 20u);
}

TEST(Hunt, LeavesOutInputsOfOtherSubjects) {
  HuntOptions options = of_rate_unit();
  options.first = {marked(0.123F)};
  options.first[0].subject.profile = "px4-v1.15.4";
  bool is_tried = false;
  (void)found_by(options, changed_host([&](const ModuleUnderTest&, Trace& trace) {
                   is_tried = is_tried || is_marked(trace, 0.123F);
                   return std::nullopt;
                 }));
  EXPECT_FALSE(is_tried);
}

TEST(Hunt, ReportsEachTrialThatReachesSomethingNew) {
  HuntOptions options = of_rate_unit();
  std::vector<std::string> cases;
  options.on_new = [&](const std::string& profile, const std::string& toml) {
    EXPECT_EQ(profile, "px4-v1.16.0");
    cases.push_back(toml);
    return Result<void>();
  };
  (void)found_by(options, changed_host(unchanged));
  EXPECT_GT(cases.size(), 20u);
  EXPECT_THAT(cases[0],
              HasSubstr("Kept by attest hunt: the reference came nearer to a decision: "));
  const std::size_t before = cases.size();
  options.least_steps = 60'000;
  (void)found_by(options, changed_host(unchanged));
  // Of the second hunt, which repeats the first. Later rounds reach less that is new.
  EXPECT_LT(cases.size() - before, 4 * before);
}

TEST(Hunt, AnErrorOfTheCorpusEndsTheHunt) {
  HuntOptions options = of_rate_unit();
  options.on_new = [](const std::string&, const std::string&) -> Result<void> {
    return fail("the disk is full");
  };
  const auto found = hunt(options, changed_host(unchanged));
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().message, "the disk is full");
}

// ---- steps before a failure ---------------------------------------------------------------------

TEST(Hunt, StepsBeforeAFailureAreThoseOfTheRoundsBefore) {
  // The mistake begins in the second round: a round has 128 trials.
  std::size_t traces = 0;
  const auto wrong_from_second_round = [&] {
    traces = 0;
    return changed_host([&](const ModuleUnderTest&, Trace& trace) {
      const bool is_wrong = ++traces > 128;
      for (Sample& sample : trace.samples) {
        if (is_wrong) sample.rate_out.vehicle_torque_setpoint.xyz[1] += 1;
      }
      return std::optional<PortFault>();
    });
  };
  HuntOptions options = of_rate_unit();
  std::vector<std::size_t> steps;
  options.on_round = [&](const HuntProgress& now) { steps.push_back(now.steps); };
  const auto in_first = steps_before_failure(options, wrong_from_second_round());
  ASSERT_TRUE(in_first);
  EXPECT_EQ(*in_first, std::nullopt);
  options.least_steps = steps.at(0) + 1;
  const auto in_second = steps_before_failure(options, wrong_from_second_round());
  ASSERT_TRUE(in_second);
  EXPECT_EQ(*in_second, steps.at(0));
  EXPECT_LT(traces, 2 * 128u);  // ended at the first failing trial
  options.workers.stop = [] { return true; };
  const auto stopped = steps_before_failure(options, wrong_from_second_round());
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().message, "interrupted");
}

// ---- silent topics ------------------------------------------------------------------------------

// Publishes no topic of these names.
ChangeAnswer without(std::vector<std::string> silent) {
  return [silent](const ModuleUnderTest& subject, Trace& trace) -> std::optional<PortFault> {
    for (const OutputTopic& topic : output_topics(subject.module)) {
      if (std::ranges::find(silent, topic.name) == silent.end()) continue;
      for (Sample& sample : trace.samples) set_value(channels()[topic.published], sample, 0);
    }
    return std::nullopt;
  };
}

TEST(Hunt, ATopicThatIsNeverPublishedIsOneFinding) {
  const HuntRun run = found_by(of_rate_unit(), changed_host(without({"rate_ctrl_status"})));
  ASSERT_THAT(names_of(run), ElementsAre("never_publishes_rate_ctrl_status"));
  EXPECT_EQ(run.findings[0].failure.reason,
            "the port never publishes rate_ctrl_status; its other outputs are judged");
  EXPECT_EQ(run.progress.trials, 128u);
}

TEST(Hunt, ASilentTopicHidesNoOtherMistake) {
  const HuntRun run = found_by(of_rate_unit(), changed_host([](const ModuleUnderTest& s, Trace& t) {
                                 for (Sample& sample : t.samples)
                                   sample.rate_out.vehicle_torque_setpoint.xyz[1] *= 1.1F;
                                 return without({"rate_ctrl_status"})(s, t);
                               }));
  ASSERT_THAT(run.findings, SizeIs(testing::Ge(2u)));
  EXPECT_EQ(run.findings[0].name, "never_publishes_rate_ctrl_status");
  EXPECT_THAT(run.findings[1].name, Not(HasSubstr("rate_ctrl_status")));
}

TEST(Hunt, APortThatPublishesNothingHasAFindingForEachTopic) {
  const HuntRun run = found_by(
      of_rate_unit(), changed_host(without({"vehicle_torque_setpoint", "vehicle_thrust_setpoint",
                                            "rate_ctrl_status", "vehicle_rates_setpoint"})));
  EXPECT_EQ(run.findings.size(), output_topics(Module::rate_unit).size());
  for (const std::string& name : names_of(run)) EXPECT_THAT(name, HasSubstr("never_publishes_"));
}

// The second round takes the finding back.
TEST(Hunt, ATopicThatIsPublishedLaterIsJudgedAgain) {
  std::size_t traces = 0;
  HuntOptions options = of_rate_unit();
  options.least_steps = 1'000'000'000;
  int rounds = 0;
  options.is_over = [&] { return ++rounds == 3; };
  const HuntRun run =
      found_by(options, changed_host([&](const ModuleUnderTest& s, Trace& t) {
                 return ++traces < 300 ? without({"rate_ctrl_status"})(s, t) : std::nullopt;
               }));
  EXPECT_THAT(names_of(run), IsEmpty());
}

TEST(Hunt, WhatThePortLacksIsNotJudged) {
  HostOptions host = changed_host(without({"rate_ctrl_status"}));
  host.said->lacks = *Lacks::parse(std::vector<std::string>{"rate_ctrl_status"});
  EXPECT_THAT(found_by(of_rate_unit(), host).findings, IsEmpty());
}

}  // namespace
}  // namespace attest
