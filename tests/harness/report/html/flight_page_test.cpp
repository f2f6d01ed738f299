#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/report/flight_document.hpp"
#include "tests/harness/report/sample_run.hpp"

namespace attest {
namespace {

using testing::ElementsAre;
using testing::FloatNear;
using testing::HasSubstr;
using testing::Not;

// The vehicle turns from level to a roll of 90 deg, with three rotors.
Flown two_ticks() {
  Flown flown = two_level_ticks();
  Trace& trace = flown.trace;
  trace.samples[1].out.mc_att_ctrl_status.roll_rate_integ = 0.25f;
  const float half = std::sqrt(0.5f);
  trace.plant[1].q = {half, half, 0, 0};
  for (PlantSample& sample : trace.plant) {
    sample.rotor_rad_s = {500, 500, 500};
    sample.motor = {0.1f, 0.1f, 0.1f};
  }
  return flown;
}

// The plot of that title, of one flight, or of the same flight on two plants.
Plot plot(const std::string& title, bool two_plants = false) {
  SimulatedFlight mujoco{passed("flight", "hover", Rate::hz(250)), two_ticks()}, ode = mujoco;
  mujoco.result.plant_configuration = PlantConfiguration{"iris", PlantKind::mujoco};
  ode.result.plant_configuration = PlantConfiguration{"iris", PlantKind::ode};
  const auto flights = two_plants ? std::vector{mujoco, ode} : std::vector{mujoco};
  const Document document = flight_document(flights, {});
  for (const Plot& one : document.groups.front().plots) {
    if (one.title == title) return one;
  }
  return {};
}

TEST(FlightPlots, TheAttitudeIsInDegrees) {
  const Plot attitude = plot("Attitude");
  ASSERT_EQ(attitude.series.size(), 6u);
  EXPECT_EQ(attitude.unit, "deg");
  EXPECT_EQ(attitude.series[0].name, "roll");
  EXPECT_THAT(attitude.series[0].y, ElementsAre(0, FloatNear(90, 1e-4f)));
  EXPECT_THAT(attitude.series[2].y, ElementsAre(0, 0));
}

TEST(FlightPlots, SignalsHaveNamesInWords) {
  const Plot integrals = plot("Integrals");
  EXPECT_EQ(integrals.series[0].name, "roll integral");
  EXPECT_THAT(integrals.series[0].y, ElementsAre(0, 0.25f));
  EXPECT_THAT(integrals.series[0].x, ElementsAre(0, 0.004));
}

TEST(FlightPlots, WhatIsZeroThroughoutIsLeftOut) {
  EXPECT_THAT(plot("Saturation of the mixer").series, testing::IsEmpty());
}

TEST(FlightPlots, AltitudeIsUp) {
  Flown flown = two_ticks();
  flown.trace.plant[1].position_m = {1, 2, -3};
  const auto document = flight_document({{passed("flight", "hover", Rate::hz(250)), flown}}, {});
  const Plot& position = document.groups.front().plots.back();
  EXPECT_EQ(position.series[2].name, "altitude");
  EXPECT_THAT(position.series[2].y, ElementsAre(0, 3));
}

// A yaw that passes through half a turn goes on.
TEST(FlightPlots, AnglesHaveNoJumps) {
  Flown flown = two_ticks();
  const auto yaw = [](PlantSample& sample, float deg) {
    const float half = deg * std::numbers::pi_v<float> / 360;
    sample.q = {std::cos(half), 0, 0, std::sin(half)};
  };
  yaw(flown.trace.plant[0], 179);
  yaw(flown.trace.plant[1], -179);
  const auto document = flight_document({{passed("flight", "hover", Rate::hz(250)), flown}}, {});
  const auto& series = document.groups.front().plots.front().series[2];
  EXPECT_THAT(series.y, ElementsAre(FloatNear(179, 1e-3f), FloatNear(181, 1e-3f)));
}

TEST(FlightPlots, OnlyMotorsOfTheVehicleArePlotted) {
  EXPECT_EQ(plot("Motor commands").series.size(), 3u);
}

TEST(FlightPlots, TwoPlantsAreInOnePlotWithOneSetpoint) {
  const Plot attitude = plot("Attitude", true);
  ASSERT_EQ(attitude.series.size(), 9u);
  EXPECT_EQ(attitude.series[0].name, "roll (mujoco)");
  EXPECT_EQ(attitude.series[3].name, "setpoint roll (mujoco)");
  EXPECT_EQ(attitude.series[6].name, "roll (ode)");
  EXPECT_NE(attitude.series[6].colour, attitude.series[0].colour);
  EXPECT_NE(attitude.series[6].pattern, attitude.series[0].pattern);
}

TEST(FlightPlots, TheReferenceIsAThinLineAfterTheFlight) {
  const SimulatedFlight flight{passed("flight", "hover", Rate::hz(250)), two_ticks()};
  const auto document = flight_document({flight}, {}, {two_ticks(), {}});
  const Plot& attitude = document.groups.front().plots.front();
  ASSERT_EQ(attitude.series.size(), 9u);
  EXPECT_EQ(attitude.series[6].name, "roll (reference)");
  EXPECT_EQ(attitude.series[6].pattern, LinePattern::dotted);
  EXPECT_EQ(document.replay.size(), 1u);  // the animation has the flight only
}

TEST(FlightMarks, AreTheEventsAndTheFirstDeviationInOrderOfTime) {
  Case the_case;
  the_case.flight.emplace();
  the_case.flight->motor_failure = MotorFailure{2, {0.5, Span::In::seconds}};
  const Step gust{0, 3, {25, Span::In::ticks}};
  the_case.flight->wind_m_s = {gust, gust, Constant{0}};
  SimulatedFlight flight{passed("flight", "hover", Rate::hz(250)), two_ticks()};
  flight.flown.trace.samples[0].in.timestamp = 5'000'000;
  flight.result.first = Deviation{};
  flight.result.first->timestamp_us = 5'200'000;
  flight.result.first->channel =
      *find_channel(Module::mc_att_control, "out/mc_att_ctrl_status.roll_rate_integ");
  const std::vector<PlotMark> marks = marks_of(the_case, flight);
  ASSERT_EQ(marks.size(), 3u);  // a gust in two directions is one event
  EXPECT_EQ(marks[0].text, "wind");
  EXPECT_DOUBLE_EQ(marks[0].x, 0.1);
  EXPECT_TRUE(marks[0].is_quiet);
  EXPECT_EQ(marks[1].text, "first deviation: out/mc_att_ctrl_status.roll_rate_integ");
  EXPECT_DOUBLE_EQ(marks[1].x, 0.2);
  EXPECT_FALSE(marks[1].is_quiet);
  EXPECT_EQ(marks[2].text, "motor 2 fails");
}

TEST(FlightPlots, TheReplayHasTheQuaternions) {
  const SimulatedFlight flight{passed("flight", "hover", Rate::hz(250)), two_ticks()};
  const auto replay = flight_document({flight}, {}).replay;
  ASSERT_EQ(replay.size(), 1u);
  EXPECT_THAT(replay[0].times, ElementsAre(0, 0.004f));
  EXPECT_THAT(replay[0].attitude[1], ElementsAre(0, std::sqrt(0.5f)));
}

TEST(FlightPage, HasTheVerdictAndTheMetrics) {
  SimulatedFlight flight{passed("flight", "hover", Rate::hz(250)), two_ticks()};
  flight.result.verdict = Verdict::fail;
  flight.result.metrics = {{"levels", Measure::settling_time_s, 3.5, 3.5, 0, 0, 2}};
  Declarations port;
  port.name = "<b>acme</b>";
  const std::string page = html_page(flight_document({flight}, port));
  EXPECT_THAT(page, HasSubstr("</span> fail</p>"));
  EXPECT_THAT(page, HasSubstr("&lt;b&gt;acme&lt;/b&gt;"));
  EXPECT_THAT(page, Not(HasSubstr("<b>acme")));
  EXPECT_THAT(page, HasSubstr("levels</th><td class=\"\">settling_time_s</td>"
                              "<td class=\"number\">3.5</td><td class=\"number\">0 to 2</td>"
                              "<td class=\"v-fail\"><b>\u2717</b> missed</td>"));
}

TEST(FlightPage, TwoPlantsHaveAColumnEachAndTheWorseVerdict) {
  SimulatedFlight mujoco{passed("flight", "hover", Rate::hz(250)), two_ticks()}, ode = mujoco;
  mujoco.result.plant_configuration = PlantConfiguration{"iris", PlantKind::mujoco};
  ode.result.plant_configuration = PlantConfiguration{"iris", PlantKind::ode};
  mujoco.result.metrics = {{"levels", Measure::settling_time_s, 1.5, 1.5, 0, 0, 2}};
  ode.result.metrics = {{"levels", Measure::settling_time_s, 3.5, 3.5, 0, 0, 2}};
  ode.result.verdict = Verdict::fail;
  ode.result.reason = "levels";
  const std::string page = html_page(flight_document({mujoco, ode}, {}));
  EXPECT_THAT(page, HasSubstr("</span> fail</p>"));
  EXPECT_THAT(page, HasSubstr("<p class=\"error\">ode: levels</p>"));
  EXPECT_THAT(page, HasSubstr("<td class=\"number\">1.5</td><td class=\"number\">3.5</td>"
                              "<td class=\"number\">0 to 2</td><td class=\"v-fail\">"));
  EXPECT_THAT(page, HasSubstr("\"name\":\"roll (ode)\""));
}

TEST(FlightPage, WithoutATickHasNoPlots) {
  const SimulatedFlight crashed{passed("flight", "hover", Rate::hz(250)), {}};
  EXPECT_THAT(html_page(flight_document({crashed}, {})), Not(HasSubstr("id=\"plots-of-page\"")));
}

}  // namespace
}  // namespace attest
