// What PX4 v1.14 to v1.18 logs is divided between the attitude unit and the rate unit.
#include "harness/ulog/unit_log.hpp"

#include <cstring>
#include <map>
#include <utility>

#include <gmock/gmock.h>

#include "harness/ulog/flight_log.hpp"
#include "harness/ulog/single_steps.hpp"
#include "harness/ulog/writer.hpp"
#include "tests/harness/core/temporary_directory.hpp"
#include "tests/harness/ulog/crafted.hpp"

namespace attest {
namespace {

using testing::Contains;
using testing::ElementsAre;
using ulog::raw;

// A log of PX4 v1.16 with these topics.
class LogOfPx4 : public testing::Test {
 protected:
  void SetUp() override {
    for (const char* topic :
         {"vehicle_attitude:uint64_t timestamp;uint64_t timestamp_sample;float[4] q;"
          "float[4] delta_q_reset;uint8_t quat_reset_counter;",
          "vehicle_attitude_setpoint:uint64_t timestamp;float yaw_sp_move_rate;float[4] q_d;"
          "float[3] thrust_body;",
          "vehicle_rates_setpoint:uint64_t timestamp;float roll;float pitch;float yaw;"
          "float[3] thrust_body;",
          "vehicle_angular_velocity:uint64_t timestamp;uint64_t timestamp_sample;float[3] xyz;"
          "float[3] xyz_derivative;",
          "vehicle_torque_setpoint:uint64_t timestamp;uint64_t timestamp_sample;float[3] xyz;",
          "vehicle_control_mode:uint64_t timestamp;bool flag_armed;"
          "bool flag_control_manual_enabled;bool flag_control_attitude_enabled;"
          "bool flag_control_rates_enabled;",
          "vehicle_status:uint64_t timestamp;uint64_t armed_time;uint8_t arming_state;"
          "uint8_t vehicle_type;",
          "vehicle_land_detected:uint64_t timestamp;bool landed;"}) {
      ASSERT_TRUE(writer_.define(topic));
      names_.emplace_back(topic, std::string_view(topic).find(':'));
    }
    for (const std::string& name : names_) ids_[name] = *writer_.subscribe(name);
  }

  template <typename... Values>
  void add(const char* topic, std::uint64_t time, Values... values) {
    ASSERT_TRUE(writer_.data(ids_.at(topic), raw(time, values...)));
  }
  void add_attitude(std::uint64_t time, float q1 = 0, int counter = 0) {
    add("vehicle_attitude", time, time - 500, 1.0f, q1, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f,
        static_cast<std::uint8_t>(counter));
  }
  void add_setpoint(std::uint64_t time, float q1) {
    add("vehicle_attitude_setpoint", time, 0.0f, 1.0f, q1, 0.0f, 0.0f, 0.0f, 0.0f, -0.5f);
  }
  void add_rates(std::uint64_t time, float roll) {
    add("vehicle_rates_setpoint", time, roll, 0.0f, 0.0f, 0.0f, 0.0f, -0.5f);
  }
  void add_gyro(std::uint64_t time) {
    add("vehicle_angular_velocity", time, time - 300, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f);
  }
  void add_torque(std::uint64_t time, std::uint64_t sampled, float roll) {
    add("vehicle_torque_setpoint", time, sampled, roll, 0.0f, 0.0f);
  }
  void add_mode(std::uint64_t time, bool manual, bool attitude) {
    add("vehicle_control_mode", time, true, manual, attitude, true);
  }

  FlightLog read(const std::vector<std::string>& assumed = {}) {
    EXPECT_TRUE(writer_.commit());
    auto log = read_flight_log(path_, assumed);
    EXPECT_TRUE(log) << log.error().message;
    return *std::move(log);
  }

