/* SPDX-License-Identifier: BSD-3-Clause */
/* Subsystem <Root>/AttitudeLoop: attitude error to rates setpoint. */
#include "mc_att_control.h"

real_T mc_att_control_Saturate(real_T u, real_T lower, real_T upper) {
  real_T y;
  if (u < lower) {
    y = lower;
  } else if (u > upper) {
    y = upper;
  } else {
    y = u;
  }
  return y;
}

real_T mc_att_control_Deg2Rad(real_T degrees) { return degrees / 180.0F * 3.14159274F; }

void mc_att_control_AttitudeGain(const P_T* rtP, real_T rty_P[3]) {
  rty_P[0] = 0.2F / rtP->ATT_TC[0] * rtP->ATT_P[0];
  rty_P[1] = 0.2F / rtP->ATT_TC[1] * rtP->ATT_P[1];
  rty_P[2] = rtP->ATT_P[2];
}

void mc_att_control_RateLimits(const P_T* rtP, boolean_T rtu_Auto, real_T rty_Max[3]) {
  rty_Max[0] = mc_att_control_Deg2Rad(rtP->RATE_MAX[0]);
  rty_Max[1] = mc_att_control_Deg2Rad(rtP->RATE_MAX[1]);
  if (rtu_Auto) {
    rty_Max[2] = mc_att_control_Deg2Rad(rtP->YAWRAUTO_MAX);
  } else {
    rty_Max[2] = mc_att_control_Deg2Rad(rtP->RATE_MAX[2]);
  }
}

void mc_att_control_Quat2Dcm(const real_T rtu_q[4], real_T rty_R[9]) {
  real_T Product_ww = rtu_q[0] * rtu_q[0];
  real_T Product_xx = rtu_q[1] * rtu_q[1];
  real_T Product_yy = rtu_q[2] * rtu_q[2];
  real_T Product_zz = rtu_q[3] * rtu_q[3];
  rty_R[0] = ((Product_ww + Product_xx) - Product_yy) - Product_zz;
  rty_R[1] = (rtu_q[1] * rtu_q[2] + rtu_q[0] * rtu_q[3]) * 2.0F;
  rty_R[2] = (rtu_q[1] * rtu_q[3] - rtu_q[0] * rtu_q[2]) * 2.0F;
  rty_R[3] = (rtu_q[1] * rtu_q[2] - rtu_q[0] * rtu_q[3]) * 2.0F;
  rty_R[4] = ((Product_ww - Product_xx) + Product_yy) - Product_zz;
  rty_R[5] = (rtu_q[0] * rtu_q[1] + rtu_q[2] * rtu_q[3]) * 2.0F;
  rty_R[6] = (rtu_q[0] * rtu_q[2] + rtu_q[1] * rtu_q[3]) * 2.0F;
  rty_R[7] = (rtu_q[2] * rtu_q[3] - rtu_q[0] * rtu_q[1]) * 2.0F;
  rty_R[8] = ((Product_ww - Product_xx) - Product_yy) + Product_zz;
}

/* Product: A' * B if rtu_Transpose, else A * B. */
static void MatrixMultiply(const real_T rtu_A[9], const real_T rtu_B[9], boolean_T rtu_Transpose,
                           real_T rty_C[9]) {
  int32_T i;
  int32_T j;
  int32_T row = rtu_Transpose ? 3 : 1;
  int32_T step = rtu_Transpose ? 1 : 3;
  for (j = 0; j < 3; j++) {
    for (i = 0; i < 3; i++) {
      rty_C[i + 3 * j] =
          (rtu_A[row * i + step] * rtu_B[3 * j + 1] + rtu_A[row * i] * rtu_B[3 * j]) +
          rtu_A[row * i + 2 * step] * rtu_B[3 * j + 2];
    }
  }
}

static real_T DotProduct(const real_T rtu_a[3], const real_T rtu_b[3]) {
  return (rtu_a[0] * rtu_b[0] + rtu_a[1] * rtu_b[1]) + rtu_a[2] * rtu_b[2];
}

static void CrossProduct(const real_T rtu_a[3], const real_T rtu_b[3], real_T rty_c[3]) {
  rty_c[0] = rtu_a[1] * rtu_b[2] - rtu_a[2] * rtu_b[1];
  rty_c[1] = rtu_a[2] * rtu_b[0] - rtu_a[0] * rtu_b[2];
  rty_c[2] = rtu_a[0] * rtu_b[1] - rtu_a[1] * rtu_b[0];
}

