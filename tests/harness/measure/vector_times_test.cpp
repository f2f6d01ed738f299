// Which of the steps count, for times that the test gives.
#include "harness/measure/vector_times.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/harness/casefile/case_files.hpp"
#include "tests/harness/times.hpp"
#include "tests/harness/verify/given_host.hpp"

namespace attest {
namespace {

using testing::ElementsAre;

SelectedCase open_loop(const std::string& name, std::vector<Rate> rates = {Rate::hz(100)}) {
  SelectedCase selected{case_of(""), {}};
  selected.the_case.name = name;
  for (const Rate& rate : rates) selected.configurations.push_back({rate, {}});
  return selected;
}

StepTimes steps(std::vector<Nanoseconds> times) {
  StepTimes timed;
  timed.steps = std::move(times);
  timed.clock = ns(25);
  return timed;
}

StepTimes counts(std::vector<StepCost> costs) {
  StepTimes counted;
  counted.costs = std::move(costs);
  return counted;
}

StepTimes gone_wrong() {
  StepTimes timed = steps({us(90), us(90)});
  timed.stack_bytes = 9000;
  timed.fault = PortFault{PortFault::Kind::crash, 2, "it died"};
  return timed;
}

VectorTimes timed_vector(const SelectedCase& selected, const Rate& rate,
                         std::vector<Nanoseconds> times) {
  VectorTimes vector;
  vector.result.profile = selected.the_case.profile;
  vector.result.group = selected.the_case.group;
  vector.result.name = selected.the_case.name;
  vector.result.rate = rate;
  vector.steps = std::move(times);
  return vector;
}

VectorTimes with_stack_of(std::optional<std::size_t> bytes) { return {{}, {}, bytes}; }

// A request to the host.
struct Question {
  ModuleUnderTest subject;
  std::vector<std::uint64_t> timestamps;
  bool with_stack = false;
};

class TimeCorpus : public testing::Test {
 protected:
  Result<CorpusTimes> timed(const std::vector<SelectedCase>& cases) {
    HostOptions host;
    host.start = [this](const HostOptions&, const Course&) { return start(); };
    host.stop = [this] { return stops_after_ && results_.size() == *stops_after_; };
    return time_corpus(cases, options_, host,
                       [this](const VectorResult& result) { results_.push_back(result); });
  }

  Result<std::unique_ptr<PortHost>> start() {
    ++hosts_;
    is_spent_ = false;
    GivenHost::Answers answers;
    answers.says = declarations_;
    answers.is_spent = [this] { return is_spent_; };
    answers.time_steps = [this](const ModuleUnderTest& subject, const Trace& inputs,
                                bool with_stack) {
      Question question{subject, {}, with_stack};
      for (const Sample& sample : inputs.samples) {
        question.timestamps.push_back(sample.in.timestamp);
      }
      questions_.push_back(question);
      return next_answer();
    };
    return std::make_unique<GivenHost>(answers);
  }

  Result<StepTimes> next_answer() {
    Result<StepTimes> answer = answers_.at(questions_.size() - 1);
    if (answer && answer->fault) is_spent_ = true;
    return answer;
  }

