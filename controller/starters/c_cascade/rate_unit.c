/* SPDX-License-Identifier: BSD-3-Clause */
/* The rate unit: body rates to torque. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "port.h"
#include "scalar.h"

/* ---- state -----------------------------------------------------------------------------------*/

/* The parameters as set, in their own units. Arrays are roll, pitch, yaw. The host changes them
 * only before a step that has parameter_update set, so the law may read them in every step. */
typedef struct parameters {
  float k[3], p[3], i[3], d[3], ff[3], int_limit[3];
  float acro_max[3]; /* [deg/s] */
  float acro_expo, acro_expo_yaw, acro_superexpo, acro_superexpo_yaw;
  float yaw_torque_cutoff; /* [Hz] */
  float battery_scale_enabled;
} parameters;

/* Values derived from the parameters, computed when they are read. */
typedef struct gains {
  float p[3], i[3], d[3], ff[3]; /* torque per rad/s, rad, rad/s^2, rad/s */
  float acro_max[3];             /* [rad/s] */
  float yaw_torque_tau;          /* [s] */
} gains;

typedef struct rates_setpoint {
  float rates[3];  /* [rad/s] */
  float thrust[3]; /* [-1..1] along body x, y, z */
} rates_setpoint;

typedef struct rate_unit {
  const profile* profile;
  parameters parameters;
  gains gains;
  bool started;  /* false until the first step has read the parameters */
  uint64_t last; /* [us] timestamp_sample of the previous step */

  /* Topics as last latched. */
  uint32_t pending;      /* ATTEST_RATE_UPDATED_ bits of samples that are not latched yet */
  rates_setpoint sample; /* newest vehicle_rates_setpoint, external or of the sticks */
  bool armed, manual, attitude_controlled, rates_controlled;
  bool rotary_wing, on_ground;
  bool saturated_up[3], saturated_down[3];
  float battery_scale; /* 0 before the first valid sample */

  rates_setpoint setpoint;
  float integral[3];
  lowpass yaw_torque;
} rate_unit;

/* ---- parameters ------------------------------------------------------------------------------*/

static const parameter table[] = {
    {"MC_ROLLRATE_K", offsetof(parameters, k[0]), SAME(1.0f)},
    {"MC_PITCHRATE_K", offsetof(parameters, k[1]), SAME(1.0f)},
    {"MC_YAWRATE_K", offsetof(parameters, k[2]), SAME(1.0f)},
    {"MC_ROLLRATE_P", offsetof(parameters, p[0]), SAME(0.15f)},
    {"MC_PITCHRATE_P", offsetof(parameters, p[1]), SAME(0.15f)},
    {"MC_YAWRATE_P", offsetof(parameters, p[2]), SAME(0.2f)},
    {"MC_ROLLRATE_I", offsetof(parameters, i[0]), SAME(0.2f)},
    {"MC_PITCHRATE_I", offsetof(parameters, i[1]), SAME(0.2f)},
    {"MC_YAWRATE_I", offsetof(parameters, i[2]), SAME(0.1f)},
    {"MC_ROLLRATE_D", offsetof(parameters, d[0]), SAME(0.003f)},
    {"MC_PITCHRATE_D", offsetof(parameters, d[1]), SAME(0.003f)},
    {"MC_YAWRATE_D", offsetof(parameters, d[2]), SAME(0.0f)},
    {"MC_ROLLRATE_FF", offsetof(parameters, ff[0]), SAME(0.0f)},
    {"MC_PITCHRATE_FF", offsetof(parameters, ff[1]), SAME(0.0f)},
    {"MC_YAWRATE_FF", offsetof(parameters, ff[2]), SAME(0.0f)},
    {"MC_RR_INT_LIM", offsetof(parameters, int_limit[0]), SAME(0.3f)},
    {"MC_PR_INT_LIM", offsetof(parameters, int_limit[1]), SAME(0.3f)},
    {"MC_YR_INT_LIM", offsetof(parameters, int_limit[2]), SAME(0.3f)},
    /* Columns: px4-v1.14.4, px4-v1.15.4, px4-v1.16.0, px4-v1.17, px4-v1.18. */
    {"MC_ACRO_R_MAX", offsetof(parameters, acro_max[0]), {720.0f, 100.0f, 100.0f, 100.0f, 100.0f}},
    {"MC_ACRO_P_MAX", offsetof(parameters, acro_max[1]), {720.0f, 100.0f, 100.0f, 100.0f, 100.0f}},
    {"MC_ACRO_Y_MAX", offsetof(parameters, acro_max[2]), {540.0f, 100.0f, 100.0f, 100.0f, 100.0f}},
    {"MC_ACRO_EXPO", offsetof(parameters, acro_expo), {0.69f, 0.0f, 0.0f, 0.0f, 0.0f}},
    {"MC_ACRO_EXPO_Y", offsetof(parameters, acro_expo_yaw), {0.69f, 0.0f, 0.0f, 0.0f, 0.0f}},
    {"MC_ACRO_SUPEXPO", offsetof(parameters, acro_superexpo), {0.7f, 0.0f, 0.0f, 0.0f, 0.0f}},
    {"MC_ACRO_SUPEXPOY", offsetof(parameters, acro_superexpo_yaw), {0.7f, 0.0f, 0.0f, 0.0f, 0.0f}},
    {"MC_YAW_TQ_CUTOFF",
     offsetof(parameters, yaw_torque_cutoff),
     {ABSENT, ABSENT, 2.0f, 2.0f, 2.0f}},
    {"MC_BAT_SCALE_EN", offsetof(parameters, battery_scale_enabled), SAME(0.0f)},
};
enum { TABLE_ROWS = sizeof table / sizeof table[0] };

