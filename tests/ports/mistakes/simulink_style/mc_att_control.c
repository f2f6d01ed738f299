/* SPDX-License-Identifier: BSD-3-Clause */
/* Model <Root>: one step of the multicopter attitude controller. */
#include "mc_att_control.h"

#include <string.h>

static const P_T rtP_default = {
    .ATT_P = {6.5F, 6.5F, 2.8F},
    .ATT_TC = {0.2F, 0.2F},
    .RATE_P = {0.15F, 0.15F, 0.2F},
    .RATE_I = {0.05F, 0.05F, 0.1F},
    .RATE_D = {0.003F, 0.003F, 0.0F},
    .RATE_FF = {0.0F, 0.0F, 0.0F},
    .RATE_MAX = {220.0F, 220.0F, 200.0F},
    .YAWRAUTO_MAX = 45.0F,
    .ACRO_MAX = {360.0F, 360.0F, 360.0F},
    .YAW_FF = 0.5F,
    .RATT_TH = 1.0F,
    .TPA_BREAK = 1.0F,
    .TPA_SLOPE = 1.0F,
    .WV_YAWR_SCL = 0.15F,
};

void mc_att_control_initialize(RT_MODEL* rtM, LawVersion law) {
  memset(rtM, 0, sizeof(RT_MODEL));
  rtM->Law = law;
  rtM->rtP = rtP_default;
  rtM->rtDW.Latch_Status_DSTATE.is_rotary_wing = true;
  rtM->rtDW.FirstStep = true;
}

/* Subsystem <Root>/SampleTime: seconds since the step before, within the bounds of the law. */
static real_T SampleTime(RT_MODEL* rtM) {
  DW_T* rtDW = &rtM->rtDW;
  uint64_T Sum_elapsed = rtM->rtU.timestamp - rtDW->UnitDelay_Timestamp_DSTATE;
  rtDW->UnitDelay_Timestamp_DSTATE = rtM->rtU.timestamp;
  return mc_att_control_Saturate((real_T)Sum_elapsed / 1.0E+6F, 0.002F, 0.02F);
}

/* Subsystem <Root>/Latch: sample and hold of the topics; the setpoints wait for their mode. */
static void Latch(RT_MODEL* rtM) {
  const ExtU_T* rtU = &rtM->rtU;
  DW_T* rtDW = &rtM->rtDW;
  if (rtU->attitude_sp_new) {
    rtDW->Pending_AttitudeSp_DSTATE = rtU->attitude_sp;
    rtDW->AttitudeSp_IsPending = true;
  }
  if (rtU->rates_sp_new) {
    rtDW->Pending_RatesSp_DSTATE = rtU->rates_sp;
    rtDW->RatesSp_IsPending = true;
  }
  if (rtU->manual_new) {
    rtDW->Latch_Manual_DSTATE = rtU->manual;
  }
  if (rtU->battery_new) {
    rtDW->Latch_BatteryScale_DSTATE = rtU->battery_scale;
  }
  if (rtU->mode_new) {
    rtDW->Latch_Mode_DSTATE = rtU->mode;
  }
  if (rtU->armed_new) {
    rtDW->Latch_Armed_DSTATE = rtU->armed;
  }
  if (rtU->status_new) {
    rtDW->Latch_Status_DSTATE = rtU->status;
    if (!rtDW->Status_Received) {
      rtDW->Status_Received = true;
      rtDW->Topics_AreVirtual = rtU->status.is_vtol;
    }
  }
  if (rtU->limits_new) {
    rtDW->Latch_Limits_DSTATE = rtU->limits;
  }
  if (rtDW->FirstStep) {
    rtDW->FirstStep = false;
    rtDW->Tailsitter_Enabled = rtM->rtP.VT_TYPE == 0.0F && rtM->rtP.VT_OPT_RECOV_EN != 0.0F;
  }
}

/* Chart <Root>/OuterLoopMode. A stick beyond the threshold ends attitude mode until the next
 * vehicle_control_mode. */
static OuterLoopMode SelectMode(const P_T* rtP, DW_T* rtDW) {
  ControlModeBus* rtb_Mode = &rtDW->Latch_Mode_DSTATE;
  OuterLoopMode y;
  if (rtb_Mode->rattitude_enabled && (fabsf(rtDW->Latch_Manual_DSTATE.y) > rtP->RATT_TH ||
                                      fabsf(rtDW->Latch_Manual_DSTATE.x) > rtP->RATT_TH)) {
    rtb_Mode->attitude_enabled = false;
  }
  if (rtb_Mode->attitude_enabled) {
    y = OuterLoop_Attitude;
  } else if (rtb_Mode->manual_enabled) {
    y = OuterLoop_Acro;
  } else {
    y = OuterLoop_OffboardRates;
  }
  return y;
}

