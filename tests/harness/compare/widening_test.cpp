// Near a tilt error of 180 deg the tolerance of the rates setpoint is wider: when, and how much.
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "harness/compare/compare.hpp"
#include "tests/harness/compare/sample_trace.hpp"

namespace attest {
namespace {

constexpr const char* roll = "out/vehicle_rates_setpoint.roll";
constexpr double default_tolerance = Tolerances::rate.absolute;

// 179.5 deg away from a level setpoint: this allows 3e-6/8.7e-3 = 3.4e-4 more.
Trace nearly_upside_down() {
  Trace trace = sample_trace(1);
  const double half = 179.5 * std::numbers::pi / 360;
  set(trace, 0, "in/control_state.q[0]", std::cos(half));
  set(trace, 0, "in/control_state.q[1]", std::sin(half));
  set(trace, 0, roll, 0);
  return trace;
}

bool agrees(const Trace& want, double off_by, const Tolerances& tolerances = Tolerances(),
            const char* name = roll) {
  Trace got = want;
  const Channel& what = channels()[channel(name)];
  set(got, 0, name, value_of(what, want.samples[0]) + off_by);
  return compare(got, want, tolerances).agrees();
}

TEST(Widening, AppliesToTheRatesSetpointNear180Degrees) {
  EXPECT_FALSE(agrees(sample_trace(1), 2 * default_tolerance));
  EXPECT_TRUE(agrees(nearly_upside_down(), 2 * default_tolerance));
  EXPECT_FALSE(agrees(nearly_upside_down(), 3 * default_tolerance));
  EXPECT_FALSE(agrees(nearly_upside_down(), 2 * Tolerances::control.absolute, Tolerances(),
                      "out/actuator_controls_0.control[0]"));
}

// A deviation that is allowed without the widening, too: its headroom is that of the wider one.
TEST(Widening, CountsInTheHeadroom) {
  const Trace want = nearly_upside_down();
  Trace got = want;
  set(got, 0, roll, default_tolerance / 2);
  const auto tightest = compare(got, want, Tolerances()).tightest;
  ASSERT_TRUE(tightest);
  EXPECT_NEAR(tightest->ratio, 2 * (default_tolerance + 3.4e-4) / default_tolerance, 0.1);
}

TEST(Widening, IsAddedToATolerancesOfTheCase) {
  Tolerances none;
  none.set("vehicle_rates_setpoint", {0, 0});
  EXPECT_TRUE(agrees(nearly_upside_down(), 3.3e-4, none));
  EXPECT_FALSE(agrees(nearly_upside_down(), 3.6e-4, none));
}

TEST(Widening, IsNotForTheExactLevel) {
  EXPECT_FALSE(agrees(nearly_upside_down(), 1e-7, Tolerances(Level::exact)));
}

TEST(Widening, IsNotForModesWithoutAttitude) {
  Trace acro = nearly_upside_down();
  set(acro, 0, "in/vehicle_control_mode.flag_control_attitude_enabled", 0);
  EXPECT_FALSE(agrees(acro, 2 * default_tolerance));
}

TEST(Widening, GrowsWithTheGainInForce) {
  Trace trace = nearly_upside_down();
  trace.parameters = {{0, "MC_PITCH_P", 13}};
  EXPECT_TRUE(agrees(trace, 4 * default_tolerance));
  EXPECT_FALSE(agrees(trace, 5 * default_tolerance));
}

// An unbounded gain must not make the tolerance unbounded.
TEST(Widening, ATimeConstantOfZeroWidensNothing) {
  Trace trace = nearly_upside_down();
  trace.parameters = {{0, "MC_ROLL_TC", 0}};
  EXPECT_FALSE(agrees(trace, 2 * default_tolerance));
}

TEST(Widening, NothingIsWiderWithoutASetpoint) {
  Trace trace = nearly_upside_down();
  set(trace, 0, "in/vehicle_attitude_setpoint.q_d[0]", 0);
  EXPECT_FALSE(agrees(trace, 2 * default_tolerance));
}

// The law keeps the setpoint that was published, although a later row of a recording shows another.
TEST(Widening, IsByTheSetpointLastPublished) {
  Trace trace = nearly_upside_down();
  trace.samples.push_back(trace.samples[0]);
  trace.samples[1].in.timestamp += 4000;
  trace.samples[1].in.updated = 0;
  for (int i = 0; i < 4; ++i) trace.samples[1].in.vehicle_attitude_setpoint.q_d[i] = 0;
  Trace got = trace;
  set(got, 1, roll, 2 * default_tolerance);
  EXPECT_TRUE(compare(got, trace, Tolerances()).agrees());
}

}  // namespace
}  // namespace attest
