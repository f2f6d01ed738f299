/* SPDX-License-Identifier: BSD-3-Clause */
/* The attitude unit: its parameters, and one step. */
#include <stdlib.h>
#include <string.h>

#include "attitude.h"

/* ---- parameters ------------------------------------------------------------------------------*/

#define AT(field) offsetof(attitude_parameters, field)

static const parameter table[] = {
    {"MC_YAW_P", AT(p[2]), SAME(2.8f)},
    {"MC_YAW_WEIGHT", AT(yaw_weight), SAME(0.4f)},
    {"MC_ROLLRATE_MAX", AT(rate_max[0]), SAME(220.0f)},
    {"MC_PITCHRATE_MAX", AT(rate_max[1]), SAME(220.0f)},
    {"MC_YAWRATE_MAX", AT(rate_max[2]), SAME(200.0f)},
    {"MC_MAN_TILT_TAU", AT(tilt_tau), SAME(0.0f)},
    {"MC_AIRMODE", AT(airmode), SAME(0.0f)},
    {"MPC_MAN_TILT_MAX", AT(tilt_max), SAME(35.0f)},
    {"MPC_MAN_Y_MAX", AT(yaw_max), SAME(150.0f)},
    {"MPC_MANTHR_MIN", AT(throttle_min), SAME(0.08f)},
    {"MPC_THR_HOVER", AT(throttle_hover), SAME(0.5f)},
    {"MPC_THR_MAX", AT(throttle_max), SAME(1.0f)},
    {"MPC_THR_CURVE", AT(throttle_curve), SAME(0.0f)},
    /* Columns: px4-v1.14.4, px4-v1.15.4, px4-v1.16.0, px4-v1.17, px4-v1.18. */
    {"MC_ROLL_P", AT(p[0]), {6.5f, 6.5f, 6.5f, 4.0f, 4.0f}},
    {"MC_PITCH_P", AT(p[1]), {6.5f, 6.5f, 6.5f, 4.0f, 4.0f}},
    {"COM_SPOOLUP_TIME", AT(spoolup_time), {ABSENT, 1.0f, 1.0f, 1.0f, 1.0f}},
    {"MPC_MAN_Y_TAU", AT(yaw_tau), {ABSENT, ABSENT, 0.08f, 0.08f, 0.08f}},
    {"MPC_YAW_EXPO", AT(yaw_expo), {ABSENT, ABSENT, 0.6f, ABSENT, ABSENT}},
    {"MPC_HOLD_DZ", AT(hold_deadzone), {ABSENT, ABSENT, 0.1f, ABSENT, ABSENT}},
    {"MAN_DEADZONE", AT(hold_deadzone), {ABSENT, ABSENT, ABSENT, 0.1f, 0.1f}},
    {"MC_REF_W_N", AT(reference.frequency), {ABSENT, ABSENT, ABSENT, ABSENT, 50.0f}},
    {"MC_REF_FF", AT(reference.feed_forward), {ABSENT, ABSENT, ABSENT, ABSENT, 0.0f}},
    {"MC_REF_FF_MAX", AT(reference.feed_forward_max), {ABSENT, ABSENT, ABSENT, ABSENT, 100.0f}},
};
enum { TABLE_ROWS = sizeof table / sizeof table[0] };

static void read_parameters(attitude_unit* u) {
  const attitude_parameters* p = &u->parameters;
  attitude_law_set_gains(&u->law, p->p, p->yaw_weight, p->rate_max);
  reference_model_set_parameters(&u->law.reference, &p->reference);
  sticks_read_parameters(u);
}

/* ---- topics ----------------------------------------------------------------------------------*/

static void receive_setpoint(attitude_unit* u, const attest_attitude_inputs* in) {
  if (!(in->updated & ATTEST_ATTITUDE_UPDATED_VEHICLE_ATTITUDE_SETPOINT)) return;
  u->sample.timestamp = in->vehicle_attitude_setpoint.timestamp;
  u->sample.q_d = quat_of(in->vehicle_attitude_setpoint.q_d);
  memcpy(u->sample.thrust, in->vehicle_attitude_setpoint.thrust_body, sizeof u->sample.thrust);
  u->sample.yaw_rate = in->vehicle_attitude_setpoint.yaw_sp_move_rate;
  u->sample_pending = true;
}

