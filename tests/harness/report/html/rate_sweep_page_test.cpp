#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/report/rate_sweep_document.hpp"

namespace attest {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr double infinite = std::numeric_limits<double>::infinity();

// Holds at 100 Hz and misses at 20 Hz.
RateSweepRun one_vehicle() {
  Metric settles;
  settles.name = "settles";
  settles.max = 1.5;
  RateSweepRun run;
  run.says.name = "acme";
  run.the_case.flight.emplace().metrics = {settles};
  run.rates = {Rate::hz(100)};
  RateSweepResult lowest, delay;
  lowest.result.plant_configuration = PlantConfiguration{"iris", PlantKind::ode};
  lowest.result.verdict = Verdict::pass;
  lowest.lowest_rate_hz = 30;
  lowest.trials = {{100, 0, {0.5}, true}, {20, 0, {infinite}, false}};
  delay.result = lowest.result;
  delay.largest_delay_ms = -1;
  run.results = {lowest, delay};
  return run;
}

TEST(SweepPage, ShowsTheLimitsAndWhatIsMissed) {
  const std::string page = html_page(rate_sweep_document(one_vehicle()));
  EXPECT_THAT(page, HasSubstr("</span> measured</p>"));
  EXPECT_THAT(page, HasSubstr(">iris</th><td class=\"\">ode</td><td class=\"number\">30</td>"));
  EXPECT_THAT(page, HasSubstr("<b>\u2717</b> none</td>"));
  EXPECT_THAT(page, HasSubstr("settles (settling_time_s) is inf, allowed: at most 1.5"));
  EXPECT_THAT(page, HasSubstr("\"name\":\"within bounds\""));
}

TEST(SweepPage, APlotHasTheUnitOfTheMeasureAndAtLeastOneValue) {
  RateSweepRun run = one_vehicle();
  const auto plots = rate_sweep_document(run).groups.front().plots;
  ASSERT_EQ(plots.size(), 1u);  // no delay was found, so none is plotted
  EXPECT_EQ(plots[0].title, "settles: settling_time_s");
  EXPECT_EQ(plots[0].unit, "s");
  run.results[0].trials = {{100, 0, {infinite}, false}};
  EXPECT_THAT(rate_sweep_document(run).groups, testing::IsEmpty());
}

TEST(SweepPage, AFailureOfThePortIsTheConclusion) {
  RateSweepRun run = one_vehicle();
  run.results[1].result.verdict = Verdict::crash;
  run.results[1].result.reason = "the process died";
  run.results[0].trials = {{100, 0, {}, false}};
  const std::string page = html_page(rate_sweep_document(run));
  EXPECT_THAT(page, HasSubstr("</span> fail</p>"));
  EXPECT_THAT(page, HasSubstr("iris on ode: crash: the process died"));
  EXPECT_THAT(page, HasSubstr("the vehicle is lost"));
  EXPECT_THAT(page, Not(HasSubstr("</span> measured</p>")));
}

}  // namespace
}  // namespace attest
