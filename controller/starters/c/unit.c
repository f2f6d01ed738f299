/* SPDX-License-Identifier: BSD-3-Clause */
/* One step of PX4 v1.5.5 mc_att_control, its parameters, and the C ABI of attest_unit.h. */
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "law.h"

/* ---- parameters ------------------------------------------------------------------------------*/

static const struct {
  const char* name;
  size_t offset;
  float initial;
} parameter_table[] = {
    {"MC_ROLL_P", offsetof(parameters, roll_p), 6.5f},
    {"MC_ROLL_TC", offsetof(parameters, roll_tc), 0.2f},
    {"MC_ROLLRATE_P", offsetof(parameters, roll_rate_p), 0.15f},
    {"MC_ROLLRATE_I", offsetof(parameters, roll_rate_i), 0.05f},
    {"MC_ROLLRATE_D", offsetof(parameters, roll_rate_d), 0.003f},
    {"MC_ROLLRATE_FF", offsetof(parameters, roll_rate_ff), 0.0f},
    {"MC_PITCH_P", offsetof(parameters, pitch_p), 6.5f},
    {"MC_PITCH_TC", offsetof(parameters, pitch_tc), 0.2f},
    {"MC_PITCHRATE_P", offsetof(parameters, pitch_rate_p), 0.15f},
    {"MC_PITCHRATE_I", offsetof(parameters, pitch_rate_i), 0.05f},
    {"MC_PITCHRATE_D", offsetof(parameters, pitch_rate_d), 0.003f},
    {"MC_PITCHRATE_FF", offsetof(parameters, pitch_rate_ff), 0.0f},
    {"MC_YAW_P", offsetof(parameters, yaw_p), 2.8f},
    {"MC_YAWRATE_P", offsetof(parameters, yaw_rate_p), 0.2f},
    {"MC_YAWRATE_I", offsetof(parameters, yaw_rate_i), 0.1f},
    {"MC_YAWRATE_D", offsetof(parameters, yaw_rate_d), 0.0f},
    {"MC_YAWRATE_FF", offsetof(parameters, yaw_rate_ff), 0.0f},
    {"MC_YAW_FF", offsetof(parameters, yaw_ff), 0.5f},
    {"MC_ROLLRATE_MAX", offsetof(parameters, roll_rate_max), 220.0f},
    {"MC_PITCHRATE_MAX", offsetof(parameters, pitch_rate_max), 220.0f},
    {"MC_YAWRATE_MAX", offsetof(parameters, yaw_rate_max), 200.0f},
    {"MC_YAWRAUTO_MAX", offsetof(parameters, yaw_auto_max), 45.0f},
    {"MC_ACRO_R_MAX", offsetof(parameters, acro_roll_max), 360.0f},
    {"MC_ACRO_P_MAX", offsetof(parameters, acro_pitch_max), 360.0f},
    {"MC_ACRO_Y_MAX", offsetof(parameters, acro_yaw_max), 360.0f},
    {"MC_RATT_TH", offsetof(parameters, rattitude_threshold), 1.0f},
    {"MC_TPA_BREAK", offsetof(parameters, tpa_break), 1.0f},
    {"MC_TPA_SLOPE", offsetof(parameters, tpa_slope), 1.0f},
    {"MC_BAT_SCALE_EN", offsetof(parameters, battery_scale_enabled), 0.0f},
    {"VT_WV_YAWR_SCL", offsetof(parameters, weather_vane_scale), 0.15f},
    {"VT_TYPE", offsetof(parameters, vtol_type), 0.0f},
    {"VT_OPT_RECOV_EN", offsetof(parameters, recovery_enabled), 0.0f},
    {"CBRK_RATE_CTRL", offsetof(parameters, circuit_breaker), 0.0f},
};
enum { PARAMETER_COUNT = sizeof parameter_table / sizeof parameter_table[0] };

static void write_parameter(controller* c, size_t index, float value) {
  memcpy((char*)&c->parameters + parameter_table[index].offset, &value, sizeof value);
}

static void set3(float out[3], float roll, float pitch, float yaw) {
  out[0] = roll;
  out[1] = pitch;
  out[2] = yaw;
}

