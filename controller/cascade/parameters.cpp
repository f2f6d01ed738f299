#include "controller/cascade/parameters.hpp"

#include <cmath>
#include <limits>

namespace attest::cascade {
namespace {

using P = Parameters;
constexpr ParameterType real = ParameterType::real;
constexpr ParameterType integer = ParameterType::integer;
constexpr float no_max = std::numeric_limits<float>::infinity();

// name, member, default, min, max, unit, type, description, profiles (all unless given)
constexpr ParameterInfo attitude_rows[] = {
    {"MC_ROLL_P", &P::mc_roll_p, 6.5f, 0.0f, 12.0f, "1/s", real,
     "roll rate setpoint for each radian of roll error"},
    {"MC_PITCH_P", &P::mc_pitch_p, 6.5f, 0.0f, 12.0f, "1/s", real,
     "pitch rate setpoint for each radian of pitch error"},
    {"MC_YAW_P", &P::mc_yaw_p, 2.8f, 0.0f, 5.0f, "1/s", real,
     "yaw rate setpoint for each radian of yaw error"},
    {"MC_YAW_WEIGHT", &P::mc_yaw_weight, 0.4f, 0.0f, 1.0f, "1", real,
     "share of the yaw error that is corrected together with the tilt"},
    {"MC_ROLLRATE_MAX", &P::mc_rollrate_max, 220.0f, 0.0f, 1800.0f, "deg/s", real,
     "limit of the roll rate setpoint"},
    {"MC_PITCHRATE_MAX", &P::mc_pitchrate_max, 220.0f, 0.0f, 1800.0f, "deg/s", real,
     "limit of the pitch rate setpoint"},
    {"MC_YAWRATE_MAX", &P::mc_yawrate_max, 200.0f, 0.0f, 1800.0f, "deg/s", real,
     "limit of the yaw rate setpoint"},
    {"MPC_MAN_TILT_MAX", &P::mpc_man_tilt_max, 35.0f, 1.0f, 70.0f, "deg", real,
     "tilt at full stick in stabilized mode", from_v1_15_4},
    {"MPC_MAN_TILT_MAX", &P::mpc_man_tilt_max, 35.0f, 0.0f, 90.0f, "deg", real,
     "tilt at full stick in stabilized mode", only_v1_14_4},
    {"MC_MAN_TILT_TAU", &P::mc_man_tilt_tau, 0.0f, 0.0f, 2.0f, "s", real,
     "time constant of the low-pass on the roll and pitch sticks"},
    {"MPC_MAN_Y_MAX", &P::mpc_man_y_max, 150.0f, 0.0f, 400.0f, "deg/s", real,
     "yaw rate at full stick in stabilized mode"},
    {"MPC_MAN_Y_TAU", &P::mpc_man_y_tau, 0.08f, 0.0f, 5.0f, "s", real,
     "time constant of the low-pass on the yaw rate of the stick", from_v1_16_0},
    {"MPC_HOLD_DZ", &P::mpc_hold_dz, 0.1f, 0.0f, 1.0f, "1", real,
     "deflection of the yaw stick up to which the heading is held", from_v1_16_0},
    {"MPC_YAW_EXPO", &P::mpc_yaw_expo, 0.6f, 0.0f, 1.0f, "1", real,
     "share of the cubic part in the curve of the yaw stick", from_v1_16_0},
    {"MPC_MANTHR_MIN", &P::mpc_manthr_min, 0.08f, 0.0f, 1.0f, "1", real,
     "thrust at the lowest throttle in flight"},
    {"MPC_THR_HOVER", &P::mpc_thr_hover, 0.5f, 0.1f, 0.8f, "1", real,
     "hover thrust while it is not estimated"},
    {"MPC_THR_MAX", &P::mpc_thr_max, 1.0f, 0.0f, 1.0f, "1", real, "thrust at full throttle"},
    {"MPC_THR_CURVE", &P::mpc_thr_curve, 0.0f, 0.0f, 2.0f, "1", integer,
     "throttle curve: 0 through the estimated hover thrust, 1 straight, 2 through MPC_THR_HOVER",
     from_v1_16_0},
    {"MPC_THR_CURVE", &P::mpc_thr_curve, 0.0f, 0.0f, 1.0f, "1", integer,
     "throttle curve: 0 through MPC_THR_HOVER, 1 straight", until_v1_15_4},
    {"MC_AIRMODE", &P::mc_airmode, 0.0f, 0.0f, 2.0f, "1", integer,
     "2: yaw is controlled at the lowest throttle too"},
    {"COM_SPOOLUP_TIME", &P::com_spoolup_time, 1.0f, 0.0f, 30.0f, "s", real,
     "time after arming before thrust may rise", from_v1_15_4},
};

constexpr ParameterInfo rate_rows[] = {
    {"MC_ROLLRATE_P", &P::mc_rollrate_p, 0.15f, 0.01f, 0.5f, "s/rad", real,
     "roll torque for each rad/s of roll rate error"},
    {"MC_PITCHRATE_P", &P::mc_pitchrate_p, 0.15f, 0.01f, 0.6f, "s/rad", real,
     "pitch torque for each rad/s of pitch rate error"},
    {"MC_YAWRATE_P", &P::mc_yawrate_p, 0.2f, 0.0f, 0.6f, "s/rad", real,
     "yaw torque for each rad/s of yaw rate error"},
    {"MC_ROLLRATE_I", &P::mc_rollrate_i, 0.2f, 0.0f, no_max, "1/rad", real,
     "growth of the roll integral for each radian of accumulated error"},
    {"MC_PITCHRATE_I", &P::mc_pitchrate_i, 0.2f, 0.0f, no_max, "1/rad", real,
     "growth of the pitch integral for each radian of accumulated error"},
    {"MC_YAWRATE_I", &P::mc_yawrate_i, 0.1f, 0.0f, no_max, "1/rad", real,
     "growth of the yaw integral for each radian of accumulated error"},
    {"MC_RR_INT_LIM", &P::mc_rr_int_lim, 0.3f, 0.0f, no_max, "1", real,
     "limit of the roll integral"},
    {"MC_PR_INT_LIM", &P::mc_pr_int_lim, 0.3f, 0.0f, no_max, "1", real,
     "limit of the pitch integral"},
    {"MC_YR_INT_LIM", &P::mc_yr_int_lim, 0.3f, 0.0f, no_max, "1", real,
     "limit of the yaw integral"},
    {"MC_ROLLRATE_D", &P::mc_rollrate_d, 0.003f, 0.0f, 0.01f, "s^2/rad", real,
     "roll torque against each rad/s^2 of roll acceleration"},
    {"MC_PITCHRATE_D", &P::mc_pitchrate_d, 0.003f, 0.0f, no_max, "s^2/rad", real,
     "pitch torque against each rad/s^2 of pitch acceleration"},
    {"MC_YAWRATE_D", &P::mc_yawrate_d, 0.0f, 0.0f, no_max, "s^2/rad", real,
     "yaw torque against each rad/s^2 of yaw acceleration"},
    {"MC_ROLLRATE_FF", &P::mc_rollrate_ff, 0.0f, 0.0f, no_max, "s/rad", real,
     "roll torque for each rad/s of roll rate setpoint"},
    {"MC_PITCHRATE_FF", &P::mc_pitchrate_ff, 0.0f, 0.0f, no_max, "s/rad", real,
     "pitch torque for each rad/s of pitch rate setpoint"},
    {"MC_YAWRATE_FF", &P::mc_yawrate_ff, 0.0f, 0.0f, no_max, "s/rad", real,
     "yaw torque for each rad/s of yaw rate setpoint"},
    {"MC_ROLLRATE_K", &P::mc_rollrate_k, 1.0f, 0.01f, 5.0f, "1", real,
     "factor on P, I and D of roll"},
    {"MC_PITCHRATE_K", &P::mc_pitchrate_k, 1.0f, 0.01f, 5.0f, "1", real,
     "factor on P, I and D of pitch"},
    {"MC_YAWRATE_K", &P::mc_yawrate_k, 1.0f, 0.0f, 5.0f, "1", real, "factor on P, I and D of yaw"},
    {"MC_ACRO_R_MAX", &P::mc_acro_r_max, 100.0f, 0.0f, 1800.0f, "deg/s", real,
     "roll rate at full stick in acro", from_v1_15_4},
    {"MC_ACRO_R_MAX", &P::mc_acro_r_max, 720.0f, 0.0f, 1800.0f, "deg/s", real,
     "roll rate at full stick in acro", only_v1_14_4},
    {"MC_ACRO_P_MAX", &P::mc_acro_p_max, 100.0f, 0.0f, 1800.0f, "deg/s", real,
     "pitch rate at full stick in acro", from_v1_15_4},
    {"MC_ACRO_P_MAX", &P::mc_acro_p_max, 720.0f, 0.0f, 1800.0f, "deg/s", real,
     "pitch rate at full stick in acro", only_v1_14_4},
    {"MC_ACRO_Y_MAX", &P::mc_acro_y_max, 100.0f, 0.0f, 1800.0f, "deg/s", real,
     "yaw rate at full stick in acro", from_v1_15_4},
    {"MC_ACRO_Y_MAX", &P::mc_acro_y_max, 540.0f, 0.0f, 1800.0f, "deg/s", real,
     "yaw rate at full stick in acro", only_v1_14_4},
    {"MC_ACRO_EXPO", &P::mc_acro_expo, 0.0f, 0.0f, 1.0f, "1", real,
     "share of the cubic part in the curve of the roll and pitch sticks", from_v1_15_4},
    {"MC_ACRO_EXPO", &P::mc_acro_expo, 0.69f, 0.0f, 1.0f, "1", real,
     "share of the cubic part in the curve of the roll and pitch sticks", only_v1_14_4},
    {"MC_ACRO_EXPO_Y", &P::mc_acro_expo_y, 0.0f, 0.0f, 1.0f, "1", real,
     "share of the cubic part in the curve of the yaw stick", from_v1_15_4},
    {"MC_ACRO_EXPO_Y", &P::mc_acro_expo_y, 0.69f, 0.0f, 1.0f, "1", real,
     "share of the cubic part in the curve of the yaw stick", only_v1_14_4},
    {"MC_ACRO_SUPEXPO", &P::mc_acro_supexpo, 0.0f, 0.0f, 0.95f, "1", real,
     "how much steeper the roll and pitch sticks are near their ends", from_v1_15_4},
    {"MC_ACRO_SUPEXPO", &P::mc_acro_supexpo, 0.7f, 0.0f, 0.95f, "1", real,
     "how much steeper the roll and pitch sticks are near their ends", only_v1_14_4},
    {"MC_ACRO_SUPEXPOY", &P::mc_acro_supexpoy, 0.0f, 0.0f, 0.95f, "1", real,
     "how much steeper the yaw stick is near its ends", from_v1_15_4},
    {"MC_ACRO_SUPEXPOY", &P::mc_acro_supexpoy, 0.7f, 0.0f, 0.95f, "1", real,
     "how much steeper the yaw stick is near its ends", only_v1_14_4},
    {"MC_YAW_TQ_CUTOFF", &P::mc_yaw_tq_cutoff, 2.0f, 0.0f, 10.0f, "Hz", real,
     "cutoff of the low-pass on the yaw torque; 0: it passes all frequencies", from_v1_16_0},
    {"MC_BAT_SCALE_EN", &P::mc_bat_scale_en, 0.0f, 0.0f, 1.0f, "1", integer,
     "not 0: torque and thrust are multiplied by battery_status.scale"},
};

}  // namespace

ParameterTable attitude_parameters() { return attitude_rows; }
ParameterTable rate_parameters() { return rate_rows; }

const ParameterInfo* find_parameter(ParameterTable table, Profile profile, std::string_view name) {
  for (const ParameterInfo& info : table) {
    if (info.name == name && info.profiles.contains(profile)) return &info;
  }
  return nullptr;
}

Parameters default_parameters(ParameterTable table, Profile profile) {
  Parameters parameters{};
  for (const ParameterInfo& info : table) {
    if (info.profiles.contains(profile)) parameters.*info.member = info.default_value;
  }
  return parameters;
}

bool set_parameter(Parameters& parameters, ParameterTable table, Profile profile,
                   std::string_view name, float value) {
  const ParameterInfo* const info = find_parameter(table, profile, name);
  if (info == nullptr) return false;
  const bool is_integer = std::isfinite(value) && std::trunc(value) == value;
  if (info->is_int() && !is_integer) return false;
  parameters.*info->member = value;
  return true;
}

}  // namespace attest::cascade
