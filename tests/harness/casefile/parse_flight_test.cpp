#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/harness/casefile/case_files.hpp"

namespace attest {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* metrics =
    "[flight.metrics.settles]\nmeasure = \"settling_time_s\"\nmax = 1\n";

// A suite with two vehicles; what is in their files does not matter here.
class ParseFlight : public testing::Test {
 protected:
  ParseFlight() {
    for (const char* name : {"bee", "iris"}) files_.name_vehicle(name);
  }

  Case case_of(const std::string& body) {
    auto parsed = files_.parse(CaseFiles::with(body));
    if (!parsed) throw std::invalid_argument(parsed.error().to_string());
    return *parsed;
  }
  Flight flight_of(const std::string& lines) {
    return *case_of("[flight]\n" + lines + metrics).flight;
  }
  std::string error_of(const std::string& body) {
    const auto parsed = files_.parse(CaseFiles::with(body));
    return parsed ? "" : parsed.error().to_string();
  }
  std::string flight_error(const std::string& lines) {
    return error_of("[flight]\n" + lines + metrics);
  }

  CaseFiles files_;
};

TEST_F(ParseFlight, EveryVehicleFliesOnEveryPlantTheLeadAtAllRates) {
  const Case parsed = case_of(std::string("[flight]\n") + metrics);
  std::vector<std::string> labels;
  for (const auto& configuration : parsed.configurations()) labels.push_back(configuration.label());
  ASSERT_EQ(labels.size(), 2 * (11 + 3));
  EXPECT_EQ(labels.front(), "100hz-bee-mujoco");
  EXPECT_EQ(labels[3], "100hz-bee-ode");
  EXPECT_EQ(labels[6], "50hz-iris-mujoco");
  EXPECT_EQ(labels.back(), "8000hz-iris-ode");
}

TEST_F(ParseFlight, AChoiceOfVehiclesOrPlantsSaysWhy) {
  const Flight flight = flight_of(
      "vehicles = [\"bee\"]\nvehicles_why = \"small\"\nplants = [\"ode\"]\nplants_why = \"exact\"\n"
      "other_rates_hz = [250, 100]\n");
  EXPECT_THAT(flight.plant_configurations, ElementsAre(PlantConfiguration{"bee", PlantKind::ode}));
  EXPECT_EQ(flight.lead_vehicle, "bee");
  EXPECT_THAT(flight.other_rates, ElementsAre(Rate::hz(100), Rate::hz(250)));
  EXPECT_THAT(flight_error("vehicles = [\"bee\"]\n"), HasSubstr("vehicles_why"));
  EXPECT_THAT(flight_error("plants = [\"ode\"]\n"), HasSubstr("plants_why"));
}

TEST_F(ParseFlight, AnUnknownVehicleIsNamedWithItsLine) {
  EXPECT_THAT(flight_error("vehicles = [\"irsi\"]\nvehicles_why = \"x\"\n"),
              HasSubstr("the_case.toml:7:1: unknown vehicle `irsi`; did you mean `iris`?; there "
                        "are bee, iris"));
  EXPECT_THAT(flight_error("plants = [\"gazebo\"]\nplants_why = \"x\"\n"),
              HasSubstr("the_case.toml:7:1: "));
}

TEST_F(ParseFlight, PhysicsSlowerThanTheLoopIsRefusedWithItsLine) {
  EXPECT_THAT(
      flight_error("physics_hz = 1000\n"),
      HasSubstr("the_case.toml:7:1: physics at 1000 Hz is slower than the loop at 8000 Hz"));
  const Case parsed =
      case_of("rates_hz = [333]\nrates_why = \"odd\"\n[flight]\nphysics_hz = 1000\n" +
              std::string(metrics));
  EXPECT_EQ(parsed.flight->physics, Rate::hz(1000));
  EXPECT_EQ(parsed.flight->physics_line, 9);
}

TEST_F(ParseFlight, AnImpossibleRateIsNamedWithItsLine) {
  EXPECT_THAT(error_of("rates_hz = [0]\nrates_why = \"x\"\n[flight]\n" + std::string(metrics)),
              HasSubstr("the_case.toml:6:1: "));
  EXPECT_THAT(flight_error("other_rates_hz = [-5]\n"), HasSubstr("the_case.toml:7:1: "));
  EXPECT_THAT(flight_error("[flight.motor_limits]\nrate_hz = 1e9\n"),
              HasSubstr("the_case.toml:8:1: "));
}

TEST_F(ParseFlight, TasksHaveTheirTiming) {
  const Flight flight = flight_of(
      "actuator_delay_ticks = 2\n[flight.motor_limits]\nrate_hz = 25\nphase_s = 0.01\njitter = "
      "0.5\n"
      "seed = 7\ndelay_s = 0.02\ndrop_ticks = [3]\n[flight.estimator]\ndelay_s = 0.004\ndrift = "
      "0.01\n"
      "rate_noise_rad_s = 0.1\nattitude_noise_deg = 0.2\nseed = 9\n");
  EXPECT_EQ(flight.saturation.rate, Rate::hz(25));
  EXPECT_EQ(flight.saturation.phase.amount, 0.01);
  EXPECT_EQ(flight.saturation.jitter, 0.5);
  EXPECT_EQ(flight.saturation.seed, 7u);
  EXPECT_EQ(flight.saturation.delay.amount, 0.02);
  EXPECT_THAT(flight.saturation.drop_ticks, ElementsAre(3));
  EXPECT_EQ(flight.actuator_delay.amount, 2);
  EXPECT_EQ(flight.estimator.delay.amount, 0.004);
  EXPECT_EQ(flight.estimator.rate_noise_rad_s, 0.1);
  EXPECT_EQ(flight.estimator.attitude_noise_deg, 0.2);
  EXPECT_EQ(flight.estimator.seed, 9u);
  EXPECT_EQ(flight.estimator.drift, 0.01);
}

TEST_F(ParseFlight, MetricsAreBounded) {
  const Case parsed = case_of(
      "[flight.metrics.slower]\nmeasure = \"rms_attitude_error_deg\"\nfrom_s = 1\nto_s = 2\n"
      "versus = { from_s = 0, to_s = 1 }\nmin = 1.2\nband_deg = 3\n");
  const Metric& metric = parsed.flight->metrics.at(0);
  EXPECT_EQ(metric.name, "slower");
  EXPECT_EQ(metric.measure, Measure::rms_attitude_error_deg);
  EXPECT_EQ(metric.window.from_s, 1);
  EXPECT_EQ(metric.versus->to_s, 1);
  EXPECT_EQ(metric.min, 1.2);
  EXPECT_EQ(metric.band_deg, 3);
  EXPECT_THAT(error_of("[flight]\n"), HasSubstr("metrics"));
  EXPECT_THAT(error_of("[flight.metrics.a]\nmeasure = \"sink_m\"\n"),
              HasSubstr("needs `min` or `max`"));
  EXPECT_THAT(error_of("[flight.metrics.a]\nmeasure = \"speed\"\nmax = 1\n"),
              HasSubstr("the_case.toml:7:1: "));
}

TEST_F(ParseFlight, WhatThePlantMakesIsNotScripted) {
  EXPECT_THAT(flight_error("[control_state]\nroll_rate = 1\n"),
              HasSubstr("the_case.toml:7:2: comes from the plant in a flight"));
  EXPECT_THAT(flight_error("[multirotor_motor_limits]\nyaw = 1\n"),
              HasSubstr("comes from the plant in a flight"));
  EXPECT_THAT(flight_error("[battery_status]\nscale = 1\n[flight.battery]\n"),
              HasSubstr("comes from [flight.battery]"));
  EXPECT_EQ(flight_error("[battery_status]\nscale = 1\n"), "");
}

TEST_F(ParseFlight, ThrustIsInHoversOrAsItIs) {
  const auto thrust_of = [&](const std::string& line) {
    const Case parsed = case_of("[vehicle_attitude_setpoint]\n" + line + "[flight]\n" + metrics);
    for (const TopicStimulus& topic : parsed.topics) {
      if (topic.topic != "vehicle_attitude_setpoint") continue;
      for (const FieldStimulus& field : topic.fields) {
        if (channels()[field.channel].name.ends_with(".thrust")) return field;
      }
    }
    throw std::logic_error("no thrust");
  };
  EXPECT_TRUE(thrust_of("").of_hover);
  EXPECT_EQ(std::get<Constant>(thrust_of("").signal).value, 1);
  EXPECT_TRUE(thrust_of("thrust_of_hover = 1.2\n").of_hover);
  EXPECT_EQ(std::get<Constant>(thrust_of("thrust_of_hover = 1.2\n").signal).value, 1.2);
  EXPECT_FALSE(thrust_of("thrust = 0.3\n").of_hover);
  EXPECT_THAT(error_of("[vehicle_attitude_setpoint]\nthrust_of_hover = 1\n"),
              HasSubstr("unknown key `thrust_of_hover`"));
}

TEST_F(ParseFlight, AStartHasTheAnglesOfAttitudes) {
  const Quaternion tilted =
      flight_of("start = { tilt_deg = 180, azimuth_deg = 90 }\n").start.attitude;
  EXPECT_NEAR(tilted.y, 1, 1e-12);
  const Quaternion rolled = flight_of("start = { roll_deg = 180, yaw_deg = 180 }\n").start.attitude;
  EXPECT_NEAR(rolled.y, 1, 1e-12);
  EXPECT_THAT(flight_error("start = { roll_deg = 1, tilt_deg = 2 }\n"),
              HasSubstr("`roll_deg` is given too"));
}

TEST_F(ParseFlight, TheEstimatorMayTriggerTheUnit) {
  const std::string trigger = "[unit]\ntrigger = \"estimator\"\n";
  EXPECT_TRUE(case_of(trigger + "[flight]\n" + metrics).unit.on_estimate);
  EXPECT_FALSE(case_of(std::string("[flight]\n") + metrics).unit.on_estimate);
  EXPECT_THAT(error_of(trigger), HasSubstr("7:1: needs a [flight], which has an estimator"));
  EXPECT_THAT(error_of(std::string("[unit]\ntrigger = \"gps\"\n[flight]\n") + metrics),
              HasSubstr("7:1: must be \"estimator\""));
}

TEST_F(ParseFlight, GroundContactNeedsMujoco) {
  EXPECT_THAT(flight_error("floor = true\n"), HasSubstr("needs `plants = [\"mujoco\"]`"));
  EXPECT_EQ(flight_error("floor = true\nplants = [\"mujoco\"]\nplants_why = \"contact\"\n"), "");
}

TEST_F(ParseFlight, AFlightNeedsVehicles) {
  std::filesystem::remove_all(files_.folder().parent_path() / "models");
  EXPECT_THAT(flight_error(""), HasSubstr("needs vehicles, and there are none in "));
}

// From 500 Hz on all rates give the law the same time step.
TEST_F(ParseFlight, AFurtherProfileFliesAtEachDistinctTimeStep) {
  Case parsed = case_of(std::string("[flight]\nvehicles = [\"iris\"]\nvehicles_why = \"one\"\n"
                                    "plants = [\"ode\"]\nplants_why = \"one\"\n") +
                        metrics);
  parsed.profiles = {"px4-v1.5.5", "px4-v1.3.4"};
  std::vector<std::string> labels;
  for (const auto& configuration : parsed.in_profile("px4-v1.3.4").configurations()) {
    labels.push_back(configuration.rate.label());
  }
  EXPECT_THAT(labels, testing::IsSupersetOf({"50hz", "333hz", "500hz", "8000hz"}));
  EXPECT_THAT(labels, testing::Not(testing::Contains("1000hz")));
}

}  // namespace
}  // namespace attest
