#include "harness/compare/metric.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/harness/compare/sample_trace.hpp"

namespace attest {
namespace {

using testing::HasSubstr;

constexpr double infinity = std::numeric_limits<double>::infinity();

// Ticks 4 ms apart; the setpoint is level, and the attitude rolls by these errors.
Trace rolled_by(const std::vector<double>& errors_deg) {
  Trace trace = sample_trace(errors_deg.size());
  for (const double error : errors_deg) {
    const double half = error * std::numbers::pi / 360;
    PlantSample plant{};
    plant.q = {static_cast<float>(std::cos(half)), static_cast<float>(std::sin(half)), 0, 0};
    trace.plant.push_back(plant);
  }
  return trace;
}

Metric metric(Measure measure) {
  Metric result;
  result.measure = measure;
  return result;
}

TEST(Measure, IsReadBackFromItsName) {
  for (int i = 0; i <= static_cast<int>(Measure::sink_m); ++i) {
    const auto measure = static_cast<Measure>(i);
    const auto parsed = parse_measure(name_of(measure));
    ASSERT_TRUE(parsed);
    EXPECT_EQ(*parsed, measure);
  }
  const auto unknown = parse_measure("settling_time");
  ASSERT_FALSE(unknown);
  EXPECT_THAT(unknown.error().message, HasSubstr("did you mean `settling_time_s`?"));
  EXPECT_THAT(unknown.error().message, HasSubstr("sink_m"));
}

TEST(Measure, HasTheUnitOfItsName) {
  EXPECT_EQ(unit_of(Measure::settling_time_s), "s");
  EXPECT_EQ(unit_of(Measure::overshoot_deg), "deg");
  EXPECT_EQ(unit_of(Measure::peak_rate_rad_s), "rad/s");
  EXPECT_EQ(unit_of(Measure::sink_m), "m");
  EXPECT_EQ(unit_of(Measure::peak_integral), "");
}

TEST(SettlingTime, IsOfTheLastArrivalInTheBand) {
  Metric settles = metric(Measure::settling_time_s);
  EXPECT_NEAR(measured(settles, rolled_by({30, 1, 3, 1.9, 1, 0})), 0.012, 1e-12);
  EXPECT_EQ(measured(settles, rolled_by({1, 1, 1})), 0);
  EXPECT_EQ(measured(settles, rolled_by({1, 1, 3})), infinity);
  settles.band_deg = 5;
  EXPECT_NEAR(measured(settles, rolled_by({30, 1, 3, 1.9, 1, 0})), 0.004, 1e-12);
}

TEST(SettlingTime, CountsFromTheBeginOfTheWindow) {
  Metric settles = metric(Measure::settling_time_s);
  const Trace trace = rolled_by({0, 0, 30, 20, 10, 1, 1, 30});
  settles.window = {0.008, 0.028};
  EXPECT_NEAR(measured(settles, trace), 0.012, 1e-12);
  settles.window = {0.008, 0.032};
  EXPECT_EQ(measured(settles, trace), infinity);
  settles.window = {1, 2};
  EXPECT_TRUE(std::isnan(measured(settles, trace)));
}

TEST(Overshoot, IsWhatComesAfterTheFirstArrival) {
  const Metric overshoots = metric(Measure::overshoot_deg);
  EXPECT_NEAR(measured(overshoots, rolled_by({40, 10, 1, -7, 3, 0})), 7, 1e-4);
  EXPECT_EQ(measured(overshoots, rolled_by({40, 10, 3})), infinity);
}

// Only the directions of the quaternions count.
TEST(AttitudeError, DoesNotMindSignsAndIsFineNearZero) {
  Trace trace = rolled_by({0.001, 0.001});
  trace.samples[1].in.vehicle_attitude_setpoint.q_d[0] = -1;
  EXPECT_NEAR(measured(metric(Measure::rms_attitude_error_deg), trace), 0.001, 1e-6);
}

TEST(AttitudeError, OfNaNIsNeverWithinTheBand) {
  Trace trace = rolled_by({0, 0, 0});
  trace.plant[2].q[1] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(measured(metric(Measure::settling_time_s), trace), infinity);
}

TEST(RateError, IsAgainstTheSetpointInForce) {
  Trace trace = rolled_by({0});
  Sample& sample = trace.samples[0];
  trace.plant[0].rate_rad_s = {1, 2, 3};
  sample.out.vehicle_rates_setpoint = {1, 2, 1, 0, 1};
  EXPECT_NEAR(measured(metric(Measure::rms_rate_error_rad_s), trace), 2, 1e-6);
  // The rates setpoint comes from outside: the unit's own output is not used.
  sample.in.vehicle_control_mode.flag_control_attitude_enabled = 0;
  sample.in.vehicle_control_mode.flag_control_manual_enabled = 0;
  sample.in.vehicle_rates_setpoint = {1, 2, 0, 0};
  EXPECT_NEAR(measured(metric(Measure::rms_rate_error_rad_s), trace), 3, 1e-6);
}

TEST(Metric, PeaksDutyAndSink) {
  Trace trace = rolled_by({0, 0, 0, 0});
  trace.plant[1].rate_rad_s = {3, 0, -4};
  trace.plant[2].saturated = 1;
  trace.plant[3].position_m = {0, 0, 1.5f};
  for (Sample& sample : trace.samples) sample.out.mc_att_ctrl_status = {};
  trace.samples[2].out.mc_att_ctrl_status.pitch_rate_integ = -0.25f;
  EXPECT_NEAR(measured(metric(Measure::peak_rate_rad_s), trace), 5, 1e-6);
  EXPECT_EQ(measured(metric(Measure::saturation_duty), trace), 0.25);
  EXPECT_EQ(measured(metric(Measure::peak_integral), trace), 0.25);
  EXPECT_EQ(measured(metric(Measure::sink_m), trace), 1.5);
}

TEST(Metric, VersusAnotherWindowIsARatio) {
  Metric ratio = metric(Measure::rms_attitude_error_deg);
  ratio.window = {0.008, infinity};
  ratio.versus = Window{0, 0.008};
  EXPECT_NEAR(measured(ratio, rolled_by({10, 10, 5, 5})), 0.5, 1e-6);
}

// std::max drops a NaN that comes second, so the peak would be that of the numbers.
TEST(Metric, OfSomethingThatIsNoNumberIsNone) {
  const char* const integrals[] = {"out/mc_att_ctrl_status.roll_rate_integ",
                                   "out/mc_att_ctrl_status.pitch_rate_integ",
                                   "out/mc_att_ctrl_status.yaw_rate_integ"};
  for (const char* name : integrals) {
    Trace trace = rolled_by({1, 1, 1});
    set(trace, 1, name, nan);
    EXPECT_TRUE(std::isnan(measured(metric(Measure::peak_integral), trace))) << name;
  }
  Trace trace = rolled_by({1, 1, 1});
  trace.plant[1].rate_rad_s[2] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(std::isnan(measured(metric(Measure::peak_rate_rad_s), trace)));
  trace.plant[1].q[0] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(std::isnan(measured(metric(Measure::overshoot_deg), trace)));
}

Trace trace_of(Module module, std::size_t ticks) {
  Trace trace;
  trace.present = channels_of(module);
  trace.samples.resize(ticks);
  return trace;
}

// Of the cascade: 2 ms between the rate unit's ticks, 4 ms between the attitude unit's.
TEST(AttitudeSetpoints, AreThoseOfTheAttitudeUnitsLastTick) {
  Trace rate = trace_of(Module::rate_unit, 4), attitude = trace_of(Module::attitude_unit, 2);
  for (std::size_t i = 0; i < 4; ++i) rate.samples[i].in.timestamp = 1000 + 2000 * i;
  for (std::size_t i = 0; i < 2; ++i) {
    Sample& sample = attitude.samples[i];
    sample.in.timestamp = 2000 + 4000 * i;
    sample.attitude_in.vehicle_attitude_setpoint.q_d[0] = static_cast<float>(i + 1);
    sample.attitude_out.vehicle_attitude_setpoint.q_d[0] = static_cast<float>(i + 5);
  }
  auto& mode = attitude.samples[1].attitude_in.vehicle_control_mode;
  const auto first = [&](std::size_t tick) { return attitude_setpoints(rate, &attitude)[tick][0]; };
  EXPECT_EQ(first(0), 1);  // before the first
  EXPECT_EQ(first(1), 1);
  EXPECT_EQ(first(2), 1);
  EXPECT_EQ(first(3), 2);
  mode.flag_control_manual_enabled = 1;
  mode.flag_control_attitude_enabled = 1;
  EXPECT_EQ(first(3), 6);  // of the sticks
  mode.flag_control_altitude_enabled = 1;
  EXPECT_EQ(first(3), 2);
}

TEST(Metrics, OfTheCascadeReadTheRateUnit) {
  Trace rate = trace_of(Module::rate_unit, 1);
  const Trace attitude = trace_of(Module::attitude_unit, 1);
  rate.plant.resize(1);
  Sample& sample = rate.samples[0];
  sample.rate_in.vehicle_rates_setpoint.roll = 3;
  sample.rate_out.vehicle_rates_setpoint.pitch = 5;
  sample.rate_out.rate_ctrl_status.yawspeed_integ = -0.25f;
  EXPECT_EQ(measured(metric(Measure::rms_rate_error_rad_s), rate, &attitude), 3);
  sample.rate_in.vehicle_control_mode.flag_control_manual_enabled = 1;
  EXPECT_EQ(measured(metric(Measure::rms_rate_error_rad_s), rate, &attitude), 5);  // acro
  EXPECT_EQ(measured(metric(Measure::peak_integral), rate, &attitude), 0.25);
}

}  // namespace
}  // namespace attest