  TimeOptions options_ = {
      .repeats = 1, .budget_us = {}, .stack = false, .worst = {}, .counter = {}};
  Declarations declarations_;
  std::vector<Result<StepTimes>> answers_;
  std::optional<std::size_t> stops_after_;
  bool is_spent_ = false;
  int hosts_ = 0;
  std::vector<Question> questions_;
  std::vector<VectorResult> results_;
};

TEST_F(TimeCorpus, OfEachStepTheQuickestRepeatCounts) {
  options_.repeats = 3;
  answers_ = {steps({us(5), us(9), us(4)}), steps({us(7), us(3), us(6)}),
              steps({us(8), us(8), us(8)})};
  const auto times = timed({open_loop("level")});
  ASSERT_TRUE(times) << times.error().to_string();
  ASSERT_EQ(times->vectors.size(), 1u);
  EXPECT_THAT(times->vectors[0].steps, ElementsAre(us(5), us(3), us(4)));
  EXPECT_EQ(times->vectors[0].result.ticks, 3u);
  EXPECT_EQ(times->steps.count(), 3u);
  EXPECT_EQ(times->steps.min(), us(3));
  EXPECT_EQ(times->steps.max(), us(5));
  EXPECT_EQ(times->clock, ns(25));
}

TEST_F(TimeCorpus, ALaterRepeatCountsWhereItIsTheQuickest) {
  options_.repeats = 2;
  answers_ = {steps({us(9), us(1)}), steps({us(2), us(8)})};
  EXPECT_THAT(timed({open_loop("level")})->vectors[0].steps, ElementsAre(us(2), us(1)));
}

TEST_F(TimeCorpus, OfEachStepTheLargestCountOfThePortCounts) {
  options_ = {.repeats = 2,
              .budget_us = 100,
              .stack = false,
              .worst = {},
              .counter = CostCounter{CostUnit::cycles, 25e6}};
  answers_ = {counts({{2500, 0}, {2501, 700}, {9, 690}}), counts({{2500, 710}, {2400, 0}, {9, 0}})};
  const auto times = timed({open_loop("level")});
  ASSERT_TRUE(times) << times.error().to_string();
  const VectorTimes& vector = times->vectors.at(0);
  EXPECT_THAT(vector.steps, ElementsAre(Cost(2500), Cost(2501), Cost(9)));
  EXPECT_EQ(vector.stack_bytes, 710u);
  EXPECT_EQ(vector.varying, 1u);
  EXPECT_EQ(vector.slowest_tick(), 1u);
  EXPECT_EQ(times->steps.over_limit(), 1u);  // 100 us are 2500 cycles
}

TEST_F(TimeCorpus, CountsOfThePortAreMadeOnce) {
  options_.repeats = {};
  options_.counter = CostCounter{CostUnit::instructions};
  answers_ = {counts({{7, 0}})};
  const auto times = timed({open_loop("level")});
  ASSERT_TRUE(times) << times.error().to_string();
  EXPECT_EQ(questions_.size(), 1u);
  EXPECT_FALSE(times->vectors.at(0).stack_bytes);
}

TEST_F(TimeCorpus, EachVectorHasItsOwnInputsAndTimes) {
  answers_ = {steps({us(1)}), steps({us(2)}), steps({us(3)})};
  const SelectedCase level = open_loop("level", {Rate::hz(100), Rate::hz(250)});
  const auto times = timed({level, open_loop("roll")});
  ASSERT_TRUE(times) << times.error().to_string();
  ASSERT_EQ(times->vectors.size(), 3u);
  EXPECT_EQ(times->vectors[0].result.id(), "px4-v1.5.5/tests/level@100hz");
  EXPECT_EQ(times->vectors[1].result.id(), "px4-v1.5.5/tests/level@250hz");
  EXPECT_EQ(times->vectors[2].result.id(), "px4-v1.5.5/tests/roll@100hz");
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_THAT(times->vectors[i].steps, ElementsAre(us(static_cast<std::int64_t>(i) + 1)));
    EXPECT_EQ(results_[i].id(), times->vectors[i].result.id());
    EXPECT_EQ(questions_[i].subject.profile, "px4-v1.5.5");
    EXPECT_EQ(questions_[i].timestamps.size(), 10u);
    EXPECT_EQ(questions_[i].timestamps[1], i == 1 ? 5'004'000u : 5'010'000u);
  }
  EXPECT_EQ(times->steps.count(), 3u);
  EXPECT_EQ(hosts_, 1);
}

TEST_F(TimeCorpus, TheStepsOfEachModuleAreCountedApart) {
  SelectedCase rate = open_loop("rate");
  rate.the_case = unit_case_of(Module::rate_unit, "px4-v1.16.0", "");
  answers_ = {steps({us(1), us(2)}), steps({us(3)})};
  const auto times = timed({open_loop("level"), rate});
  ASSERT_TRUE(times) << times.error().to_string();
  EXPECT_EQ(questions_[1].subject.module, Module::rate_unit);
  EXPECT_EQ(questions_[1].subject.profile, "px4-v1.16.0");
  const auto modules = times->by_module();
  ASSERT_EQ(modules.size(), 2u);
  EXPECT_EQ(modules.at(Module::mc_att_control).max(), us(2));
  EXPECT_EQ(modules.at(Module::rate_unit).count(), 1u);
  EXPECT_EQ(modules.at(Module::rate_unit).max(), us(3));
}

TEST_F(TimeCorpus, TheStackIsMeasuredOnceAVector) {
  options_.repeats = 3;
  options_.stack = true;
  for (const bool of_last : {false, false, true, false, false, true}) {
    answers_.emplace_back(steps({us(1)}));
    if (of_last) answers_.back()->stack_bytes = 1000 + answers_.size();
  }
  const auto times = timed({open_loop("level"), open_loop("roll")});
  std::vector<bool> asked;
  for (const Question& question : questions_) asked.push_back(question.with_stack);
  EXPECT_THAT(asked, ElementsAre(false, false, true, false, false, true));
  EXPECT_EQ(times->vectors[0].stack_bytes, 1003u);
  EXPECT_EQ(times->vectors[1].stack_bytes, 1006u);
  EXPECT_EQ(times->with_most_stack(), &times->vectors[1]);
}

TEST_F(TimeCorpus, WithoutTheOptionTheStackIsNotMeasured) {
  options_.repeats = 2;
  answers_ = {steps({us(1)}), steps({us(1)})};
  EXPECT_FALSE(timed({open_loop("level")})->vectors[0].stack_bytes);
  for (const Question& question : questions_) EXPECT_FALSE(question.with_stack);
}

TEST_F(TimeCorpus, QuickestStepsLongerThanTheBudgetAreCounted) {
  options_.repeats = 2;
  options_.budget_us = 5;
  answers_ = {steps({us(9), us(9), us(5), ns(5001)}), steps({us(4), us(6), us(6), us(6)})};
  EXPECT_EQ(timed({open_loop("level")})->steps.over_limit(), 2u);
}

TEST_F(TimeCorpus, WithoutABudgetNoStepIsTooLong) {
  answers_ = {steps({std::chrono::hours(1)})};
  EXPECT_EQ(timed({open_loop("level")})->steps.over_limit(), 0u);
}

TEST_F(TimeCorpus, AVectorOfAPortThatGoesWrongHasNoTimes) {
  options_.repeats = 2;
  options_.stack = true;
  answers_ = {steps({us(80), us(80)}), gone_wrong(), steps({us(1)}), steps({us(2)})};
  const auto times = timed({open_loop("level"), open_loop("roll")});
  ASSERT_TRUE(times) << times.error().to_string();
  ASSERT_EQ(times->vectors.size(), 2u);
  const VectorTimes &wrong = times->vectors[0], &right = times->vectors[1];
  EXPECT_EQ(wrong.result.verdict, Verdict::crash);
  EXPECT_EQ(wrong.result.reason, "it died");
  EXPECT_FALSE(wrong.is_timed());
  EXPECT_FALSE(wrong.stack_bytes);
  EXPECT_EQ(results_[0].verdict, Verdict::crash);
  EXPECT_EQ(right.result.verdict, Verdict::pass);
  EXPECT_THAT(right.steps, ElementsAre(us(1)));
  EXPECT_EQ(times->steps.count(), 1u);
  EXPECT_EQ(hosts_, 2);  // a new one after the crash
}

TEST_F(TimeCorpus, APortThatDeclinesTheGroupIsNotTimed) {
  declarations_.unsupported_groups = {"tests"};
  const auto times = timed({open_loop("level")});
  ASSERT_TRUE(times) << times.error().to_string();
  EXPECT_EQ(times->vectors[0].result.verdict, Verdict::unsupported);
  EXPECT_FALSE(times->vectors[0].is_timed());
  EXPECT_TRUE(questions_.empty());
}

TEST_F(TimeCorpus, EndsEarlyWithWhatWasTimed) {
  stops_after_ = 1;
  answers_ = {steps({us(1)})};
  const auto times = timed({open_loop("level", {Rate::hz(100), Rate::hz(250)}), open_loop("roll")});
  ASSERT_TRUE(times) << times.error().to_string();
  EXPECT_EQ(times->vectors.size(), 1u);
  EXPECT_EQ(times->steps.count(), 1u);
}

TEST_F(TimeCorpus, NoMemoryForTheStackIsAnError) {
  answers_ = {steps({us(1)}), fail("no memory")};
  const auto times = timed({open_loop("level"), open_loop("roll")});
  ASSERT_FALSE(times);
  EXPECT_EQ(times.error().message, "no memory");
}

TEST(TimeCorpusWithoutAHost, APortThatCannotBeOpenedIsAnError) {
  HostOptions host;
  host.port = "lib:/does/not/exist.so";
  EXPECT_FALSE(time_corpus({open_loop("level")}, {}, host, [](const VectorResult&) {}));
}

TEST(VectorTimesTest, TheSlowestTickIsThatOfTheLongestStep) {
  const SelectedCase level = open_loop("level");
  const VectorTimes times = timed_vector(level, Rate::hz(100), {us(2), us(9), us(1), us(4), us(3)});
  EXPECT_TRUE(times.is_timed());
  EXPECT_EQ(times.slowest_tick(), 1u);
  EXPECT_EQ(times.slowest(), us(9));
  EXPECT_EQ(times.median(), us(3));
  EXPECT_FALSE(VectorTimes().is_timed());
}

TEST(CorpusTimesTest, KnowsTheVectorsOfTheSlowestStepAndOfTheMostStack) {
  const SelectedCase level = open_loop("level");
  const Rate rate = Rate::hz(100);
  CorpusTimes times;
  EXPECT_EQ(times.with_slowest_step(), nullptr);
  times.vectors = {VectorTimes{}};
  EXPECT_EQ(times.with_slowest_step(), nullptr);
  times.vectors = {VectorTimes{}, timed_vector(level, rate, {us(5), us(5)}),
                   timed_vector(level, rate, {us(1), us(6)}),
                   timed_vector(level, rate, {us(4), us(4), us(4)})};
  EXPECT_EQ(times.with_slowest_step(), &times.vectors[2]);
  EXPECT_EQ(times.with_most_stack(), nullptr);
  times.vectors = {with_stack_of({}), with_stack_of(200), with_stack_of(300), with_stack_of(100)};
  EXPECT_EQ(times.with_most_stack(), &times.vectors[2]);
}

// A port that has died cannot report how long reading the clock takes.
TEST_F(TimeCorpus, TheClockIsThatOfAnAnswerWithoutAFault) {
  StepTimes died;
  died.fault = PortFault{PortFault::Kind::crash, 0, "it died"};
  answers_ = {steps({us(5)}), died};
  answers_[0]->clock = ns(25);
  const auto times = timed({open_loop("level"), open_loop("other")});
  ASSERT_TRUE(times) << times.error().to_string();
  EXPECT_EQ(times->clock, ns(25));
}

}  // namespace
}  // namespace attest
