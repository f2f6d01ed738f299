/* SPDX-License-Identifier: BSD-3-Clause */
/* Model '<Root>': one step of the multicopter attitude controller. */
#include "mc_att_control.h"

#include <math.h>
#include <string.h>

#include "mc_att_control_private.h"

/* Subsystem '<Root>/Latch': what the model keeps of its inports. */
static void latch(RT_MODEL* rtM) {
  const P* rtP = rtM->defaultParam;
  const ExtU* rtU = rtM->inputs;
  DW* rtDW = rtM->dwork;
  if (!rtDW->NotFirstStep) {
    /* VT_TYPE 0 is the tailsitter. Later changes of these parameters have no effect. */
    rtDW->Tailsitter_Enabled = rtP->VT_TYPE == 0.0F && rtP->VT_OPT_RECOV_EN != 0.0F;
    rtDW->NotFirstStep = true;
  }
  if (rtU->rates_sp_new) {
    rtDW->RatesSp_Pending = true;
  }
  if (rtU->status_new && !rtDW->Status_Received) {
    rtDW->Status_Received = true;
    rtDW->Topics_Virtual = rtU->is_vtol;
  }
  if (rtU->mode_new) {
    rtDW->Attitude_Enabled = rtU->mode.attitude_enabled;
  }
  if (rtU->mode.rattitude_enabled &&
      (fabsf(rtU->sticks.y) > rtP->MC_RATT_TH || fabsf(rtU->sticks.x) > rtP->MC_RATT_TH)) {
    rtDW->Attitude_Enabled = false;
  }
}

/* Subsystem '<Root>/PublishRatesSp': replaces a pending external sample on the same topic. */
static void publish_rates_sp(RT_MODEL* rtM) {
  DW* rtDW = rtM->dwork;
  RatesSetpoint* rtb_Copy = &rtDW->Latch_rates_sp_DSTATE;
  memcpy(rtb_Copy->rates, rtDW->RatesSp_DSTATE, sizeof(rtb_Copy->rates));
  rtb_Copy->thrust = rtDW->ThrustSp_DSTATE;
  if (rtDW->Status_Received) {
    rtM->outputs->rates_sp = *rtb_Copy;
    rtM->outputs->rates_sp_valid = true;
    if (!rtDW->Topics_Virtual) {
      rtDW->RatesSp_Pending = false;
    }
  }
}

/* IfAction '<Root>/Attitude'. */
static void attitude_mode(RT_MODEL* rtM) {
  DW* rtDW = rtM->dwork;
  rtDW->Latch_attitude_sp_DSTATE = rtM->inputs->attitude_sp;
  if (rtDW->Tailsitter_Enabled) {
    mc_att_control_tailsitter(rtM);
  } else {
    mc_att_control_attitude_loop(rtM);
  }
  rtDW->ThrustSp_DSTATE = rtDW->Latch_attitude_sp_DSTATE.thrust;
}

/* IfAction '<Root>/Acro'. */
static void acro_mode(RT_MODEL* rtM) {
  const P* rtP = rtM->defaultParam;
  const Sticks* rtb_Sticks = &rtM->inputs->sticks;
  DW* rtDW = rtM->dwork;
  rtDW->RatesSp_DSTATE[0] = rtb_Sticks->y * rt_deg2rad(rtP->MC_ACRO_R_MAX);
  rtDW->RatesSp_DSTATE[1] = -rtb_Sticks->x * rt_deg2rad(rtP->MC_ACRO_P_MAX);
  rtDW->RatesSp_DSTATE[2] = rtb_Sticks->r * rt_deg2rad(rtP->MC_ACRO_Y_MAX);
  /* NaN gives 0.9. */
  rtDW->ThrustSp_DSTATE = rtb_Sticks->z < 0.9F ? rtb_Sticks->z : 0.9F;
}

