#include "harness/report/html/flight_page.hpp"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/report/html/base64.hpp"
#include "harness/report/html/flight_plots.hpp"
#include "tests/harness/report/sample_run.hpp"

namespace attest {
namespace {

using testing::HasSubstr;
using testing::Not;

// Two ticks, 4 ms apart. The vehicle turns from level to a roll of 90 deg, with three rotors.
Trace two_ticks() {
  Trace trace;
  trace.present = channels_of(Module::mc_att_control);
  trace.samples.resize(2);
  trace.plant.resize(2);
  trace.samples[1].in.timestamp = 4000;
  trace.samples[1].out.mc_att_ctrl_status.roll_rate_integ = 0.25f;
  const float half = std::sqrt(0.5f);
  trace.plant[0].q = {1, 0, 0, 0};
  trace.plant[1].q = {half, half, 0, 0};
  for (PlantSample& sample : trace.plant) sample.rotor_rad_s = {500, 500, 500};
  return trace;
}

nlohmann::json plot(const std::string& title) {
  const auto flight = nlohmann::json::parse(flight_plots_json(two_ticks()));
  for (const auto& one : flight.at("plots")) {
    if (one.at("title") == title) return one;
  }
  return {};
}

TEST(FlightPlots, TheAttitudeIsInDegrees) {
  const auto attitude = plot("Attitude");
  ASSERT_EQ(attitude.at("series").size(), 6u);
  EXPECT_EQ(attitude.at("unit"), "deg");
  EXPECT_EQ(attitude.at("series")[0].at("name"), "roll");
  const float right_angle =
      180 / std::numbers::pi_v<float> * std::atan2(1.0f, 1 - 2 * std::sqrt(0.5f) * std::sqrt(0.5f));
  EXPECT_NEAR(right_angle, 90, 1e-4);
  EXPECT_EQ(attitude.at("series")[0].at("values"), base64(std::vector<float>{0, right_angle}));
  EXPECT_EQ(attitude.at("series")[2].at("values"), base64(std::vector<float>{0, 0}));
}

TEST(FlightPlots, SignalsHaveTheNamesOfTheTrace) {
  const auto integrals = plot("Integrals");
  EXPECT_EQ(integrals.at("series")[0].at("name"), "out/mc_att_ctrl_status.roll_rate_integ");
  EXPECT_EQ(integrals.at("series")[0].at("values"), base64(std::vector<float>{0, 0.25f}));
  EXPECT_EQ(integrals.at("time"), base64(std::vector<float>{0, 0.004f}));
}

TEST(FlightPlots, OnlyMotorsOfTheVehicleArePlotted) {
  EXPECT_EQ(plot("Motor commands").at("series").size(), 3u);
}

TEST(FlightPlots, TheReplayHasTheQuaternions) {
  const auto replay = nlohmann::json::parse(flight_plots_json(two_ticks())).at("replay");
  EXPECT_EQ(replay.at("attitude").size(), 4u);
  EXPECT_EQ(replay.at("attitude")[1], base64(std::vector<float>{0, std::sqrt(0.5f)}));
}

TEST(FlightPage, HasTheVerdictAndTheMetrics) {
  SimulatedFlight flight{passed("flight", "hover", Rate::hz(250)), two_ticks()};
  flight.result.verdict = Verdict::fail;
  flight.result.metrics = {{"levels", Measure::settling_time_s, 3.5, 3.5, 0, 0, 2}};
  PortSays port;
  port.name = "<b>acme</b>";
  const std::string page = flight_page(flight, port);
  EXPECT_THAT(page, HasSubstr("</span> fail</p>"));
  EXPECT_THAT(page, HasSubstr("&lt;b&gt;acme&lt;/b&gt;"));
  EXPECT_THAT(page, Not(HasSubstr("<b>acme")));
  EXPECT_THAT(page, HasSubstr("levels<br><small>settling_time_s</small></th><td>3.5</td>"
                              "<td>0 to 2<br><b class=\"is-fail\">\u2717 missed</b>"));
}

TEST(FlightPage, WithoutATickHasNoPlots) {
  const SimulatedFlight crashed{passed("flight", "hover", Rate::hz(250)), {}};
  EXPECT_THAT(flight_page(crashed, {}), HasSubstr("id=\"flight\"></script>"));
}

}  // namespace
}  // namespace attest
