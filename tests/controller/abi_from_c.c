/* The ABI header and a unit as a C11 host sees them. Returns 0, or the line that failed. */
#include <string.h>

#include "controller/attest_unit.h"

int attest_abi_from_c(const attest_unit* unit);

int attest_abi_from_c(const attest_unit* unit) {
  if (unit->abi_version != ATTEST_UNIT_ABI_VERSION) return __LINE__;
  void* self = unit->create("px4-v1.5.5");
  if (self == NULL) return __LINE__;
  if (unit->set_parameter(self, "MC_ROLL_P", 6.5f) != ATTEST_OK) return __LINE__;
  if (unit->set_parameter(self, "NO_SUCH_NAME", 1.0f) != ATTEST_INVALID) return __LINE__;

  attest_inputs in;
  attest_outputs out;
  memset(&in, 0, sizeof in);
  memset(&out, 0, sizeof out);
  in.timestamp = 4000;
  in.updated = ATTEST_UPDATED_VEHICLE_ATTITUDE_SETPOINT | ATTEST_UPDATED_VEHICLE_CONTROL_MODE |
               ATTEST_UPDATED_VEHICLE_STATUS;
  in.control_state.q[0] = 1.0f;
  in.vehicle_attitude_setpoint.q_d[0] = 1.0f;
  in.vehicle_attitude_setpoint.thrust = 0.5f;
  in.vehicle_status.is_rotary_wing = 1;
  in.vehicle_control_mode.flag_control_attitude_enabled = 1;
  in.vehicle_control_mode.flag_control_rates_enabled = 1;
  if (unit->step(self, &in, &out) != ATTEST_OK) return __LINE__;
  if (out.vehicle_rates_setpoint.published != 1) return __LINE__;
  if (out.actuator_controls_0.published != 1) return __LINE__;
  if (out.actuator_controls_0.control[3] < 0.5f) return __LINE__;
  unit->destroy(self);
  return 0;
}