/* IfAction '<Root>/OffboardRates'. */
static void offboard_rates_mode(RT_MODEL* rtM) {
  DW* rtDW = rtM->dwork;
  if (rtDW->RatesSp_Pending) {
    rtDW->RatesSp_Pending = false;
    rtDW->Latch_rates_sp_DSTATE = rtM->inputs->rates_sp;
  }
  memcpy(rtDW->RatesSp_DSTATE, rtDW->Latch_rates_sp_DSTATE.rates, sizeof(rtDW->RatesSp_DSTATE));
  rtDW->ThrustSp_DSTATE = rtDW->Latch_rates_sp_DSTATE.thrust;
}

/* If '<Root>/Mode'. */
static void outer_loop(RT_MODEL* rtM) {
  if (rtM->dwork->Attitude_Enabled) {
    attitude_mode(rtM);
    publish_rates_sp(rtM);
  } else if (rtM->inputs->mode.manual_enabled) {
    acro_mode(rtM);
    publish_rates_sp(rtM);
  } else {
    offboard_rates_mode(rtM);
  }
}

/* Subsystem '<S3>/Tpa': thrust-based attenuation. NaN thrust gives 1, because fminf ignores NaN. */
static real32_T tpa_factor(const RT_MODEL* rtM) {
  const P* rtP = rtM->defaultParam;
  const real32_T thrust = fabsf(rtM->dwork->Latch_rates_sp_DSTATE.thrust);
  real32_T y = 1.0F;
  if (rtP->law_version != LawVersion_v1_3_4) {
    y = fmaxf(0.0F, fminf(1.0F, 1.0F - rtP->MC_TPA_SLOPE * (thrust - rtP->MC_TPA_BREAK)));
  }
  return y;
}

/* Subsystem '<S3>/Integrator' of one axis. */
static void integrate(RT_MODEL* rtM, int32_T axis, real32_T rtu_Increment, real32_T rtu_Control) {
  const MotorLimits* rtb_Limits = &rtM->inputs->limits;
  DW* rtDW = rtM->dwork;
  const real32_T Next = rtDW->Integrator_DSTATE[axis] + rtu_Increment;
  boolean_T Freeze = rtb_Limits->lower_limit || rtb_Limits->upper_limit;
  if (axis == 2 && rtM->defaultParam->law_version != LawVersion_v1_3_4) {
    Freeze = Freeze || rtb_Limits->yaw;
  }
  /* Up to a thrust of 0.2 the vehicle may stand on the ground. No comparison holds for NaN. */
  if (!Freeze && rtDW->ThrustSp_DSTATE > 0.2F && fabsf(rtu_Control) < rtDW->ThrustSp_DSTATE &&
      fabsf(rtu_Control) < 0.3F && fabsf(Next) < 0.3F) {
    rtDW->Integrator_DSTATE[axis] = Next;
  }
}

