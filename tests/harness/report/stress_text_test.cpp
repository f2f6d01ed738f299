#include "harness/report/stress_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

TEST(StressText, NamesNoPercentileThatTheSampleCannotSupport) {
  const std::string text = render_stress(result(Rate::hz(250), Verdict::pass), {});
  EXPECT_THAT(text, HasSubstr("  response time            8.06 us   8.06 us         -         -"
                              "     40 us\n"));
  EXPECT_THAT(text, HasSubstr("  plant's wake-up          8.06 us   8.06 us   8.06 us     40 us"));
}

TEST(StressText, NamesARhythmOnlyWhereOneWasFound) {
  const StressRun run = mixed_run();
  EXPECT_THAT(render_stress(run.results[0], {}), Not(HasSubstr("they come every")));
  EXPECT_THAT(render_stress(run.results[1], {}),
              HasSubstr("they come every 100 steps, from tick 99 on (chance: below 1e-09)"));
}

TEST(StressText, ARateThatIsNotJudgedIsNoPassOfTheWhole) {
  StressRun run = mixed_run();
  EXPECT_EQ(verdict_of(run), "fail");
  EXPECT_THAT(rates_not_judged(run), ElementsAre("1000"));
  run.results.erase(run.results.begin() + 1);
  EXPECT_EQ(verdict_of(run), "partial");
  EXPECT_EQ(render_stress_end(run, {}),
            "PARTIAL 1 of 2 rates hold in real time (load: none); not judged: 1000 Hz\n");
  run.results.back().result.verdict = Verdict::unsupported;
  EXPECT_EQ(verdict_of(run), "partial");
  run.results.pop_back();
  EXPECT_EQ(verdict_of(run), "pass");
  EXPECT_EQ(render_stress_end(run, {}), "PASS 1 of 1 rate hold in real time (load: none)\n");
  run.interrupted = true;
  EXPECT_EQ(verdict_of(run), "partial");
  run.results.clear();
  EXPECT_EQ(verdict_of(run), "none");
}

TEST(StressJson, IsTheReviewedOne) {
  EXPECT_TRUE(is_baseline("stress.json", stress_json(mixed_run())));
}

}  // namespace
}  // namespace attest