static void read_parameters(controller* c) {
  const parameters* p = &c->parameters;
  gains* g = &c->gains;
  /* A time constant above the default of 0.2 s lowers the gains of its axis, except I and FF. */
  const float roll = 0.2f / p->roll_tc;
  const float pitch = 0.2f / p->pitch_tc;
  set3(g->att_p, p->roll_p * roll, p->pitch_p * pitch, p->yaw_p);
  set3(g->rate_p, p->roll_rate_p * roll, p->pitch_rate_p * pitch, p->yaw_rate_p);
  set3(g->rate_i, p->roll_rate_i, p->pitch_rate_i, p->yaw_rate_i);
  set3(g->rate_d, p->roll_rate_d * roll, p->pitch_rate_d * pitch, p->yaw_rate_d);
  set3(g->rate_ff, p->roll_rate_ff, p->pitch_rate_ff, p->yaw_rate_ff);
  set3(g->mc_rate_max, rad(p->roll_rate_max), rad(p->pitch_rate_max), rad(p->yaw_rate_max));
  set3(g->auto_rate_max, rad(p->roll_rate_max), rad(p->pitch_rate_max), rad(p->yaw_auto_max));
  set3(g->acro_rate_max, rad(p->acro_roll_max), rad(p->acro_pitch_max), rad(p->acro_yaw_max));
  g->yaw_ff = p->yaw_ff;
  g->rattitude_threshold = p->rattitude_threshold;
  g->tpa_break = p->tpa_break;
  g->tpa_slope = p->tpa_slope;
  g->weather_vane_scale = p->weather_vane_scale;
  g->battery_scale_enabled = p->battery_scale_enabled != 0.0f;
  g->circuit_breaker_open = p->circuit_breaker == 140253.0f; /* the key of CBRK_RATE_CTRL */
}

/* ---- one step --------------------------------------------------------------------------------*/

/* Removes `bit` from the pending samples. Returns whether it was set. */
static bool take(controller* c, uint32_t bit) {
  const bool was_pending = (c->pending & bit) != 0;
  c->pending &= ~bit;
  return was_pending;
}

