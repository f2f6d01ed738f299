/* SPDX-License-Identifier: BSD-3-Clause */
/*
 * Subsystem '<Root>/Tailsitter': replaces AttitudeLoop for a tailsitter that recovers from a large
 * tilt. Its rates are fitted to the solutions of an optimisation. A model for multicopters only can
 * leave this file out; its wrapper must then declare the group `tailsitter` as unsupported.
 */
#include <math.h>

#include "mc_att_control_private.h"

static void quat_multiply(const real32_T u0[4], const real32_T u1[4], real32_T y[4]) {
  y[0] = ((u0[0] * u1[0] - u0[1] * u1[1]) - u0[2] * u1[2]) - u0[3] * u1[3];
  y[1] = ((u0[0] * u1[1] + u0[1] * u1[0]) + u0[2] * u1[3]) - u0[3] * u1[2];
  y[2] = ((u0[0] * u1[2] - u0[1] * u1[3]) + u0[2] * u1[0]) + u0[3] * u1[1];
  y[3] = ((u0[0] * u1[3] + u0[1] * u1[2]) - u0[2] * u1[1]) + u0[3] * u1[0];
}

/* A gain times the logistic function of u. It is one Divide block, as in the recorded firmware: a
 * product with 1 / (1 + exp(-u)) has other last bits. */
static real32_T times_sigmoid(real32_T gain, real32_T u) { return gain / (rt_exp(-u) + 1.0F); }

/* Subsystem '<S2>/Tilt': angle between the thrust axes [rad], and the direction [rad] of the tilt
 * axis in the body's x-y plane, counted from y. */
static void tilt_error(const real32_T rtu_q[4], const real32_T rtu_q_sp_conj[4],
                       real32_T* rty_Angle, real32_T* rty_Direction) {
  const real32_T Down[3] = {0.0F, 0.0F, -1.0F};
  real32_T rtb_q_err[4];
  real32_T rtb_R[9];
  real32_T rtb_Thrust[3];
  real32_T rtb_Axis[3] = {0.0F, 0.0F, -1.0F};
  real32_T rtb_Body[3];
  real32_T Cosine;
  int32_T i;
  quat_multiply(rtu_q, rtu_q_sp_conj, rtb_q_err);
  rt_quat2dcm(rtb_q_err, rtb_R);
  for (i = 0; i < 3; i++) {
    rtb_Thrust[i] = -rtb_R[6 + i];
  }
  Cosine = -rtb_Thrust[2];
  if (Cosine >= 1.0F) {
    *rty_Angle = 0.0F;
  } else if (Cosine <= -1.0F) {
    *rty_Angle = RT_PIF;
  } else {
    *rty_Angle = rt_acos(Cosine);
  }
  if (fminf(fabsf(*rty_Angle), fabsf(*rty_Angle - RT_PIF)) > 1.0E-5F) {
    rt_cross(rtb_Thrust, Down, rtb_Axis);
  }
  rt_quat2dcm(rtu_q, rtb_R);
  rt_transpose_times_vector(rtb_R, rtb_Axis, rtb_Body);
  *rty_Direction = rt_atan2(rtb_Body[0], rtb_Body[1]);
}

