/* SPDX-License-Identifier: BSD-3-Clause */
/*
 * mc_att_control_private.h - blocks and subsystems that several files of the model use.
 *
 * Matrices are stored column by column. The order of every sum is part of the law: a dot product
 * and an element of a matrix product start at 0, and add the products in index order.
 */
#ifndef RTW_HEADER_mc_att_control_private_h_
#define RTW_HEADER_mc_att_control_private_h_

#include <math.h>

#include "mc_att_control.h"

#define RT_PIF 3.14159274F /* the single nearest to pi */

/* Subsystems of other files. They set rtDW.RatesSp_DSTATE from the latched attitude setpoint. */
void mc_att_control_attitude_loop(RT_MODEL* rtM);
void mc_att_control_tailsitter(RT_MODEL* rtM);

/* The nearest single. The functions of single precision are often off by the last bit. */
static inline real32_T rt_acos(real32_T u) { return (real32_T)acos((double)u); }
static inline real32_T rt_atan2(real32_T u0, real32_T u1) {
  return (real32_T)atan2((double)u0, (double)u1);
}
static inline real32_T rt_exp(real32_T u) { return (real32_T)exp((double)u); }

/* NaN passes through. */
static inline real32_T rt_saturate(real32_T u, real32_T lower, real32_T upper) {
  real32_T y;
  if (u < lower) {
    y = lower;
  } else if (u > upper) {
    y = upper;
  } else {
    y = u;
  }
  return y;
}

static inline real32_T rt_deg2rad(real32_T degrees) { return degrees / 180.0F * RT_PIF; }

static inline real32_T rt_dot(const real32_T u0[3], const real32_T u1[3]) {
  real32_T y = 0.0F;
  int32_T i;
  for (i = 0; i < 3; i++) {
    y += u0[i] * u1[i];
  }
  return y;
}

static inline void rt_cross(const real32_T u0[3], const real32_T u1[3], real32_T y[3]) {
  y[0] = u0[1] * u1[2] - u0[2] * u1[1];
  y[1] = u0[2] * u1[0] - u0[0] * u1[2];
  y[2] = u0[0] * u1[1] - u0[1] * u1[0];
}

/* y = transpose(u0) * u1. This sum starts at the first product, so it can be -0. */
static inline void rt_transpose_times_vector(const real32_T u0[9], const real32_T u1[3],
                                             real32_T y[3]) {
  int32_T i;
  for (i = 0; i < 9; i += 3) {
    y[i / 3] = (u0[i] * u1[0] + u0[i + 1] * u1[1]) + u0[i + 2] * u1[2];
  }
}

/* Rotation matrix, body to world. The quaternion is not normalised first. */
static inline void rt_quat2dcm(const real32_T u[4], real32_T y[9]) {
  const real32_T ww = u[0] * u[0];
  const real32_T xx = u[1] * u[1];
  const real32_T yy = u[2] * u[2];
  const real32_T zz = u[3] * u[3];
  y[0] = ((ww + xx) - yy) - zz;
  y[1] = (u[1] * u[2] + u[0] * u[3]) * 2.0F;
  y[2] = (u[1] * u[3] - u[0] * u[2]) * 2.0F;
  y[3] = (u[1] * u[2] - u[0] * u[3]) * 2.0F;
  y[4] = ((ww - xx) + yy) - zz;
  y[5] = (u[0] * u[1] + u[2] * u[3]) * 2.0F;
  y[6] = (u[0] * u[2] + u[1] * u[3]) * 2.0F;
  y[7] = (u[2] * u[3] - u[0] * u[1]) * 2.0F;
  y[8] = ((ww - xx) - yy) + zz;
}

/* Proportional gains of the attitude loop [1/s]. */
static inline void rt_attitude_gains(const P* rtP, real32_T y[3]) {
  y[0] = 0.2F / rtP->MC_ROLL_TC * rtP->MC_ROLL_P;
  y[1] = 0.2F / rtP->MC_PITCH_TC * rtP->MC_PITCH_P;
  y[2] = rtP->MC_YAW_P;
}

/* Limits of the rates setpoint [rad/s]. */
static inline void rt_rate_limits(const P* rtP, boolean_T autonomous, real32_T y[3]) {
  y[0] = rt_deg2rad(rtP->MC_ROLLRATE_MAX);
  y[1] = rt_deg2rad(rtP->MC_PITCHRATE_MAX);
  y[2] = rt_deg2rad(autonomous ? rtP->MC_YAWRAUTO_MAX : rtP->MC_YAWRATE_MAX);
}

#endif /* RTW_HEADER_mc_att_control_private_h_ */
