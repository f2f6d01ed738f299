// The parameters of the law: one table of names, defaults, units and meanings, and the raw values.
//
// Names and defaults are those of PX4 v1.5.5 (mc_att_control, vtol_att_control, commander). Angles
// and angular rates of parameters are in degrees; everything computed from them is in radians
// (gains.hpp). The law accepts values outside `min` .. `max`. That is the range in which a vehicle
// can be expected to fly: the documentation and the choice of random parameters use it.
//
// The table is static and constant; `Parameters` is a plain value. Any thread.
#pragma once

#include <string_view>

#include "controller/mc_att_control/profile.hpp"
#include "controller/parameter_table.hpp"

namespace attest::mc_att_control {

// Raw values, as set. Integer parameters are stored as the float of the same value.
struct Parameters {
  float mc_roll_tc, mc_pitch_tc;
  float mc_roll_p, mc_pitch_p, mc_yaw_p, mc_yaw_ff;
  float mc_rollrate_p, mc_rollrate_i, mc_rollrate_d, mc_rollrate_ff;
  float mc_pitchrate_p, mc_pitchrate_i, mc_pitchrate_d, mc_pitchrate_ff;
  float mc_yawrate_p, mc_yawrate_i, mc_yawrate_d, mc_yawrate_ff;
  float mc_rollrate_max, mc_pitchrate_max, mc_yawrate_max, mc_yawrauto_max;
  float mc_acro_r_max, mc_acro_p_max, mc_acro_y_max;
  float mc_ratt_th;
  float mc_tpa_break, mc_tpa_slope;
  float mc_bat_scale_en;
  float vt_wv_yawr_scl, vt_type, vt_opt_recov_en;
  float cbrk_rate_ctrl;
};

using attest::ParameterType;
using ParameterInfo = attest::ParameterInfo<Parameters, all_profiles>;
using ParameterTable = attest::ParameterTable<Parameters, all_profiles>;

// Every parameter of the law, in a fixed order.
ParameterTable parameter_table();

// The values of a new controller of any profile: each parameter has one default, and the newest
// profile has all parameters.
inline Parameters default_parameters() {
  return attest::default_parameters(parameter_table(), newest);
}

// Same as set_parameter() of parameter_table.hpp, with the table of the law.
inline bool set_parameter(Parameters& parameters, Profile profile, std::string_view name,
                          float value) {
  return attest::set_parameter(parameters, parameter_table(), profile, name, value);
}

}  // namespace attest::mc_att_control