#define LATCH(topic, bit)                                         \
  do {                                                            \
    if (take(c, ATTEST_UPDATED_##bit)) c->copy.topic = in->topic; \
  } while (0)

/* Latches every topic except the two setpoints, which the law latches in some modes only. */
static void latch_inputs(controller* c, const attest_inputs* in) {
  c->pending |= in->updated;
  c->copy.timestamp = in->timestamp;
  c->copy.control_state = in->control_state;
  if (take(c, ATTEST_UPDATED_PARAMETER_UPDATE) || !c->started) read_parameters(c);
  if (!c->started) {
    /* VT_TYPE 0 is the tailsitter. Later changes of these parameters have no effect. */
    c->tailsitter = c->parameters.vtol_type == 0.0f && c->parameters.recovery_enabled != 0.0f;
    c->started = true;
  }
  if ((in->updated & ATTEST_UPDATED_VEHICLE_STATUS) && !c->have_vehicle_status) {
    /* The first sample decides for the life of the instance whether it publishes on the virtual
     * topics of a VTOL. */
    c->have_vehicle_status = true;
    c->on_virtual_topics = in->vehicle_status.is_vtol != 0;
  }
  LATCH(manual_control_setpoint, MANUAL_CONTROL_SETPOINT);
  LATCH(vehicle_control_mode, VEHICLE_CONTROL_MODE);
  LATCH(actuator_armed, ACTUATOR_ARMED);
  LATCH(vehicle_status, VEHICLE_STATUS);
  LATCH(multirotor_motor_limits, MULTIROTOR_MOTOR_LIMITS);
  LATCH(battery_status, BATTERY_STATUS);
}

static void publish_rates_setpoint(controller* c, attest_outputs* out) {
  c->copy.vehicle_rates_setpoint.roll = c->rates_sp[0];
  c->copy.vehicle_rates_setpoint.pitch = c->rates_sp[1];
  c->copy.vehicle_rates_setpoint.yaw = c->rates_sp[2];
  c->copy.vehicle_rates_setpoint.thrust = c->thrust_sp;
  if (!c->have_vehicle_status) return;
  /* This newer sample supersedes a pending external one on the same topic. */
  if (!c->on_virtual_topics) take(c, ATTEST_UPDATED_VEHICLE_RATES_SETPOINT);
  out->vehicle_rates_setpoint.roll = c->rates_sp[0];
  out->vehicle_rates_setpoint.pitch = c->rates_sp[1];
  out->vehicle_rates_setpoint.yaw = c->rates_sp[2];
  out->vehicle_rates_setpoint.thrust = c->thrust_sp;
  out->vehicle_rates_setpoint.published = 1;
}

/* Sets rates_sp and thrust_sp by the mode: attitude, acro or offboard rates. */
static void outer_loop(controller* c, const attest_inputs* in, attest_outputs* out) {
  const gains* g = &c->gains;
  if (c->copy.vehicle_control_mode.flag_control_attitude_enabled) {
    LATCH(vehicle_attitude_setpoint, VEHICLE_ATTITUDE_SETPOINT);
    if (c->tailsitter) {
      tailsitter_law(c);
    } else {
      attitude_law(c);
    }
    c->thrust_sp = c->copy.vehicle_attitude_setpoint.thrust;
    publish_rates_setpoint(c, out);
  } else if (c->copy.vehicle_control_mode.flag_control_manual_enabled) {
    const float z = c->copy.manual_control_setpoint.z;
    c->rates_sp[0] = c->copy.manual_control_setpoint.y * g->acro_rate_max[0];
    c->rates_sp[1] = -c->copy.manual_control_setpoint.x * g->acro_rate_max[1];
    c->rates_sp[2] = c->copy.manual_control_setpoint.r * g->acro_rate_max[2];
    c->thrust_sp = z < 0.9f ? z : 0.9f; /* leaves headroom for attitude control; NaN gives 0.9 */
    publish_rates_setpoint(c, out);
  } else {
    LATCH(vehicle_rates_setpoint, VEHICLE_RATES_SETPOINT);
    c->rates_sp[0] = c->copy.vehicle_rates_setpoint.roll;
    c->rates_sp[1] = c->copy.vehicle_rates_setpoint.pitch;
    c->rates_sp[2] = c->copy.vehicle_rates_setpoint.yaw;
    c->thrust_sp = c->copy.vehicle_rates_setpoint.thrust;
  }
}

static void publish_actuator_controls(const controller* c, const float u[3], attest_outputs* out) {
  if (c->gains.circuit_breaker_open || !c->have_vehicle_status) return;
  float* control = out->actuator_controls_0.control;
  memset(control, 0, sizeof out->actuator_controls_0.control);
  for (int i = 0; i < 3; i++) control[i] = isfinite(u[i]) ? u[i] : 0.0f;
  control[3] = isfinite(c->thrust_sp) ? c->thrust_sp : 0.0f;
  if (c->profile == PROFILE_PX4_V1_5_5) {
    control[7] = c->copy.vehicle_attitude_setpoint.landing_gear;
    /* After the check for finite controls: an infinite scale gives infinite controls. */
    if (c->gains.battery_scale_enabled && c->copy.battery_status.scale > 0.0f) {
      for (int i = 0; i < 4; i++) control[i] *= c->copy.battery_status.scale;
    }
  }
  out->actuator_controls_0.published = 1;
}

static int step(void* self, const attest_inputs* in, attest_outputs* out) {
  controller* c = self;
  out->vehicle_rates_setpoint.published = 0;
  out->actuator_controls_0.published = 0;
  out->mc_att_ctrl_status.published = 0;

  /* The clamp is part of the law: above 500 Hz the law still uses 2 ms. */
  float dt = (float)(in->timestamp - c->copy.timestamp) / 1000000.0f;
  dt = dt < 0.002f ? 0.002f : (dt > 0.02f ? 0.02f : dt);
  latch_inputs(c, in);

  if (c->copy.vehicle_control_mode.flag_control_rattitude_enabled &&
      (fabsf(c->copy.manual_control_setpoint.y) > c->gains.rattitude_threshold ||
       fabsf(c->copy.manual_control_setpoint.x) > c->gains.rattitude_threshold)) {
    /* Cleared in the copy: attitude mode returns only with the next vehicle_control_mode. */
    c->copy.vehicle_control_mode.flag_control_attitude_enabled = 0;
  }
  outer_loop(c, in, out);
  if (!c->copy.vehicle_control_mode.flag_control_rates_enabled) return ATTEST_OK;

  float u[3];
  rate_law(c, dt, u);
  publish_actuator_controls(c, u, out);
  out->mc_att_ctrl_status.roll_rate_integ = c->rates_int[0];
  out->mc_att_ctrl_status.pitch_rate_integ = c->rates_int[1];
  out->mc_att_ctrl_status.yaw_rate_integ = c->rates_int[2];
  out->mc_att_ctrl_status.published = 1;
  return ATTEST_OK;
}

/* ---- life cycle ------------------------------------------------------------------------------*/

static void* create(const char* profile_name) {
  profile selected;
  if (strcmp(profile_name, "px4-v1.5.5") == 0) {
    selected = PROFILE_PX4_V1_5_5;
  } else if (strcmp(profile_name, "px4-v1.3.4") == 0) {
    selected = PROFILE_PX4_V1_3_4;
  } else {
    return NULL;
  }
  controller* c = calloc(1, sizeof *c);
  if (c == NULL) return NULL;
  c->profile = selected;
  c->copy.vehicle_status.is_rotary_wing = 1;
  for (size_t i = 0; i < PARAMETER_COUNT; i++) write_parameter(c, i, parameter_table[i].initial);
  return c;
}

static void destroy(void* self) { free(self); }

/* px4-v1.3.4 has neither throttle attenuation nor battery scaling. */
static bool exists(const controller* c, const char* name) {
  if (c->profile != PROFILE_PX4_V1_3_4) return true;
  return strncmp(name, "MC_TPA_", 7) != 0 && strcmp(name, "MC_BAT_SCALE_EN") != 0;
}

static int set_parameter(void* self, const char* name, float value) {
  for (size_t i = 0; i < PARAMETER_COUNT; i++) {
    if (strcmp(parameter_table[i].name, name) == 0 && exists(self, name)) {
      write_parameter(self, i, value);
      return ATTEST_OK;
    }
  }
  return ATTEST_INVALID;
}

const attest_unit* attest_unit_v1(void) {
  static const attest_unit unit = {
      .abi_version = ATTEST_UNIT_ABI_VERSION,
      .name = "attest-starter-c",
      .version = "0.1.0",
      .create = create,
      .destroy = destroy,
      .set_parameter = set_parameter,
      .step = step,
      .extension = NULL,
  };
  return &unit;
}