static void read_parameters(rate_unit* u) {
  const parameters* p = &u->parameters;
  gains* g = &u->gains;
  for (int i = 0; i < 3; i++) {
    g->p[i] = p->k[i] * p->p[i];
    g->i[i] = p->k[i] * p->i[i];
    g->d[i] = p->k[i] * p->d[i];
    g->ff[i] = p->ff[i]; /* without K */
    g->acro_max[i] = rad(p->acro_max[i]);
  }
  g->yaw_torque_tau =
      p->yaw_torque_cutoff > FLT_EPSILON ? 1.0f / (6.28318548f * p->yaw_torque_cutoff) : 0.0f;
}

/* ---- the rate law ----------------------------------------------------------------------------*/

/* The next value of one integral. */
static float integrate(const rate_unit* u, int axis, float err, float dt) {
  /* No windup in a direction in which the motors cannot give more torque. */
  if (u->saturated_up[axis]) err = min(err, 0.0f);
  if (u->saturated_down[axis]) err = max(err, 0.0f);

  /* A large error is integrated less, and from 400 deg/s on not at all. Otherwise the vehicle would
   * overshoot after a flip. */
  float share = err / 6.98131704f;
  share = max(0.0f, 1.0f - share * share);
  const float next = u->integral[axis] + ((share * u->gains.i[axis]) * err) * dt;
  if (!isfinite(next)) return u->integral[axis];
  return clamp(next, -u->parameters.int_limit[axis], u->parameters.int_limit[axis]);
}

static void rate_law(rate_unit* u, const float rates[3], const float accel[3], float dt,
                     float torque[3]) {
  const gains* g = &u->gains;
  for (int i = 0; i < 3; i++) {
    const float sp = u->setpoint.rates[i];
    const float err = sp - rates[i];
    torque[i] = ((g->p[i] * err + u->integral[i]) - g->d[i] * accel[i]) + g->ff[i] * sp;
    if (!u->on_ground) u->integral[i] = integrate(u, i, err, dt);
  }
}

/* ---- one step --------------------------------------------------------------------------------*/

/* Removes `bit` from the pending samples. Returns whether it was set. */
static bool take(rate_unit* u, uint32_t bit) {
  const bool was_pending = (u->pending & bit) != 0;
  u->pending &= ~bit;
  return was_pending;
}

