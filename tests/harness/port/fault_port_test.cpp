#include "harness/port/fault_port.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/port/builtin.hpp"

namespace attest {
namespace {

// The outputs of one step with a tilt and a yaw error, and more thrust than MC_TPA_BREAK.
attest_outputs answer_of(Port& port) {
  const auto unit = port.create("px4-v1.5.5");
  unit->set_parameter("MC_TPA_BREAK", 0.3f);
  attest_inputs in{};
  in.timestamp = 1000;
  in.updated = ATTEST_UPDATED_VEHICLE_CONTROL_MODE | ATTEST_UPDATED_VEHICLE_ATTITUDE_SETPOINT |
               ATTEST_UPDATED_VEHICLE_STATUS | ATTEST_UPDATED_PARAMETER_UPDATE;
  in.control_state.q[0] = 1;
  in.control_state.roll_rate = 0.5f;
  const float half_tilt = 0.35f, half_yaw = 0.2f;
  in.vehicle_attitude_setpoint.q_d[0] = std::cos(half_yaw) * std::cos(half_tilt);
  in.vehicle_attitude_setpoint.q_d[1] = std::cos(half_yaw) * std::sin(half_tilt);
  in.vehicle_attitude_setpoint.q_d[2] = std::sin(half_yaw) * std::sin(half_tilt);
  in.vehicle_attitude_setpoint.q_d[3] = std::sin(half_yaw) * std::cos(half_tilt);
  in.vehicle_attitude_setpoint.thrust = 0.8f;
  in.vehicle_control_mode.flag_control_attitude_enabled = 1;
  in.vehicle_control_mode.flag_control_rates_enabled = 1;
  attest_outputs out{};
  EXPECT_EQ(unit->step(in, out), ATTEST_OK);
  return out;
}

attest_outputs answer_of(const char* faults) {
  const auto port = open_fault(faults);
  EXPECT_TRUE(port) << port.error().to_string();
  return answer_of(**port);
}

TEST(FaultPort, HasAllFaultsThatItNames) {
  const attest_outputs law = answer_of(*open_builtin());
  const attest_outputs yaw = answer_of("yaw-weight-dropped"), tpa = answer_of("tpa-missing");
  const float law_yaw = law.vehicle_rates_setpoint.yaw;
  const float law_roll = law.actuator_controls_0.control[0];
  ASSERT_NE(yaw.vehicle_rates_setpoint.yaw, law_yaw);
  ASSERT_EQ(yaw.actuator_controls_0.control[0], law_roll);
  ASSERT_EQ(tpa.vehicle_rates_setpoint.yaw, law_yaw);
  ASSERT_NE(tpa.actuator_controls_0.control[0], law_roll);
  for (const char* both : {"yaw-weight-dropped+tpa-missing", "tpa-missing+yaw-weight-dropped"}) {
    const attest_outputs out = answer_of(both);
    EXPECT_EQ(out.vehicle_rates_setpoint.yaw, yaw.vehicle_rates_setpoint.yaw) << both;
    EXPECT_EQ(out.actuator_controls_0.control[0], tpa.actuator_controls_0.control[0]) << both;
  }
}

TEST(FaultPort, OneThatIsNotInTheCatalogueIsAnError) {
  const auto port = open_fault("tpa-misssing");
  ASSERT_FALSE(port);
  EXPECT_THAT(port.error().message, testing::HasSubstr("did you mean `tpa-missing`"));
}

}  // namespace
}  // namespace attest
