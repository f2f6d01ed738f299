// Flights of the cascade in case files.
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/casefile/parse.hpp"
#include "harness/casefile/select.hpp"
#include "harness/core/file.hpp"
#include "tests/harness/core/temporary_directory.hpp"

namespace attest {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

namespace fs = std::filesystem;

const LoopRate usual(Rate::hz(250), Rate::hz(1000));

class ParseCascade : public testing::Test {
 protected:
  ParseCascade() {
    fs::create_directories(folder());
    fs::create_directories(directory_.path() / "models");
    for (const char* name : {"bee", "iris"}) {
      EXPECT_TRUE(
          write_file(directory_.path() / "models" / (std::string(name) + ".toml"), "x = 1\n"));
    }
  }
  fs::path folder() const { return directory_.path() / "cases/px4-v1.16.0/flight"; }

  // Six lines, then `body`.
  Result<Case> parse(const std::string& body) const {
    const fs::path file = folder() / "the_case.toml";
    const std::string text =
        "schema = 1\nprofiles = [\"px4-v1.16.0\", \"px4-v1.14.4\"]\ngroup = \"flight\"\n"
        "why = \"x\"\nduration_s = 1\n" +
        body + "\n[flight.metrics.sinks]\nmeasure = \"sink_m\"\nmax = 1\n";
    if (auto written = write_file(file, text); !written) return tl::unexpected(written.error());
    return parse_case(file);
  }
  Case case_of(const std::string& body) const {
    auto parsed = parse(body);
    if (!parsed) throw std::invalid_argument(parsed.error().to_string());
    return *std::move(parsed);
  }
  std::string error_of(const std::string& body) const {
    const auto parsed = parse(body);
    return parsed ? "" : parsed.error().to_string();
  }

