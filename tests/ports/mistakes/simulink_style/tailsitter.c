/* SPDX-License-Identifier: BSD-3-Clause */
/* Subsystem <Root>/Tailsitter: recovery of a tailsitter from a large tilt. */
#include "mc_att_control.h"

#define PI_F (3.14159274F)
#define HALF_PI_F (1.57079637F)

static void QuaternionMultiply(const real_T rtu_p[4], const real_T rtu_q[4], real_T rty_r[4]) {
  rty_r[0] =
      ((rtu_p[0] * rtu_q[0] - rtu_p[1] * rtu_q[1]) - rtu_p[2] * rtu_q[2]) - rtu_p[3] * rtu_q[3];
  rty_r[1] =
      ((rtu_p[0] * rtu_q[1] + rtu_p[1] * rtu_q[0]) + rtu_p[2] * rtu_q[3]) - rtu_p[3] * rtu_q[2];
  rty_r[2] =
      ((rtu_p[0] * rtu_q[2] - rtu_p[1] * rtu_q[3]) + rtu_p[2] * rtu_q[0]) + rtu_p[3] * rtu_q[1];
  rty_r[3] =
      ((rtu_p[0] * rtu_q[3] + rtu_p[1] * rtu_q[2]) - rtu_p[2] * rtu_q[1]) + rtu_p[3] * rtu_q[0];
}

static real_T Sigmoid(real_T u) { return 1.0F / (expf(-u) + 1.0F); }

/* Subsystem <S2>/TiltError: angle between the thrust axes; direction of its axis from body y. */
static real_T TiltError(const real_T rtu_q[4], const real_T rtu_qspConj[4], const real_T rtu_R[9],
                        real_T* rty_direction) {
  real_T rtb_qErr[4];
  real_T rtb_RErr[9];
  real_T rtb_axis[3];
  real_T rtb_body[2];
  real_T Acos_tilt;
  real_T Distance;
  int32_T i;
  QuaternionMultiply(rtu_q, rtu_qspConj, rtb_qErr);
  mc_att_control_Quat2Dcm(rtb_qErr, rtb_RErr);
  /* The third column of RErr, negated, is the thrust axis; its cosine with {0, 0, -1} is RErr[8].
   */
  if (rtb_RErr[8] > -1.0F && rtb_RErr[8] < 1.0F) {
    Acos_tilt = acosf(rtb_RErr[8]);
  } else if (rtb_RErr[8] > 0.0F) {
    Acos_tilt = 0.0F;
  } else {
    Acos_tilt = PI_F;
  }
  Distance = fminf(fabsf(Acos_tilt), fabsf(Acos_tilt - PI_F));
  rtb_axis[0] = 0.0F;
  rtb_axis[1] = 0.0F;
  rtb_axis[2] = -1.0F;
  if (Distance > 1.0E-5F) {
    rtb_axis[0] = rtb_RErr[7];
    rtb_axis[1] = -rtb_RErr[6];
    rtb_axis[2] = 0.0F;
  }
  for (i = 0; i < 2; i++) {
    rtb_body[i] = (rtu_R[3 * i] * rtb_axis[0] + rtu_R[3 * i + 1] * rtb_axis[1]) +
                  rtu_R[3 * i + 2] * rtb_axis[2];
  }
  *rty_direction = rt_atan2f_snf(rtb_body[0], rtb_body[1]);
  return Acos_tilt;
}