  TemporaryDirectory directory_;
  std::filesystem::path path_ = directory_.path() / "px4.ulg";
  ulog::Writer writer_ = ulog::Writer::open(path_, 0).value();
  std::vector<std::string> names_;
  std::map<std::string, std::uint16_t> ids_;
};

std::vector<float> rolls_of(const LoggedUnit& unit) {
  std::vector<float> found;
  for (const Sample& sample : unit.trace.samples) {
    const auto& published = sample.attitude_out.vehicle_rates_setpoint;
    if (published.published != 0) found.push_back(published.roll);
  }
  return found;
}

TEST_F(LogOfPx4, FindsTheSingleStepsWhenItIsRead) {
  add_mode(500, false, true);
  for (std::uint64_t time = 1'000'000; time < 3'000'000; time += 100'000) {
    add_setpoint(time - 900, 0.5f);
    add_attitude(time, 0.25f, time < 2'000'000 ? 0 : 1);
    if (time % 300'000 != 0) add_rates(time + 100, static_cast<float>(time));
  }
  LoggedUnit unit = read().units[0];
  ASSERT_TRUE(unit.found_steps) << "the log is too sparse to be judged tick by tick";
  const LoggedUnit found = single_steps_of(unit).value();
  unit.found_steps = nullptr;
  const LoggedUnit searched = single_steps_of(unit).value();
  Trace of_found, of_searched;
  ASSERT_TRUE(found.ticks->next_part(100, of_found));
  ASSERT_TRUE(searched.ticks->next_part(100, of_searched));
  EXPECT_EQ(of_found.samples.size(), 13u);
  ASSERT_EQ(of_found.samples.size(), of_searched.samples.size());
  EXPECT_EQ(std::memcmp(of_found.samples.data(), of_searched.samples.data(),
                        of_found.samples.size() * sizeof(Sample)),
            0);
  EXPECT_EQ(found.ticks->setpoints(), searched.ticks->setpoints());
  EXPECT_EQ(found.single_steps->left_out.size(), searched.single_steps->left_out.size());
}

TEST_F(LogOfPx4, HasTheSameTicksInParts) {
  add_mode(500, false, true);
  add_setpoint(900, 0.5f);
  for (std::uint64_t time = 1000; time < 50000; time += 4000) {
    add_attitude(time, 0.25f, time > 20000 ? 1 : 0);
    if (time % 3 != 0) add_rates(time + 100, static_cast<float>(time));
    if (time == 25000) add_mode(time + 50, true, true);
  }
  const FlightLog whole = read();
  const auto opened = read_flight_log(path_, {}, false);
  ASSERT_TRUE(opened);
  const LoggedUnit& unit = whole.units[0];
  const auto& ticks = opened->units[0].ticks;
  ASSERT_TRUE(ticks);
  for (const std::size_t most : {1U, 5U, 13U}) {
    ASSERT_TRUE(ticks->rewind());
    std::size_t tick = 0;
    ASSERT_TRUE(for_each_part(*ticks, most, [&](const Trace& part, std::size_t, bool) {
      for (std::size_t i = 0; i < part.samples.size(); ++i, ++tick) {
        EXPECT_EQ(std::memcmp(&part.samples[i], &unit.trace.samples[tick], sizeof(Sample)), 0);
        EXPECT_EQ(ticks->setpoints()[i], unit.setpoints[tick]);
      }
      return true;
    }));
    EXPECT_EQ(tick, unit.trace.samples.size());
  }
}

TEST_F(LogOfPx4, HasTwoUnits) {
  add_mode(500, false, true);
  add_setpoint(900, 0.5f);
  for (const std::uint64_t time : {1000U, 5000U, 9000U}) {
    add_attitude(time, 0.25f);
    add_rates(time + 100, static_cast<float>(time));
    add_gyro(time);
    add_torque(time + 60, time - 300, static_cast<float>(time));
  }
  const FlightLog log = read();
  ASSERT_EQ(log.units.size(), 2u);
  EXPECT_FALSE(log.is_of_attest);
  const LoggedUnit &attitude = log.units[0], &rate = log.units[1];
  EXPECT_EQ(attitude.module, Module::attitude_unit);
  EXPECT_THAT(rolls_of(attitude), ElementsAre(1000, 5000, 9000));
  EXPECT_EQ(attitude.trace.samples[1].attitude_in.vehicle_attitude.timestamp, 5000u);
  EXPECT_EQ(attitude.trace.samples[1].attitude_in.vehicle_attitude.timestamp_sample, 4500u);
  EXPECT_EQ(attitude.trace.samples[0].attitude_in.vehicle_attitude_setpoint.timestamp, 900u);
  EXPECT_EQ(attitude.trace.samples[0].attitude_in.vehicle_attitude_setpoint.q_d[1], 0.5f);
  EXPECT_EQ(rate.module, Module::rate_unit);
  EXPECT_EQ(rate.trace.samples[2].rate_out.vehicle_torque_setpoint.xyz[0], 9000);
  // The setpoint of the attitude unit is the input of the rate unit, from the next step on.
  EXPECT_EQ(rate.trace.samples[1].rate_in.vehicle_rates_setpoint.roll, 1000);
  EXPECT_EQ(rate.trace.samples[2].rate_in.vehicle_rates_setpoint.roll, 5000);
  EXPECT_THAT(rate.setpoints,
              ElementsAre(LoggedSetpoint{Known::nothing, 0}, LoggedSetpoint{Known::all, 1100},
                          LoggedSetpoint{Known::all, 5100}));
}

TEST_F(LogOfPx4, AnInputIsThereFromTheNextStepOn) {
  add_mode(500, false, true);
  add_setpoint(900, 0.5f);
  add_attitude(1000);
  add_rates(1100, 0);
  add_setpoint(5000, 0.75f);  // at the time of the step
  add_attitude(5000);
  add_attitude(9000);
  const LoggedUnit unit = read().units[0];
  EXPECT_EQ(unit.trace.samples[1].attitude_in.vehicle_attitude_setpoint.q_d[1], 0.5f);
  EXPECT_EQ(unit.trace.samples[2].attitude_in.vehicle_attitude_setpoint.q_d[1], 0.75f);
}

TEST_F(LogOfPx4, ASetpointOfTheSticksIsAnOutput) {
  add_mode(500, false, true);
  add_setpoint(900, 0.5f);
  add_attitude(1000);
  add_rates(1100, 1);
  add_mode(4900, true, true);  // stabilized
  add_attitude(5000);
  add_setpoint(5080, 0.75f);
  add_rates(5100, 2);
  add_mode(8900, false, true);
  add_attitude(9000);
  add_setpoint(9080, 0.875f);
  add_rates(9100, 3);
  add_attitude(13000);
  const LoggedUnit unit = read().units[0];
  const auto external = [&](std::size_t tick) {
    return unit.trace.samples[tick].attitude_in.vehicle_attitude_setpoint.q_d[1];
  };
  const auto own = [&](std::size_t tick) {
    return unit.trace.samples[tick].attitude_out.vehicle_attitude_setpoint;
  };
  EXPECT_EQ(external(2), 0.5f);
  EXPECT_EQ(external(3), 0.875f);
  EXPECT_EQ(own(0).published, 0);
  EXPECT_EQ(own(1).published, 1);
  EXPECT_EQ(own(1).q_d[1], 0.75f);
  EXPECT_EQ(own(2).published, 0);
  EXPECT_THAT(
      unit.setpoints,
      ElementsAre(LoggedSetpoint{Known::all, 900}, LoggedSetpoint{Known::if_every_step, 900},
                  LoggedSetpoint{Known::if_every_step, 900}, LoggedSetpoint{Known::all, 9080}));
}

TEST_F(LogOfPx4, ARatesSetpointInAcroModeIsOfTheRateUnit) {
  add_mode(500, true, false);  // acro
  add_setpoint(600, 0.5f);
  add_attitude(900);
  add_gyro(1000);
  add_rates(1050, 4);
  add_torque(1060, 700, 1);
  add_mode(4900, false, true);
  add_attitude(4950);
  add_rates(4980, 5);
  add_gyro(5000);
  add_torque(5060, 4700, 1);
  const FlightLog log = read();
  EXPECT_THAT(rolls_of(log.units[0]), ElementsAre(5));
  const auto& ticks = log.units[1].trace.samples;
  EXPECT_EQ(ticks[0].rate_out.vehicle_rates_setpoint.published, 1);
  EXPECT_EQ(ticks[0].rate_out.vehicle_rates_setpoint.roll, 4);
  EXPECT_EQ(ticks[1].rate_out.vehicle_rates_setpoint.published, 0);
  EXPECT_EQ(ticks[1].rate_in.vehicle_rates_setpoint.roll, 5);
}

TEST_F(LogOfPx4, AnAnswerIsNotLate) {
  add_mode(500, false, true);
  add_setpoint(900, 0.5f);
  add_attitude(1000);
  add_rates(3001, 1);  // the answer to a sample that is not logged
  add_attitude(9000);
  add_rates(10900, 2);
  const LoggedUnit unit = read().units[0];
  EXPECT_THAT(rolls_of(unit), ElementsAre(2));
  EXPECT_EQ(unit.outputs[0].samples, 2u);
  EXPECT_EQ(unit.outputs[0].paired, 1u);
  EXPECT_FALSE(unit.has_every_step);
}

TEST_F(LogOfPx4, ATorqueAnswersTheGyroSampleOfItsTime) {
  add_mode(500, false, true);
  add_setpoint(600, 0.5f);
  add_rates(900, 1);
  add_gyro(1000);
  add_gyro(2000);
  add_torque(2010, 700, 3);   // late, the answer to the first
  add_torque(2060, 1200, 4);  // to a sample that is not logged
  const LoggedUnit unit = read().units[1];
  EXPECT_EQ(unit.trace.samples[0].rate_out.vehicle_torque_setpoint.xyz[0], 3);
  EXPECT_EQ(unit.trace.samples[1].rate_out.vehicle_torque_setpoint.published, 0);
  EXPECT_EQ(unit.outputs[0].paired, 1u);
}

TEST_F(LogOfPx4, StatesOfVehicleStatusAreFlags) {
  add_mode(500, false, true);
  add_setpoint(600, 0.5f);
  const auto add_status = [&](std::uint64_t time, int arming_state, int vehicle_type) {
    add("vehicle_status", time, std::uint64_t{77}, static_cast<std::uint8_t>(arming_state),
        static_cast<std::uint8_t>(vehicle_type));
  };
  add_status(700, 2, 1);
  add_attitude(1000);
  add_rates(1100, 0);
  add_status(1200, 1, 2);
  add_attitude(5000);
  const LoggedUnit unit = read().units[0];
  const auto status = [&](std::size_t tick) {
    return unit.trace.samples[tick].attitude_in.vehicle_status;
  };
  EXPECT_EQ(status(0).armed, 1);
  EXPECT_EQ(status(0).is_rotary_wing, 1);
  EXPECT_EQ(status(0).armed_time, 77u);
  EXPECT_EQ(status(1).armed, 0);
  EXPECT_EQ(status(1).is_rotary_wing, 0);
}

TEST_F(LogOfPx4, EarlierResetsOfTheEstimatorAreNotSeen) {
  add_mode(500, false, true);
  add_setpoint(600, 0.5f);
  add_attitude(1000, 0, 255);
  add_rates(1100, 0);
  add_attitude(5000, 0, 0);
  const LoggedUnit unit = read().units[0];
  EXPECT_EQ(unit.trace.samples[0].attitude_in.vehicle_attitude.quat_reset_counter, 0);
  EXPECT_EQ(unit.trace.samples[1].attitude_in.vehicle_attitude.quat_reset_counter, 1);
}

TEST_F(LogOfPx4, AUnitOfWhichTheLogHasTooLittleIsNamed) {
  add_mode(500, false, true);
  add_setpoint(600, 0.5f);
  add_attitude(1000);
  add_rates(1100, 0);
  const FlightLog log = read();
  EXPECT_EQ(log.units[1].not_judged, "the log has no sample of the topic vehicle_angular_velocity");
  EXPECT_TRUE(log.units[1].trace.samples.empty());
}

TEST_F(LogOfPx4, SaysWhatIsAssumed) {
  add_setpoint(600, 0.5f);
  add_attitude(1000);
  add_rates(1100, 0);
  const FlightLog log = read();
  EXPECT_THAT(log.notes, Contains("assumed, because the log does not have it: armed, rotary_wing, "
                                  "attitude, flying (--assume)"));
}

TEST_F(LogOfPx4, IsNotCompleteIfTheModeIsAssumed) {
  add_setpoint(600, 0.5f);
  for (const std::uint64_t time : {1000U, 5000U, 9000U}) {
    add_attitude(time);
    add_rates(time + 100, 0);
  }
  EXPECT_FALSE(read({"attitude"}).units[0].has_every_step);
}

TEST_F(LogOfPx4, IsCompleteIfNothingIsMissing) {
  add_mode(500, false, true);
  add_setpoint(600, 0.5f);
  for (const std::uint64_t time : {1000U, 5000U, 9000U}) {
    add_attitude(time);
    add_rates(time + 100, 0);
  }
  add("vehicle_status", 700, std::uint64_t{77}, std::uint8_t{2}, std::uint8_t{1});
  add("vehicle_land_detected", 700, true);
  const FlightLog log = read();
  EXPECT_TRUE(log.units[0].has_every_step);
  EXPECT_FALSE(log.units[0].begins_in_flight);
}

}  // namespace
}  // namespace attest
