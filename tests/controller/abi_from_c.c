/* The ABI header and a unit as a C11 host sees them. Returns 0, or the line that failed. */
#include <string.h>

#include "controller/attest_actuation.h"
#include "controller/attest_cascade.h"
#include "controller/attest_unit.h"

int attest_actuation_from_c(const attest_unit* unit);
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

int attest_actuation_from_c(const attest_unit* unit) {
  const attest_mixer* mixer = unit->extension(ATTEST_EXTENSION_MIXER);
  const attest_battery_status* battery = unit->extension(ATTEST_EXTENSION_BATTERY_STATUS);
  if (unit->extension("no.such.extension") != NULL) return __LINE__;
  if (mixer == NULL || battery == NULL) return __LINE__;
  if (mixer->create("px4-v1.0.0", "R: 4x 10000 10000 10000 0") != NULL) return __LINE__;
  if (mixer->create("px4-v1.5.5", "R: 5x 10000 10000 10000 0") != NULL) return __LINE__;
  if (battery->create("px4-v1.0.0") != NULL) return __LINE__;

  void* self = mixer->create("px4-v1.5.5", "R: 4x 10000 10000 10000 0");
  if (self == NULL) return __LINE__;
  attest_mixer_inputs controls;
  attest_mixer_outputs motors;
  memset(&controls, 0, sizeof controls);
  memset(&motors, 0, sizeof motors);
  controls.actuator_controls_0.control[3] = 0.75f;
  if (mixer->step(self, &controls, &motors) != ATTEST_OK) return __LINE__;
  if (mixer->step(self, NULL, &motors) != ATTEST_INVALID) return __LINE__;
  for (int i = 0; i < 4; ++i) {
    if (motors.actuator_outputs.output[i] < 0.5f) return __LINE__;
  }
  if (motors.multirotor_motor_limits.upper_limit != 0) return __LINE__;
  mixer->destroy(self);

  self = battery->create("px4-v1.5.5");
  if (self == NULL) return __LINE__;
  attest_battery_inputs sample = {{10.2f, 0.0f, 0.0f, 0}};
  attest_battery_outputs status = {{0.0f}};
  if (battery->set_parameter(self, "BAT_N_CELLS", -1.0f) != ATTEST_INVALID) return __LINE__;
  if (battery->set_parameter(self, "BAT_N_CELLS", 3.0f) != ATTEST_OK) return __LINE__;
  for (int i = 0; i < 1000; ++i) {
    if (battery->step(self, &sample, &status) != ATTEST_OK) return __LINE__;
  }
  if (status.battery_status.scale < 1.19f) return __LINE__;
  if (battery->set_parameter(self, "BAT_N_CELLS", 4.0f) != ATTEST_INVALID) return __LINE__;
  battery->destroy(self);
  return 0;
}
