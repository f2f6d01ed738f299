#include "controller/mc_att_control/unit.hpp"

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "controller/mc_att_control/parameters.hpp"
#include "controller/mc_att_control/profile.hpp"
#include "tests/controller/allocation_count.hpp"
#include "tests/controller/generators.hpp"

extern "C" int attest_abi_from_c(const attest_unit* unit);
extern "C" int attest_actuation_from_c(const attest_unit* unit);

namespace attest::mc_att_control {
namespace {

const attest_unit& unit() { return *mc_att_control_unit(); }

TEST(Unit, WorksFromC) {
  EXPECT_EQ(attest_abi_from_c(mc_att_control_unit()), 0) << "line of abi_from_c";
}

TEST(Unit, HasAMixerAndABatteryEstimate) {
  EXPECT_EQ(attest_actuation_from_c(mc_att_control_unit()), 0) << "line of abi_from_c";
  EXPECT_EQ(attest_actuation_from_c(mc_att_control_unit_in_double()), 0) << "line of abi_from_c";
}

TEST(Unit, KnowsItsProfiles) {
  for (const Profile profile : every_profile) {
    const std::string name(name_of(profile));
    void* const self = unit().create(name.c_str());
    EXPECT_NE(self, nullptr) << name;
    unit().destroy(self);
  }
  EXPECT_EQ(unit().create("px4-v1.0.0"), nullptr);
  EXPECT_EQ(unit().create(""), nullptr);
  EXPECT_EQ(unit().create(nullptr), nullptr);
}

TEST(Unit, TakesEveryParameterOfTheTable) {
  void* const self = unit().create("px4-v1.5.5");
  for (const ParameterInfo& info : parameter_table()) {
    const std::string name(info.name);
    EXPECT_EQ(unit().set_parameter(self, name.c_str(), info.default_value), ATTEST_OK) << name;
  }
  EXPECT_EQ(unit().set_parameter(self, "MC_ROLL_Q", 1.0f), ATTEST_INVALID);
  EXPECT_EQ(unit().set_parameter(self, nullptr, 1.0f), ATTEST_INVALID);
  unit().destroy(self);
}

TEST(Unit, RefusesNull) {
  attest_inputs in{};
  attest_outputs out{};
  EXPECT_EQ(unit().step(nullptr, &in, &out), ATTEST_INVALID);
  EXPECT_EQ(unit().set_parameter(nullptr, "MC_ROLL_P", 1.0f), ATTEST_INVALID);
  unit().destroy(nullptr);
}

// Every topic is fresh. The modes change from step to step, and the attitude rolls by 0.02 rad a
// step.
attest_inputs step_in_mode(unsigned index) {
  attest_inputs in{};
  in.timestamp = 1000000 + 4000ull * index;
  in.updated = 0x1ff;
  in.control_state.q[0] = std::cos(0.01f * static_cast<float>(index));
  in.control_state.q[1] = std::sin(0.01f * static_cast<float>(index));
  in.vehicle_attitude_setpoint.q_d[0] = 1.0f;
  in.vehicle_attitude_setpoint.thrust = 0.5f;
  in.vehicle_control_mode.flag_control_rates_enabled = 1;
  in.vehicle_control_mode.flag_control_attitude_enabled = index % 3 == 0;
  in.vehicle_control_mode.flag_control_manual_enabled = index % 3 == 1;
  in.vehicle_status.is_rotary_wing = 1;
  in.actuator_armed.armed = 1;
  return in;
}

class UnitAllocation : public ::testing::TestWithParam<float> {};

TEST_P(UnitAllocation, NoneInStepOrSetParameter) {
  void* const self = unit().create("px4-v1.5.5");
  unit().set_parameter(self, "VT_OPT_RECOV_EN", GetParam());
  attest_outputs out{};
  const std::size_t before = test::allocation_count();
  for (unsigned i = 0; i < 300; ++i) {
    const attest_inputs in = step_in_mode(i);
    unit().set_parameter(self, "MC_ROLL_P", 6.0f);
    unit().step(self, &in, &out);
  }
  EXPECT_EQ(test::allocation_count(), before);
  unit().destroy(self);
}

INSTANTIATE_TEST_SUITE_P(AttitudeAndRecovery, UnitAllocation, ::testing::Values(0.0f, 1.0f));

TEST(AllocationCount, SeesAnAllocation) {
  const std::size_t before = test::allocation_count();
  const auto owned = std::make_unique<std::vector<int>>(100);
  EXPECT_GE(test::allocation_count(), before + 2);
}

}  // namespace
}  // namespace attest::mc_att_control
