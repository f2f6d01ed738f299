#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/port/port.hpp"

namespace attest {
namespace {

using testing::HasSubstr;

TEST(Builtin, IsTheReference) {
  const auto port = open_port("builtin");
  ASSERT_TRUE(port);
  EXPECT_FALSE((*port)->name().empty());
  EXPECT_FALSE((*port)->version().empty());
}

TEST(Builtin, MakesUnitsOfItsProfilesOnly) {
  const auto port = open_port("builtin");
  ASSERT_TRUE(port);
  EXPECT_NE((*port)->create("px4-v1.5.5"), nullptr);
  EXPECT_NE((*port)->create("px4-v1.3.4"), nullptr);
  EXPECT_EQ((*port)->create("px4-v9.9.9"), nullptr);
  EXPECT_EQ((*port)->create(""), nullptr);
}

TEST(FractionBits, AreThoseOfTheArithmetic) {
  EXPECT_EQ(parse_fraction_bits("fixed:16").value(), 16);
  EXPECT_EQ(parse_fraction_bits("fixed:32").value(), 32);
  for (const char* text :
       {"", "fixed", "fixed:", "fixed:15", "fixed:33", "fixed:22x", "float", "22"}) {
    const auto bits = parse_fraction_bits(text);
    ASSERT_FALSE(bits) << text;
    EXPECT_THAT(bits.error().message, HasSubstr("must be `fixed:BITS`, from 16 to 32"));
  }
}

TEST(Builtin, UnitsAreIndependent) {
  const auto port = open_port("builtin");
  ASSERT_TRUE(port);
  const auto changed = (*port)->create("px4-v1.5.5");
  const auto other = (*port)->create("px4-v1.5.5");
  EXPECT_EQ(changed->set_parameter("MC_ROLL_P", 1.0f), ATTEST_OK);
  EXPECT_EQ(changed->set_parameter("MC_ROL_P", 1.0f), ATTEST_INVALID);

  attest_inputs in{};
  in.timestamp = 1000;
  in.updated = ATTEST_UPDATED_VEHICLE_CONTROL_MODE | ATTEST_UPDATED_VEHICLE_ATTITUDE_SETPOINT |
               ATTEST_UPDATED_VEHICLE_STATUS | ATTEST_UPDATED_PARAMETER_UPDATE;
  in.control_state.q[0] = 1;
  in.vehicle_attitude_setpoint.q_d[0] = 0.8f;
  in.vehicle_attitude_setpoint.q_d[1] = 0.6f;
  in.vehicle_control_mode.flag_control_attitude_enabled = 1;
  in.vehicle_control_mode.flag_control_rates_enabled = 1;
  attest_outputs of_changed{}, of_other{};
  EXPECT_EQ(changed->step(in, of_changed), ATTEST_OK);
  EXPECT_EQ(other->step(in, of_other), ATTEST_OK);
  EXPECT_NE(of_changed.vehicle_rates_setpoint.roll, of_other.vehicle_rates_setpoint.roll);
}

TEST(OpenPort, NamesTheKindsThereAre) {
  for (const char* specification : {"", "bultin", "libmine", "LIB:x", "prog:x"}) {
    const auto port = open_port(specification);
    ASSERT_FALSE(port) << specification;
    EXPECT_THAT(port.error().message,
                HasSubstr("use one of `builtin`, `lib:PATH`, `proc:COMMAND`, `fault:ID`"));
  }
}

}  // namespace
}  // namespace attest
