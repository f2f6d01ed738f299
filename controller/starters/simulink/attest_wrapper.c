/* SPDX-License-Identifier: BSD-3-Clause */
/*
 * attest_wrapper.c - the C ABI of attest_unit.h around the model of mc_att_control.h. It computes
 * no part of the law. Two options of the compiler adapt it to other models:
 *
 *     -DSINGLE_INSTANCE      the model keeps its data in globals: one instance at a time
 *     -DFIXED_STEP_HZ=250    the model has a fixed sample time, here of 1/250 s
 */
#include <attest_unit.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "mc_att_control.h"

/* One instance of the model, and what the ABI needs in addition. */
typedef struct {
  RT_MODEL rtM;
  P rtP;
  ExtU rtU;
  ExtY rtY;
  DW rtDW;
  P tuned;            /* as set; the model gets them at the first step and parameter_update */
  uint64_t timestamp; /* [us] of the previous step */
  bool started;
} Instance;

/* ---- inports and outports --------------------------------------------------------------------*/

static void read_setpoints(ExtU* rtU, const attest_inputs* in) {
  if (in->updated & ATTEST_UPDATED_VEHICLE_ATTITUDE_SETPOINT) {
    memcpy(rtU->attitude_sp.q_d, in->vehicle_attitude_setpoint.q_d, sizeof(rtU->attitude_sp.q_d));
    rtU->attitude_sp.thrust = in->vehicle_attitude_setpoint.thrust;
    rtU->attitude_sp.yaw_sp_move_rate = in->vehicle_attitude_setpoint.yaw_sp_move_rate;
    rtU->attitude_sp.landing_gear = in->vehicle_attitude_setpoint.landing_gear;
    rtU->attitude_sp.disable_mc_yaw_control =
        in->vehicle_attitude_setpoint.disable_mc_yaw_control != 0;
  }
  rtU->rates_sp_new = (in->updated & ATTEST_UPDATED_VEHICLE_RATES_SETPOINT) != 0;
  if (rtU->rates_sp_new) {
    rtU->rates_sp.rates[0] = in->vehicle_rates_setpoint.roll;
    rtU->rates_sp.rates[1] = in->vehicle_rates_setpoint.pitch;
    rtU->rates_sp.rates[2] = in->vehicle_rates_setpoint.yaw;
    rtU->rates_sp.thrust = in->vehicle_rates_setpoint.thrust;
  }
  if (in->updated & ATTEST_UPDATED_MANUAL_CONTROL_SETPOINT) {
    rtU->sticks.x = in->manual_control_setpoint.x;
    rtU->sticks.y = in->manual_control_setpoint.y;
    rtU->sticks.z = in->manual_control_setpoint.z;
    rtU->sticks.r = in->manual_control_setpoint.r;
  }
}

/* A flag of the ABI is true for any value but 0. */
static void read_mode(ExtU* rtU, const attest_inputs* in) {
  rtU->mode_new = (in->updated & ATTEST_UPDATED_VEHICLE_CONTROL_MODE) != 0;
  if (rtU->mode_new) {
    rtU->mode.manual_enabled = in->vehicle_control_mode.flag_control_manual_enabled != 0;
    rtU->mode.auto_enabled = in->vehicle_control_mode.flag_control_auto_enabled != 0;
    rtU->mode.velocity_enabled = in->vehicle_control_mode.flag_control_velocity_enabled != 0;
    rtU->mode.attitude_enabled = in->vehicle_control_mode.flag_control_attitude_enabled != 0;
    rtU->mode.rattitude_enabled = in->vehicle_control_mode.flag_control_rattitude_enabled != 0;
    rtU->mode.rates_enabled = in->vehicle_control_mode.flag_control_rates_enabled != 0;
  }
}

static void read_vehicle(ExtU* rtU, const attest_inputs* in) {
  memcpy(rtU->q, in->control_state.q, sizeof(rtU->q));
  rtU->rates[0] = in->control_state.roll_rate;
  rtU->rates[1] = in->control_state.pitch_rate;
  rtU->rates[2] = in->control_state.yaw_rate;
  if (in->updated & ATTEST_UPDATED_ACTUATOR_ARMED) {
    rtU->armed = in->actuator_armed.armed != 0;
  }
  rtU->status_new = (in->updated & ATTEST_UPDATED_VEHICLE_STATUS) != 0;
  if (rtU->status_new) {
    rtU->is_rotary_wing = in->vehicle_status.is_rotary_wing != 0;
    rtU->is_vtol = in->vehicle_status.is_vtol != 0;
  }
  if (in->updated & ATTEST_UPDATED_MULTIROTOR_MOTOR_LIMITS) {
    rtU->limits.lower_limit = in->multirotor_motor_limits.lower_limit != 0;
    rtU->limits.upper_limit = in->multirotor_motor_limits.upper_limit != 0;
    rtU->limits.yaw = in->multirotor_motor_limits.yaw != 0;
  }
  if (in->updated & ATTEST_UPDATED_BATTERY_STATUS) {
    rtU->battery_scale = in->battery_status.scale;
  }
}