/* Parameters, and the topics that every step latches. */
static void latch_topics(rate_unit* u, const attest_rate_inputs* in) {
  u->pending |= in->updated;
  if (in->updated & ATTEST_RATE_UPDATED_VEHICLE_RATES_SETPOINT) {
    const float sample[3] = {in->vehicle_rates_setpoint.roll, in->vehicle_rates_setpoint.pitch,
                             in->vehicle_rates_setpoint.yaw};
    memcpy(u->sample.rates, sample, sizeof sample);
    memcpy(u->sample.thrust, in->vehicle_rates_setpoint.thrust_body, sizeof u->sample.thrust);
  }
  if (take(u, ATTEST_RATE_UPDATED_PARAMETER_UPDATE) || !u->started) {
    read_parameters(u);
    u->started = true;
  }
  if (take(u, ATTEST_RATE_UPDATED_VEHICLE_CONTROL_MODE)) {
    u->armed = in->vehicle_control_mode.flag_armed != 0;
    u->manual = in->vehicle_control_mode.flag_control_manual_enabled != 0;
    u->attitude_controlled = in->vehicle_control_mode.flag_control_attitude_enabled != 0;
    u->rates_controlled = in->vehicle_control_mode.flag_control_rates_enabled != 0;
  }
  if (take(u, ATTEST_RATE_UPDATED_VEHICLE_LAND_DETECTED)) {
    u->on_ground =
        in->vehicle_land_detected.landed != 0 || in->vehicle_land_detected.maybe_landed != 0;
  }
  if (take(u, ATTEST_RATE_UPDATED_VEHICLE_STATUS)) {
    u->rotary_wing = in->vehicle_status.is_rotary_wing != 0;
  }
}

/* Sets the setpoint from new sticks. Without new sticks it stays. */
static void acro(rate_unit* u, const attest_rate_inputs* in, attest_rate_outputs* out) {
  if (!take(u, ATTEST_RATE_UPDATED_MANUAL_CONTROL_SETPOINT)) return;
  const parameters* p = &u->parameters;
  const float* rate_max = u->gains.acro_max;
  /* Stick forward: nose down. */
  const float roll = superexpo(in->manual_control_setpoint.roll, p->acro_expo, p->acro_superexpo);
  const float pitch =
      superexpo(-in->manual_control_setpoint.pitch, p->acro_expo, p->acro_superexpo);
  const float yaw =
      superexpo(in->manual_control_setpoint.yaw, p->acro_expo_yaw, p->acro_superexpo_yaw);
  const float thrust = (-(in->manual_control_setpoint.throttle + 1.0f)) * 0.5f; /* up: negative */
  u->setpoint = (rates_setpoint){
      .rates = {roll * rate_max[0], pitch * rate_max[1], yaw * rate_max[2]},
      .thrust = {0.0f, 0.0f, thrust},
  };

  out->vehicle_rates_setpoint.roll = u->setpoint.rates[0];
  out->vehicle_rates_setpoint.pitch = u->setpoint.rates[1];
  out->vehicle_rates_setpoint.yaw = u->setpoint.rates[2];
  memcpy(out->vehicle_rates_setpoint.thrust_body, u->setpoint.thrust, sizeof u->setpoint.thrust);
  out->vehicle_rates_setpoint.published = 1;

  /* The unit also receives what it publishes, and latches it when acro mode has ended. */
  u->sample = u->setpoint;
  u->pending |= ATTEST_RATE_UPDATED_VEHICLE_RATES_SETPOINT;
}

/* An axis without a finite setpoint holds the rate measured now. */
static void follow_setpoint(rate_unit* u, const float rates[3]) {
  if (!take(u, ATTEST_RATE_UPDATED_VEHICLE_RATES_SETPOINT)) return;
  u->setpoint = u->sample;
  for (int i = 0; i < 3; i++) {
    if (!isfinite(u->setpoint.rates[i])) u->setpoint.rates[i] = rates[i];
  }
}

/* Positive unallocated torque: the motors cannot give more positive torque. */
static void latch_saturation(rate_unit* u, const attest_rate_inputs* in) {
  if (!take(u, ATTEST_RATE_UPDATED_CONTROL_ALLOCATOR_STATUS)) return;
  const bool achieved = in->control_allocator_status.torque_setpoint_achieved != 0;
  for (int i = 0; i < 3; i++) {
    const float missing = in->control_allocator_status.unallocated_torque[i];
    u->saturated_up[i] = !achieved && missing > FLT_EPSILON;
    u->saturated_down[i] = !achieved && missing < -FLT_EPSILON;
  }
}

