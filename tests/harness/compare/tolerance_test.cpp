#include "harness/compare/tolerance.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/harness/compare/sample_trace.hpp"

namespace attest {
namespace {

using testing::HasSubstr;

TEST(Level, IsReadBackFromItsName) {
  for (const Level level : {Level::exact, Level::numeric, Level::events}) {
    const auto parsed = parse_level(name_of(level));
    ASSERT_TRUE(parsed);
    EXPECT_EQ(*parsed, level);
  }
  const auto unknown = parse_level("strict");
  ASSERT_FALSE(unknown);
  EXPECT_THAT(unknown.error().message, HasSubstr("`strict`; use exact, numeric or events"));
}

TEST(Tolerances, DefaultsAreThoseOfTheQuantity) {
  const Tolerances tolerances;
  const auto absolute = [&](const char* name) { return tolerances.of(channel(name)).absolute; };
  EXPECT_EQ(absolute("out/vehicle_rates_setpoint.yaw"), Tolerances::rate.absolute);
  EXPECT_EQ(absolute("out/vehicle_rates_setpoint.thrust"), Tolerances::passed_through.absolute);
  EXPECT_EQ(absolute("out/actuator_controls_0.control[0]"), Tolerances::control.absolute);
  EXPECT_EQ(absolute("out/mc_att_ctrl_status.yaw_rate_integ"), Tolerances::integral.absolute);
  EXPECT_EQ(absolute("out/actuator_controls_0.published"), 0);
}

TEST(Tolerances, EveryFloatOutputHasOne) {
  const Tolerances tolerances;
  for (std::size_t i = 0; i < channels().size(); ++i) {
    const Channel& what = channels()[i];
    const bool should = what.is_output() && what.type == ChannelType::f32;
    EXPECT_EQ(tolerances.of(i).absolute > 0, should) << what.name;
  }
}

TEST(Tolerances, AreSetForATopicOrAChannel) {
  Tolerances tolerances;
  EXPECT_TRUE(tolerances.set("vehicle_rates_setpoint", {0.5, 0.25}));
  EXPECT_TRUE(tolerances.set("actuator_controls_0.control[2]", {0.75, 0}));
  EXPECT_EQ(tolerances.of(channel("out/vehicle_rates_setpoint.roll")).relative, 0.25);
  EXPECT_EQ(tolerances.of(channel("out/actuator_controls_0.control[2]")).absolute, 0.75);
  EXPECT_EQ(tolerances.of(channel("out/actuator_controls_0.control[1]")).absolute,
            Tolerances::control.absolute);
  EXPECT_EQ(tolerances.of(channel("out/vehicle_rates_setpoint.published")).absolute, 0);
}

TEST(Tolerances, AreNotSetForWhatIsNoFloatOutput) {
  Tolerances tolerances;
  for (const char* name : {"vehicle_rate_setpoint", "control_state", "out/vehicle_rates_setpoint",
                           "vehicle_rates_setpoint.published", "vehicle_rates_setpoint.rolls"}) {
    EXPECT_FALSE(tolerances.set(name, {1, 0})) << name;
  }
}

// At the exact level a case's tolerances are accepted, but have no effect.
TEST(Tolerances, TheExactLevelHasNone) {
  Tolerances tolerances(Level::exact);
  EXPECT_TRUE(tolerances.set("vehicle_rates_setpoint", {0.5, 0}));
  for (std::size_t i = 0; i < channels().size(); ++i) {
    EXPECT_EQ(tolerances.of(i).absolute, 0);
    EXPECT_EQ(tolerances.of(i).relative, 0);
  }
}

TEST(Tolerances, OfFixedPointAreAtLeastItsLsbs) {
  const std::size_t yaw = channel("out/vehicle_rates_setpoint.yaw");
  const std::size_t integral = channel("out/mc_att_ctrl_status.yaw_rate_integ");
  Tolerances coarse;
  coarse.allow_lsb(22);
  EXPECT_DOUBLE_EQ(coarse.of(yaw).absolute, Tolerances::rate_lsb / (1 << 22));
  EXPECT_DOUBLE_EQ(coarse.of(integral).absolute, Tolerances::integral_lsb / (1 << 22));
  EXPECT_EQ(coarse.of(channel("out/actuator_controls_0.published")).absolute, 0);
  // Fixed point rounds only computed values.
  for (std::size_t i = 0; i < channels().size(); ++i) {
    const Quantity quantity = channels()[i].quantity;
    const bool is_computed =
        channels()[i].is_output() && quantity != Quantity::flag && quantity != Quantity::time;
    if (is_computed) continue;
    EXPECT_EQ(coarse.of(i).absolute, Tolerances().of(i).absolute) << channels()[i].name;
    EXPECT_EQ(coarse.of(i).relative, Tolerances().of(i).relative) << channels()[i].name;
  }
  // An integral may be off by one more LSB for each tick of a flight.
  Tolerances of_flight;
  of_flight.allow_lsb(22, 1000);
  EXPECT_EQ(of_flight.of(yaw).absolute, coarse.of(yaw).absolute);
  EXPECT_DOUBLE_EQ(of_flight.of(integral).absolute, (Tolerances::integral_lsb + 1000) / (1 << 22));
  EXPECT_DOUBLE_EQ(of_flight.of(channel("out/actuator_controls_0.control[1]")).absolute,
                   (Tolerances::control_lsb + 1000) / (1 << 22));
  Tolerances fine;
  fine.allow_lsb(32);
  EXPECT_EQ(fine.of(yaw).absolute, Tolerances::rate.absolute);
  Tolerances exact(Level::exact);
  exact.allow_lsb(22);
  EXPECT_EQ(exact.of(yaw).absolute, 0);
}

TEST(Tolerances, AreScaledAltogether) {
  const Tolerances tenth = Tolerances().scaled(0.1);
  const Tolerance rate = tenth.of(channel("out/vehicle_rates_setpoint.yaw"));
  EXPECT_DOUBLE_EQ(rate.absolute, 0.1 * Tolerances::rate.absolute);
  EXPECT_DOUBLE_EQ(rate.relative, 0.1 * Tolerances::rate.relative);
  EXPECT_DOUBLE_EQ(tenth.widening(3, 6.5), 0.1 * Tolerances().widening(3, 6.5));
}

TEST(Tolerances, WideningGrowsTowards180DegreesAndEndsNearIt) {
  constexpr double pi = 3.14159265358979;
  EXPECT_NEAR(Tolerances().widening(pi - 1, 6.5), 3e-6, 1e-12);
  EXPECT_NEAR(Tolerances().widening(pi - 1, 13), 6e-6, 1e-12);
  EXPECT_NEAR(Tolerances().widening(pi - 0.01, 6.5), 3e-4, 1e-9);
  EXPECT_EQ(Tolerances().widening(pi, 6.5), Tolerances().widening(pi - 1e-3, 6.5));
  EXPECT_LT(Tolerances().widening(pi, 6.5), 2e-3);
}

}  // namespace
}  // namespace attest
