// The parameters of the cascade: a table for each unit with names, defaults, bounds, units and
// meanings, and the raw values.
//
// Names, defaults and bounds are those of PX4 v1.14.4 to v1.18. Angles and angular
// rates of parameters are in degrees; everything computed from them is in radians (gains.hpp). The
// law does not enforce the bounds, which are those of the ground station.
//
// The tables are static and constant; `Parameters` is a plain value. Any thread.
#pragma once

#include "controller/cascade/profile.hpp"
#include "controller/parameter_table.hpp"

namespace attest::cascade {

// Raw values, as set. Integer parameters are stored as the float of the same value. A unit uses
// only the parameters of its own table.
struct Parameters {
  // attitude unit
  float mc_roll_p, mc_pitch_p, mc_yaw_p, mc_yaw_weight;
  float mc_rollrate_max, mc_pitchrate_max, mc_yawrate_max;
  float mpc_man_tilt_max, mc_man_tilt_tau;
  float mpc_man_y_max, mpc_man_y_tau;
  float man_deadzone;         // MPC_HOLD_DZ in v1.16.0
  float mpc_yaw_expo = 0.6f;  // a parameter of v1.16.0, and a constant since
  float mpc_manthr_min, mpc_thr_hover, mpc_thr_max, mpc_thr_curve;
  float mc_airmode, com_spoolup_time;
  float mc_ref_w_n, mc_ref_ff, mc_ref_ff_max;
  // rate unit
  float mc_rollrate_p, mc_rollrate_i, mc_rollrate_d, mc_rollrate_ff, mc_rollrate_k, mc_rr_int_lim;
  float mc_pitchrate_p, mc_pitchrate_i, mc_pitchrate_d, mc_pitchrate_ff, mc_pitchrate_k,
      mc_pr_int_lim;
  float mc_yawrate_p, mc_yawrate_i, mc_yawrate_d, mc_yawrate_ff, mc_yawrate_k, mc_yr_int_lim;
  float mc_acro_r_max, mc_acro_p_max, mc_acro_y_max;
  float mc_acro_expo, mc_acro_expo_y, mc_acro_supexpo, mc_acro_supexpoy;
  float mc_yaw_tq_cutoff, mc_bat_scale_en;
};

using attest::ParameterType;
using ParameterInfo = attest::ParameterInfo<Parameters, all_profiles>;
using ParameterTable = attest::ParameterTable<Parameters, all_profiles>;

// Every parameter of a unit, in a fixed order.
ParameterTable attitude_parameters();
ParameterTable rate_parameters();

}  // namespace attest::cascade
