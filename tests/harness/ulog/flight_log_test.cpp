// Which control_state an output answers, and what the controller was given at each step.
#include "harness/ulog/flight_log.hpp"

#include <fstream>
#include <map>
#include <utility>

#include <gmock/gmock.h>

#include "harness/ulog/writer.hpp"
#include "tests/harness/ulog/log_file.hpp"

namespace attest {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using ulog::raw;

constexpr const char* state =
    "control_state:uint64_t timestamp;float[4] q;float roll_rate;"
    "float pitch_rate;float yaw_rate;";
constexpr const char* setpoint =
    "vehicle_attitude_setpoint:uint64_t timestamp;float[4] q_d;float thrust;"
    "float yaw_sp_move_rate;";
constexpr const char* rates =
    "vehicle_rates_setpoint:uint64_t timestamp;float roll;float pitch;float yaw;float thrust;";
constexpr const char* controls =
    "actuator_controls_0:uint64_t timestamp;uint64_t timestamp_sample;float[8] control;";

// A log with any of these topics.
class FlightLogFile : public ulog::LogFile {
 protected:
  std::filesystem::path path() const { return directory_.path() / "flight.ulg"; }

  void define(const std::vector<std::string>& topics) {
    for (const std::string& topic : topics) ASSERT_TRUE(writer_.define(topic));
    for (const std::string& topic : topics) {
      const std::string name = topic.substr(0, topic.find(':'));
      ids_[name] = *writer_.subscribe(name);
    }
  }
  template <typename... Values>
  void add(const char* topic, std::uint64_t time, Values... values) {
    ASSERT_TRUE(writer_.data(ids_.at(topic), raw(time, values...)));
  }
  void add_state(std::uint64_t time, float roll_rate = 0) {
    add("control_state", time, 1.0f, 0.0f, 0.0f, 0.0f, roll_rate, 0.0f, 0.0f);
  }
  void add_setpoint(std::uint64_t time, float thrust = 0.5f) {
    add("vehicle_attitude_setpoint", time, 1.0f, 0.0f, 0.0f, 0.0f, thrust, 0.0f);
  }
  void add_rates(std::uint64_t time, float roll) {
    add("vehicle_rates_setpoint", time, roll, 0.0f, 0.0f, 0.5f);
  }
  void add_controls(std::uint64_t time, std::uint64_t sampled, float roll) {
    add("actuator_controls_0", time, sampled, roll, 0.0f, 0.0f, 0.5f, 0.0f, 0.0f, 0.0f, 0.0f);
  }
  // A log with one step, which a test extends.
  void start(const char* other_topic = "other:uint64_t timestamp;") {
    define({state, setpoint, rates, controls, other_topic});
    add_setpoint(1000);
    add_state(1000);
    add_rates(1050, 0.25f);
    add_controls(1080, 1000, 0.5f);
  }

  FlightLog read(const std::vector<std::string>& assumed = {}) {
    auto log = written(assumed);
    EXPECT_TRUE(log) << log.error().message;
    return *std::move(log);
  }
  std::string error(const std::vector<std::string>& assumed = {}) {
    const auto log = written(assumed);
    return log ? "" : log.error().message;
  }

  ulog::Writer writer_ = ulog::Writer::open(path(), 0).value();

 private:
  Result<FlightLog> written(const std::vector<std::string>& assumed) {
    if (!std::exchange(is_written_, true)) {
      EXPECT_TRUE(writer_.commit());
    }
    return read_flight_log(path(), assumed);
  }

  bool is_written_ = false;
  std::map<std::string, std::uint16_t> ids_;
};

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
  EXPECT_THAT(error(), HasSubstr("the topic control_state has no field q[0]"));
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
