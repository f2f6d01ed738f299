#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/report/flight_document.hpp"
#include "tests/harness/report/sample_run.hpp"

namespace attest {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr double infinity = std::numeric_limits<double>::infinity();

Metric metric(Measure measure, double min, double max) {
  Metric out;
  out.name = "holds";
  out.measure = measure;
  out.min = min;
  out.max = max;
  return out;
}

// Of a plot with one line: a value each second.
Plot plot_with(const std::vector<float>& values) {
  PlotSeries line{"line", {}, values};
  for (std::size_t i = 0; i < values.size(); ++i) line.x.push_back(static_cast<double>(i));
  Plot plot;
  plot.series = {line};
  return plot;
}

void expect_line(const PlotBound& line, double first, double last, float level, bool is_upper) {
  EXPECT_EQ(line.first, first);
  EXPECT_EQ(line.last, last);
  EXPECT_FLOAT_EQ(line.level, level);
  EXPECT_EQ(line.is_upper, is_upper);
}

TEST(LinesOfBounds, OfASettlingTimeAreTheBandFromTheLatestTimeOn) {
  Metric settles = metric(Measure::settling_time_s, -infinity, 2);
  settles.window = {1, 5};
  settles.band_deg = 3;
  const auto lines = lines_of_bounds(settles, plot_with({9, 9, 9, 1, 1, 1, 1}));
  ASSERT_EQ(lines.size(), 1u);
  expect_line(lines[0], 3, 5, 3, true);
  EXPECT_EQ(lines[0].text, "holds: at most 3 from 3 s on");
}

TEST(LinesOfBounds, OfAPeakAreLevelsInTheWindow) {
  Metric peak = metric(Measure::peak_rate_rad_s, 2, 9);
  peak.window.from_s = 1;
  const auto lines = lines_of_bounds(peak, plot_with({0, 1, 2, 3}));
  ASSERT_EQ(lines.size(), 2u);
  expect_line(lines[0], 1, 3, 9, true);
  expect_line(lines[1], 1, 3, 2, false);
  EXPECT_EQ(lines[1].text, "holds: peak at least 2");
}

TEST(LinesOfBounds, OfAnIntegralHaveBothSigns) {
  const auto lines =
      lines_of_bounds(metric(Measure::peak_integral, -infinity, 0.5), plot_with({0, 0}));
  ASSERT_EQ(lines.size(), 2u);
  expect_line(lines[0], 0, 1, 0.5f, true);
  expect_line(lines[1], 0, 1, -0.5f, false);
}

TEST(LinesOfBounds, OfAnOvershootBeginAtTheFirstTickInTheBand) {
  Metric overshoot = metric(Measure::overshoot_deg, -infinity, 4);
  overshoot.band_deg = 2;
  overshoot.window.from_s = 1;
  const auto lines = lines_of_bounds(overshoot, plot_with({0, 9, 1, 3, 0}));
  ASSERT_EQ(lines.size(), 1u);
  expect_line(lines[0], 2, 4, 4, true);
  EXPECT_THAT(lines_of_bounds(overshoot, plot_with({0, 9, 9, 9})), IsEmpty());
}

TEST(LinesOfBounds, OfASinkAreBelowTheAltitudeAtTheBeginOfTheWindow) {
  Metric sink = metric(Measure::sink_m, -infinity, 2);
  sink.window.from_s = 1;
  Plot position = plot_with({0, 0, 0});
  position.series.assign(3, position.series.front());  // north, east, altitude
  position.series[2].y = {5, 7, 6};
  const auto lines = lines_of_bounds(sink, position);
  ASSERT_EQ(lines.size(), 1u);
  expect_line(lines[0], 1, 2, 5, false);
}

TEST(LinesOfBounds, AMeanARatioAndAWindowAfterTheFlightHaveNone) {
  const Plot plot = plot_with({0, 1});
  EXPECT_THAT(lines_of_bounds(metric(Measure::rms_attitude_error_deg, 0, 2), plot), IsEmpty());
  EXPECT_THAT(lines_of_bounds(metric(Measure::saturation_duty, 0, 1), plot), IsEmpty());
  Metric ratio = metric(Measure::peak_rate_rad_s, 0, 2);
  ratio.versus = Window{0, 1};
  EXPECT_THAT(lines_of_bounds(ratio, plot), IsEmpty());
  Metric late = metric(Measure::peak_rate_rad_s, 0, 2);
  late.window.from_s = 3;
  EXPECT_THAT(lines_of_bounds(late, plot), IsEmpty());
}

// With a height of 0 and then 3 m.
Flown climb() {
  Flown flown = two_level_ticks();
  flown.trace.plant[0].rate_rad_s = {3, 0, 4};
  flown.trace.plant[1].position_m = {0, 0, -3};
  return flown;
}

std::vector<std::string> titles(const std::vector<Plot>& plots) {
  std::vector<std::string> out;
  for (const Plot& plot : plots) out.push_back(plot.title);
  return out;
}

TEST(FlightBounds, AreInThePlotOfTheirMeasureAndSayWhichIsMissed) {
  SimulatedFlight flight{passed("flight", "hover", Rate::hz(250)), climb()};
  flight.result.metrics = {{"holds", Measure::peak_rate_rad_s, 5, 5, 0, -infinity, 4}};
  FlightBackground background;
  background.metrics = {metric(Measure::peak_rate_rad_s, -infinity, 4)};
  const auto plots = flight_document({flight}, {}, background).groups.front().plots;
  EXPECT_THAT(titles(plots), ElementsAre("Body rates", "Length of the body rate", "Position"));
  EXPECT_THAT(plots[1].series[0].y, ElementsAre(5, 0));
  ASSERT_EQ(plots[1].bounds.size(), 1u);
  EXPECT_TRUE(plots[1].bounds[0].is_missed);
  EXPECT_THAT(plots[0].bounds, IsEmpty());
  EXPECT_THAT(titles(flight_document({flight}, {}).groups.front().plots),
              ElementsAre("Body rates", "Position"));
}

}  // namespace
}  // namespace attest