/* Vector part of the quaternion of a matrix, of the sign that makes the scalar part positive. */
static void Dcm2RotationVector(const real_T rtu_D[9], real_T rty_v[3]) {
  real_T trace = (rtu_D[0] + rtu_D[4]) + rtu_D[8];
  real_T scale;
  real_T scalar;
  if (trace > 0.0F) {
    scalar = sqrtf(trace + 1.0F);
    scale = 0.5F / scalar;
    rty_v[0] = (rtu_D[5] - rtu_D[7]) * scale;
    rty_v[1] = (rtu_D[6] - rtu_D[2]) * scale;
    rty_v[2] = (rtu_D[1] - rtu_D[3]) * scale;
  } else if (rtu_D[0] >= rtu_D[4] && rtu_D[0] >= rtu_D[8]) {
    scale = sqrtf(((rtu_D[0] - rtu_D[4]) - rtu_D[8]) + 1.0F);
    rty_v[0] = scale * 0.5F;
    scale = 0.5F / scale;
    rty_v[1] = (rtu_D[3] + rtu_D[1]) * scale;
    rty_v[2] = (rtu_D[6] + rtu_D[2]) * scale;
    scalar = (rtu_D[5] - rtu_D[7]) * scale;
  } else if (rtu_D[4] >= rtu_D[8]) {
    scale = sqrtf(((rtu_D[4] - rtu_D[8]) - rtu_D[0]) + 1.0F);
    rty_v[1] = scale * 0.5F;
    scale = 0.5F / scale;
    rty_v[2] = (rtu_D[7] + rtu_D[5]) * scale;
    rty_v[0] = (rtu_D[3] + rtu_D[1]) * scale;
    scalar = (rtu_D[6] - rtu_D[2]) * scale;
  } else {
    scale = sqrtf(((rtu_D[8] - rtu_D[0]) - rtu_D[4]) + 1.0F);
    rty_v[2] = scale * 0.5F;
    scale = 0.5F / scale;
    rty_v[0] = (rtu_D[6] + rtu_D[2]) * scale;
    rty_v[1] = (rtu_D[7] + rtu_D[5]) * scale;
    scalar = (rtu_D[1] - rtu_D[3]) * scale;
  }
  if (!(scalar >= 0.0F)) {
    rty_v[0] = -rty_v[0];
    rty_v[1] = -rty_v[1];
    rty_v[2] = -rty_v[2];
  }
}

/* Rodrigues' formula: R turned about a body axis. */
static void RotateAboutAxis(const real_T rtu_R[9], const real_T rtu_axis[3], real_T rtu_sin,
                            real_T rtu_cos, real_T rty_R[9]) {
  real_T rtb_K[9];
  real_T rtb_KK[9];
  int32_T i;
  rtb_K[0] = 0.0F;
  rtb_K[1] = rtu_axis[2];
  rtb_K[2] = -rtu_axis[1];
  rtb_K[3] = -rtu_axis[2];
  rtb_K[4] = 0.0F;
  rtb_K[5] = rtu_axis[0];
  rtb_K[6] = rtu_axis[1];
  rtb_K[7] = -rtu_axis[0];
  rtb_K[8] = 0.0F;
  MatrixMultiply(rtb_K, rtb_K, false, rtb_KK);
  for (i = 0; i < 9; i++) {
    rtb_K[i] = (rtb_K[i] * rtu_sin + (i % 4 == 0 ? 1.0F : 0.0F)) + rtb_KK[i] * (1.0F - rtu_cos);
  }
  MatrixMultiply(rtu_R, rtb_K, false, rty_R);
}