/* Subsystem <S2>/RecoveryRates: fitted to one quadrant of directions, the others by symmetry. */
static void RecoveryRates(real_T rtu_tilt, real_T rtu_direction, real_T rty_rates[3]) {
  real_T Sign_roll = 1.0F;
  real_T Sign_pitch = 1.0F;
  real_T Sign_yaw = 1.0F;
  real_T y;
  real_T Product_share;
  if (rtu_direction < -HALF_PI_F) {
    y = rtu_direction + PI_F;
    Sign_roll = -1.0F;
    Sign_pitch = -1.0F;
  } else if (rtu_direction < 0.0F) {
    y = -rtu_direction;
    Sign_roll = -1.0F;
    Sign_yaw = -1.0F;
  } else if (rtu_direction < HALF_PI_F) {
    y = rtu_direction;
  } else {
    y = PI_F - rtu_direction;
    Sign_pitch = -1.0F;
    Sign_yaw = -1.0F;
  }
  y = HALF_PI_F - y;
  Product_share = y / HALF_PI_F;
  rty_rates[0] = -3.997F * rtu_tilt + 3.997F * rtu_tilt * Sigmoid((2.133F - rtu_tilt) * 4.013F) *
                                          (Product_share * Product_share);
  rty_rates[1] = (0.8725F * y + 1.38F) * y *
                 (expf((0.3586F - PI_F) * 2.642F) * Sigmoid((PI_F - 0.3586F) * 2.642F) -
                  Sigmoid((0.3586F - rtu_tilt) * 2.642F)) *
                 (1.676F * rtu_tilt);
  rty_rates[2] = (3.168F - 0.3913F * y) * y * ((rtu_tilt - PI_F) * 2.726F) *
                 (Sigmoid((rtu_tilt - 1.75F) * 2.298F) - Sigmoid(-1.75F * 2.298F));
  rty_rates[0] *= -Sign_roll;
  rty_rates[1] *= -Sign_pitch * 1.5F;
  rty_rates[2] *= -Sign_yaw;
}

void mc_att_control_Tailsitter(RT_MODEL* rtM) {
  const P_T* rtP = &rtM->rtP;
  DW_T* rtDW = &rtM->rtDW;
  const AttitudeSpBus* rtb_Sp = &rtDW->Latch_AttitudeSp_DSTATE;
  real_T* rtb_Rates = rtDW->RatesSp_DSTATE;
  real_T rtb_qspConj[4];
  real_T rtb_R[9];
  real_T rtb_qe[4];
  real_T rtb_P[3];
  real_T rtb_Max[3];
  real_T direction;
  real_T tilt;
  real_T Gain_sign;
  int32_T i;
  rtb_qspConj[0] = rtb_Sp->q_d[0];
  rtb_qspConj[1] = -rtb_Sp->q_d[1];
  rtb_qspConj[2] = -rtb_Sp->q_d[2];
  rtb_qspConj[3] = -rtb_Sp->q_d[3];
  mc_att_control_Quat2Dcm(rtM->rtU.q, rtb_R);
  tilt = TiltError(rtM->rtU.q, rtb_qspConj, rtb_R, &direction);
  if (tilt > mc_att_control_Deg2Rad(30.0F)) {
    rtDW->Relay_Recovery_Mode = true;
  } else if (tilt < mc_att_control_Deg2Rad(5.0F)) {
    rtDW->Relay_Recovery_Mode = false;
  }
  if (rtDW->Relay_Recovery_Mode) {
    RecoveryRates(tilt, direction, rtb_Rates);
  } else {
    QuaternionMultiply(rtb_qspConj, rtM->rtU.q, rtb_qe);
    mc_att_control_AttitudeGain(rtP, rtb_P);
    Gain_sign = rtb_qe[0] > 0.0F ? -2.0F : 2.0F;
    for (i = 0; i < 3; i++) {
      rtb_Rates[i] = Gain_sign * rtb_qe[i + 1] * rtb_P[i];
    }
    rtb_Rates[2] = mc_att_control_Saturate(rtb_Rates[2], -1.0F, 1.0F);
  }
  rtb_Rates[2] += rtb_Sp->yaw_sp_move_rate *
                  mc_att_control_Saturate(fmaxf(rtb_R[8], 0.0F), 0.0F, 1.0F) * rtP->YAW_FF;
  mc_att_control_RateLimits(rtP, false, rtb_Max);
  for (i = 0; i < 3; i++) {
    rtb_Rates[i] = mc_att_control_Saturate(rtb_Rates[i], -rtb_Max[i], rtb_Max[i]);
  }
}