 private:
  TemporaryDirectory directory_;
};

std::vector<std::string> labels_of(const Case& the_case) {
  std::vector<std::string> labels;
  for (const auto& configuration : the_case.configurations()) {
    labels.push_back(configuration.label());
  }
  return labels;
}

std::vector<std::string> topics_of(const std::vector<TopicStimulus>& stimuli) {
  std::vector<std::string> topics;
  for (const TopicStimulus& stimulus : stimuli) topics.push_back(stimulus.topic);
  return topics;
}

TEST_F(ParseCascade, FliesAtPairsOfRates) {
  const auto labels = labels_of(case_of("[flight]\n"));
  EXPECT_EQ(labels.size(), 2u * (6 + 1));
  EXPECT_EQ(labels.front(), "250-1000hz-bee-mujoco");
  EXPECT_EQ(labels[2], "50-250hz-iris-mujoco");
  EXPECT_EQ(labels.back(), "250-8000hz-iris-ode");
}

TEST_F(ParseCascade, TheOtherProfilesFlyAtTheSlowestAndTheFastestPair) {
  const auto labels = labels_of(case_of("[flight]\n").in_profile("px4-v1.14.4"));
  EXPECT_EQ(labels.size(), 2u * (2 + 1));
  EXPECT_THAT(labels, Contains("50-250hz-iris-ode"));
  EXPECT_THAT(labels, Contains("250-8000hz-iris-ode"));
}

TEST_F(ParseCascade, PairsAreTexts) {
  const Case parsed = case_of(
      "rates_hz = [\"250:1000\", \"125/2:333\"]\nrates_why = \"x\"\n[flight]\n"
      "other_rates_hz = [\"100:500\"]\n");
  EXPECT_THAT(parsed.rates, ElementsAre(LoopRate(Rate::hz(125, 2), Rate::hz(333)), usual));
  EXPECT_THAT(parsed.flight->other_rates, ElementsAre(LoopRate(Rate::hz(100), Rate::hz(500))));
  const auto with_rates = [&](const std::string& rates) {
    return error_of("rates_hz = " + rates + "\nrates_why = \"x\"\n[flight]\n");
  };
  EXPECT_THAT(with_rates("[\"1000\"]"), HasSubstr("6:1: `1000` is one rate"));
  EXPECT_THAT(with_rates("[\"1000\"]"), HasSubstr("as in \"250:1000\""));
  EXPECT_THAT(with_rates("[\"1000:250\"]"), HasSubstr("slower than the attitude unit"));
  EXPECT_THAT(with_rates("[250]"), HasSubstr("must be text, found an integer"));
  EXPECT_THAT(with_rates("[\"250:1000\", \"250:1000\"]"), HasSubstr("names a rate twice"));
}

TEST_F(ParseCascade, ATopicIsForEachUnitThatHasIt) {
  const Case parsed = case_of(
      "[vehicle_control_mode]\nflight_mode = \"ACRO\"\n[battery_status]\nscale = 1.1\n[flight]\n");
  EXPECT_EQ(parsed.module, Module::rate_unit);
  EXPECT_THAT(topics_of(parsed.topics), Contains("vehicle_control_mode"));
  EXPECT_THAT(topics_of(parsed.topics), Contains("battery_status"));
  const Case attitude = parsed.of_module(Module::attitude_unit);
  EXPECT_EQ(attitude.module, Module::attitude_unit);
  EXPECT_THAT(topics_of(attitude.topics), Contains("vehicle_control_mode"));
  EXPECT_THAT(topics_of(attitude.topics), Not(Contains("battery_status")));
}

TEST_F(ParseCascade, WhatTheFlightComputesIsNotScripted) {
  const Case parsed = case_of("[flight]\n");
  for (const char* topic :
       {"vehicle_angular_velocity", "control_allocator_status", "vehicle_rates_setpoint"}) {
    EXPECT_THAT(topics_of(parsed.topics), Not(Contains(topic)));
  }
  EXPECT_THAT(topics_of(parsed.attitude_loop->topics), Not(Contains("vehicle_attitude")));
  EXPECT_THAT(error_of("[control_allocator_status]\ntorque_setpoint_achieved = 0\n[flight]\n"),
              HasSubstr("6:2: comes from the plant in a flight"));
  EXPECT_THAT(topics_of(case_of("[vehicle_rates_setpoint]\nroll = 1\n[flight]\n").topics),
              Contains("vehicle_rates_setpoint"));
}

TEST_F(ParseCascade, OnAFloorThePlantDetectsTheLanding) {
  const std::string floor = "[flight]\nplants = [\"mujoco\"]\nplants_why = \"x\"\nfloor = true\n";
  const Case parsed = case_of(floor);
  EXPECT_THAT(topics_of(parsed.topics), Not(Contains("vehicle_land_detected")));
  EXPECT_THAT(topics_of(parsed.attitude_loop->topics), Not(Contains("vehicle_land_detected")));
  EXPECT_THAT(error_of("[vehicle_land_detected]\nlanded = 1\n" + floor),
              HasSubstr("comes from the plant in a flight with a floor"));
}

TEST_F(ParseCascade, EachUnitHasItsTicks) {
  const Case parsed = case_of(
      "[unit]\nstart_s = 7\njitter = 0.2\n[attitude_unit]\ndrop_ticks = [3]\n[flight]\n"
      "rates_setpoint_delay_s = 0.002\n[flight.allocator_status]\nrate_hz = 100\n"
      "[flight.estimator]\nreset = { at_s = 0.5, yaw_deg = 180 }\n");
  EXPECT_EQ(parsed.unit.jitter, 0.2);
  const Case attitude = parsed.of_module(Module::attitude_unit);
  EXPECT_EQ(attitude.unit.jitter, 0);
  EXPECT_THAT(attitude.unit.drop_ticks, ElementsAre(3));
  EXPECT_EQ(attitude.unit.start.amount, 7);
  EXPECT_EQ(parsed.attitude_loop->delay.amount, 0.002);
  EXPECT_EQ(parsed.flight->saturation.rate, Rate::hz(100));
  ASSERT_TRUE(parsed.flight->estimator.reset);
  EXPECT_EQ(parsed.flight->estimator.reset->at.amount, 0.5);
  EXPECT_NEAR(parsed.flight->estimator.reset->turn.z, 1, 1e-12);
  EXPECT_THAT(error_of("[attitude_unit]\nstart_s = 1\n[flight]\n"), HasSubstr("is that of [unit]"));
  EXPECT_THAT(error_of("[unit]\ntrigger = \"estimator\"\n[flight]\n"),
              HasSubstr("is for the controller"));
  EXPECT_THAT(error_of("module = \"rate_unit\"\n[flight]\n"), HasSubstr("leave it out"));
}

TEST_F(ParseCascade, ParametersAreThoseOfEitherUnit) {
  const Case parsed = case_of("[parameters]\nMC_ROLL_P = 5\nMC_ROLLRATE_P = 0.1\n[flight]\n");
  ASSERT_EQ(parsed.of_module(Module::rate_unit).parameters.size(), 1u);
  EXPECT_EQ(parsed.of_module(Module::rate_unit).parameters[0].name, "MC_ROLLRATE_P");
  EXPECT_EQ(parsed.of_module(Module::attitude_unit).parameters[0].name, "MC_ROLL_P");
  EXPECT_THAT(error_of("[parameters]\nMC_TPA_BREAK_P = 5\n[flight]\n"),
              HasSubstr("unknown parameter"));
}

TEST_F(ParseCascade, ARateSelectsItsPairsToo) {
  ASSERT_TRUE(parse("[flight]\n"));
  Selection selection;
  const auto count = [&] {
    const auto found = select_cases({folder().parent_path().parent_path()}, selection);
    std::size_t vectors = 0;
    if (found) {
      for (const auto& one : *found) vectors += one.configurations.size();
    }
    return vectors;
  };
  selection.profiles = {"px4-v1.16.0"};
  selection.vehicles = {"iris"};
  selection.rates = {Rate::hz(400)};
  EXPECT_EQ(count(), 2u * 2);
  selection.rates = {LoopRate(Rate::hz(100), Rate::hz(400))};
  EXPECT_EQ(count(), 2u);
  selection.rates = {LoopRate(Rate::hz(50), Rate::hz(400))};
  EXPECT_EQ(count(), 0u);
}

}  // namespace
}  // namespace attest
