#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/report/html/histogram_plot.hpp"
#include "harness/report/stress_document.hpp"
#include "tests/harness/times.hpp"

namespace attest {
namespace {

using testing::Each;
using testing::HasSubstr;
using testing::Le;
using testing::Not;

std::vector<Histogram::Bucket> buckets_of(const std::vector<Nanoseconds>& times) {
  Histogram histogram;
  for (const Nanoseconds time : times) histogram.add(time);
  return histogram.buckets();
}

TEST(HistogramPlot, HistogramsShareTheBarsAndAddUpTo100Percent) {
  const Plot plot = histogram_plot("Latency",
                                   {{"idle", buckets_of({us(8), us(8), us(9), ms(1)})},
                                    {"none", {}},
                                    {"live", buckets_of({us(20)})}},
                                   {});
  ASSERT_EQ(plot.series.size(), 2u);
  EXPECT_EQ(plot.series[0].x, plot.series[1].x);
  EXPECT_LE(plot.series[0].x.front(), 8);
  EXPECT_GT(plot.series[0].x.back(), 1000);
  for (const PlotSeries& series : plot.series) {
    float sum = 0;
    for (const float y : series.y) sum += y;
    EXPECT_NEAR(sum, 100, 1e-3);
    EXPECT_THAT(series.y, Each(Le(100)));
    EXPECT_EQ(series.y.back(), 0);
  }
}

// A rate that failed: one late step of two.
StressRun failed_run() {
  StressRun run;
  run.description.name = "acme <1>";
  run.load = "none";
  StressResult& stress = run.results.emplace_back();
  stress.result.rate = Rate::hz(1000);
  stress.result.verdict = Verdict::fail;
  stress.result.reason = "1 of 1 deadline misses";
  stress.ticks = stress.deadlines = 2;
  LiveTick tick;
  tick.deadline = ms(1);
  tick.finish = us(1500);
  tick.elapsed = tick.cpu = us(1400);
  LiveTick next = tick;
  next.release = ms(2);
  next.deadline = next.finish = ms(3);
  stress.misses.late = 1;
  stress.timeline = flight_timeline({tick, next}, {});
  Histogram latency;
  latency.add(us(8));
  stress.idle = stress.latency = percentiles_of(latency);
  return run;
}

std::string page_of(const StressRun& run) { return html_page(stress_document(run)); }

TEST(StressPage, ShowsTheReasonTheFloorAndTheTimeline) {
  const std::string page = page_of(failed_run());
  EXPECT_THAT(page, HasSubstr("</span> fail</p>"));
  EXPECT_THAT(page, HasSubstr("<p class=\"error\">1000 Hz: fail: 1 of 1 deadline misses</p>"));
  EXPECT_THAT(page, HasSubstr("\"name\":\"idle machine\""));
  EXPECT_THAT(page, HasSubstr("\"name\":\"late responses\""));
  EXPECT_THAT(page, Not(HasSubstr("\"name\":\"overruns\"")));
  EXPECT_THAT(page, HasSubstr("acme &lt;1&gt;"));
  EXPECT_THAT(page, HasSubstr("<td class=\"number\">1500</td>"));
}

TEST(StressPage, ARateWithoutATickHasNoPlots) {
  StressRun run = failed_run();
  run.results[0].ticks = 0;
  run.results[0].result.verdict = Verdict::crash;
  const std::string page = page_of(run);
  EXPECT_THAT(page, Not(HasSubstr("idle machine")));
  EXPECT_THAT(page, HasSubstr("crash"));
}

}  // namespace
}  // namespace attest
