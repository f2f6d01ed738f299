/* SPDX-License-Identifier: BSD-3-Clause */
/* A port in the manner of generated code: the model of mc_att_control.h behind the C ABI. */
#include <attest_unit.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "mc_att_control.h"

typedef struct {
  RT_MODEL model;
  P_T tuned; /* becomes the model's at the next parameter_update */
  boolean_T running;
} Instance;

#define TUNABLE(name, member) \
  { name, offsetof(P_T, member) }

static const struct {
  const char* name;
  size_t offset;
} tunables[] = {
    TUNABLE("MC_ROLL_P", ATT_P[0]),
    TUNABLE("MC_PITCH_P", ATT_P[1]),
    TUNABLE("MC_YAW_P", ATT_P[2]),
    TUNABLE("MC_ROLL_TC", ATT_TC[0]),
    TUNABLE("MC_PITCH_TC", ATT_TC[1]),
    TUNABLE("MC_ROLLRATE_P", RATE_P[0]),
    TUNABLE("MC_PITCHRATE_P", RATE_P[1]),
    TUNABLE("MC_YAWRATE_P", RATE_P[2]),
    TUNABLE("MC_ROLLRATE_I", RATE_I[0]),
    TUNABLE("MC_PITCHRATE_I", RATE_I[1]),
    TUNABLE("MC_YAWRATE_I", RATE_I[2]),
    TUNABLE("MC_ROLLRATE_D", RATE_D[0]),
    TUNABLE("MC_PITCHRATE_D", RATE_D[1]),
    TUNABLE("MC_YAWRATE_D", RATE_D[2]),
    TUNABLE("MC_ROLLRATE_FF", RATE_FF[0]),
    TUNABLE("MC_PITCHRATE_FF", RATE_FF[1]),
    TUNABLE("MC_YAWRATE_FF", RATE_FF[2]),
    TUNABLE("MC_ROLLRATE_MAX", RATE_MAX[0]),
    TUNABLE("MC_PITCHRATE_MAX", RATE_MAX[1]),
    TUNABLE("MC_YAWRATE_MAX", RATE_MAX[2]),
    TUNABLE("MC_YAWRAUTO_MAX", YAWRAUTO_MAX),
    TUNABLE("MC_ACRO_R_MAX", ACRO_MAX[0]),
    TUNABLE("MC_ACRO_P_MAX", ACRO_MAX[1]),
    TUNABLE("MC_ACRO_Y_MAX", ACRO_MAX[2]),
    TUNABLE("MC_YAW_FF", YAW_FF),
    TUNABLE("MC_RATT_TH", RATT_TH),
    TUNABLE("MC_TPA_BREAK", TPA_BREAK),
    TUNABLE("MC_TPA_SLOPE", TPA_SLOPE),
    TUNABLE("MC_BAT_SCALE_EN", BAT_SCALE_EN),
    TUNABLE("VT_WV_YAWR_SCL", WV_YAWR_SCL),
    TUNABLE("VT_TYPE", VT_TYPE),
    TUNABLE("VT_OPT_RECOV_EN", VT_OPT_RECOV_EN),
    TUNABLE("CBRK_RATE_CTRL", CBRK_RATE_CTRL),
};

static void* create(const char* profile) {
  Instance* instance;
  LawVersion law;
  if (strcmp(profile, "px4-v1.5.5") == 0) {
    law = Law_v1_5_5;
  } else if (strcmp(profile, "px4-v1.3.4") == 0) {
    law = Law_v1_3_4;
  } else {
    return NULL;
  }
  instance = malloc(sizeof(Instance));
  if (instance != NULL) {
    mc_att_control_initialize(&instance->model, law);
    instance->tuned = instance->model.rtP;
    instance->running = false;
  }
  return instance;
}

static void destroy(void* self) { free(self); }

static int set_parameter(void* self, const char* name, float value) {
  Instance* instance = self;
  size_t i;
  for (i = 0; i < sizeof(tunables) / sizeof(tunables[0]); i++) {
    if (strcmp(tunables[i].name, name) == 0) {
      memcpy((char*)&instance->tuned + tunables[i].offset, &value, sizeof(value));
      return ATTEST_OK;
    }
  }
  return ATTEST_INVALID;
}

