/* SPDX-License-Identifier: BSD-3-Clause */
/*
 * mc_att_control.h - a model of the multicopter attitude controller in the manner of generated
 * code.
 *
 * rtU are the inputs, rtY the outputs, rtDW the states, rtP the parameters. Matrices are stored
 * column by column. World is NED, body is FRD; rates are rad/s, parameters in their own units.
 */
#ifndef RTW_HEADER_mc_att_control_h_
#define RTW_HEADER_mc_att_control_h_

#include "rtwtypes.h"

typedef enum { Law_v1_5_5, Law_v1_3_4 } LawVersion;

typedef enum { OuterLoop_Attitude, OuterLoop_Acro, OuterLoop_OffboardRates } OuterLoopMode;

typedef struct {
  real_T q_d[4];
  real_T thrust;
  real_T yaw_sp_move_rate;
  real_T landing_gear;
  boolean_T disable_mc_yaw_control;
} AttitudeSpBus;

typedef struct {
  real_T rates[3];
  real_T thrust;
} RatesSpBus;

typedef struct {
  real_T x, y, z, r;
} ManualBus;

typedef struct {
  boolean_T manual_enabled, auto_enabled, rates_enabled;
  boolean_T attitude_enabled, rattitude_enabled, velocity_enabled;
} ControlModeBus;

typedef struct {
  boolean_T is_rotary_wing, is_vtol;
} StatusBus;

typedef struct {
  boolean_T lower_limit, upper_limit, yaw;
} MotorLimitsBus;

/* External inputs; the booleans `..._new` are true in the step in which the topic arrived. */
typedef struct {
  uint64_T timestamp; /* [us] */
  real_T q[4];
  real_T rates[3];
  AttitudeSpBus attitude_sp;
  RatesSpBus rates_sp;
  ManualBus manual;
  real_T battery_scale;
  ControlModeBus mode;
  boolean_T armed;
  StatusBus status;
  MotorLimitsBus limits;
  boolean_T attitude_sp_new, rates_sp_new, manual_new, battery_new;
  boolean_T mode_new, armed_new, status_new, limits_new;
} ExtU_T;

/* External outputs. */
typedef struct {
  RatesSpBus rates_sp;
  boolean_T rates_sp_valid;
  real_T control[8];
  boolean_T control_valid;
  real_T rates_int[3];
  boolean_T rates_int_valid;
} ExtY_T;

/* Tunable parameters; vectors are roll, pitch, yaw. */
typedef struct {
  real_T ATT_P[3];
  real_T ATT_TC[2]; /* of roll and pitch [s] */
  real_T RATE_P[3], RATE_I[3], RATE_D[3], RATE_FF[3];
  real_T RATE_MAX[3]; /* [deg/s] */
  real_T YAWRAUTO_MAX;
  real_T ACRO_MAX[3]; /* [deg/s] */
  real_T YAW_FF;
  real_T RATT_TH;
  real_T TPA_BREAK;
  real_T TPA_SLOPE;
  real_T WV_YAWR_SCL;
  real_T BAT_SCALE_EN;
  real_T VT_TYPE;
  real_T VT_OPT_RECOV_EN;
  real_T CBRK_RATE_CTRL;
} P_T;

/* Block states. */
typedef struct {
  uint64_T UnitDelay_Timestamp_DSTATE;
  AttitudeSpBus Latch_AttitudeSp_DSTATE, Pending_AttitudeSp_DSTATE;
  RatesSpBus Latch_RatesSp_DSTATE, Pending_RatesSp_DSTATE;
  ManualBus Latch_Manual_DSTATE;
  real_T Latch_BatteryScale_DSTATE;
  ControlModeBus Latch_Mode_DSTATE;
  StatusBus Latch_Status_DSTATE;
  MotorLimitsBus Latch_Limits_DSTATE;
  real_T RatesSp_DSTATE[3];
  real_T ThrustSp_DSTATE;
  real_T UnitDelay_Rates_DSTATE[3];
  real_T UnitDelay_RatesSp_DSTATE[3];
  real_T Integrator_DSTATE[3];
  boolean_T Latch_Armed_DSTATE;
  boolean_T AttitudeSp_IsPending, RatesSp_IsPending;
  boolean_T Status_Received;
  boolean_T Topics_AreVirtual; /* of the first status */
  boolean_T Tailsitter_Enabled;
  boolean_T Relay_Recovery_Mode;
  boolean_T FirstStep;
} DW_T;

typedef struct {
  LawVersion Law;
  P_T rtP;
  ExtU_T rtU;
  ExtY_T rtY;
  DW_T rtDW;
} RT_MODEL;

/* Sets the parameters to their defaults and the states to those of power-on. */
void mc_att_control_initialize(RT_MODEL* rtM, LawVersion law);

/* One step: rtU to rtY. Reads rtP. */
void mc_att_control_step(RT_MODEL* rtM);

/* Subsystems of the step: they set rtDW.RatesSp_DSTATE. */
void mc_att_control_AttitudeLoop(RT_MODEL* rtM);
void mc_att_control_Tailsitter(RT_MODEL* rtM);

/* Subsystems of the attitude loops. `att_p` in 1/s, limits in rad/s. */
void mc_att_control_AttitudeGain(const P_T* rtP, real_T rty_P[3]);
void mc_att_control_RateLimits(const P_T* rtP, boolean_T rtu_Auto, real_T rty_Max[3]);
void mc_att_control_Quat2Dcm(const real_T rtu_q[4], real_T rty_R[9]);
real_T mc_att_control_Saturate(real_T u, real_T lower, real_T upper);
real_T mc_att_control_Deg2Rad(real_T degrees);

#endif /* RTW_HEADER_mc_att_control_h_ */
