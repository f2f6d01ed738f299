/* SPDX-License-Identifier: BSD-3-Clause */
/*
 * The outer loop of a tailsitter with VT_OPT_RECOV_EN: PX4 v1.5.5 TailsitterRecovery, called by
 * mc_att_control. Its rates return the vehicle from a large tilt as fast as possible. They are
 * fitted to the solutions of an optimisation, with the constants below. A port for multicopters
 * only can leave this file out and return ATTEST_UNSUPPORTED where it is called.
 */
#include <math.h>

#include "elementary.h"
#include "law.h"
#include "vector.h"

static void product(const float p[4], const float q[4], float out[4]) {
  out[0] = p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3];
  out[1] = p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2];
  out[2] = p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1];
  out[3] = p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0];
}

/* A value times the logistic function of v. It is one division, as in the recorded firmware: a
 * product with 1 / (1 + exp(-v)) has other last bits. */
static float times_sigmoid(float value, float v) { return value / (1.0f + law_exp(-v)); }

/* Returns the angle [rad] between the thrust axis and that of the setpoint. `direction` [rad] is
 * that of the tilt axis in the body's x-y plane, counted from y. */
static float tilt_error(const float q[4], const float q_sp_conj[4], const float R[9],
                        float* direction) {
  const float z_B[3] = {0.0f, 0.0f, -1.0f};
  float q_err[4], R_err[9], Rt[9], z_I[3], axis_I[3] = {0.0f, 0.0f, -1.0f}, axis[3];
  product(q, q_sp_conj, q_err);
  rotation_matrix(q_err, R_err);
  multiply_vector(R_err, z_B, z_I);
  const float cosine = dot(z_I, z_B);
  float tilt = law_acos(cosine);
  if (cosine >= 1.0f) tilt = 0.0f;
  if (cosine <= -1.0f) tilt = LAW_PI;
  if (fminf(fabsf(tilt), fabsf(tilt - LAW_PI)) > 1e-5f) cross(z_I, z_B, axis_I);
  transpose(R, Rt);
  multiply_vector(Rt, axis_I, axis);
  *direction = law_atan2(axis[0], axis[1]);
  return tilt;
}

/* The fit covers one quadrant of tilt directions; the others follow by symmetry. Returns the
 * direction in [0, pi/2] and the sign of each rate. */
static float fold_direction(float direction, float sign[3]) {
  static const float signs[4][3] = {
      {-1.0f, -1.0f, 1.0f}, {-1.0f, 1.0f, -1.0f}, {1.0f, 1.0f, 1.0f}, {1.0f, -1.0f, -1.0f}};
  int quadrant;
  if (direction < -LAW_PI / 2.0f) {
    quadrant = 0;
    direction += LAW_PI;
  } else if (direction < 0.0f) {
    quadrant = 1;
    direction = -direction;
  } else if (direction < LAW_PI / 2.0f) {
    quadrant = 2;
  } else {
    quadrant = 3;
    direction = LAW_PI - direction;
  }
  for (int i = 0; i < 3; i++) sign[i] = signs[quadrant][i];
  return direction;
}

static void recovery_rates(float tilt, float direction, float rates_sp[3]) {
  float sign[3];
  const float x = tilt;
  const float y = LAW_PI / 2.0f - fold_direction(direction, sign);
  const float roll_share = y / (LAW_PI / 2.0f);
  const float pitch_share = 1.38f * y + 0.8725f * (y * y);
  const float yaw_share = 3.168f * y - 0.3913f * (y * y);
  const float roll =
      -3.997f * x + roll_share * roll_share * times_sigmoid(3.997f * x, 4.013f * (2.133f - x));
  const float pitch =
      pitch_share * (times_sigmoid(-1.676f * x, 2.642f * (0.3586f - x)) +
                     times_sigmoid(1.676f * x * law_exp(2.642f * (0.3586f - LAW_PI)),
                                   2.642f * (LAW_PI - 0.3586f)));
  const float yaw = yaw_share * (times_sigmoid(2.726f * (x - LAW_PI), 2.298f * (x - 1.75f)) -
                                 times_sigmoid(2.726f * (x - LAW_PI), -1.75f * 2.298f));
  rates_sp[0] = roll * -sign[0];
  rates_sp[1] = pitch * (-sign[1] * 1.5f);
  rates_sp[2] = yaw * -sign[2];
}

/* Without a recovery: rates proportional to the imaginary part of the rotation to the setpoint. */
static void hold_rates(const gains* g, const float q[4], const float q_sp_conj[4],
                       float rates_sp[3]) {
  float q_e[4];
  product(q_sp_conj, q, q_e);
  const float sign = q_e[0] > 0.0f ? -2.0f : 2.0f;
  for (int i = 0; i < 3; i++) rates_sp[i] = g->att_p[i] * (q_e[1 + i] * sign);
  rates_sp[2] = clamp(rates_sp[2], -1.0f, 1.0f);
}

void tailsitter_law(controller* c) {
  const gains* g = &c->gains;
  const float* q = c->copy.control_state.q;
  const float* q_sp = c->copy.vehicle_attitude_setpoint.q_d;
  const float q_sp_conj[4] = {q_sp[0], -q_sp[1], -q_sp[2], -q_sp[3]};
  float R[9], direction;
  rotation_matrix(q, R);
  const float tilt = tilt_error(q, q_sp_conj, R, &direction);

  if (fabsf(tilt) > rad(30.0f)) {
    c->recovering = true;
  } else if (fabsf(tilt) < rad(5.0f)) {
    c->recovering = false;
  }
  if (c->recovering) {
    recovery_rates(tilt, direction, c->rates_sp);
  } else {
    hold_rates(g, q, q_sp_conj, c->rates_sp);
  }

  const float upright = clamp(fmaxf(R[8], 0.0f), 0.0f, 1.0f);
  c->rates_sp[2] += c->copy.vehicle_attitude_setpoint.yaw_sp_move_rate * upright * g->yaw_ff;
  for (int i = 0; i < 3; i++) {
    c->rates_sp[i] = clamp(c->rates_sp[i], -g->mc_rate_max[i], g->mc_rate_max[i]);
  }
}