static void latch_hover_estimate(attitude_unit* u, const attest_attitude_inputs* in) {
  if (!u->profile->hover_estimate) return;
  if (!(in->updated & ATTEST_ATTITUDE_UPDATED_HOVER_THRUST_ESTIMATE)) return;
  u->hover_estimate = in->hover_thrust_estimate.valid
                          ? clamp(in->hover_thrust_estimate.hover_thrust, 0.05f, 0.9f)
                          : u->parameters.throttle_hover;
}

static void latch_vehicle_status(attitude_unit* u, const attest_attitude_inputs* in) {
  u->rotary_wing = in->vehicle_status.is_rotary_wing != 0;
  u->vtol = in->vehicle_status.is_vtol != 0;
  u->in_transition = in->vehicle_status.in_transition_mode != 0;
  u->tailsitter = in->vehicle_status.is_vtol_tailsitter != 0;
  /* spooled_up changes only here: after the spool-up time, with the next sample of the topic. */
  const float armed_for = (float)(in->timestamp - in->vehicle_status.armed_time); /* [us] */
  u->spooled_up = in->vehicle_status.armed && armed_for > u->parameters.spoolup_time * 1e6f;
}

/* Topics that every step latches, so that none of them can be pending. */
static void latch_topics(attitude_unit* u, const attest_attitude_inputs* in) {
  if (in->updated & ATTEST_ATTITUDE_UPDATED_MANUAL_CONTROL_SETPOINT) {
    u->roll = in->manual_control_setpoint.roll;
    u->pitch = in->manual_control_setpoint.pitch;
    u->yaw = in->manual_control_setpoint.yaw;
    u->throttle = in->manual_control_setpoint.throttle;
  }
  if (in->updated & ATTEST_ATTITUDE_UPDATED_VEHICLE_CONTROL_MODE) {
    u->attitude_controlled = in->vehicle_control_mode.flag_control_attitude_enabled != 0;
    u->sticks_enabled = in->vehicle_control_mode.flag_control_manual_enabled &&
                        !in->vehicle_control_mode.flag_control_altitude_enabled &&
                        !in->vehicle_control_mode.flag_control_velocity_enabled &&
                        !in->vehicle_control_mode.flag_control_position_enabled;
  }
  if (in->updated & ATTEST_ATTITUDE_UPDATED_VEHICLE_STATUS) latch_vehicle_status(u, in);
  if (in->updated & ATTEST_ATTITUDE_UPDATED_VEHICLE_LAND_DETECTED) {
    u->landed = in->vehicle_land_detected.landed != 0;
  }
  if (in->updated & ATTEST_ATTITUDE_UPDATED_VEHICLE_LOCAL_POSITION) {
    if (!u->profile->ignores_heading_good) {
      u->heading_good = in->vehicle_local_position.heading_good_for_control != 0;
    }
    if (u->profile->yaw_lock) u->unaided_heading = in->vehicle_local_position.unaided_heading;
  }
}

/* ---- setpoint --------------------------------------------------------------------------------*/

static void use_sample(attitude_unit* u) {
  const bool first = u->setpoint_time == 0;
  const float elapsed = first ? 0.0f : seconds(u->setpoint_time, u->sample.timestamp);
  attitude_law_set_setpoint(&u->law, u->sample.q_d, u->sample.yaw_rate, elapsed);
  memcpy(u->thrust, u->sample.thrust, sizeof u->thrust);
  u->setpoint_time = u->sample.timestamp;
}

/* Takes the newest setpoint, then follows a reset of the estimator. */
static void follow_setpoint(attitude_unit* u, const attest_attitude_inputs* in) {
  if (u->sample_pending) {
    u->sample_pending = false;
    if (u->sample.timestamp > u->setpoint_time) use_sample(u);
  }
  if (in->vehicle_attitude.quat_reset_counter != u->reset_counter) {
    const quat delta = quat_of(in->vehicle_attitude.delta_q_reset);
    sticks_adapt(u, attitude_heading(u, delta));
    /* A setpoint that is newer than the attitude was made after the reset. */
    if (in->vehicle_attitude.timestamp > u->setpoint_time) attitude_law_adapt(&u->law, delta);
    u->reset_counter = in->vehicle_attitude.quat_reset_counter;
  }
}

