/* SPDX-License-Identifier: BSD-3-Clause */
/* Subsystem '<Root>/AttitudeLoop': attitude error to rates setpoint. */
#include <math.h>
#include <string.h>

#include "mc_att_control_private.h"

/* Product: y = u0 * u1. */
static void matrix_multiply(const real32_T u0[9], const real32_T u1[9], real32_T y[9]) {
  int32_T i;
  int32_T j;
  int32_T k;
  for (j = 0; j < 3; j++) {
    for (i = 0; i < 3; i++) {
      y[3 * j + i] = 0.0F;
      for (k = 0; k < 3; k++) {
        y[3 * j + i] += u0[3 * k + i] * u1[3 * j + k];
      }
    }
  }
}

/* Product: y = transpose(u0) * u1. */
static void transpose_multiply(const real32_T u0[9], const real32_T u1[9], real32_T y[9]) {
  int32_T i;
  int32_T j;
  for (j = 0; j < 9; j += 3) {
    for (i = 0; i < 9; i += 3) {
      y[j + i / 3] = rt_dot(&u0[i], &u1[j]);
    }
  }
}

/* The quaternion {w, x, y, z} of a rotation matrix. */
static void dcm2quat(const real32_T u[9], real32_T y[4]) {
  const real32_T trace = (u[0] + u[4]) + u[8];
  real32_T root;
  real32_T scale;
  if (trace > 0.0F) {
    root = sqrtf(trace + 1.0F);
    scale = 0.5F / root;
    y[0] = root * 0.5F;
    y[1] = (u[5] - u[7]) * scale;
    y[2] = (u[6] - u[2]) * scale;
    y[3] = (u[1] - u[3]) * scale;
  } else if (u[8] > (u[4] > u[0] ? u[4] : u[0])) {
    root = sqrtf(((u[8] - u[0]) - u[4]) + 1.0F);
    scale = 0.5F / root;
    y[0] = (u[1] - u[3]) * scale;
    y[1] = (u[6] + u[2]) * scale;
    y[2] = (u[7] + u[5]) * scale;
    y[3] = root * 0.5F;
  } else if (u[4] > u[0]) {
    root = sqrtf(((u[4] - u[8]) - u[0]) + 1.0F);
    scale = 0.5F / root;
    y[0] = (u[6] - u[2]) * scale;
    y[1] = (u[3] + u[1]) * scale;
    y[2] = root * 0.5F;
    y[3] = (u[7] + u[5]) * scale;
  } else {
    root = sqrtf(((u[0] - u[4]) - u[8]) + 1.0F);
    scale = 0.5F / root;
    y[0] = (u[5] - u[7]) * scale;
    y[1] = root * 0.5F;
    y[2] = (u[3] + u[1]) * scale;
    y[3] = (u[6] + u[2]) * scale;
  }
}

/* Subsystem '<S1>/Rodrigues': R turned about a body axis by an angle of known sine and cosine. */
static void rodrigues(const real32_T rtu_R[9], const real32_T rtu_axis[3], real32_T rtu_sine,
                      real32_T rtu_cosine, real32_T rty_R[9]) {
  real32_T rtb_K[9] = {0.0F};
  real32_T rtb_KK[9];
  real32_T rtb_Turn[9];
  int32_T i;
  rtb_K[1] = rtu_axis[2];
  rtb_K[2] = -rtu_axis[1];
  rtb_K[3] = -rtu_axis[2];
  rtb_K[5] = rtu_axis[0];
  rtb_K[6] = rtu_axis[1];
  rtb_K[7] = -rtu_axis[0];
  matrix_multiply(rtb_K, rtb_K, rtb_KK);
  for (i = 0; i < 9; i++) {
    const real32_T identity = i % 4 == 0 ? 1.0F : 0.0F;
    rtb_Turn[i] = (rtb_K[i] * rtu_sine + identity) + rtb_KK[i] * (1.0F - rtu_cosine);
  }
  matrix_multiply(rtu_R, rtb_Turn, rty_R);
}

/* Subsystem '<S1>/DirectRotation': mixes the direct rotation into rty_e with weight rtu_w. */
static void direct_rotation(const real32_T rtu_R[9], const real32_T rtu_R_sp[9], real32_T rtu_w,
                            real32_T rty_e[3]) {
  real32_T rtb_D[9];
  real32_T rtb_q[4];
  real32_T Switch_sign;
  int32_T i;
  transpose_multiply(rtu_R, rtu_R_sp, rtb_D);
  dcm2quat(rtb_D, rtb_q);
  Switch_sign = rtb_q[0] >= 0.0F ? 2.0F : -2.0F;
  for (i = 0; i < 3; i++) {
    rty_e[i] = (1.0F - rtu_w) * rty_e[i] + rtb_q[i + 1] * Switch_sign * rtu_w;
  }
}

