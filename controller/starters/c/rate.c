/* SPDX-License-Identifier: BSD-3-Clause */
/* The inner loop: PX4 v1.5.5 mc_att_control, control_attitude_rates. */
#include <math.h>
#include <string.h>

#include "law.h"

#define MIN_TAKEOFF_THRUST 0.2f /* up to it the vehicle may stand on the ground: no integration */
#define RATES_INT_LIMIT 0.3f

/* Thrust-based attenuation of the P gain. fminf and fmaxf ignore a NaN: NaN thrust gives 1. */
static float tpa_factor(const gains* g, float thrust) {
  return fmaxf(0.0f, fminf(1.0f, 1.0f - g->tpa_slope * (fabsf(thrust) - g->tpa_break)));
}

static float feed_forward(const controller* c, int i, float dt) {
  if (c->profile == PROFILE_PX4_V1_3_4) {
    return c->gains.rate_ff[i] * (c->rates_sp[i] - c->rates_sp_prev[i]) / dt;
  }
  return c->gains.rate_ff[i] * c->rates_sp[i];
}

static bool inside_int_limit(float v) { return -RATES_INT_LIMIT < v && v < RATES_INT_LIMIT; }

static void integrate(controller* c, float dt, const float err[3], const float control[3]) {
  const bool at_limit =
      c->copy.multirotor_motor_limits.lower_limit || c->copy.multirotor_motor_limits.upper_limit;
  if (!(c->thrust_sp > MIN_TAKEOFF_THRUST) || at_limit) return;
  const bool yaw_frozen = c->profile != PROFILE_PX4_V1_3_4 && c->copy.multirotor_motor_limits.yaw;
  for (int i = 0; i < 3; i++) {
    if (!(fabsf(control[i]) < c->thrust_sp)) continue;
    const float next = c->rates_int[i] + c->gains.rate_i[i] * err[i] * dt;
    /* A NaN or infinite `next` is outside, too. */
    if (inside_int_limit(next) && inside_int_limit(control[i]) && !(i == 2 && yaw_frozen)) {
      c->rates_int[i] = next;
    }
  }
}

void rate_law(controller* c, float dt, float control[3]) {
  const gains* g = &c->gains;
  if (!c->copy.actuator_armed.armed || !c->copy.vehicle_status.is_rotary_wing) {
    memset(c->rates_int, 0, sizeof c->rates_int); /* integrate() below still runs in this step */
  }
  const float tpa = c->profile == PROFILE_PX4_V1_3_4
                        ? 1.0f
                        : tpa_factor(g, c->copy.vehicle_rates_setpoint.thrust);
  const float rates[3] = {c->copy.control_state.roll_rate, c->copy.control_state.pitch_rate,
                          c->copy.control_state.yaw_rate};
  float err[3];
  for (int i = 0; i < 3; i++) {
    err[i] = c->rates_sp[i] - rates[i];
    const float p = g->rate_p[i] * (err[i] * tpa);
    const float d = g->rate_d[i] * (c->rates_prev[i] - rates[i]) / dt;
    control[i] = ((p + d) + c->rates_int[i]) + feed_forward(c, i, dt);
  }
  memcpy(c->rates_prev, rates, sizeof c->rates_prev);
  memcpy(c->rates_sp_prev, c->rates_sp, sizeof c->rates_sp_prev);
  integrate(c, dt, err, control);
}