/* The unit also receives this setpoint: it replaces a pending sample from outside. */
static void publish_setpoint(attitude_unit* u, const attitude_setpoint* sp,
                             attest_attitude_outputs* out) {
  u->sample = *sp;
  u->sample_pending = true;
  if (u->profile->setpoint_first) use_sample(u);

  const float q_d[4] = {sp->q_d.w, sp->q_d.x, sp->q_d.y, sp->q_d.z};
  memcpy(out->vehicle_attitude_setpoint.q_d, q_d, sizeof q_d);
  memcpy(out->vehicle_attitude_setpoint.thrust_body, sp->thrust, sizeof sp->thrust);
  out->vehicle_attitude_setpoint.yaw_sp_move_rate = sp->yaw_rate;
  out->vehicle_attitude_setpoint.published = 1;
}

/* ---- one step --------------------------------------------------------------------------------*/

/* The newest sample counts, whether or not it is new in this step. */
static bool autotune_active(const attitude_unit* u, const attest_attitude_inputs* in) {
  const uint64_t age = in->timestamp - in->autotune_attitude_control_status.timestamp; /* [us] */
  const uint8_t* states = u->profile->autotune_states;
  const uint8_t state = in->autotune_attitude_control_status.state;
  return age < 1000000 && memchr(states, state, sizeof u->profile->autotune_states) != NULL;
}

static void publish_rates(const attitude_unit* u, quat q, const attest_attitude_inputs* in,
                          attest_attitude_outputs* out) {
  float rates[3];
  attitude_law_rates(&u->law, q, rates);
  if (autotune_active(u, in)) { /* after the limit of the law */
    for (int i = 0; i < 3; i++) rates[i] += in->autotune_attitude_control_status.rate_sp[i];
  }
  out->vehicle_rates_setpoint.roll = rates[0];
  out->vehicle_rates_setpoint.pitch = rates[1];
  out->vehicle_rates_setpoint.yaw = rates[2];
  memcpy(out->vehicle_rates_setpoint.thrust_body, u->thrust, sizeof u->thrust);
  out->vehicle_rates_setpoint.published = 1;
}

static int step(void* self, const attest_attitude_inputs* in, attest_attitude_outputs* out) {
  attitude_unit* u = self;
  const quat q = quat_of(in->vehicle_attitude.q);
  out->vehicle_rates_setpoint.published = 0;
  out->vehicle_attitude_setpoint.published = 0;

  if (!u->started || (in->updated & ATTEST_ATTITUDE_UPDATED_PARAMETER_UPDATE)) read_parameters(u);
  u->started = true;
  latch_hover_estimate(u, in);
  const uint64_t sampled = in->vehicle_attitude.timestamp_sample;
  const float dt = seconds_between(u->last, sampled, 0.0002f, 0.02f);
  u->last = sampled;
  receive_setpoint(u, in);
  if (u->profile->setpoint_first) follow_setpoint(u, in);
  latch_topics(u, in);

  /* A tailsitter is controlled in transition, too. */
  const bool run = u->attitude_controlled &&
                   ((u->rotary_wing && !u->in_transition) || (u->tailsitter && u->in_transition));
  const bool sticks = run && u->sticks_enabled;
  if (sticks) {
    attitude_setpoint sp = sticks_setpoint(u, q, dt);
    sp.timestamp = in->timestamp;
    publish_setpoint(u, &sp, out);
  } else {
    sticks_release(u, q, run);
  }
  if (run) {
    if (!u->profile->setpoint_first) follow_setpoint(u, in);
    publish_rates(u, q, in, out);
  }
  sticks_finish(u, sticks, dt);
  return ATTEST_OK;
}

/* ---- life cycle ------------------------------------------------------------------------------*/

static void* create(const char* profile_name) {
  const profile* selected = profile_find(profile_name);
  if (selected == NULL) return NULL;
  attitude_unit* u = calloc(1, sizeof *u);
  if (u == NULL) return NULL;
  u->profile = selected;
  u->rotary_wing = true;
  u->landed = true;
  u->heading_good = true;
  u->unaided_heading = NAN;
  u->hover_estimate = NAN;
  u->law.has_reference = selected->reference_model;
  u->law.q_d = (quat){1.0f, 0.0f, 0.0f, 0.0f};
  u->sticks.restart_yaw = true;
  parameters_initialise(table, TABLE_ROWS, selected, &u->parameters);
  return u;
}

static void destroy(void* self) { free(self); }

static int set_parameter(void* self, const char* name, float value) {
  attitude_unit* u = self;
  return parameters_set(table, TABLE_ROWS, u->profile, &u->parameters, name, value);
}

const attest_attitude_unit attitude_unit_table = {
    .create = create, .destroy = destroy, .set_parameter = set_parameter, .step = step};