/* Subsystem <S1>/AttitudeError: rotation vector in body axes, tilt first, then weighted yaw. */
static void AttitudeError(const real_T rtu_R[9], const real_T rtu_Rsp[9], real_T rtu_yaw_w,
                          real_T rty_e[3]) {
  real_T rtb_cross[3];
  real_T rtb_axis[3];
  real_T rtb_Rrp[9];
  real_T rtb_D[9];
  real_T Sqrt_sin;
  real_T Dot_cos;
  real_T Gain_angle;
  real_T Product_direct_w;
  int32_T i;
  CrossProduct(&rtu_R[6], &rtu_Rsp[6], rtb_cross);
  for (i = 0; i < 3; i++) {
    rty_e[i] = DotProduct(&rtu_R[3 * i], rtb_cross);
  }
  Sqrt_sin = sqrtf(DotProduct(rty_e, rty_e));
  Dot_cos = DotProduct(&rtu_R[6], &rtu_Rsp[6]);
  if (Sqrt_sin > 0.0F) {
    Gain_angle = rt_atan2f_snf(Sqrt_sin, Dot_cos);
    for (i = 0; i < 3; i++) {
      rtb_axis[i] = rty_e[i] / Sqrt_sin;
      rty_e[i] = rtb_axis[i] * Gain_angle;
    }
    RotateAboutAxis(rtu_R, rtb_axis, Sqrt_sin, Dot_cos, rtb_Rrp);
  } else {
    for (i = 0; i < 9; i++) {
      rtb_Rrp[i] = rtu_R[i];
    }
  }
  CrossProduct(&rtb_Rrp[0], &rtu_Rsp[0], rtb_cross);
  rty_e[2] =
      rt_atan2f_snf(DotProduct(rtb_cross, &rtu_Rsp[6]), DotProduct(&rtb_Rrp[0], &rtu_Rsp[0])) *
      rtu_yaw_w;
  if (Dot_cos < 0.0F) {
    MatrixMultiply(rtu_R, rtu_Rsp, true, rtb_D);
    Dcm2RotationVector(rtb_D, rtb_axis);
    Product_direct_w = Dot_cos * Dot_cos * rtu_yaw_w;
    for (i = 0; i < 3; i++) {
      rty_e[i] = (1.0F - Product_direct_w) * rty_e[i] + 2.0F * rtb_axis[i] * Product_direct_w;
    }
  }
}

void mc_att_control_AttitudeLoop(RT_MODEL* rtM) {
  const P_T* rtP = &rtM->rtP;
  DW_T* rtDW = &rtM->rtDW;
  const AttitudeSpBus* rtb_Sp = &rtDW->Latch_AttitudeSp_DSTATE;
  const ControlModeBus* rtb_Mode = &rtDW->Latch_Mode_DSTATE;
  real_T rtb_R[9];
  real_T rtb_Rsp[9];
  real_T rtb_e[3];
  real_T rtb_P[3];
  real_T rtb_Max[3];
  real_T Product_yaw_w;
  real_T Gain_vane;
  boolean_T LogicalOperator_Auto;
  int32_T i;
  if (rtM->Law == Law_v1_3_4) {
    LogicalOperator_Auto = rtb_Mode->velocity_enabled && !rtb_Mode->manual_enabled;
  } else {
    LogicalOperator_Auto =
        (rtb_Mode->velocity_enabled || rtb_Mode->auto_enabled) && !rtb_Mode->manual_enabled;
  }
  mc_att_control_Quat2Dcm(rtM->rtU.q, rtb_R);
  mc_att_control_Quat2Dcm(rtb_Sp->q_d, rtb_Rsp);
  Product_yaw_w = rtb_Rsp[8] * rtb_Rsp[8];
  AttitudeError(rtb_R, rtb_Rsp, Product_yaw_w, rtb_e);
  mc_att_control_AttitudeGain(rtP, rtb_P);
  mc_att_control_RateLimits(rtP, LogicalOperator_Auto, rtb_Max);
  for (i = 0; i < 3; i++) {
    rtDW->RatesSp_DSTATE[i] = mc_att_control_Saturate(rtb_P[i] * rtb_e[i], -rtb_Max[i], rtb_Max[i]);
  }
  Gain_vane = mc_att_control_Deg2Rad(rtP->YAWRAUTO_MAX) * rtP->WV_YAWR_SCL;
  LogicalOperator_Auto = LogicalOperator_Auto && rtb_Sp->disable_mc_yaw_control;
  if (LogicalOperator_Auto && rtM->Law == Law_v1_3_4) {
    rtDW->RatesSp_DSTATE[2] =
        mc_att_control_Saturate(rtDW->RatesSp_DSTATE[2], -Gain_vane, Gain_vane);
  }
  rtDW->RatesSp_DSTATE[2] += rtb_Sp->yaw_sp_move_rate * Product_yaw_w * rtP->YAW_FF;
  if (LogicalOperator_Auto) {
    rtDW->RatesSp_DSTATE[2] =
        mc_att_control_Saturate(rtDW->RatesSp_DSTATE[2], -Gain_vane, Gain_vane);
    rtDW->Integrator_DSTATE[2] = 0.0F;
  }
}