/* A low battery gives less thrust for the same command; the scale makes up for it. While
 * MC_BAT_SCALE_EN is 0, samples of the battery stay pending. */
static void compensate_battery(rate_unit* u, const attest_rate_inputs* in, float thrust[3],
                               float torque[3]) {
  if (u->parameters.battery_scale_enabled == 0.0f) return;
  if (take(u, ATTEST_RATE_UPDATED_BATTERY_STATUS)) {
    const float scale = in->battery_status.scale;
    if (in->battery_status.connected && scale > 0.0f) u->battery_scale = scale;
  }
  if (!(u->battery_scale > 0.0f)) return;
  for (int i = 0; i < 3; i++) {
    thrust[i] = clamp(thrust[i] * u->battery_scale, -1.0f, 1.0f);
    torque[i] = clamp(torque[i] * u->battery_scale, -1.0f, 1.0f);
  }
}

static void publish_integral(const rate_unit* u, attest_rate_outputs* out) {
  out->rate_ctrl_status.rollspeed_integ = u->integral[0];
  out->rate_ctrl_status.pitchspeed_integ = u->integral[1];
  out->rate_ctrl_status.yawspeed_integ = u->integral[2];
  out->rate_ctrl_status.published = 1;
}

/* The part of a step that runs only if the rates are controlled. */
static void control_rates(rate_unit* u, const attest_rate_inputs* in, float dt,
                          attest_rate_outputs* out) {
  if (!u->armed || !u->rotary_wing) memset(u->integral, 0, sizeof u->integral);
  latch_saturation(u, in);

  float torque[3], thrust[3];
  rate_law(u, in->vehicle_angular_velocity.xyz, in->vehicle_angular_velocity.xyz_derivative, dt,
           torque);
  if (u->profile->yaw_torque_filter) {
    /* Not skipped at cutoff 0: the filter is then not exactly the identity. */
    torque[2] = lowpass_update(&u->yaw_torque, u->gains.yaw_torque_tau, dt, torque[2]);
  }
  publish_integral(u, out);
  for (int i = 0; i < 3; i++) {
    if (!isfinite(torque[i])) torque[i] = 0.0f;
    thrust[i] = u->setpoint.thrust[i]; /* NaN stays NaN */
  }
  compensate_battery(u, in, thrust, torque);

  memcpy(out->vehicle_thrust_setpoint.xyz, thrust, sizeof thrust);
  out->vehicle_thrust_setpoint.published = 1;
  memcpy(out->vehicle_torque_setpoint.xyz, torque, sizeof torque);
  out->vehicle_torque_setpoint.published = 1;
}

static int step(void* self, const attest_rate_inputs* in, attest_rate_outputs* out) {
  rate_unit* u = self;
  out->vehicle_torque_setpoint.published = 0;
  out->vehicle_thrust_setpoint.published = 0;
  out->rate_ctrl_status.published = 0;
  out->vehicle_rates_setpoint.published = 0;

  const uint64_t sampled = in->vehicle_angular_velocity.timestamp_sample;
  const float dt = seconds_between(u->last, sampled, 0.000125f, 0.02f);
  u->last = sampled;
  latch_topics(u, in);

  if (u->manual && !u->attitude_controlled) {
    acro(u, in, out);
  } else {
    follow_setpoint(u, in->vehicle_angular_velocity.xyz);
  }
  if (u->rates_controlled) control_rates(u, in, dt, out);
  return ATTEST_OK;
}

/* ---- life cycle ------------------------------------------------------------------------------*/

static void* create(const char* profile_name) {
  const profile* selected = profile_find(profile_name);
  if (selected == NULL) return NULL;
  rate_unit* u = calloc(1, sizeof *u);
  if (u == NULL) return NULL;
  u->profile = selected;
  u->rotary_wing = true;
  u->on_ground = true;
  parameters_initialise(table, TABLE_ROWS, selected, &u->parameters);
  return u;
}

static void destroy(void* self) { free(self); }

static int set_parameter(void* self, const char* name, float value) {
  rate_unit* u = self;
  return parameters_set(table, TABLE_ROWS, u->profile, &u->parameters, name, value);
}

const attest_rate_unit rate_unit_table = {
    .create = create, .destroy = destroy, .set_parameter = set_parameter, .step = step};
