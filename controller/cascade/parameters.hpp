// The parameters of the cascade: a table for each unit with names, defaults, bounds, units and
// meanings, and the raw values.
//
// Names, defaults and bounds are those of PX4 v1.14.4, v1.15.4 and v1.16.0. Angles and angular
// rates of parameters are in degrees; everything computed from them is in radians (gains.hpp). The
// law does not enforce the bounds, which are those of the ground station.
//
// The tables are static and constant; `Parameters` is a plain value. Any thread.
#pragma once

#include <span>
#include <string_view>

#include "controller/cascade/profile.hpp"

namespace attest::cascade {

// Raw values, as set. Integer parameters are stored as the float of the same value. A unit uses
// only the parameters of its own table.
struct Parameters {
  // attitude unit
  float mc_roll_p, mc_pitch_p, mc_yaw_p, mc_yaw_weight;
  float mc_rollrate_max, mc_pitchrate_max, mc_yawrate_max;
  float mpc_man_tilt_max, mc_man_tilt_tau;
  float mpc_man_y_max, mpc_man_y_tau, mpc_hold_dz, mpc_yaw_expo;
  float mpc_manthr_min, mpc_thr_hover, mpc_thr_max, mpc_thr_curve;
  float mc_airmode, com_spoolup_time;
  // rate unit
  float mc_rollrate_p, mc_rollrate_i, mc_rollrate_d, mc_rollrate_ff, mc_rollrate_k, mc_rr_int_lim;
  float mc_pitchrate_p, mc_pitchrate_i, mc_pitchrate_d, mc_pitchrate_ff, mc_pitchrate_k,
      mc_pr_int_lim;
  float mc_yawrate_p, mc_yawrate_i, mc_yawrate_d, mc_yawrate_ff, mc_yawrate_k, mc_yr_int_lim;
  float mc_acro_r_max, mc_acro_p_max, mc_acro_y_max;
  float mc_acro_expo, mc_acro_expo_y, mc_acro_supexpo, mc_acro_supexpoy;
  float mc_yaw_tq_cutoff, mc_bat_scale_en;
};

enum class ParameterType { real, integer };

struct ParameterInfo {
  std::string_view name;
  float Parameters::*member;
  float default_value;
  float min;
  float max;              // infinity if there is no upper bound
  std::string_view unit;  // "1" when dimensionless
  ParameterType type;
  std::string_view description;
  ProfileRange profiles = all_profiles;  // versions of the law to which this row applies

  bool is_int() const { return type == ParameterType::integer; }
};

// Every parameter of a unit, in a fixed order. If default or bounds of a parameter differ between
// profiles, it has several rows; find_parameter() and default_parameters() select by profile.
using ParameterTable = std::span<const ParameterInfo>;
ParameterTable attitude_parameters();
ParameterTable rate_parameters();

// The row of that name for that profile, or nullptr if the profile has no such parameter.
const ParameterInfo* find_parameter(ParameterTable table, Profile profile, std::string_view name);

// The values of a new unit. Parameters that the profile does not have in this table are 0.
Parameters default_parameters(ParameterTable table, Profile profile);

// Sets one value by name. Returns false and changes no value if the profile has no parameter of
// that name, or if the parameter is an integer and the value is not a whole number.
bool set_parameter(Parameters& parameters, ParameterTable table, Profile profile,
                   std::string_view name, float value);

}  // namespace attest::cascade