/* Subsystem <Root>/PublishRatesSp. An own sample replaces a waiting one of the same topic. */
static void PublishRatesSp(RT_MODEL* rtM) {
  DW_T* rtDW = &rtM->rtDW;
  RatesSpBus* rtb_Copy = &rtDW->Latch_RatesSp_DSTATE;
  memcpy(rtb_Copy->rates, rtDW->RatesSp_DSTATE, sizeof(rtb_Copy->rates));
  rtb_Copy->thrust = rtDW->ThrustSp_DSTATE;
  if (rtDW->Status_Received) {
    rtM->rtY.rates_sp = *rtb_Copy;
    rtM->rtY.rates_sp_valid = true;
    rtDW->RatesSp_IsPending = rtDW->RatesSp_IsPending && rtDW->Topics_AreVirtual;
  }
}

/* SwitchCase <Root>/OuterLoop. */
static void OuterLoop(RT_MODEL* rtM) {
  const P_T* rtP = &rtM->rtP;
  DW_T* rtDW = &rtM->rtDW;
  const ManualBus* rtb_Manual = &rtDW->Latch_Manual_DSTATE;
  switch (SelectMode(rtP, rtDW)) {
    case OuterLoop_Attitude:
      if (rtDW->AttitudeSp_IsPending) {
        rtDW->Latch_AttitudeSp_DSTATE = rtDW->Pending_AttitudeSp_DSTATE;
        rtDW->AttitudeSp_IsPending = false;
      }
      if (rtDW->Tailsitter_Enabled) {
        mc_att_control_Tailsitter(rtM);
      } else {
        mc_att_control_AttitudeLoop(rtM);
      }
      rtDW->ThrustSp_DSTATE = rtDW->Latch_AttitudeSp_DSTATE.thrust;
      PublishRatesSp(rtM);
      break;

    case OuterLoop_Acro:
      rtDW->RatesSp_DSTATE[0] = mc_att_control_Deg2Rad(rtP->ACRO_MAX[0]) * rtb_Manual->y;
      rtDW->RatesSp_DSTATE[1] = mc_att_control_Deg2Rad(rtP->ACRO_MAX[1]) * -rtb_Manual->x;
      rtDW->RatesSp_DSTATE[2] = mc_att_control_Deg2Rad(rtP->ACRO_MAX[2]) * rtb_Manual->r;
      if (rtb_Manual->z < 0.9F) {
        rtDW->ThrustSp_DSTATE = rtb_Manual->z;
      } else {
        rtDW->ThrustSp_DSTATE = 0.9F;
      }
      PublishRatesSp(rtM);
      break;

    default:
      if (rtDW->RatesSp_IsPending) {
        rtDW->Latch_RatesSp_DSTATE = rtDW->Pending_RatesSp_DSTATE;
        rtDW->RatesSp_IsPending = false;
      }
      memcpy(rtDW->RatesSp_DSTATE, rtDW->Latch_RatesSp_DSTATE.rates, sizeof(rtDW->RatesSp_DSTATE));
      rtDW->ThrustSp_DSTATE = rtDW->Latch_RatesSp_DSTATE.thrust;
      break;
  }
}

/* Gains of P and D: roll and pitch are scaled by their time constants. */
static real_T TimeConstantScale(const P_T* rtP, int32_T axis) {
  return axis < 2 ? 0.2F / rtP->ATT_TC[axis] : 1.0F;
}

/* Subsystem <S3>/Tpa. */
static real_T Tpa(const RT_MODEL* rtM) {
  real_T Gain_tpa;
  if (rtM->Law == Law_v1_3_4) {
    Gain_tpa = 1.0F;
  } else {
    Gain_tpa = 1.0F - (fabsf(rtM->rtDW.Latch_RatesSp_DSTATE.thrust) - rtM->rtP.TPA_BREAK) *
                          rtM->rtP.TPA_SLOPE;
    if (rtIsNaNF(Gain_tpa)) {
      Gain_tpa = 1.0F;
    }
    Gain_tpa = mc_att_control_Saturate(Gain_tpa, 0.0F, 1.0F);
  }
  return Gain_tpa;
}

