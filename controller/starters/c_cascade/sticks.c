/* SPDX-License-Identifier: BSD-3-Clause */
/* Stabilized mode: sticks to an attitude setpoint. */
#include "attitude.h"

static const vec3 world_z = {0.0f, 0.0f, 1.0f};

/* With the throttle at its lowest, the motors keep authority over yaw only in MC_AIRMODE 2. */
static bool lacks_yaw_authority(const attitude_unit* u) {
  return u->throttle < -0.9f && u->parameters.airmode != 2.0f;
}

/* ---- yaw -------------------------------------------------------------------------------------*/

/* While the estimate of the heading converges, it changes although the vehicle does not turn. The
 * unaided heading, from the gyros alone, shows this. `error` is the estimated minus the unaided
 * heading. Returns its change since it was last steady [rad]. The yaw setpoint moves by this
 * change. */
static float yaw_correction(stick_state* s, float error, float dt) {
  const float change = wrap(error - s->yaw_error.state);
  lowpass_update(&s->yaw_error, 1.0f, dt, error);
  const bool was_converging = s->converging;
  s->converging = fabsf(change) > 0.0174532924f; /* 1 deg */
  if (!s->converging) {
    s->yaw_ref = error;
    if (was_converging) s->yaw_sp = NAN;
  }
  return wrap(error - s->yaw_ref);
}

/* The unaided heading is back. How the two headings changed without it is not known. */
static void restart_correction(stick_state* s, float error) {
  s->yaw_error.state = error;
  s->yaw_ref = error;
  s->correction = 0.0f;
  s->converging = false;
  s->yaw_sp = NAN;
}

static void correct_yaw(attitude_unit* u, float heading, float dt) {
  stick_state* s = &u->sticks;
  const bool was_lost = s->lost;
  s->lost = !isfinite(u->unaided_heading);
  if (s->lost) {
    if (!u->profile->keeps_lost_correction) s->correction = 0.0f;
    return;
  }
  const float error = wrap(heading - u->unaided_heading);
  if (was_lost && u->profile->keeps_lost_correction) {
    restart_correction(s, error);
  } else {
    s->correction = yaw_correction(s, error, dt);
  }
}

/* The yaw stick after its curve, [-1..1]. */
static float yaw_stick(const attitude_unit* u) {
  const attitude_parameters* p = &u->parameters;
  const float share = u->profile->yaw_expo_fixed ? 0.6f : p->yaw_expo;
  return expo(deadzone(u->yaw, p->hold_deadzone), share);
}

/* A centred yaw stick locks the heading. Returns the yaw of the setpoint. */
static float lock_yaw(attitude_unit* u, float heading, float dt, float* yaw_rate) {
  stick_state* s = &u->sticks;
  if (lacks_yaw_authority(u) || !u->heading_good) s->yaw_sp = NAN;

  const float old_correction = s->correction;
  correct_yaw(u, heading, dt);

  const float wanted = yaw_stick(u) * u->stick_yaw_max;
  *yaw_rate = lowpass_update(&s->yaw_rate, u->parameters.yaw_tau, dt, wanted);

  if (fabsf(*yaw_rate) > FLT_EPSILON) {
    s->yaw_sp = NAN;
  } else if (!isfinite(s->yaw_sp)) {
    s->yaw_sp = heading;
  } else {
    s->yaw_sp = wrap((s->yaw_sp - old_correction) + s->correction);
  }
  return isfinite(s->yaw_sp) ? s->yaw_sp : heading;
}

/* Before v1.16: the yaw setpoint is the integral of the yaw stick. */
static float integrate_yaw(attitude_unit* u, float heading, float dt, float* yaw_rate) {
  stick_state* s = &u->sticks;
  *yaw_rate = u->yaw * u->stick_yaw_max;
  if (s->restart_yaw || lacks_yaw_authority(u)) {
    s->yaw_sp = heading;
  } else {
    s->yaw_sp = wrap(s->yaw_sp + *yaw_rate * dt);
  }
  return s->yaw_sp;
}

/* ---- tilt ------------------------------------------------------------------------------------*/

static float filter_tilt(const attitude_unit* u, lowpass* f, float dt, float x) {
  const float tau = u->parameters.tilt_tau;
  if (!u->profile->lowpass_as_average) return lowpass_update(f, tau, dt, x);
  const float weight = lowpass_weight(f, tau, dt);
  f->state = (1.0f - weight) * f->state + weight * x;
  return f->state;
}

/* The rotation about a horizontal axis that the roll and pitch sticks ask for. */
static quat stick_tilt(attitude_unit* u, float dt) {
  const float limit = u->stick_tilt_max;
  const float roll = filter_tilt(u, &u->sticks.roll, dt, u->roll * limit);
  const float pitch = filter_tilt(u, &u->sticks.pitch, dt, u->pitch * limit);
  vec3 v = {roll, -pitch, 0.0f}; /* stick forward: nose down */
  const float tilt = length(v);
  if (tilt > limit) v = scale(v, limit / tilt);
  return quat_of_rotation_vector(v);
}

