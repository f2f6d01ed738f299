/* SPDX-License-Identifier: BSD-3-Clause */
/*
 * mc_att_control.h - the multicopter attitude controller in the form that a code generator gives
 * to a model: inports rtU, outports rtY, parameters rtP, states rtDW.
 *
 *     rtM = {&rtP, &rtU, &rtY, &rtDW};
 *     mc_att_control_initialize(&rtM);
 *     each step: write rtU and, if changed, rtP; mc_att_control_step(&rtM); read rtY
 *
 * World is NED, body is FRD. Vectors are roll, pitch, yaw, and rates are [rad/s] about body x, y,
 * z. Quaternions are {w, x, y, z}, body to world.
 */
#ifndef RTW_HEADER_mc_att_control_h_
#define RTW_HEADER_mc_att_control_h_

#include "rtwtypes.h"

typedef enum { LawVersion_v1_5_5, LawVersion_v1_3_4 } LawVersion;

/* Buses. */
typedef struct {
  real32_T q_d[4];
  real32_T thrust;
  real32_T yaw_sp_move_rate;
  real32_T landing_gear;
  boolean_T disable_mc_yaw_control;
} AttitudeSetpoint;

typedef struct {
  real32_T rates[3];
  real32_T thrust;
} RatesSetpoint;

typedef struct {
  real32_T x, y, z, r;
} Sticks;

typedef struct {
  boolean_T manual_enabled, auto_enabled, velocity_enabled;
  boolean_T attitude_enabled, rattitude_enabled, rates_enabled;
} ControlMode;

typedef struct {
  boolean_T lower_limit, upper_limit, yaw;
} MotorLimits;

/* External inputs (root inports). An inport holds the last sample of its topic. A `..._new` is true
 * in the step in which a sample arrived. */
typedef struct {
  uint64_T elapsed; /* [us] since the previous step */
  real32_T q[4];
  real32_T rates[3];
  AttitudeSetpoint attitude_sp;
  RatesSetpoint rates_sp;
  boolean_T rates_sp_new;
  Sticks sticks;
  ControlMode mode;
  boolean_T mode_new;
  MotorLimits limits;
  real32_T battery_scale;
  boolean_T armed;
  boolean_T is_rotary_wing;
  boolean_T is_vtol;
  boolean_T status_new; /* of is_rotary_wing and is_vtol */
} ExtU;

/* External outputs (root outports). A `..._valid` is true in a step that publishes. */
typedef struct {
  RatesSetpoint rates_sp;
  boolean_T rates_sp_valid;
  real32_T control[8];
  boolean_T control_valid;
  real32_T rates_int[3];
  boolean_T rates_int_valid;
} ExtY;

/* Tunable parameters, with the names of PX4. Rates are in deg/s. */
typedef struct {
  LawVersion law_version;
  real32_T MC_ROLL_P, MC_PITCH_P, MC_YAW_P;
  real32_T MC_ROLL_TC, MC_PITCH_TC; /* [s] */
  real32_T MC_ROLLRATE_P, MC_ROLLRATE_I, MC_ROLLRATE_D, MC_ROLLRATE_FF;
  real32_T MC_PITCHRATE_P, MC_PITCHRATE_I, MC_PITCHRATE_D, MC_PITCHRATE_FF;
  real32_T MC_YAWRATE_P, MC_YAWRATE_I, MC_YAWRATE_D, MC_YAWRATE_FF;
  real32_T MC_YAW_FF;
  real32_T MC_ROLLRATE_MAX, MC_PITCHRATE_MAX, MC_YAWRATE_MAX, MC_YAWRAUTO_MAX;
  real32_T MC_ACRO_R_MAX, MC_ACRO_P_MAX, MC_ACRO_Y_MAX;
  real32_T MC_RATT_TH;
  real32_T MC_TPA_BREAK, MC_TPA_SLOPE;
  real32_T MC_BAT_SCALE_EN;
  real32_T VT_WV_YAWR_SCL;
  real32_T VT_TYPE, VT_OPT_RECOV_EN;
  real32_T CBRK_RATE_CTRL;
} P;

/* Block states. */
typedef struct {
  AttitudeSetpoint Latch_attitude_sp_DSTATE;
  RatesSetpoint Latch_rates_sp_DSTATE;
  real32_T RatesSp_DSTATE[3];
  real32_T ThrustSp_DSTATE;
  real32_T UnitDelay_rates_DSTATE[3];
  real32_T UnitDelay_rates_sp_DSTATE[3]; /* for law v1.3.4 */
  real32_T Integrator_DSTATE[3];
  boolean_T RatesSp_Pending;  /* an external sample that was not latched yet */
  boolean_T Attitude_Enabled; /* in rattitude, large sticks clear it until the next mode_new */
  boolean_T Status_Received;
  boolean_T Topics_Virtual; /* of the first status: a VTOL publishes on virtual topics */
  boolean_T Tailsitter_Enabled;
  boolean_T Relay_Recovering;
  boolean_T NotFirstStep;
} DW;

typedef struct {
  P* defaultParam;
  ExtU* inputs;
  ExtY* outputs;
  DW* dwork;
} RT_MODEL;

/* mc_att_control_data.c: the parameters' defaults. */
extern const P mc_att_control_default_P;

/* Sets inports, outports and states to 0. Does not change the parameters. */
void mc_att_control_initialize(RT_MODEL* rtM);

void mc_att_control_step(RT_MODEL* rtM);

#endif /* RTW_HEADER_mc_att_control_h_ */