/* Subsystem '<S2>/Recovery': the fit covers one quadrant, the others follow by symmetry. */
static void recovery_rates(real32_T rtu_Angle, real32_T rtu_Direction, real32_T rty_Rates[3]) {
  const real32_T half_pi = RT_PIF / 2.0F;
  const real32_T x = rtu_Angle;
  real32_T Sign[3] = {1.0F, 1.0F, 1.0F};
  real32_T y;
  real32_T Share;
  if (rtu_Direction < -half_pi) {
    y = rtu_Direction + RT_PIF;
    Sign[0] = -1.0F;
    Sign[1] = -1.0F;
  } else if (rtu_Direction < 0.0F) {
    y = -rtu_Direction;
    Sign[0] = -1.0F;
    Sign[2] = -1.0F;
  } else if (rtu_Direction < half_pi) {
    y = rtu_Direction;
  } else {
    y = RT_PIF - rtu_Direction;
    Sign[1] = -1.0F;
    Sign[2] = -1.0F;
  }
  y = half_pi - y;
  Share = y / half_pi;
  rty_Rates[0] = -3.997F * x + Share * Share * times_sigmoid(3.997F * x, (2.133F - x) * 4.013F);
  rty_Rates[1] = (1.38F * y + 0.8725F * (y * y)) *
                 (times_sigmoid(-1.676F * x, (0.3586F - x) * 2.642F) +
                  times_sigmoid(1.676F * x * rt_exp((0.3586F - RT_PIF) * 2.642F),
                                (RT_PIF - 0.3586F) * 2.642F));
  rty_Rates[2] = (3.168F * y - 0.3913F * (y * y)) *
                 (times_sigmoid((x - RT_PIF) * 2.726F, (x - 1.75F) * 2.298F) -
                  times_sigmoid((x - RT_PIF) * 2.726F, -1.75F * 2.298F));
  rty_Rates[0] *= -Sign[0];
  rty_Rates[1] *= -Sign[1] * 1.5F;
  rty_Rates[2] *= -Sign[2];
}

/* Subsystem '<S2>/Hold': without a recovery, rates proportional to the rotation to the setpoint. */
static void hold_rates(const P* rtP, const real32_T rtu_q[4], const real32_T rtu_q_sp_conj[4],
                       real32_T rty_Rates[3]) {
  real32_T rtb_q_e[4];
  real32_T rtb_Gain[3];
  real32_T Switch_sign;
  int32_T i;
  quat_multiply(rtu_q_sp_conj, rtu_q, rtb_q_e);
  rt_attitude_gains(rtP, rtb_Gain);
  Switch_sign = rtb_q_e[0] > 0.0F ? -2.0F : 2.0F;
  for (i = 0; i < 3; i++) {
    rty_Rates[i] = rtb_Gain[i] * (rtb_q_e[i + 1] * Switch_sign);
  }
  rty_Rates[2] = rt_saturate(rty_Rates[2], -1.0F, 1.0F);
}

void mc_att_control_tailsitter(RT_MODEL* rtM) {
  const P* rtP = rtM->defaultParam;
  const ExtU* rtU = rtM->inputs;
  DW* rtDW = rtM->dwork;
  const AttitudeSetpoint* rtb_Sp = &rtDW->Latch_attitude_sp_DSTATE;
  real32_T rtb_q_sp_conj[4];
  real32_T rtb_R[9];
  real32_T rtb_Limit[3];
  real32_T Angle;
  real32_T Direction;
  int32_T i;
  rtb_q_sp_conj[0] = rtb_Sp->q_d[0];
  for (i = 1; i < 4; i++) {
    rtb_q_sp_conj[i] = -rtb_Sp->q_d[i];
  }
  tilt_error(rtU->q, rtb_q_sp_conj, &Angle, &Direction);
  if (fabsf(Angle) > rt_deg2rad(30.0F)) {
    rtDW->Relay_Recovering = true;
  } else if (fabsf(Angle) < rt_deg2rad(5.0F)) {
    rtDW->Relay_Recovering = false;
  }
  if (rtDW->Relay_Recovering) {
    recovery_rates(Angle, Direction, rtDW->RatesSp_DSTATE);
  } else {
    hold_rates(rtP, rtU->q, rtb_q_sp_conj, rtDW->RatesSp_DSTATE);
  }
  rt_quat2dcm(rtU->q, rtb_R);
  rtDW->RatesSp_DSTATE[2] +=
      rtb_Sp->yaw_sp_move_rate * rt_saturate(fmaxf(rtb_R[8], 0.0F), 0.0F, 1.0F) * rtP->MC_YAW_FF;
  rt_rate_limits(rtP, false, rtb_Limit);
  for (i = 0; i < 3; i++) {
    rtDW->RatesSp_DSTATE[i] = rt_saturate(rtDW->RatesSp_DSTATE[i], -rtb_Limit[i], rtb_Limit[i]);
  }
}