/* Subsystem '<S1>/AttitudeError': rotation vector in body axes, thrust axis first, then yaw. */
static void attitude_error(const real32_T rtu_R[9], const real32_T rtu_R_sp[9], real32_T rtu_yaw_w,
                           real32_T rty_e[3]) {
  real32_T rtb_Cross[3];
  real32_T rtb_Axis[3];
  real32_T rtb_R_rp[9];
  real32_T Sine;
  real32_T Cosine;
  real32_T Angle;
  int32_T i;
  rt_cross(&rtu_R[6], &rtu_R_sp[6], rtb_Cross);
  rt_transpose_times_vector(rtu_R, rtb_Cross, rty_e);
  Sine = sqrtf(rt_dot(rty_e, rty_e));
  Cosine = rt_dot(&rtu_R[6], &rtu_R_sp[6]);
  if (Sine > 0.0F) {
    Angle = rt_atan2(Sine, Cosine);
    for (i = 0; i < 3; i++) {
      rtb_Axis[i] = rty_e[i] / Sine;
      rty_e[i] = rtb_Axis[i] * Angle;
    }
    rodrigues(rtu_R, rtb_Axis, Sine, Cosine, rtb_R_rp);
  } else {
    memcpy(rtb_R_rp, rtu_R, sizeof(rtb_R_rp));
  }
  rt_cross(&rtb_R_rp[0], &rtu_R_sp[0], rtb_Cross);
  rty_e[2] =
      rt_atan2(rt_dot(rtb_Cross, &rtu_R_sp[6]), rt_dot(&rtb_R_rp[0], &rtu_R_sp[0])) * rtu_yaw_w;
  if (Cosine < 0.0F) {
    direct_rotation(rtu_R, rtu_R_sp, Cosine * Cosine * rtu_yaw_w, rty_e);
  }
}

/* Subsystem '<S1>/WeatherVane': the wind may turn the nose, and no integral opposes it. */
static void weather_vane(RT_MODEL* rtM) {
  const P* rtP = rtM->defaultParam;
  DW* rtDW = rtM->dwork;
  const real32_T limit = rt_deg2rad(rtP->MC_YAWRAUTO_MAX) * rtP->VT_WV_YAWR_SCL;
  rtDW->RatesSp_DSTATE[2] = rt_saturate(rtDW->RatesSp_DSTATE[2], -limit, limit);
  rtDW->Integrator_DSTATE[2] = 0.0F;
}

void mc_att_control_attitude_loop(RT_MODEL* rtM) {
  const P* rtP = rtM->defaultParam;
  const ExtU* rtU = rtM->inputs;
  DW* rtDW = rtM->dwork;
  const AttitudeSetpoint* rtb_Sp = &rtDW->Latch_attitude_sp_DSTATE;
  const boolean_T old_law = rtP->law_version == LawVersion_v1_3_4;
  real32_T rtb_R[9];
  real32_T rtb_R_sp[9];
  real32_T rtb_e[3];
  real32_T rtb_Gain[3];
  real32_T rtb_Limit[3];
  real32_T Yaw_w;
  boolean_T Autonomous;
  boolean_T Vane;
  int32_T i;
  Autonomous = rtU->mode.velocity_enabled || (rtU->mode.auto_enabled && !old_law);
  Autonomous = Autonomous && !rtU->mode.manual_enabled;
  Vane = Autonomous && rtb_Sp->disable_mc_yaw_control;
  rt_quat2dcm(rtU->q, rtb_R);
  rt_quat2dcm(rtb_Sp->q_d, rtb_R_sp);
  Yaw_w = rtb_R_sp[8] * rtb_R_sp[8];
  attitude_error(rtb_R, rtb_R_sp, Yaw_w, rtb_e);
  rt_attitude_gains(rtP, rtb_Gain);
  rt_rate_limits(rtP, Autonomous, rtb_Limit);
  for (i = 0; i < 3; i++) {
    rtDW->RatesSp_DSTATE[i] = rt_saturate(rtb_Gain[i] * rtb_e[i], -rtb_Limit[i], rtb_Limit[i]);
  }
  if (Vane && old_law) {
    weather_vane(rtM);
  }
  /* Added after the limit, so the sum may exceed the limit. */
  rtDW->RatesSp_DSTATE[2] += rtb_Sp->yaw_sp_move_rate * Yaw_w * rtP->MC_YAW_FF;
  if (Vane) {
    weather_vane(rtM);
  }
}