/* Subsystem '<Root>/RateController'. `rtu_dt` in [s], not 0. */
static void rate_controller(RT_MODEL* rtM, real32_T rtu_dt, real32_T rty_Control[3]) {
  const P* rtP = rtM->defaultParam;
  const ExtU* rtU = rtM->inputs;
  DW* rtDW = rtM->dwork;
  const real32_T Roll = 0.2F / rtP->MC_ROLL_TC;
  const real32_T Pitch = 0.2F / rtP->MC_PITCH_TC;
  const real32_T Gain_P[3] = {rtP->MC_ROLLRATE_P * Roll, rtP->MC_PITCHRATE_P * Pitch,
                              rtP->MC_YAWRATE_P};
  const real32_T Gain_I[3] = {rtP->MC_ROLLRATE_I, rtP->MC_PITCHRATE_I, rtP->MC_YAWRATE_I};
  const real32_T Gain_D[3] = {rtP->MC_ROLLRATE_D * Roll, rtP->MC_PITCHRATE_D * Pitch,
                              rtP->MC_YAWRATE_D};
  const real32_T Gain_FF[3] = {rtP->MC_ROLLRATE_FF, rtP->MC_PITCHRATE_FF, rtP->MC_YAWRATE_FF};
  const real32_T Tpa = tpa_factor(rtM);
  int32_T i;
  if (!rtU->armed || !rtU->is_rotary_wing) {
    /* The update below still runs in this step. */
    memset(rtDW->Integrator_DSTATE, 0, sizeof(rtDW->Integrator_DSTATE));
  }
  for (i = 0; i < 3; i++) {
    const real32_T Rate_sp = rtDW->RatesSp_DSTATE[i];
    const real32_T Error = Rate_sp - rtU->rates[i];
    const real32_T Proportional = Gain_P[i] * (Error * Tpa);
    const real32_T Derivative = Gain_D[i] * (rtDW->UnitDelay_rates_DSTATE[i] - rtU->rates[i]);
    real32_T Feed_forward = Gain_FF[i] * Rate_sp;
    if (rtP->law_version == LawVersion_v1_3_4) {
      Feed_forward = Gain_FF[i] * (Rate_sp - rtDW->UnitDelay_rates_sp_DSTATE[i]) / rtu_dt;
    }
    rty_Control[i] =
        ((Proportional + Derivative / rtu_dt) + rtDW->Integrator_DSTATE[i]) + Feed_forward;
    integrate(rtM, i, Gain_I[i] * Error * rtu_dt, rty_Control[i]);
    rtDW->UnitDelay_rates_DSTATE[i] = rtU->rates[i];
    rtDW->UnitDelay_rates_sp_DSTATE[i] = Rate_sp;
  }
}

static real32_T finite_or_zero(real32_T u) { return isfinite(u) ? u : 0.0F; }

/* Subsystem '<Root>/Actuators'. */
static void actuators(RT_MODEL* rtM, const real32_T rtu_Control[3]) {
  const P* rtP = rtM->defaultParam;
  const ExtU* rtU = rtM->inputs;
  ExtY* rtY = rtM->outputs;
  int32_T i;
  if (!rtM->dwork->Status_Received || rtP->CBRK_RATE_CTRL == 140253.0F) {
    return;
  }
  for (i = 0; i < 3; i++) {
    rtY->control[i] = finite_or_zero(rtu_Control[i]);
  }
  rtY->control[3] = finite_or_zero(rtM->dwork->ThrustSp_DSTATE);
  if (rtP->law_version != LawVersion_v1_3_4) {
    rtY->control[7] = rtM->dwork->Latch_attitude_sp_DSTATE.landing_gear;
    /* After the check for finite controls: an infinite scale gives infinite controls. */
    if (rtP->MC_BAT_SCALE_EN != 0.0F && rtU->battery_scale > 0.0F) {
      for (i = 0; i < 4; i++) {
        rtY->control[i] *= rtU->battery_scale;
      }
    }
  }
  rtY->control_valid = true;
}

void mc_att_control_step(RT_MODEL* rtM) {
  ExtY* rtY = rtM->outputs;
  real32_T rtb_Control[3];
  /* The limits are part of the law: above 500 Hz the law still uses 2 ms. */
  const real32_T dt = rt_saturate((real32_T)rtM->inputs->elapsed / 1.0E+6F, 0.002F, 0.02F);
  rtY->rates_sp_valid = false;
  rtY->control_valid = false;
  rtY->rates_int_valid = false;
  latch(rtM);
  outer_loop(rtM);
  if (rtM->inputs->mode.rates_enabled) {
    rate_controller(rtM, dt, rtb_Control);
    actuators(rtM, rtb_Control);
    memcpy(rtY->rates_int, rtM->dwork->Integrator_DSTATE, sizeof(rtY->rates_int));
    rtY->rates_int_valid = true;
  }
}

void mc_att_control_initialize(RT_MODEL* rtM) {
  memset(rtM->inputs, 0, sizeof(*rtM->inputs));
  memset(rtM->outputs, 0, sizeof(*rtM->outputs));
  memset(rtM->dwork, 0, sizeof(*rtM->dwork));
}
