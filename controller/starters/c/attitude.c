/* SPDX-License-Identifier: BSD-3-Clause */
/* The outer loop: PX4 v1.5.5 mc_att_control, control_attitude. */
#include <math.h>
#include <string.h>

#include "elementary.h"
#include "law.h"
#include "vector.h"

/* R turned about the body axis `axis` by the angle of the given sine and cosine (Rodrigues). */
static void rotate_about(const float R[9], const float axis[3], float sine, float cosine,
                         float out[9]) {
  const float K[9] = {0.0f, -axis[2], axis[1], axis[2], 0.0f, -axis[0], -axis[1], axis[0], 0.0f};
  float KK[9], turn[9];
  multiply(K, K, KK);
  for (int i = 0; i < 9; i++) {
    const float identity = i % 4 == 0 ? 1.0f : 0.0f;
    turn[i] = (identity + K[i] * sine) + KK[i] * (1.0f - cosine);
  }
  multiply(R, turn, out);
}

static void quaternion_of(const float D[9], float q[4]) {
  const float trace = D[0] + D[4] + D[8];
  if (trace > 0.0f) {
    float s = sqrtf(trace + 1.0f);
    q[0] = s * 0.5f;
    s = 0.5f / s;
    q[1] = (D[7] - D[5]) * s;
    q[2] = (D[2] - D[6]) * s;
    q[3] = (D[3] - D[1]) * s;
    return;
  }
  int i = 0; /* the largest diagonal element, the first if several are */
  if (D[4] > D[0]) i = 1;
  if (D[8] > D[4 * i]) i = 2;
  const int j = (i + 1) % 3;
  const int k = (i + 2) % 3;
  float s = sqrtf((D[4 * i] - D[4 * j] - D[4 * k]) + 1.0f);
  q[1 + i] = s * 0.5f;
  s = 0.5f / s;
  q[1 + j] = (D[3 * i + j] + D[3 * j + i]) * s;
  q[1 + k] = (D[3 * k + i] + D[3 * i + k]) * s;
  q[0] = (D[3 * k + j] - D[3 * j + k]) * s;
}

/* Beyond 90 deg of tilt error the law mixes in the direct rotation: twice the imaginary part of the
 * quaternion from R to R_sp. */
static void mix_direct_rotation(const float Rt[9], const float R_sp[9], float cosine, float yaw_w,
                                float e[3]) {
  float D[9], q_e[4];
  multiply(Rt, R_sp, D);
  quaternion_of(D, q_e);
  const float direct_w = cosine * cosine * yaw_w;
  for (int i = 0; i < 3; i++) {
    const float imaginary = q_e[0] >= 0.0f ? q_e[1 + i] : -q_e[1 + i];
    e[i] = e[i] * (1.0f - direct_w) + imaginary * 2.0f * direct_w;
  }
}

/* The rotation vector, in body axes, that takes R to R_sp: thrust axis first, then yaw. The weight
 * `yaw_w` of the yaw falls as the tilt of the setpoint grows to 90 deg. */
static void attitude_error(const float R[9], const float R_sp[9], float yaw_w, float e[3]) {
  float Rt[9], z[3], z_sp[3], z_cross[3];
  transpose(R, Rt);
  column(R, 2, z);
  column(R_sp, 2, z_sp);
  cross(z, z_sp, z_cross);
  multiply_vector(Rt, z_cross, e);
  const float sine = length(e);
  const float cosine = dot(z, z_sp);

  float R_rp[9]; /* R with its thrust axis turned onto that of the setpoint */
  if (sine > 0.0f) {
    const float angle = law_atan2(sine, cosine);
    float axis[3];
    for (int i = 0; i < 3; i++) {
      axis[i] = e[i] / sine;
      e[i] = axis[i] * angle;
    }
    rotate_about(R, axis, sine, cosine, R_rp);
  } else {
    memcpy(R_rp, R, sizeof R_rp);
  }

  float x_sp[3], x_rp[3], x_cross[3];
  column(R_sp, 0, x_sp);
  column(R_rp, 0, x_rp);
  cross(x_rp, x_sp, x_cross);
  e[2] = law_atan2(dot(x_cross, z_sp), dot(x_rp, x_sp)) * yaw_w;

  if (cosine < 0.0f) mix_direct_rotation(Rt, R_sp, cosine, yaw_w, e);
}

/* The wind may turn the nose: the yaw rate has a small limit, and no integral opposes the wind. */
static void weather_vane(controller* c) {
  const float limit = c->gains.auto_rate_max[2] * c->gains.weather_vane_scale;
  c->rates_sp[2] = clamp(c->rates_sp[2], -limit, limit);
  c->rates_int[2] = 0.0f;
}

void attitude_law(controller* c) {
  const gains* g = &c->gains;
  const bool old = c->profile == PROFILE_PX4_V1_3_4;
  const bool piloted = c->copy.vehicle_control_mode.flag_control_manual_enabled;
  const bool autonomous =
      !piloted && (c->copy.vehicle_control_mode.flag_control_velocity_enabled ||
                   (!old && c->copy.vehicle_control_mode.flag_control_auto_enabled));
  const bool vane = autonomous && c->copy.vehicle_attitude_setpoint.disable_mc_yaw_control;

  float R[9], R_sp[9], e[3];
  rotation_matrix(c->copy.control_state.q, R);
  rotation_matrix(c->copy.vehicle_attitude_setpoint.q_d, R_sp);
  const float yaw_w = R_sp[8] * R_sp[8];
  attitude_error(R, R_sp, yaw_w, e);

  const float* rate_max = autonomous ? g->auto_rate_max : g->mc_rate_max;
  for (int i = 0; i < 3; i++) {
    c->rates_sp[i] = clamp(g->att_p[i] * e[i], -rate_max[i], rate_max[i]);
  }
  if (vane && old) weather_vane(c);
  /* Added after the limit, so the sum may exceed the limit. */
  c->rates_sp[2] += c->copy.vehicle_attitude_setpoint.yaw_sp_move_rate * yaw_w * g->yaw_ff;
  if (vane) weather_vane(c);
}
