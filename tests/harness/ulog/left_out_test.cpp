// Samples that are left out, lost messages and damage: what they mean for the steps of a log.
#include "harness/ulog/left_out.hpp"

#include <fstream>

#include <gmock/gmock.h>

#include "tests/harness/ulog/flight_log_file.hpp"

namespace attest {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;
using ulog::raw;

TEST_F(FlightLogFile, SamplesWithoutTimestampAreCounted) {
  ulog::Crafted log;
  log.flag_bits().format(state).format(setpoint).format(rates).format(
      "battery_status:float scale;");
  log.subscribe(0, "control_state").subscribe(1, "vehicle_attitude_setpoint");
  log.subscribe(2, "vehicle_rates_setpoint").subscribe(3, "battery_status");
  const std::uint64_t time = 1000;
  log.data(0, raw(time) + std::string(28, '\0')).data(1, raw(time) + std::string(24, '\0'));
  log.data(2, raw(time) + std::string(16, '\0')).data(3, raw(1.0f)).data(3, raw(0.5f));
  const auto read = read_flight_log(write(log));
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_THAT(read->notes,
              Contains("2 samples of battery_status left out, because the topic has no timestamp"));
  EXPECT_FALSE(read->units[0].has_every_step);
}

TEST_F(FlightLogFile, TimestampsThatDoNotIncreaseAreLeftOutAndCounted) {
  start();
  add_state(1000);
  add_state(900);
  add_state(5000);
  const FlightLog log = read();
  EXPECT_EQ(log.units[0].trace.samples.size(), 2u);
  EXPECT_THAT(log.notes, Contains(HasSubstr("2 samples of control_state left out")));
  EXPECT_FALSE(log.units[0].has_every_step);
}

TEST_F(FlightLogFile, AnAbsurdTimeRemovesOneSampleOfItsTopic) {
  define({state, setpoint, rates});
  add_setpoint(1000, 0.75f);  // an event, long before the log
  for (std::uint64_t tick = 0; tick < 60; ++tick) {
    const std::uint64_t time = 100'000'000 + 4000 * tick;
    const std::uint64_t early = tick == 0 ? time - 5'000'000 : 0;
    const std::uint64_t late = tick == 20 || tick == 40 ? std::uint64_t{1} << (10 + tick) : 0;
    add_state(time - early + late, static_cast<float>(tick));
    add_rates(time + 50 + (tick == 30 ? std::uint64_t{1} << 63 : 0), static_cast<float>(tick));
  }
  const FlightLog log = read();
  const LoggedUnit& unit = log.units[0];
  ASSERT_EQ(unit.trace.samples.size(), 57u);
  EXPECT_EQ(unit.trace.samples[0].in.control_state.roll_rate, 1);
  EXPECT_EQ(unit.trace.samples[0].in.vehicle_attitude_setpoint.thrust, 0.75f);
  EXPECT_EQ(unit.trace.samples[19].in.control_state.roll_rate, 21);
  EXPECT_EQ(unit.outputs[0].paired, 56u);
  EXPECT_FALSE(unit.has_every_step);
  EXPECT_THAT(log.notes, Contains("4 samples of 2 topics left out, because the time does not fit "
                                  "the samples around it: 3 of control_state, 1 of "
                                  "vehicle_rates_setpoint"));
}

TEST_F(FlightLogFile, AJumpOfTheClockIsOneNote) {
  start();
  add_setpoint(900);
  add_state(900);
  add_rates(900, 1);
  EXPECT_THAT(read().notes,
              Contains("3 samples of 3 topics left out, because the timestamps do not "
                       "increase: 1 of control_state, 1 of vehicle_attitude_setpoint, "
                       "1 of vehicle_rates_setpoint"));
}

TEST_F(FlightLogFile, WithoutMostOfItsStepsAUnitIsNotReplayed) {
  start();
  for (std::uint64_t tick = 0; tick < 3; ++tick) add_state(900 + tick);
  EXPECT_THAT(error(), HasSubstr("3 of 4 samples of the topic control_state have no usable time"));
}

TEST_F(FlightLogFile, LostMessagesMeanMissingSteps) {
  start();
  ASSERT_TRUE(writer_.dropout(20));
  add_state(5000);
  const FlightLog log = read();
  EXPECT_FALSE(log.units[0].has_every_step);
  EXPECT_THAT(log.notes, Contains(HasSubstr("lost messages")));
}

TEST_F(FlightLogFile, ABadInfoMessageMeansNoMissingStep) {
  start();
  add_state(5000);
  read();
  std::ofstream(path(), std::ios::binary | std::ios::app)
      << ulog::Crafted().value('I', "char[3] x", "ab").bytes().substr(16);
  const FlightLog log = read();
  EXPECT_THAT(log.notes, Contains(HasSubstr("damaged: byte ")));
  EXPECT_TRUE(log.units[0].has_every_step);
}

TEST_F(FlightLogFile, ADamagedLogIsReplayedUpToThere) {
  start();
  add_state(5000);
  const FlightLog whole = read();
  EXPECT_THAT(whole.notes, Not(Contains(HasSubstr("damaged"))));
  std::filesystem::resize_file(path(), std::filesystem::file_size(path()) - 3);
  const FlightLog log = read();
  EXPECT_EQ(log.units[0].trace.samples.size(), 1u);
  EXPECT_THAT(log.notes, Contains(HasSubstr("damaged: byte ")));
  EXPECT_FALSE(log.units[0].has_every_step);
}

}  // namespace
}  // namespace attest
