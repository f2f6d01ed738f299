#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/report/stress_document.hpp"
#include "harness/report/text.hpp"
#include "tests/harness/report/baseline.hpp"
#include "tests/harness/times.hpp"

namespace attest {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

// The percentiles of `count` samples of some microseconds each.
Percentiles spread(std::uint64_t count) {
  Histogram histogram;
  for (std::uint64_t i = 0; i < count; ++i) histogram.add(us(i % 100 == 99 ? 40 : 8));
  return percentiles_of(histogram);
}

StressResult result(Rate rate, Verdict verdict, std::string reason = "") {
  StressResult stress;
  stress.result.profile = "px4-v1.5.5";
  stress.result.group = "flight";
  stress.result.name = "hover";
  stress.result.rate = rate;
  stress.result.plant_configuration = PlantConfiguration{"iris", PlantKind::mujoco};
  stress.result.verdict = verdict;
  stress.result.reason = std::move(reason);
  stress.ticks = stress.result.ticks = 499;
  stress.deadlines = 500;
  stress.idle = stress.latency = stress.execution = stress.response = stress.age = spread(499);
  stress.plant = spread(20'000);
  stress.plant_steps = 20'000;
  stress.wall = ms(2000);
  return stress;
}

// A rate that passed, one that fails and one that was not judged.
StressRun mixed_run() {
  StressRun run;
  run.port = "lib:./mine.so";
  run.load = "none";
  run.results.push_back(result(Rate::hz(250), Verdict::pass));
  run.results.push_back(result(Rate::hz(500), Verdict::fail, "9 overruns"));
  StressResult& slow = run.results.back();
  slow.misses = {2, 1, 3, 4, 4};
  slow.overruns = 9;
  slow.waiting_steps = 1;
  slow.slow = {us(64), 2, {{99, us(300), us(310)}, {199, us(290), us(290)}}, Rhythm{100, 99, 1e-9}};
  slow.cyclictest = Cyclictest{us(7), us(70), 2000};
  slow.privileges = {{"mlockall", true, ""}, {"SCHED_FIFO 80", false, "not permitted"}};
  run.results.push_back(result(Rate::hz(1000), Verdict::skip, "the machine's"));
  return run;
}

std::string text_of_result(const StressResult& stress) {
  return render_text(result_table(stress), {});
}

std::string last_line(const StressRun& run) {
  return lines_of(render_text(stress_document(run).head, {})).back();
}

TEST(StressText, NamesNoPercentileThatTheSampleCannotSupport) {
  const std::string text = text_of_result(result(Rate::hz(250), Verdict::pass));
  EXPECT_THAT(text, HasSubstr("  response time    8.06 us  8.06 us        -      -  40 us\n"));
  EXPECT_THAT(text, HasSubstr("  plant's wake-up  8.06 us  8.06 us  8.06 us  40 us  40 us\n"));
}

TEST(StressText, NamesARhythmOnlyWhereOneWasFound) {
  const StressRun run = mixed_run();
  EXPECT_THAT(text_of_result(run.results[0]), Not(HasSubstr("they come every")));
  EXPECT_THAT(text_of_result(run.results[1]),
              HasSubstr("they come every 100 steps, from tick 99 on (chance: below 1e-09)"));
}

TEST(StressText, ARateThatIsNotJudgedIsNoPassOfTheWhole) {
  StressRun run = mixed_run();
  EXPECT_EQ(conclusion_of(run), Conclusion::fail);
  EXPECT_THAT(rates_not_judged(run), ElementsAre("1000"));
  run.results.erase(run.results.begin() + 1);
  EXPECT_EQ(conclusion_of(run), Conclusion::partial);
  EXPECT_EQ(last_line(run),
            "PARTIAL 1 of 2 rates hold in real time (load: none); not judged: 1000 Hz");
  run.results.back().result.verdict = Verdict::unsupported;
  EXPECT_EQ(conclusion_of(run), Conclusion::partial);
  run.results.pop_back();
  EXPECT_EQ(conclusion_of(run), Conclusion::pass);
  EXPECT_EQ(last_line(run), "PASS 1 of 1 rate hold in real time (load: none)");
  run.interrupted = true;
  EXPECT_EQ(conclusion_of(run), Conclusion::partial);
  run.results.clear();
  EXPECT_EQ(conclusion_of(run), Conclusion::none);
}

// Of the cascade: a rate has a result for each unit.
StressRun cascade_run() {
  StressRun run;
  run.load = "none";
  run.description.modules = only(Module::rate_unit) | only(Module::attitude_unit);
  for (const Module module : {Module::rate_unit, Module::attitude_unit}) {
    run.results.push_back(result(Rate::hz(1000), Verdict::pass));
    run.results.back().result.rate = LoopRate(Rate::hz(250), Rate::hz(1000));
    run.results.back().module = module;
  }
  return run;
}

TEST(StressText, ARateOfTheCascadeHoldsIfBothUnitsDo) {
  StressRun run = cascade_run();
  EXPECT_THAT(text_of_result(run.results[1]),
              HasSubstr("hover@250-1000hz-iris-mujoco, attitude unit\n"));
  EXPECT_EQ(last_line(run), "PASS 1 of 1 rate hold in real time (load: none)");
  run.results[1].result.verdict = Verdict::skip;
  run.results[1].result.reason = "the machine's";
  EXPECT_EQ(conclusion_of(run), Conclusion::none);
  EXPECT_THAT(rates_not_judged(run), ElementsAre("250:1000"));
  run.results[0].result.verdict = Verdict::fail;
  run.results[0].result.reason = "9 overruns";
  const RunResult all = run_of(run);
  ASSERT_EQ(all.results.size(), 1u);
  EXPECT_EQ(all.results[0].verdict, Verdict::fail);
  EXPECT_EQ(all.results[0].reason, "rate unit: 9 overruns; attitude unit: the machine's");
  run.results.push_back(run.results[0]);  // another flight at that rate
  EXPECT_EQ(run_of(run).results.size(), 2u);
}

TEST(StressText, NamesTheUnitThatIsTheReferences) {
  StressRun run = cascade_run();
  EXPECT_EQ(note_on_units(run), "");
  run.description.modules = only(Module::rate_unit);
  run.results.pop_back();
  EXPECT_THAT(note_on_units(run), HasSubstr("the attitude unit is that of the reference"));
  EXPECT_EQ(note_on_units(mixed_run()), "");
}

TEST(StressJson, NamesTheUnitOfTheCascadeOnly) {
  EXPECT_THAT(stress_json(cascade_run()), HasSubstr("\"module\": \"attitude_unit\""));
  EXPECT_THAT(stress_json(mixed_run()), Not(HasSubstr("\"module\"")));
}

TEST(StressJson, IsTheReviewedOne) {
  EXPECT_TRUE(is_baseline("stress.json", stress_json(mixed_run())));
}

}  // namespace
}  // namespace attest
