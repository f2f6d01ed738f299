// Which control_state an output answers, and what the controller was given at each step.
#include "harness/ulog/flight_log.hpp"

#include <gmock/gmock.h>

#include "tests/harness/ulog/flight_log_file.hpp"

namespace attest {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using ulog::raw;

std::vector<float> rolls(const FlightLog& log) {
  std::vector<float> found;
  for (const Sample& sample : log.units[0].trace.samples) {
    if (sample.out.vehicle_rates_setpoint.published == 0) continue;
    found.push_back(sample.out.vehicle_rates_setpoint.roll);
  }
  return found;
}

TEST_F(FlightLogFile, AStepIsAControlStateWithItsOutputs) {
  start();
  add_state(5000, 0.125f);
  add_rates(5060, 0.75f);
  add_controls(5090, 5000, 0.875f);
  const FlightLog log = read();
  ASSERT_EQ(log.units[0].trace.samples.size(), 2u);
  EXPECT_EQ(log.units[0].trace.samples[1].in.timestamp, 5000u);
  EXPECT_EQ(log.units[0].trace.samples[1].in.control_state.roll_rate, 0.125f);
  EXPECT_EQ(log.units[0].trace.samples[1].out.actuator_controls_0.control[0], 0.875f);
  EXPECT_THAT(rolls(log), ElementsAre(0.25f, 0.75f));
  EXPECT_TRUE(log.units[0].has_every_step);
}

TEST_F(FlightLogFile, AnOutputThatTheTopicLacksIsNotCompared) {
  define({state, setpoint, "vehicle_rates_setpoint:uint64_t timestamp;float roll;float thrust;",
          "actuator_controls_0:uint64_t timestamp;uint64_t timestamp_sample;"});
  add_setpoint(1000);
  add_state(1000);
  add("vehicle_rates_setpoint", 1050, 0.25f, 0.5f);
  add("actuator_controls_0", 1080, std::uint64_t{1000});
  const FlightLog log = read();
  const ChannelSet outputs =
      channels_of(Module::mc_att_control, "out/") & log.units[0].trace.present;
  EXPECT_EQ(outputs.count(), 3u);
  EXPECT_TRUE(outputs[*find_channel(Module::mc_att_control, "out/vehicle_rates_setpoint.roll")]);
  EXPECT_FALSE(outputs[*find_channel(Module::mc_att_control, "out/vehicle_rates_setpoint.yaw")]);
  ASSERT_EQ(log.units[0].outputs.size(), 1u);
  EXPECT_EQ(log.units[0].outputs[0].topic, "vehicle_rates_setpoint");
  EXPECT_THAT(log.notes, Contains("not in the log, so not compared: vehicle_rates_setpoint.pitch, "
                                  "vehicle_rates_setpoint.yaw"));
}

TEST_F(FlightLogFile, ALogWithoutAnyFieldOfAnOutputIsAnError) {
  define({state, setpoint, "vehicle_rates_setpoint:uint64_t timestamp;"});
  add_setpoint(1000);
  add_state(1000);
  add("vehicle_rates_setpoint", 1050);
  EXPECT_THAT(error(), HasSubstr("there is nothing to compare a port with"));
}

TEST_F(FlightLogFile, ASecondOutputBeforeTheNextStateAnswersASampleThatIsNotLogged) {
  start();
  add_rates(3050, 0.375f);
  add_state(5000);
  add_rates(5060, 0.75f);
  add_controls(5090, 5000, 0);
  const FlightLog log = read();
  EXPECT_THAT(rolls(log), ElementsAre(0.25f, 0.75f));
  EXPECT_EQ(log.units[0].outputs[0].samples, 3u);
  EXPECT_EQ(log.units[0].outputs[0].paired, 2u);
  EXPECT_FALSE(log.units[0].has_every_step);
}

TEST_F(FlightLogFile, ControlsAnswerTheStateOfTheirSampleTime) {
  start();
  add_state(5000);
  add_controls(5010, 3000, 0.125f);  // the answer to a state that is not in the log
  const FlightLog log = read();
  EXPECT_EQ(log.units[0].trace.samples[1].out.actuator_controls_0.published, 0);
  EXPECT_EQ(log.units[0].trace.samples[1].out.actuator_controls_0.control[0], 0.5f);  // held
  EXPECT_FALSE(log.units[0].has_every_step);
}

TEST_F(FlightLogFile, AnOutputBeforeTheFirstStateHasNoStep) {
  define({state, setpoint, rates, controls});
  add_rates(500, 9);
  add_setpoint(900);
  add_state(1000);
  add_rates(1050, 0.25f);
  EXPECT_THAT(rolls(read()), ElementsAre(0.25f));
}

TEST_F(FlightLogFile, AnInputHoldsFromItsTimeOn) {
  start();
  add_state(5000);
  add_setpoint(6000, 0.75f);
  add_state(9000);
  const FlightLog log = read();
  const auto thrust = [&](std::size_t tick) {
    return log.units[0].trace.samples[tick].in.vehicle_attitude_setpoint.thrust;
  };
  const auto is_new = [&](std::size_t tick) {
    return (log.units[0].trace.samples[tick].in.updated &
            ATTEST_UPDATED_VEHICLE_ATTITUDE_SETPOINT) != 0;
  };
  EXPECT_EQ(thrust(1), 0.5f);
  EXPECT_EQ(thrust(2), 0.75f);
  EXPECT_TRUE(is_new(0));
  EXPECT_FALSE(is_new(1));
  EXPECT_TRUE(is_new(2));
}

TEST_F(FlightLogFile, ParametersChangeAtTheNextStep) {
  ASSERT_TRUE(writer_.parameter("MC_ROLL_P", 6.5f));
  start();
  ASSERT_TRUE(writer_.parameter("MC_ROLL_P", 7.5f));
  ASSERT_TRUE(writer_.parameter("CBRK_RATE_CTRL", 140253));
  add_state(5000);
  const FlightLog log = read();
  EXPECT_THAT(
      log.units[0].trace.parameters,
      ElementsAre(ParameterChange{0, "MC_ROLL_P", 6.5f}, ParameterChange{1, "MC_ROLL_P", 7.5f},
                  ParameterChange{1, "CBRK_RATE_CTRL", 140253.0f}));
  EXPECT_EQ(log.units[0].trace.samples[0].in.updated & ATTEST_UPDATED_PARAMETER_UPDATE, 0u);
  EXPECT_NE(log.units[0].trace.samples[1].in.updated & ATTEST_UPDATED_PARAMETER_UPDATE, 0u);
}

TEST_F(FlightLogFile, TopicsThatTheLogDoesNotHaveAreAssumed) {
  start();
  const FlightLog stabilized = read();
  EXPECT_EQ(stabilized.units[0].trace.samples[0].in.actuator_armed.armed, 1);
  EXPECT_EQ(
      stabilized.units[0].trace.samples[0].in.vehicle_control_mode.flag_control_attitude_enabled,
      1);
  EXPECT_THAT(stabilized.notes,
              Contains(HasSubstr("armed, rotary_wing, rates, attitude, manual (--assume)")));
  const FlightLog acro = read({"armed", "rates", "manual"});
  EXPECT_EQ(acro.units[0].trace.samples[0].in.vehicle_control_mode.flag_control_attitude_enabled,
            0);
  EXPECT_EQ(acro.units[0].trace.samples[0].in.vehicle_control_mode.flag_control_manual_enabled, 1);
  EXPECT_THAT(error({"atitude"}), HasSubstr("did you mean `attitude`"));
}

TEST_F(FlightLogFile, WhatTheLogHasIsNotAssumed) {
  start("actuator_armed:uint64_t timestamp;bool armed;");
  add("actuator_armed", 900, false);
  EXPECT_EQ(read().units[0].trace.samples[0].in.actuator_armed.armed, 0);
  EXPECT_THAT(error({"armed"}), HasSubstr("has the topic actuator_armed"));
}

TEST_F(FlightLogFile, NothingIsAssumedInALogOfAttest) {
  ASSERT_TRUE(writer_.info("sys_name", "attest"));
  ASSERT_TRUE(writer_.info("attest_source", "px4-v1.3.4/flight/hover@250hz"));
  start();
  const FlightLog log = read();
  EXPECT_TRUE(log.is_of_attest);
  EXPECT_EQ(log.profile, "px4-v1.3.4");
  EXPECT_EQ(log.units[0].trace.samples[0].in.actuator_armed.armed, 0);
}

TEST_F(FlightLogFile, LogsThatCannotBeReplayedAreExplained) {
  define({rates});
  add_rates(1000, 1);
  EXPECT_THAT(error(), HasSubstr("no sample of the topic control_state"));
}

TEST_F(FlightLogFile, WhatALogLacksForEachUnitIsNamed) {
  define({"vehicle_angular_velocity:uint64_t timestamp;float[3] xyz;"});
  add("vehicle_angular_velocity", 1000, 0.0f, 0.0f, 0.0f);
  EXPECT_THAT(error(), HasSubstr("for the controller of PX4 v1.5.5 and v1.3.4: no sample of the "
                                 "topic control_state; for the attitude unit: no sample of the "
                                 "topic vehicle_attitude; for the rate unit: no sample of the "
                                 "topic vehicle_rates_setpoint"));
}

TEST_F(FlightLogFile, ALogWithoutOutputsHasNothingToCompare) {
  define({state, setpoint, rates, controls});
  add_setpoint(1000);
  add_state(1000);
  EXPECT_THAT(error(), HasSubstr("nothing to compare"));
}

TEST_F(FlightLogFile, ATopicOfAnotherReleaseIsNamedWithItsField) {
  define({"control_state:uint64_t timestamp;float roll_rate;", setpoint, rates});
  add("control_state", 1000, 1.0f);
  add_setpoint(1000);
  add_rates(1010, 1);
  EXPECT_THAT(error(), HasSubstr("a topic control_state without the field q[0]"));
}

}  // namespace
}  // namespace attest