/* Subsystem <S3>/Integrator of one axis. */
static void Integrate(RT_MODEL* rtM, int32_T axis, real_T rtu_error, real_T rtu_control,
                      real_T rtu_dt) {
  DW_T* rtDW = &rtM->rtDW;
  const MotorLimitsBus* rtb_Limits = &rtDW->Latch_Limits_DSTATE;
  real_T Sum_next = rtM->rtP.RATE_I[axis] * rtu_error * rtu_dt + rtDW->Integrator_DSTATE[axis];
  boolean_T Freeze = rtb_Limits->lower_limit || rtb_Limits->upper_limit;
  Freeze = Freeze || (axis == 2 && rtb_Limits->yaw && rtM->Law == Law_v1_5_5);
  if (!Freeze && rtDW->ThrustSp_DSTATE > 0.2F && fabsf(rtu_control) < rtDW->ThrustSp_DSTATE &&
      fabsf(rtu_control) < 0.3F && fabsf(Sum_next) < 0.3F) {
    rtDW->Integrator_DSTATE[axis] = Sum_next;
  }
}

/* Subsystem <Root>/RateController. */
static void RateController(RT_MODEL* rtM, real_T rtu_dt, real_T rty_Control[3]) {
  const P_T* rtP = &rtM->rtP;
  DW_T* rtDW = &rtM->rtDW;
  real_T Gain_tpa = Tpa(rtM);
  real_T Sum_error;
  real_T Gain_P;
  real_T Gain_D;
  real_T Gain_FF;
  int32_T i;
  if (!rtDW->Latch_Armed_DSTATE || !rtDW->Latch_Status_DSTATE.is_rotary_wing) {
    memset(rtDW->Integrator_DSTATE, 0, sizeof(rtDW->Integrator_DSTATE));
  }
  for (i = 0; i < 3; i++) {
    Sum_error = rtDW->RatesSp_DSTATE[i] - rtM->rtU.rates[i];
    Gain_P = rtP->RATE_P[i] * TimeConstantScale(rtP, i) * Sum_error * Gain_tpa;
    Gain_D = rtP->RATE_D[i] * TimeConstantScale(rtP, i) *
             (rtDW->UnitDelay_Rates_DSTATE[i] - rtM->rtU.rates[i]) / rtu_dt;
    if (rtM->Law == Law_v1_3_4) {
      Gain_FF =
          (rtDW->RatesSp_DSTATE[i] - rtDW->UnitDelay_RatesSp_DSTATE[i]) * rtP->RATE_FF[i] / rtu_dt;
    } else {
      Gain_FF = rtP->RATE_FF[i] * rtDW->RatesSp_DSTATE[i];
    }
    rty_Control[i] = ((Gain_P + Gain_D) + rtDW->Integrator_DSTATE[i]) + Gain_FF;
    Integrate(rtM, i, Sum_error, rty_Control[i], rtu_dt);
    rtDW->UnitDelay_Rates_DSTATE[i] = rtM->rtU.rates[i];
    rtDW->UnitDelay_RatesSp_DSTATE[i] = rtDW->RatesSp_DSTATE[i];
  }
}

static real_T FiniteOrZero(real_T u) { return rtIsNaNF(u) || rtIsInfF(u) ? 0.0F : u; }

/* Subsystem <Root>/Actuators. */
static void Actuators(RT_MODEL* rtM, const real_T rtu_Control[3]) {
  DW_T* rtDW = &rtM->rtDW;
  real_T* rty_Control = rtM->rtY.control;
  int32_T i;
  if (!rtDW->Status_Received || (int32_T)rtM->rtP.CBRK_RATE_CTRL == 140253) {
    return;
  }
  memset(rty_Control, 0, sizeof(rtM->rtY.control));
  for (i = 0; i < 3; i++) {
    rty_Control[i] = FiniteOrZero(rtu_Control[i]);
  }
  rty_Control[3] = FiniteOrZero(rtDW->ThrustSp_DSTATE);
  if (rtM->Law == Law_v1_5_5) {
    rty_Control[7] = rtDW->Latch_AttitudeSp_DSTATE.landing_gear;
    if (rtM->rtP.BAT_SCALE_EN != 0.0F && rtDW->Latch_BatteryScale_DSTATE > 0.0F) {
      for (i = 0; i < 4; i++) {
        rty_Control[i] *= rtDW->Latch_BatteryScale_DSTATE;
      }
    }
  }
  rtM->rtY.control_valid = true;
}

void mc_att_control_step(RT_MODEL* rtM) {
  real_T rtb_Control[3];
  real_T Saturate_dt = SampleTime(rtM);
  rtM->rtY.rates_sp_valid = false;
  rtM->rtY.control_valid = false;
  rtM->rtY.rates_int_valid = false;
  Latch(rtM);
  OuterLoop(rtM);
  if (rtM->rtDW.Latch_Mode_DSTATE.rates_enabled) {
    RateController(rtM, Saturate_dt, rtb_Control);
    Actuators(rtM, rtb_Control);
    memcpy(rtM->rtY.rates_int, rtM->rtDW.Integrator_DSTATE, sizeof(rtM->rtY.rates_int));
    rtM->rtY.rates_int_valid = true;
  }
}
