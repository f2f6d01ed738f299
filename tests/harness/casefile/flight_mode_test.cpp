#include "harness/casefile/flight_mode.hpp"

#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/casefile/stimulus.hpp"
#include "tests/harness/casefile/case_files.hpp"

namespace attest {
namespace {

using testing::ElementsAre;

std::array<int, 6> flags_at(const Trace& trace, std::size_t tick) {
  const auto& mode = trace.samples[tick].in.vehicle_control_mode;
  return {mode.flag_control_manual_enabled,    mode.flag_control_auto_enabled,
          mode.flag_control_rates_enabled,     mode.flag_control_attitude_enabled,
          mode.flag_control_rattitude_enabled, mode.flag_control_velocity_enabled};
}

Trace with_mode(const std::string& lines) {
  return stimulate(case_of("[vehicle_control_mode]\n" + lines), Rate::hz(250));
}

TEST(FlightMode, IsFoundByItsName) {
  std::set<std::string_view> names;
  for (const FlightMode& mode : flight_modes(Module::mc_att_control)) {
    EXPECT_EQ(find_flight_mode(Module::mc_att_control, mode.name), &mode);
    names.insert(mode.name);
  }
  EXPECT_EQ(names.size(), flight_modes(Module::mc_att_control).size());
  EXPECT_EQ(find_flight_mode(Module::mc_att_control, "acro"), nullptr);
}

TEST(FlightMode, SetsTheFlags) {
  for (const FlightMode& mode : flight_modes(Module::mc_att_control)) {
    const Trace trace = with_mode("flight_mode = \"" + std::string(mode.name) + "\"\n");
    const auto flags = flags_at(trace, 0);
    EXPECT_TRUE(std::equal(flags.begin(), flags.end(), mode.flags.begin())) << mode.name;
  }
}

TEST(FlightMode, AFlagInTheSameTableReplacesThatOfTheMode) {
  const Trace trace =
      with_mode("flight_mode = \"AUTO_MISSION\"\nflag_control_velocity_enabled = false\n");
  EXPECT_THAT(flags_at(trace, 0), ElementsAre(0, 1, 1, 1, 0, 0));
}

TEST(FlightMode, ChangesAtItsTimes) {
  const Trace trace = with_mode(
      "flight_mode = { times_ticks = [0, 4], modes = [\"STABILIZED\", \"OFFBOARD_RATES\"] }\n");
  EXPECT_THAT(flags_at(trace, 3), ElementsAre(1, 0, 1, 1, 1, 0));
  EXPECT_THAT(flags_at(trace, 4), ElementsAre(0, 0, 1, 0, 0, 0));
}

TEST(FlightMode, AVtolInTransitionDoesNotControlTheVelocityInAutoModes) {
  for (const FlightMode& mode : flight_modes(Module::mc_att_control)) {
    const std::string named = "flight_mode = \"" + std::string(mode.name) + "\"\n";
    const auto flags = flags_at(with_mode(named + "in_transition = 1\n"), 0);
    auto expected = mode.flags;
    if (mode.name.starts_with("AUTO_")) expected[5] = 0;
    EXPECT_TRUE(std::equal(flags.begin(), flags.end(), expected.begin())) << mode.name;
  }
}

TEST(FlightMode, ModeAndTransitionChangeEachAtItsOwnTimes) {
  const Trace trace = with_mode(
      "flight_mode = { times_ticks = [0, 4, 8], modes = [\"AUTO_RTGS\", \"POSCTL\", "
      "\"AUTO_FOLLOW_TARGET\"] }\n"
      "in_transition = { signal = \"samples\", times_s = [0, 0.008, 0.036], values = [0, 1, 0] "
      "}\n");
  std::vector<int> velocity;
  for (std::size_t tick = 0; tick < 10; ++tick) velocity.push_back(flags_at(trace, tick)[5]);
  EXPECT_THAT(velocity, ElementsAre(1, 1, 0, 0, 1, 1, 1, 1, 0, 1));
}

TEST(FlightMode, AFlagReplacesThatOfATransitionToo) {
  const Trace trace = with_mode(
      "flight_mode = \"AUTO_LANDENGFAIL\"\nin_transition = true\n"
      "flag_control_velocity_enabled = 1\n");
  EXPECT_THAT(flags_at(trace, 0), ElementsAre(0, 1, 1, 1, 0, 1));
}

TEST(FlightMode, ATransitionIsAFlagAndNeedsAMode) {
  const auto errors = [](const std::string& lines) {
    return errors_of("[vehicle_control_mode]\n" + lines);
  };
  EXPECT_EQ(errors("in_transition = 1\n"), "7:1: needs a `flight_mode` in the same table");
  EXPECT_THAT(errors("flight_mode = \"AUTO_RTL\"\nin_transition = 0.5\n"),
              testing::HasSubstr("8:1: is a flag"));
}

}  // namespace
}  // namespace attest