static void read_setpoints(ExtU_T* rtU, const attest_inputs* in) {
  const uint32_t updated = in->updated;
  memcpy(rtU->attitude_sp.q_d, in->vehicle_attitude_setpoint.q_d, sizeof(rtU->attitude_sp.q_d));
  rtU->attitude_sp.thrust = in->vehicle_attitude_setpoint.thrust;
  rtU->attitude_sp.yaw_sp_move_rate = in->vehicle_attitude_setpoint.yaw_sp_move_rate;
  rtU->attitude_sp.landing_gear = in->vehicle_attitude_setpoint.landing_gear;
  rtU->attitude_sp.disable_mc_yaw_control =
      in->vehicle_attitude_setpoint.disable_mc_yaw_control != 0;
  rtU->attitude_sp_new = (updated & ATTEST_UPDATED_VEHICLE_ATTITUDE_SETPOINT) != 0;
  rtU->rates_sp.rates[0] = in->vehicle_rates_setpoint.roll;
  rtU->rates_sp.rates[1] = in->vehicle_rates_setpoint.pitch;
  rtU->rates_sp.rates[2] = in->vehicle_rates_setpoint.yaw;
  rtU->rates_sp.thrust = in->vehicle_rates_setpoint.thrust;
  rtU->rates_sp_new = (updated & ATTEST_UPDATED_VEHICLE_RATES_SETPOINT) != 0;
  rtU->manual.x = in->manual_control_setpoint.x;
  rtU->manual.y = in->manual_control_setpoint.y;
  rtU->manual.z = in->manual_control_setpoint.z;
  rtU->manual.r = in->manual_control_setpoint.r;
  rtU->manual_new = (updated & ATTEST_UPDATED_MANUAL_CONTROL_SETPOINT) != 0;
}

static void read_vehicle(ExtU_T* rtU, const attest_inputs* in) {
  const uint32_t updated = in->updated;
  rtU->timestamp = in->timestamp;
  memcpy(rtU->q, in->control_state.q, sizeof(rtU->q));
  rtU->rates[0] = in->control_state.roll_rate;
  rtU->rates[1] = in->control_state.pitch_rate;
  rtU->rates[2] = in->control_state.yaw_rate;
  rtU->battery_scale = in->battery_status.scale;
  rtU->battery_new = (updated & ATTEST_UPDATED_BATTERY_STATUS) != 0;
  rtU->mode.manual_enabled = in->vehicle_control_mode.flag_control_manual_enabled != 0;
  rtU->mode.auto_enabled = in->vehicle_control_mode.flag_control_auto_enabled != 0;
  rtU->mode.rates_enabled = in->vehicle_control_mode.flag_control_rates_enabled != 0;
  rtU->mode.attitude_enabled = in->vehicle_control_mode.flag_control_attitude_enabled != 0;
  rtU->mode.rattitude_enabled = in->vehicle_control_mode.flag_control_rattitude_enabled != 0;
  rtU->mode.velocity_enabled = in->vehicle_control_mode.flag_control_velocity_enabled != 0;
  rtU->mode_new = (updated & ATTEST_UPDATED_VEHICLE_CONTROL_MODE) != 0;
  rtU->armed = in->actuator_armed.armed != 0;
  rtU->armed_new = (updated & ATTEST_UPDATED_ACTUATOR_ARMED) != 0;
  rtU->status.is_rotary_wing = in->vehicle_status.is_rotary_wing != 0;
  rtU->status.is_vtol = in->vehicle_status.is_vtol != 0;
  rtU->status_new = (updated & ATTEST_UPDATED_VEHICLE_STATUS) != 0;
  rtU->limits.lower_limit = in->multirotor_motor_limits.lower_limit != 0;
  rtU->limits.upper_limit = in->multirotor_motor_limits.upper_limit != 0;
  rtU->limits.yaw = in->multirotor_motor_limits.yaw != 0;
  rtU->limits_new = (updated & ATTEST_UPDATED_MULTIROTOR_MOTOR_LIMITS) != 0;
}

static void write_outputs(const ExtY_T* rtY, attest_outputs* out) {
  out->vehicle_rates_setpoint.roll = rtY->rates_sp.rates[0];
  out->vehicle_rates_setpoint.pitch = rtY->rates_sp.rates[1];
  out->vehicle_rates_setpoint.yaw = rtY->rates_sp.rates[2];
  out->vehicle_rates_setpoint.thrust = rtY->rates_sp.thrust;
  out->vehicle_rates_setpoint.published = rtY->rates_sp_valid;
  memcpy(out->actuator_controls_0.control, rtY->control, sizeof(rtY->control));
  out->actuator_controls_0.published = rtY->control_valid;
  out->mc_att_ctrl_status.roll_rate_integ = rtY->rates_int[0];
  out->mc_att_ctrl_status.pitch_rate_integ = rtY->rates_int[1];
  out->mc_att_ctrl_status.yaw_rate_integ = rtY->rates_int[2];
  out->mc_att_ctrl_status.published = rtY->rates_int_valid;
}

static int step(void* self, const attest_inputs* in, attest_outputs* out) {
  Instance* instance = self;
  if (!instance->running || (in->updated & ATTEST_UPDATED_PARAMETER_UPDATE) != 0) {
    instance->model.rtP = instance->tuned;
    instance->running = true;
  }
  read_setpoints(&instance->model.rtU, in);
  read_vehicle(&instance->model.rtU, in);
  mc_att_control_step(&instance->model);
  write_outputs(&instance->model.rtY, out);
  return ATTEST_OK;
}

const attest_unit* attest_unit_v1(void) {
  static const attest_unit unit = {
      .abi_version = ATTEST_UNIT_ABI_VERSION,
      .name = "simulink-style",
      .version = "1.0",
      .create = create,
      .destroy = destroy,
      .set_parameter = set_parameter,
      .step = step,
      .extension = NULL,
  };
  return &unit;
}
