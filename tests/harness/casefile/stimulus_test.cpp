#include "harness/casefile/stimulus.hpp"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/harness/casefile/case_files.hpp"

namespace attest {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

Trace stimulated(const std::string& body, const Rate& rate = Rate::hz(250)) {
  return stimulate(case_of(body), rate);
}

TEST(Stimulate, HasARowForEachTick) {
  const Trace trace = stimulated("");
  ASSERT_EQ(trace.samples.size(), 10u);
  EXPECT_EQ(trace.samples[0].in.timestamp, 5'000'000u);
  EXPECT_EQ(trace.samples[1].in.timestamp, 5'004'000u);
  EXPECT_EQ(trace.source, "px4-v1.5.5/tests/the_case@250hz");
  EXPECT_TRUE(trace.present == channels_of(Module::mc_att_control));
}

TEST(Stimulate, AMixersTraceHasAsManyOutputsAsRotors) {
  const Trace trace = stimulated(
      "[mixer]\ndefinition = \"R: 6x 10000 10000 10000 0\"\ndelta_out_max = 0.25\n"
      "[actuator_controls_0]\n\"control[1]\" = -0.5\n");
  EXPECT_EQ(module_of(trace.present), Module::mixer);
  EXPECT_EQ((trace.present & channels_of(Module::mixer, "out/actuator_outputs")).count(), 6u);
  const auto& [controls, mixer] = trace.samples[3].mixer_in;
  EXPECT_THAT(controls.control, ElementsAre(0, -0.5f, 0, 0.5f));
  EXPECT_EQ(mixer.delta_out_max, 0.25f);
  EXPECT_EQ(trace.samples[0].in.updated, 0u);
}

TEST(Stimulate, ABatteryIsFullAndArmed) {
  const Case the_case = case_of("[battery]\n[parameters]\nBAT_N_CELLS = 3\n");
  EXPECT_THAT(the_case.rates, ElementsAre(Rate::hz(100)));
  const Trace trace = stimulate(the_case, Rate::hz(100));
  EXPECT_EQ(trace.present, channels_of(Module::battery_status));
  const auto& battery = trace.samples[9].battery_in.battery;
  EXPECT_EQ(battery.voltage_v, 12.15f);
  EXPECT_EQ(battery.armed, 1);
  EXPECT_EQ(trace.parameters, (std::vector<ParameterChange>{{0, "BAT_N_CELLS", 3}}));
}

TEST(Stimulate, TimestampsAreRoundedDown) {
  const Trace trace = stimulated("[unit]\nstart_s = 0\n", Rate::hz(333));
  EXPECT_EQ(trace.samples[1].in.timestamp, 3003u);
  EXPECT_EQ(trace.samples[2].in.timestamp, 6006u);
}

TEST(Stimulate, JitterIsInTheTimestamps) {
  const Trace trace = stimulated("[unit]\njitter = 0.5\n");
  bool any_late = false;
  for (std::size_t tick = 0; tick < trace.samples.size(); ++tick) {
    const std::uint64_t begin = 5'000'000 + 4000 * tick;
    EXPECT_GE(trace.samples[tick].in.timestamp, begin);
    EXPECT_LE(trace.samples[tick].in.timestamp, begin + 2000);
    any_late |= trace.samples[tick].in.timestamp > begin;
  }
  EXPECT_TRUE(any_late);
}

TEST(Stimulate, BaselineIsAVehicleThatHovers) {
  const Trace trace = stimulated("");
  const attest_inputs& in = trace.samples[0].in;
  EXPECT_EQ(in.updated, (1u << updated_topics(Module::mc_att_control).size()) - 1);
  EXPECT_EQ(in.control_state.q[0], 1.0f);
  EXPECT_EQ(in.vehicle_attitude_setpoint.q_d[0], 1.0f);
  EXPECT_EQ(in.vehicle_attitude_setpoint.thrust, 0.5f);
  EXPECT_EQ(in.manual_control_setpoint.z, 0.5f);
  EXPECT_EQ(in.battery_status.scale, 1.0f);
  EXPECT_EQ(in.actuator_armed.armed, 1);
  EXPECT_EQ(in.vehicle_status.is_rotary_wing, 1);
  EXPECT_EQ(in.vehicle_status.is_vtol, 0);
  EXPECT_EQ(in.vehicle_control_mode.flag_control_attitude_enabled, 1);
  EXPECT_EQ(in.vehicle_control_mode.flag_control_velocity_enabled, 0);
  EXPECT_EQ(trace.samples[1].in.updated, 0u);
}

TEST(Stimulate, OutputsAreZero) {
  const Trace trace = stimulated("");
  for (const Channel& channel : channels()) {
    if (channel.is_output()) {
      EXPECT_EQ(value_of(channel, trace.samples[3]), 0) << channel.name;
    }
  }
}

TEST(Stimulate, ParametersAreSetWhenTheyChange) {
  const Trace trace = stimulated(
      "[parameters]\nMC_ROLL_P = 5\n"
      "MC_PITCH_P = { signal = \"step\", from = 6, to = 7, at_ticks = 4 }\n");
  EXPECT_THAT(trace.parameters,
              ElementsAre(ParameterChange{0, "MC_ROLL_P", 5}, ParameterChange{0, "MC_PITCH_P", 6},
                          ParameterChange{4, "MC_PITCH_P", 7}));
  for (std::size_t tick = 0; tick < trace.samples.size(); ++tick) {
    const bool updated = trace.samples[tick].in.updated & ATTEST_UPDATED_PARAMETER_UPDATE;
    EXPECT_EQ(updated, tick == 0 || tick == 4) << tick;
  }
}

// As the firmware does when it starts.
TEST(Stimulate, ParametersAreUpdatedAtTheFirstTickOfEveryCase) {
  const Trace trace = stimulated("[unit]\ndrop_ticks = [0]\n");
  EXPECT_THAT(trace.parameters, IsEmpty());
  EXPECT_NE(trace.samples[0].in.updated & ATTEST_UPDATED_PARAMETER_UPDATE, 0u);
  EXPECT_EQ(trace.samples[1].in.updated & ATTEST_UPDATED_PARAMETER_UPDATE, 0u);
}

TEST(Stimulate, AChangeInADroppedTickComesWithTheNext) {
  const Trace trace = stimulated(
      "[unit]\ndrop_ticks = [4]\n[parameters]\n"
      "MC_PITCH_P = { signal = \"step\", from = 6, to = 7, at_ticks = 4 }\n");
  ASSERT_EQ(trace.parameters.size(), 2u);
  EXPECT_EQ(trace.parameters[1].tick, 4u);  // the row of tick 5
  EXPECT_NE(trace.samples[4].in.updated & ATTEST_UPDATED_PARAMETER_UPDATE, 0u);
}

TEST(Stimulate, QuaternionsAsNumbersOrAngles) {
  const Trace trace = stimulated(
      "[control_state]\nq = [0.5, -0.5, 0.5, -0.5]\n"
      "[vehicle_attitude_setpoint]\nq_d = { tilt_deg = 90, sign = -1, norm = 2 }\n");
  const attest_inputs& in = trace.samples[0].in;
  EXPECT_THAT(in.control_state.q, ElementsAre(0.5f, -0.5f, 0.5f, -0.5f));
  const float root2 = std::sqrt(2.0f);
  EXPECT_FLOAT_EQ(in.vehicle_attitude_setpoint.q_d[0], -root2);
  EXPECT_FLOAT_EQ(in.vehicle_attitude_setpoint.q_d[1], -root2);
  EXPECT_EQ(in.vehicle_attitude_setpoint.q_d[2], 0);
}

TEST(Stimulate, AnglesMayBeRollPitchAndYawEachASignal) {
  const Trace trace = stimulated(
      "[control_state]\nq = { pitch_deg = 90, sign = -1 }\n"
      "[vehicle_attitude_setpoint]\nq_d = { yaw_deg = 90, roll_deg = { signal = \"step\", "
      "from = 0, to = 180, at_ticks = 3 } }\n");
  const float half = std::sqrt(0.5f);
  const auto is = [](const float* q, float w, float x, float y, float z) {
    EXPECT_NEAR(q[0], w, 1e-6f);
    EXPECT_NEAR(q[1], x, 1e-6f);
    EXPECT_NEAR(q[2], y, 1e-6f);
    EXPECT_NEAR(q[3], z, 1e-6f);
  };
  is(trace.samples[0].in.control_state.q, -half, 0, -half, 0);
  is(trace.samples[2].in.vehicle_attitude_setpoint.q_d, half, 0, 0, half);
  is(trace.samples[3].in.vehicle_attitude_setpoint.q_d, 0, half, half, 0);
}

TEST(Stimulate, NanAndInfinityAreNumbers) {
  const Trace trace = stimulated(
      "[control_state]\nroll_rate = nan\n"
      "pitch_rate = { signal = \"step\", from = 0, to = inf, at_ticks = 2 }\n");
  EXPECT_TRUE(std::isnan(trace.samples[0].in.control_state.roll_rate));
  EXPECT_EQ(trace.samples[1].in.control_state.pitch_rate, 0);
  EXPECT_EQ(trace.samples[2].in.control_state.pitch_rate, std::numeric_limits<float>::infinity());
}

TEST(Stimulate, CyclesAreOverTheWholeCase) {
  for (const Rate& rate : standard_rates()) {
    const Trace trace = stimulated(
        "[control_state]\nyaw_rate = { signal = \"sine\", amplitude = 1, cycles = 2.5 }\n", rate);
    EXPECT_NEAR(trace.samples[5].in.control_state.yaw_rate, 1, 1e-3) << rate.to_string();
  }
}

TEST(Stimulate, InSecondsTheTicksAreThoseOfTheRate) {
  std::string text = CaseFiles::with("");
  text.replace(text.find("duration_ticks = 10"), 19, "duration_s = 0.1   ");
  const auto parsed = CaseFiles().parse(text);
  ASSERT_TRUE(parsed);
  EXPECT_EQ(stimulate(*parsed, Rate::hz(50)).samples.size(), 5u);
  EXPECT_EQ(stimulate(*parsed, Rate::hz(333)).samples.size(), 34u);
  EXPECT_EQ(stimulate(*parsed, Rate::hz(8000)).samples.size(), 800u);
}

TEST(Stimulate, ATimestampIsRoundedDownOnce) {
  const Stimulus stimulus(case_of("[unit]\nstart_s = 0.0000015\n"), Rate::hz(250));
  EXPECT_EQ(stimulus.timestamp_us(Nanoseconds(400)), 1u);
  EXPECT_EQ(stimulus.timestamp_us(Nanoseconds(500)), 2u);
}

// With a clock that is faster by a quarter, ticks come earlier, and more of them in the same time.
TEST(UnitTicks, OnAFasterClockAreCloserTogether) {
  const auto times = unit_ticks(case_of(""), Rate::hz(100), 0.25);
  ASSERT_EQ(times.size(), 13u);
  EXPECT_EQ(times[1], Nanoseconds(8'000'000));
  EXPECT_EQ(times.back(), Nanoseconds(96'000'000));
}

}  // namespace
}  // namespace attest