/* For a VTOL, whose yaw error may be large, because the wind turns the vehicle. The sticks command
 * a tilt relative to the present heading. Returns that tilt relative to the setpoint's yaw. */
static quat tilt_for_yaw_error(quat tilt, quat yaw, quat q) {
  const quat heading_only = quat_multiply(quat_inverse(quat_between(world_z, quat_z_axis(q))), q);
  const quat yaw_error = quat_multiply(quat_inverse(yaw), heading_only);
  return quat_between(world_z, quat_z_axis(quat_multiply(yaw_error, tilt)));
}

/* ---- throttle --------------------------------------------------------------------------------*/

/* v1.14.4: the limits of the thrust do not slew. */
static float fixed_throttle(const attitude_parameters* p, float stick) {
  const float s = (stick + 1.0f) * 0.5f;
  if (p->throttle_curve == 1.0f) return line(s, 0.0f, 1.0f, p->throttle_min, p->throttle_max);
  /* The firmware converts to int. On x86, a NaN and values beyond int select the lower line. */
  const float segment = s * 2.0f;
  const bool upper = segment >= 1.0f && segment < 2147483648.0f;
  return upper ? line(s, 0.5f, 1.0f, p->throttle_hover, p->throttle_max)
               : line(s, 0.0f, 0.5f, p->throttle_min, p->throttle_hover);
}

/* Since v1.15: the limits of the thrust slew after arming and landing. */
static float slewed_throttle(const attitude_unit* u, float stick) {
  const attitude_parameters* p = &u->parameters;
  const stick_state* s = &u->sticks;
  float thrust;
  if (p->throttle_curve == 1.0f) {
    thrust = line(stick, -1.0f, 1.0f, s->throttle_min, p->throttle_max);
  } else {
    const bool estimated = u->profile->hover_estimate && p->throttle_curve != 2.0f;
    const float hover = estimated ? s->hover : p->throttle_hover;
    thrust = stick > 0.0f ? line(stick, 0.0f, 1.0f, hover, p->throttle_max)
                          : line(stick, -1.0f, 0.0f, s->throttle_min, hover);
  }
  return min(thrust, s->throttle_max);
}

/* ---- interface -------------------------------------------------------------------------------*/

void sticks_read_parameters(attitude_unit* u) {
  u->stick_tilt_max = rad(u->parameters.tilt_max);
  u->stick_yaw_max = rad(u->parameters.yaw_max);
  if (!isfinite(u->hover_estimate)) u->sticks.hover = u->parameters.throttle_hover;
}

attitude_setpoint sticks_setpoint(attitude_unit* u, quat q, float dt) {
  attitude_setpoint sp = {0};
  const float heading = attitude_heading(u, q);
  const quat yaw = quat_of_yaw(u->profile->yaw_lock ? lock_yaw(u, heading, dt, &sp.yaw_rate)
                                                    : integrate_yaw(u, heading, dt, &sp.yaw_rate));
  quat tilt = stick_tilt(u, dt);
  if (u->vtol) tilt = tilt_for_yaw_error(tilt, yaw, q);
  sp.q_d = quat_multiply(yaw, tilt); /* not normalised */
  sp.thrust[2] = -(u->profile->throttle_slews ? slewed_throttle(u, u->throttle)
                                              : fixed_throttle(&u->parameters, u->throttle));
  return sp;
}

void sticks_release(attitude_unit* u, quat q, bool run) {
  stick_state* s = &u->sticks;
  if (run || u->profile->yaw_lock) {
    s->roll.state = 0.0f;
    s->pitch.state = 0.0f;
  }
  if (!u->profile->yaw_lock) return;
  s->yaw_sp = NAN;
  if (isfinite(u->unaided_heading)) {
    s->yaw_error.state = wrap(attitude_heading(u, q) - u->unaided_heading);
  }
}

void sticks_adapt(attitude_unit* u, float turn) {
  stick_state* s = &u->sticks;
  if (isfinite(s->yaw_sp)) s->yaw_sp = wrap(s->yaw_sp + turn);
  s->yaw_error.state = wrap(s->yaw_error.state + turn);
  s->yaw_ref = wrap(s->yaw_ref + turn);
}

void sticks_finish(attitude_unit* u, bool used, float dt) {
  stick_state* s = &u->sticks;
  s->throttle_min = slew(s->throttle_min, 0.05f, dt, u->landed ? 0.0f : u->parameters.throttle_min);
  s->throttle_max = u->spooled_up ? slew(s->throttle_max, 0.5f, dt, 1.0f) : 0.0f;
  if (isfinite(u->hover_estimate)) s->hover = slew(s->hover, 0.05f, dt, u->hover_estimate);
  s->restart_yaw = !used || !u->heading_good || (u->vtol && u->in_transition);
}
