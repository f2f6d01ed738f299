#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/casefile/parse.hpp"
#include "harness/core/file.hpp"
#include "harness/report/html/sweep_plots.hpp"
#include "harness/report/sweep_document.hpp"

namespace attest {
namespace {

using testing::Contains;
using testing::Each;
using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;
using testing::Le;
using testing::Not;

constexpr double unsettled = std::numeric_limits<double>::infinity();
const double lost = std::nan("");

FlightSampler sampler_of_two() {
  const std::filesystem::path source = ATTEST_SOURCE_DIR;
  const auto file = source / "cases/px4-v1.5.5/flight/tilt_step_30.toml";
  const auto sweep = parse_sweep(
      "schema = 1\ncase = 'x'\nrate = 250\ndesign = 'monte_carlo'\nsamples = 50\n"
      "[disperse.mass]\nkeys = ['vehicle.mass_kg']\nas = 'factor'\n"
      "distribution = 'uniform'\nlow = 0.9\nhigh = 1.1\n"
      "[require.soon]\nmetric = 'tilts'\nmax = 1.2\nprobability = 0.5\n",
      "dir/robust.toml");
  const auto iris = *VehicleModel::load(source / "models", "iris");
  return *FlightSampler::make(*sweep, {*parse_case(file),
                                       *read_file(file),
                                       {"iris", PlantKind::mujoco},
                                       iris,
                                       *read_file(iris->vehicle().file)});
}

class DispersedPage : public testing::Test {
 protected:
  // Sample i has the mass i and the metric value(i).
  template <typename Value>
  void fly(int samples, Value&& value) {
    data_.drawn.resize(1);
    data_.pilots.resize(1);
    data_.pilots[0].metrics.resize(1);
    for (int i = 0; i < samples; ++i) {
      data_.drawn[0].push_back(i);
      const double one = value(i);
      data_.pilots[0].outcomes.emplace_back(std::isnan(one) ? outcome_diverged : outcome_done);
      data_.pilots[0].metrics[0].push_back(one);
    }
  }
  void add_port(double offset) {
    columns_.with_port = true;
    data_.pilots.push_back(data_.pilots[0]);
    for (double& value : data_.pilots[1].metrics[0]) value += offset;
    identity_.port = "lib:<b>.so";
  }
  SweepSummary summary() const { return summarise(sampler_.sweep(), columns_, data_, 2); }
  SweepPlots plots() const { return sweep_plots(sampler_.sweep(), columns_, data_, summary()); }
  std::string page(const std::string& kept = "out/worst") const {
    const SweepSummary of = summary();
    return html_page(sweep_document({sampler_, columns_, data_, of, identity_, kept}));
  }

  FlightSampler sampler_ = sampler_of_two();
  SampleColumns columns_{{"mass"}, {"tilts"}, false};
  SampleData data_;
  SweepIdentity identity_{"1.0", "abc", "", "", "1/1"};
};

TEST_F(DispersedPage, TheConclusionAndTheRequirementsComeFirst) {
  fly(100, [](int i) { return i < 90 ? 1 : 2; });
  const std::string text = page();
  EXPECT_THAT(text, HasSubstr("</span> pass</p>"));
  EXPECT_THAT(text, HasSubstr("Requirements: 1 met, 0 not met, 0 undecided."));
  EXPECT_THAT(text, HasSubstr("<td class=\"number\">90/100</td>"));
  EXPECT_THAT(text, HasSubstr("<td class=\"v-pass\"><b>\u2713</b> met</td>"));
  EXPECT_LT(text.find("Requirements</caption>"), text.find("Metrics of the flights"));
  EXPECT_THAT(text, HasSubstr("<dd>robust.toml</dd>"));
}

TEST_F(DispersedPage, TheWorstFlightsHaveTheirValuesAndCommands) {
  fly(100, [](int i) { return i == 7 ? lost : i == 8 ? 9.5 : 1; });
  const std::string text = page();
  EXPECT_THAT(text, HasSubstr("Worst flights for soon</caption>"));
  EXPECT_THAT(text, HasSubstr(">7</th><td class=\"\">diverged</td>"));
  EXPECT_THAT(text, HasSubstr("<td class=\"number\">9.5</td>"));
  EXPECT_THAT(text, HasSubstr("attest --suite out/worst sim "));
  EXPECT_THAT(page(""), HasSubstr("No worst flight was kept."));
}

TEST_F(DispersedPage, APortIsComparedAndEscaped) {
  fly(100, [](int i) { return 1 + 0.001 * i; });
  add_port(0.5);
  const std::string text = page();
  EXPECT_THAT(text, HasSubstr("</span> fail</p>"));
  EXPECT_THAT(text, HasSubstr("The port differs from the reference: tilts."));
  EXPECT_THAT(text, Not(HasSubstr("<b>.so")));
  const auto groups = plots().groups;
  EXPECT_THAT(groups[0].plots[0].series,
              ElementsAre(Field(&PlotSeries::name, "reference"), Field(&PlotSeries::name, "port")));
  const PlotSeries difference = groups[1].plots[0].series[0];
  EXPECT_NEAR(difference.x.back(), 0.5, 1e-9);
  EXPECT_EQ(difference.x.front(), 0);  // "equal" is in the plot
}

TEST_F(DispersedPage, ADistributionIsOfAllFlights) {
  fly(10, [](int i) { return i == 0 ? lost : i == 1 ? unsettled : i < 6 ? 1 : 1.1; });
  const Plot plot = plots().groups[0].plots[0];
  EXPECT_THAT(plot.note, HasSubstr("2 of the 10 flights of the reference have no finite value"));
  // A step to 0 on the left, two values, and the bound of the requirement.
  EXPECT_THAT(plot.series[0].x, ElementsAre(testing::Lt(1), 1, 1.1, 1.2));
  EXPECT_THAT(plot.series[0].y, ElementsAre(0, 40, 80, 80));
  EXPECT_THAT(plot.marks, ElementsAre(Field(&PlotMark::x, 1.2)));
}

TEST_F(DispersedPage, ABoundFarAwayDoesNotSqueezeTheDistribution) {
  fly(10, [](int i) { return 1e-3 * i; });
  const auto groups = plots().groups;
  EXPECT_LT(groups[0].plots[0].series[0].x.back(), 0.01);
  EXPECT_THAT(groups[0].plots[0].note, HasSubstr("Outside of the plot: soon, max, 1.2."));
  EXPECT_THAT(groups[1].plots[0].band->high, Each(testing::Lt(0.01f)));
}

TEST_F(DispersedPage, ManySamplesAreThinnedAndTheWorstStay) {
  fly(200'000, [](int i) { return i == 165'432 ? 100 : 1 + 1e-7 * i; });
  const auto all = plots();
  const PlotSeries& distribution = all.groups[0].plots[0].series[0];
  EXPECT_LE(distribution.x.size(), most_drawn_quantiles + 2 * drawn_tail + 2);
  EXPECT_THAT(distribution.x, Contains(100));
  const Plot& scatter = all.groups[1].plots[0];
  EXPECT_LE(scatter.series[0].x.size(), most_drawn_samples + 2);
  EXPECT_THAT(scatter.series[1].y, Contains(100.0f));
  EXPECT_THAT(scatter.series[0].y, Not(Contains(100.0f)));
  EXPECT_THAT(scatter.band->high, Each(1.2f));
  const std::string text = page();
  EXPECT_THAT(text, HasSubstr("The plots are thinned"));
  EXPECT_THAT(text.size(), Le(500'000u));
}

}  // namespace
}  // namespace attest
