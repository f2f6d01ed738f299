// Threads on the real clock. Their lateness depends on the machine, so the tests assert only
// facts that hold for any lateness.
#include "harness/realtime/live_flight.hpp"

#include <gtest/gtest.h>

#include "harness/casefile/parse.hpp"
#include "harness/compare/compare.hpp"
#include "harness/loop/flight.hpp"
#include "harness/loop/open_loop.hpp"
#include "harness/port/builtin.hpp"

namespace attest {
namespace {

const std::filesystem::path source = ATTEST_SOURCE_DIR;

const RunConfiguration configuration{Rate::hz(500), PlantConfiguration{"iris", PlantKind::mujoco}};

LiveOptions options() {
  LiveOptions live;
  live.plant_cpu = usable_cpus().front();
  live.unit_cpu = usable_cpus().back();
  live.fifo = false;
  return live;
}

Case tilt_case(double duration_s) {
  Case tilt = *parse_case(source / "cases/px4-v1.5.5/flight/tilt_step_30.toml");
  tilt.duration = {duration_s, Span::In::seconds};
  return tilt;
}

const RunConfiguration of_cascade{LoopRate(Rate::hz(250), Rate::hz(1000)),
                                  PlantConfiguration{"iris", PlantKind::mujoco}};

Case cascade_case(const char* name, double duration_s) {
  Case the_case = *parse_case(source / "cases/px4-v1.16.0/flight" / name);
  the_case.duration = {duration_s, Span::In::seconds};
  return the_case;
}

PortUnits units_of(const Case& the_case) {
  const auto port = open_builtin();
  return *units_for(the_case, *port);
}

LiveFlight flown(const Case& the_case, const std::function<bool()>& stop) {
  const auto iris = *VehicleModel::load(source / "models", "iris");
  const LivePlan plan{the_case.attitude_loop ? of_cascade : configuration, options(), 1000};
  auto flight = fly_live(the_case, plan, *iris, units_of(the_case).for_flight(), {.stop = stop});
  if (!flight) throw std::runtime_error(flight.error().to_string());
  return std::move(*flight);
}

void expect_ordered(const LoopTiming& timing) {
  for (std::size_t i = 0; i < timing.size(); ++i) {
    EXPECT_LE(timing[i].sampled, timing[i].begins);
    EXPECT_LE(timing[i].begins, timing[i].commanded.value_or(timing[i].begins));
    if (i == 0) continue;
    EXPECT_LE(timing[i - 1].sampled, timing[i].sampled);
    EXPECT_LT(timing[i - 1].begins, timing[i].begins);
  }
}

TEST(LiveFlight, EveryReleaseIsUsedOrSkipped) {
  const LiveFlight flight = flown(tilt_case(0.4), [] { return false; });
  EXPECT_FALSE(flight.unit.fault);
  EXPECT_FALSE(flight.plant.divergence);
  EXPECT_EQ(flight.unit.ticks.size() + flight.unit.skipped, 200u);
  for (const LiveTick& tick : flight.unit.ticks) EXPECT_GE(tick.latency(), Nanoseconds(0));
  EXPECT_EQ(flight.unit.samples.size(), flight.unit.ticks.size());
}

TEST(LiveFlight, ItsTimesCanBeFlownAgain) {
  const Case the_case = tilt_case(0.4);
  const LiveFlight live = flown(the_case, [] { return false; });
  const FlightTiming timing = live.timing();
  expect_ordered(timing.unit);
  const auto iris = *VehicleModel::load(source / "models", "iris");
  const auto unit = open_builtin()->create("px4-v1.5.5");
  const Flown again = *fly(the_case, configuration, *iris, *unit, timing);
  ASSERT_EQ(again.trace.samples.size(), live.unit.samples.size());
  // MuJoCo's steps are cut at other times, so the replay is not equal to the bit. The bound is far
  // below any effect on the unit.
  for (std::size_t i = 0; i < again.trace.samples.size(); ++i) {
    const attest_inputs& then = live.unit.samples[i].in;
    const attest_inputs& now = again.trace.samples[i].in;
    ASSERT_EQ(then.timestamp, now.timestamp);
    ASSERT_NEAR(then.control_state.roll_rate, now.control_state.roll_rate, 1e-4) << i;
    ASSERT_EQ(then.multirotor_motor_limits.upper_limit, now.multirotor_motor_limits.upper_limit);
  }
}

TEST(LiveFlight, EveryReleaseOfBothUnitsIsUsedOrSkipped) {
  const LiveFlight flight = flown(cascade_case("hover.toml", 0.4), [] { return false; });
  EXPECT_FALSE(flight.unit.fault);
  EXPECT_FALSE(flight.attitude_unit->fault);
  EXPECT_FALSE(flight.plant.divergence);
  EXPECT_EQ(flight.unit.ticks.size() + flight.unit.skipped, 400u);
  EXPECT_EQ(flight.attitude_unit->ticks.size() + flight.attitude_unit->skipped, 100u);
}

// In flight, and from the floor.
TEST(LiveFlight, TheTimesOfTheCascadeCanBeFlownAgain) {
  for (const char* name : {"tilt_step_30.toml", "takeoff.toml"}) {
    const Case the_case = cascade_case(name, 0.4);
    const LiveFlight live = flown(the_case, [] { return false; });
    const FlightTiming timing = live.timing();
    expect_ordered(timing.unit);
    expect_ordered(timing.attitude_unit);
    const auto iris = *VehicleModel::load(source / "models", "iris");
    const PortUnits units = units_of(the_case);
    const Flown again = *fly(the_case, of_cascade, *iris, units.for_flight(), timing);
    ASSERT_EQ(again.trace.samples.size(), live.unit.samples.size());
    for (std::size_t i = 0; i < again.trace.samples.size(); ++i) {
      const attest_rate_inputs& then = live.unit.samples[i].rate_in;
      const attest_rate_inputs& now = again.trace.samples[i].rate_in;
      ASSERT_EQ(then.timestamp, now.timestamp);
      ASSERT_EQ(then.updated & ATTEST_RATE_UPDATED_VEHICLE_RATES_SETPOINT,
                now.updated & ATTEST_RATE_UPDATED_VEHICLE_RATES_SETPOINT)
          << name << " " << i;
      ASSERT_NEAR(then.vehicle_rates_setpoint.pitch, now.vehicle_rates_setpoint.pitch, 1e-3) << i;
      ASSERT_NEAR(then.vehicle_angular_velocity.xyz[1], now.vehicle_angular_velocity.xyz[1], 1e-4);
      ASSERT_NEAR(live.unit.samples[i].rate_out.vehicle_torque_setpoint.xyz[1],
                  again.trace.samples[i].rate_out.vehicle_torque_setpoint.xyz[1], 1e-3)
          << name << " " << i;
    }
    const std::vector<Sample>& attitude = again.attitude_trace->samples;
    ASSERT_EQ(attitude.size(), live.attitude_unit->samples.size());
    for (std::size_t i = 0; i < attitude.size(); ++i) {
      const Sample& then = live.attitude_unit->samples[i];
      ASSERT_EQ(then.attitude_in.timestamp, attitude[i].attitude_in.timestamp);
      ASSERT_NEAR(then.attitude_in.vehicle_attitude.q[2],
                  attitude[i].attitude_in.vehicle_attitude.q[2], 1e-4);
      ASSERT_NEAR(then.attitude_out.vehicle_rates_setpoint.pitch,
                  attitude[i].attitude_out.vehicle_rates_setpoint.pitch, 1e-3)
          << name << " " << i;
    }
  }
}

TEST(LiveFlight, TheEstimatorMayTriggerTheUnit) {
  Case the_case = tilt_case(0.4);
  the_case.unit.on_estimate = true;
  const LiveFlight flight = flown(the_case, [] { return false; });
  EXPECT_FALSE(flight.unit.fault);
  EXPECT_FALSE(flight.plant.divergence);
  EXPECT_EQ(flight.unit.ticks.size() + flight.unit.skipped, 200u);
  for (std::size_t i = 0; i < flight.unit.ticks.size(); ++i) {
    const LiveTick& tick = flight.unit.ticks[i];
    EXPECT_LE(tick.sampled, tick.begins);
    if (i == 0) continue;
    EXPECT_LT(flight.unit.ticks[i - 1].sampled, tick.sampled);  // each is used once
  }
}

TEST(LiveFlight, WhatItComputesDoesNotDependOnTheThreads) {
  LiveFlight flight = flown(tilt_case(0.2), [] { return false; });
  Trace trace;
  trace.present = channels_of(Module::mc_att_control);
  trace.samples = flight.unit.samples;
  trace.parameters = flight.unit.changes;
  Trace again = trace;
  const auto unit = open_builtin()->create("px4-v1.5.5");
  ASSERT_FALSE(drive(*unit, again));
  EXPECT_TRUE(compare(trace, again, Tolerances(Level::exact)).agrees());
}

TEST(LiveFlight, EndsWhenItIsAsked) {
  const LiveFlight flight = flown(tilt_case(60), [] { return true; });
  EXPECT_LT(flight.unit.ticks.size(), 20'000u);
}

// The last scale of battery_status: an emptier battery has a larger scale.
float last_scale(const std::vector<Sample>& samples) {
  return samples.back().in.battery_status.scale;
}

TEST(LiveFlight, ABatteryEmptiesAndItsScaleReachesTheUnit) {
  Case the_case = *parse_case(source / "cases/px4-v1.5.5/flight/battery_scaled.toml");
  the_case.duration = {0.5, Span::In::seconds};
  the_case.flight->battery->charge = 0.05;
  const LiveFlight live = flown(the_case, [] { return false; });
  EXPECT_FALSE(live.plant.divergence);
  ASSERT_FALSE(live.unit.samples.empty());
  std::size_t published = 0;
  for (const Sample& sample : live.unit.samples) {
    published += (sample.in.updated & ATTEST_UPDATED_BATTERY_STATUS) != 0 ? 1 : 0;
  }
  // It is published at 100 Hz; on a late machine, newer samples replace some.
  EXPECT_GE(published, 2u);
  EXPECT_LE(published, 51u);
  const auto iris = *VehicleModel::load(source / "models", "iris");
  const auto unit = open_builtin()->create("px4-v1.5.5");
  const Flown again = *fly(the_case, configuration, *iris, *unit, live.timing());
  ASSERT_EQ(again.trace.samples.size(), live.unit.samples.size());
  EXPECT_NEAR(last_scale(live.unit.samples), last_scale(again.trace.samples), 2e-3);
  EXPECT_GT(last_scale(again.trace.samples), 1.005f);
}

TEST(IdleLatency, IsOfEveryReleaseThatItWaitedFor) {
  const Histogram idle =
      idle_latency(Rate::hz(1000), std::chrono::milliseconds(50), options(), [] { return false; });
  EXPECT_GE(idle.count(), 1u);
  EXPECT_LE(idle.count(), 50u);
  EXPECT_GE(idle.min(), Nanoseconds(0));
}

}  // namespace
}  // namespace attest
