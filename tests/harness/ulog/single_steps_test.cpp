// Which steps of a log can be judged one by one, and what their inputs are.
#include "harness/ulog/single_steps.hpp"

#include <limits>

#include <gmock/gmock.h>

namespace attest {
namespace {

using testing::ElementsAre;
using testing::Field;
using testing::IsEmpty;

// Times in us.
LoggedUnit log_of(Module module, const char* output) {
  LoggedUnit log;
  log.module = module;
  log.trace.present = channels_of(module);
  log.outputs = {{output, 0, 0, 0}};
  return log;
}

void add(LoggedUnit& log, const Sample& sample, LoggedSetpoint at) {
  log.trace.samples.push_back(sample);
  log.setpoints.push_back(at);
  ++log.outputs[0].samples;
}

// A step of an attitude unit in position mode at `time`, that publishes this thrust.
Sample attitude_step(std::uint64_t time, float given_thrust, float used_thrust) {
  Sample sample;
  sample.attitude_in.timestamp = time;
  sample.attitude_in.vehicle_status.is_rotary_wing = 1;
  sample.attitude_in.vehicle_control_mode = {0, 0, 0, 1, 1};
  sample.attitude_in.vehicle_attitude_setpoint.thrust_body[2] = given_thrust;
  auto& published = sample.attitude_out.vehicle_rates_setpoint;
  published.published = 1;
  published.thrust_body[2] = used_thrust;
  return sample;
}

LoggedUnit attitude_log() { return log_of(Module::attitude_unit, "vehicle_rates_setpoint"); }

// Every second step used another setpoint than the last logged one.
LoggedUnit log_of_given_setpoints() {
  LoggedUnit log = attitude_log();
  for (std::uint64_t i = 1; i <= 40; ++i) {
    const auto thrust = -0.01F * static_cast<float>(i);
    add(log, attitude_step(100'000 * i, thrust, i % 2 == 0 ? thrust : -0.9F),
        {Known::all, 100'000 * i - 4'850});
  }
  return log;
}

Trace all_of(const LoggedUnit& unit) {
  Trace all;
  EXPECT_TRUE(unit.ticks->rewind());
  EXPECT_TRUE(unit.ticks->next_part(std::numeric_limits<std::size_t>::max(), all));
  return all;
}

std::vector<std::uint64_t> times_of(const LoggedUnit& unit) {
  std::vector<std::uint64_t> times;
  for (const Sample& sample : all_of(unit).samples) times.push_back(sample.in.timestamp);
  return times;
}

TEST(SingleSteps, TheThrustShowsThatAnotherSetpointWasInUse) {
  const LoggedUnit log = log_of_given_setpoints();
  const LoggedUnit steps = single_steps_of(log).value();
  ASSERT_TRUE(steps.single_steps);
  EXPECT_EQ(steps.single_steps->with_given_setpoint, 20u);
  EXPECT_EQ(steps.single_steps->with_own_setpoint, 0u);
  EXPECT_EQ(steps.single_steps->logged, 40u);
  EXPECT_THAT(steps.single_steps->left_out,
              ElementsAre(Field(&SingleSteps::LeftOut::outputs, 20u)));
  EXPECT_EQ(all_of(steps).samples.size(), 20u);
  EXPECT_EQ(times_of(steps).front(), 200'000u);
}

TEST(SingleSteps, AStepKeepsTheTimeOfItsSetpoint) {
  const LoggedUnit log = log_of_given_setpoints();
  const LoggedUnit steps = single_steps_of(log).value();
  Trace part;
  ASSERT_TRUE(steps.ticks->next_part(1, part));
  EXPECT_EQ(steps.ticks->setpoints().front(), (LoggedSetpoint{Known::all, 195'150, false}));
}

TEST(SingleSteps, ASetpointOfTheSticksBecomesAnInput) {
  LoggedUnit log = attitude_log();
  for (const bool has_setpoint : {true, false}) {
    Sample sample = attitude_step(has_setpoint ? 1'000 : 2'000, -0.1F, -0.4F);
    sample.attitude_in.vehicle_control_mode = {1, 0, 0, 0, 1};  // stabilized
    auto& own = sample.attitude_out.vehicle_attitude_setpoint;
    own = {{0.5F, 0.5F, 0.5F, 0.5F}, {0, 0, -0.4F}, 0.25F, has_setpoint};
    add(log, sample, {Known::if_every_step, 0});  // no other module publishes one
  }
  const LoggedUnit steps = single_steps_of(log).value();
  EXPECT_EQ(steps.single_steps->with_own_setpoint, 1u);
  const Trace all = all_of(steps);
  ASSERT_EQ(all.samples.size(), 1u);
  const auto& in = all.samples[0].attitude_in;
  EXPECT_EQ(in.vehicle_control_mode.flag_control_manual_enabled, 0);
  EXPECT_EQ(in.vehicle_attitude_setpoint.q_d[3], 0.5F);
  EXPECT_EQ(in.vehicle_attitude_setpoint.thrust_body[2], -0.4F);
  EXPECT_EQ(in.vehicle_attitude_setpoint.yaw_sp_move_rate, 0.25F);
  EXPECT_EQ(in.vehicle_attitude_setpoint.timestamp, 1'000u);
  EXPECT_NE(in.updated & ATTEST_ATTITUDE_UPDATED_VEHICLE_ATTITUDE_SETPOINT, 0u);
}

TEST(SingleSteps, AResetOfTheEstimatorIsLeftOut) {
  LoggedUnit log = log_of_given_setpoints();
  for (std::size_t i = 0; i < log.trace.samples.size(); ++i) {
    log.trace.samples[i].attitude_in.vehicle_attitude.quat_reset_counter = i < 21 ? 7 : 8;
  }
  const Trace all = all_of(single_steps_of(log).value());
  EXPECT_EQ(all.samples.size(), 19u);
  for (const Sample& sample : all.samples) {
    EXPECT_EQ(sample.attitude_in.vehicle_attitude.quat_reset_counter, 0);
  }
}

TEST(SingleSteps, AStepBeforeTheFirstModeIsLeftOut) {
  LoggedUnit log = log_of_given_setpoints();
  log.setpoints[1].known = Known::nothing;
  EXPECT_EQ(times_of(single_steps_of(log).value()).front(), 400'000u);
}

TEST(SingleSteps, AParameterChangesAtTheNextSingleStep) {
  LoggedUnit log = log_of_given_setpoints();
  log.trace.parameters = {{0, "MC_ROLL_P", 1}, {4, "MC_ROLL_P", 2}, {39, "MC_ROLL_P", 3}};
  const LoggedUnit steps = single_steps_of(log).value();
  ASSERT_EQ(steps.trace.parameters.size(), 3u);
  EXPECT_EQ(steps.trace.parameters[0].tick, 0u);
  EXPECT_EQ(steps.trace.parameters[1].tick, 2u);   // the step at 600 ms, after that at 500 ms
  EXPECT_EQ(steps.trace.parameters[2].tick, 19u);  // the last one
}

TEST(SingleSteps, PartsHaveTheSameSteps) {
  const LoggedUnit log = log_of_given_setpoints();
  const LoggedUnit steps = single_steps_of(log).value();
  const auto whole = times_of(steps);
  for (const std::size_t most : {1U, 7U, 20U}) {
    std::vector<std::uint64_t> times;
    ASSERT_TRUE(steps.ticks->rewind());
    ASSERT_TRUE(for_each_part(*steps.ticks, most, [&](const Trace& part, std::size_t, bool) {
      for (const Sample& sample : part.samples) times.push_back(sample.in.timestamp);
      return true;
    }));
    EXPECT_EQ(times, whole);
  }
}

// A step of a rate unit with torque, thrust and integral.
Sample rate_step(std::uint64_t time, float given_thrust, float used_thrust) {
  Sample sample;
  sample.rate_in.timestamp = time;
  sample.rate_in.vehicle_control_mode = {1, 0, 1, 1};
  sample.rate_in.vehicle_status.is_rotary_wing = 1;
  sample.rate_in.vehicle_rates_setpoint.thrust_body[2] = given_thrust;
  sample.rate_out.vehicle_torque_setpoint.published = 1;
  sample.rate_out.rate_ctrl_status.published = 1;
  sample.rate_out.vehicle_thrust_setpoint = {{0, 0, used_thrust}, 1};
  return sample;
}

TEST(SingleSteps, ARateUnitIsDisarmedSoThatItsIntegralIsZero) {
  LoggedUnit log = log_of(Module::rate_unit, "rate_ctrl_status");
  for (std::uint64_t i = 1; i <= 20; ++i) {
    const auto thrust = -0.01F * static_cast<float>(i);
    Sample sample = rate_step(10'000 * i, thrust, thrust);
    sample.rate_out.rate_ctrl_status.published = i % 2;
    add(log, sample, {Known::all, 10'000 * i - 1'000});
  }
  const Trace all = all_of(single_steps_of(log).value());
  ASSERT_EQ(all.samples.size(), 10u);
  EXPECT_EQ(all.samples[0].rate_in.vehicle_control_mode.flag_armed, 0);
  EXPECT_EQ(all.samples[0].rate_in.vehicle_land_detected.landed, 1);
}

TEST(SingleSteps, FixedWingFlightIsLeftOut) {
  LoggedUnit log = log_of(Module::rate_unit, "rate_ctrl_status");
  for (std::uint64_t i = 1; i <= 20; ++i) {
    const auto thrust = -0.01F * static_cast<float>(i);
    Sample sample = rate_step(10'000 * i, thrust, thrust);
    sample.rate_in.vehicle_status.is_rotary_wing = i <= 15 ? 1 : 0;
    add(log, sample, {Known::all, 10'000 * i - 1'000});
  }
  const LoggedUnit steps = single_steps_of(log).value();
  EXPECT_EQ(all_of(steps).samples.size(), 15u);
  EXPECT_THAT(steps.single_steps->left_out, ElementsAre(Field(&SingleSteps::LeftOut::outputs, 5u)));
}

TEST(SingleSteps, TheBatteryScalesTheThrust) {
  LoggedUnit log = log_of(Module::rate_unit, "rate_ctrl_status");
  log.trace.parameters = {{0, "MC_BAT_SCALE_EN", 1}};
  for (std::uint64_t i = 1; i <= 20; ++i) {
    const auto thrust = -0.01F * static_cast<float>(i);
    Sample sample = rate_step(10'000 * i, thrust, thrust * 1.25F);
    sample.rate_in.battery_status = {i < 10 ? 1.25F : 0.0F, 1};  // then the last valid one holds
    add(log, sample, {Known::all, 10'000 * i - 1'000});
  }
  EXPECT_EQ(all_of(single_steps_of(log).value()).samples.size(), 20u);
  log.trace.parameters.clear();
  EXPECT_THAT(all_of(single_steps_of(log).value()).samples, IsEmpty());
}

TEST(SingleSteps, AnAcroSetpointIsTheLastThatTheUnitPublished) {
  LoggedUnit log = log_of(Module::rate_unit, "rate_ctrl_status");
  for (std::uint64_t i = 1; i <= 20; ++i) {
    const auto thrust = -0.01F * static_cast<float>(i);
    Sample sample = rate_step(10'000 * i, 0, thrust);
    sample.rate_in.vehicle_control_mode = {1, 1, 0, 1};
    sample.rate_out.vehicle_rates_setpoint = {0.5F, 0, 0, {0, 0, thrust}, 1};
    add(log, sample, {Known::all, 0});
  }
  const Trace all = all_of(single_steps_of(log).value());
  ASSERT_EQ(all.samples.size(), 20u);
  EXPECT_EQ(all.samples[0].rate_in.vehicle_rates_setpoint.roll, 0.5F);
  EXPECT_EQ(all.samples[0].rate_in.vehicle_control_mode.flag_control_manual_enabled, 0);
}

}  // namespace
}  // namespace attest