static void write_outputs(const ExtY* rtY, attest_outputs* out) {
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

/* ---- time ------------------------------------------------------------------------------------*/

#ifdef FIXED_STEP_HZ
#define TEXT_OF_VALUE(x) #x
#define TEXT(x) TEXT_OF_VALUE(x)

static uint64_t elapsed_us(const Instance* instance, const attest_inputs* in) {
  (void)instance;
  (void)in;
  return (uint64_t)(1.0e6 / (1.0 * FIXED_STEP_HZ) + 0.5); /* `1.0 *`: the rate may be 1000/3 */
}

static const void* extension(const char* id) {
  return strcmp(id, ATTEST_EXTENSION_FIXED_STEP) == 0 ? TEXT(FIXED_STEP_HZ) : NULL;
}
#else
static uint64_t elapsed_us(const Instance* instance, const attest_inputs* in) {
  return in->timestamp - instance->timestamp;
}

static const void* extension(const char* id) {
  (void)id;
  return NULL;
}
#endif

/* ---- life cycle ------------------------------------------------------------------------------*/

#ifdef SINGLE_INSTANCE
static Instance only_instance;
static bool only_instance_exists;

static Instance* allocate(void) {
  if (only_instance_exists) return NULL;
  only_instance_exists = true;
  memset(&only_instance, 0, sizeof(only_instance));
  return &only_instance;
}

static void destroy(void* self) {
  (void)self;
  only_instance_exists = false;
}
#else
static Instance* allocate(void) { return calloc(1, sizeof(Instance)); }

static void destroy(void* self) { free(self); }
#endif

static void* create(const char* profile) {
  const bool old_law = strcmp(profile, "px4-v1.3.4") == 0;
  if (!old_law && strcmp(profile, "px4-v1.5.5") != 0) return NULL;
  Instance* instance = allocate();
  if (instance == NULL) return NULL;
  instance->tuned = mc_att_control_default_P;
  instance->tuned.law_version = old_law ? LawVersion_v1_3_4 : LawVersion_v1_5_5;
  instance->rtM.defaultParam = &instance->rtP;
  instance->rtM.inputs = &instance->rtU;
  instance->rtM.outputs = &instance->rtY;
  instance->rtM.dwork = &instance->rtDW;
  mc_att_control_initialize(&instance->rtM);
  instance->rtU.is_rotary_wing = true; /* until the first vehicle_status */
  return instance;
}

#define PARAMETER(name) \
  { #name, offsetof(P, name) }

static const struct {
  const char* name;
  size_t offset;
} parameters[] = {
    PARAMETER(MC_ROLL_P),       PARAMETER(MC_PITCH_P),       PARAMETER(MC_YAW_P),
    PARAMETER(MC_ROLL_TC),      PARAMETER(MC_PITCH_TC),      PARAMETER(MC_ROLLRATE_P),
    PARAMETER(MC_ROLLRATE_I),   PARAMETER(MC_ROLLRATE_D),    PARAMETER(MC_ROLLRATE_FF),
    PARAMETER(MC_PITCHRATE_P),  PARAMETER(MC_PITCHRATE_I),   PARAMETER(MC_PITCHRATE_D),
    PARAMETER(MC_PITCHRATE_FF), PARAMETER(MC_YAWRATE_P),     PARAMETER(MC_YAWRATE_I),
    PARAMETER(MC_YAWRATE_D),    PARAMETER(MC_YAWRATE_FF),    PARAMETER(MC_YAW_FF),
    PARAMETER(MC_ROLLRATE_MAX), PARAMETER(MC_PITCHRATE_MAX), PARAMETER(MC_YAWRATE_MAX),
    PARAMETER(MC_YAWRAUTO_MAX), PARAMETER(MC_ACRO_R_MAX),    PARAMETER(MC_ACRO_P_MAX),
    PARAMETER(MC_ACRO_Y_MAX),   PARAMETER(MC_RATT_TH),       PARAMETER(MC_TPA_BREAK),
    PARAMETER(MC_TPA_SLOPE),    PARAMETER(MC_BAT_SCALE_EN),  PARAMETER(VT_WV_YAWR_SCL),
    PARAMETER(VT_TYPE),         PARAMETER(VT_OPT_RECOV_EN),  PARAMETER(CBRK_RATE_CTRL),
};

static int set_parameter(void* self, const char* name, float value) {
  Instance* instance = self;
  for (size_t i = 0; i < sizeof(parameters) / sizeof(parameters[0]); i++) {
    if (strcmp(parameters[i].name, name) == 0) {
      memcpy((char*)&instance->tuned + parameters[i].offset, &value, sizeof(value));
      return ATTEST_OK;
    }
  }
  return ATTEST_INVALID;
}

static int step(void* self, const attest_inputs* in, attest_outputs* out) {
  Instance* instance = self;
  if (!instance->started || (in->updated & ATTEST_UPDATED_PARAMETER_UPDATE)) {
    instance->rtP = instance->tuned;
    instance->started = true;
  }
  instance->rtU.elapsed = elapsed_us(instance, in);
  instance->timestamp = in->timestamp;
  read_setpoints(&instance->rtU, in);
  read_mode(&instance->rtU, in);
  read_vehicle(&instance->rtU, in);
  mc_att_control_step(&instance->rtM);
  write_outputs(&instance->rtY, out);
  return ATTEST_OK;
}

const attest_unit* attest_unit_v1(void) {
  static const attest_unit unit = {
      .abi_version = ATTEST_UNIT_ABI_VERSION,
      .name = "attest-starter-simulink",
      .version = "0.1.0",
      .create = create,
      .destroy = destroy,
      .set_parameter = set_parameter,
      .step = step,
      .extension = extension,
  };
  return &unit;
}
