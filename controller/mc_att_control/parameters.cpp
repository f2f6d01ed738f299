#include "controller/mc_att_control/parameters.hpp"

#include <array>

namespace attest::mc_att_control {
namespace {

using P = Parameters;
constexpr ParameterType real = ParameterType::real;
constexpr ParameterType integer = ParameterType::integer;

// name, member, default, min, max, unit, type, description, profiles (all unless given)
constexpr std::array<ParameterInfo, 33> all_parameters{{
    {"MC_ROLL_TC", &P::mc_roll_tc, 0.2f, 0.15f, 0.25f, "s", real,
     "roll time constant; 0.2 s divided by it scales MC_ROLL_P, MC_ROLLRATE_P and _D"},
    {"MC_PITCH_TC", &P::mc_pitch_tc, 0.2f, 0.15f, 0.25f, "s", real,
     "pitch time constant; 0.2 s divided by it scales MC_PITCH_P, MC_PITCHRATE_P and _D"},
    {"MC_ROLL_P", &P::mc_roll_p, 6.5f, 0.0f, 12.0f, "1/s", real,
     "roll rate setpoint for each radian of roll error"},
    {"MC_PITCH_P", &P::mc_pitch_p, 6.5f, 0.0f, 12.0f, "1/s", real,
     "pitch rate setpoint for each radian of pitch error"},
    {"MC_YAW_P", &P::mc_yaw_p, 2.8f, 0.0f, 5.0f, "1/s", real,
     "yaw rate setpoint for each radian of yaw error"},
    {"MC_YAW_FF", &P::mc_yaw_ff, 0.5f, 0.0f, 1.0f, "1", real,
     "share of the commanded yaw rate that is fed forward"},
    {"MC_ROLLRATE_P", &P::mc_rollrate_p, 0.15f, 0.0f, 0.5f, "s/rad", real,
     "roll control for each rad/s of roll rate error"},
    {"MC_ROLLRATE_I", &P::mc_rollrate_i, 0.05f, 0.0f, 0.5f, "1/rad", real,
     "growth of the roll integral for each radian of accumulated error"},
    {"MC_ROLLRATE_D", &P::mc_rollrate_d, 0.003f, 0.0f, 0.01f, "s^2/rad", real,
     "roll control against each rad/s^2 of roll acceleration"},
    {"MC_ROLLRATE_FF", &P::mc_rollrate_ff, 0.0f, 0.0f, 1.0f, "s/rad", real,
     "roll control for each rad/s of roll rate setpoint"},
    {"MC_PITCHRATE_P", &P::mc_pitchrate_p, 0.15f, 0.0f, 0.5f, "s/rad", real,
     "pitch control for each rad/s of pitch rate error"},
    {"MC_PITCHRATE_I", &P::mc_pitchrate_i, 0.05f, 0.0f, 0.5f, "1/rad", real,
     "growth of the pitch integral for each radian of accumulated error"},
    {"MC_PITCHRATE_D", &P::mc_pitchrate_d, 0.003f, 0.0f, 0.01f, "s^2/rad", real,
     "pitch control against each rad/s^2 of pitch acceleration"},
    {"MC_PITCHRATE_FF", &P::mc_pitchrate_ff, 0.0f, 0.0f, 1.0f, "s/rad", real,
     "pitch control for each rad/s of pitch rate setpoint"},
    {"MC_YAWRATE_P", &P::mc_yawrate_p, 0.2f, 0.0f, 0.6f, "s/rad", real,
     "yaw control for each rad/s of yaw rate error"},
    {"MC_YAWRATE_I", &P::mc_yawrate_i, 0.1f, 0.0f, 0.5f, "1/rad", real,
     "growth of the yaw integral for each radian of accumulated error"},
    {"MC_YAWRATE_D", &P::mc_yawrate_d, 0.0f, 0.0f, 0.01f, "s^2/rad", real,
     "yaw control against each rad/s^2 of yaw acceleration"},
    {"MC_YAWRATE_FF", &P::mc_yawrate_ff, 0.0f, 0.0f, 1.0f, "s/rad", real,
     "yaw control for each rad/s of yaw rate setpoint"},
    {"MC_ROLLRATE_MAX", &P::mc_rollrate_max, 220.0f, 0.0f, 360.0f, "deg/s", real,
     "limit of the roll rate setpoint"},
    {"MC_PITCHRATE_MAX", &P::mc_pitchrate_max, 220.0f, 0.0f, 360.0f, "deg/s", real,
     "limit of the pitch rate setpoint"},
    {"MC_YAWRATE_MAX", &P::mc_yawrate_max, 200.0f, 0.0f, 360.0f, "deg/s", real,
     "limit of the yaw rate setpoint when a pilot flies"},
    {"MC_YAWRAUTO_MAX", &P::mc_yawrauto_max, 45.0f, 0.0f, 120.0f, "deg/s", real,
     "limit of the yaw rate setpoint in autonomous modes"},
    {"MC_ACRO_R_MAX", &P::mc_acro_r_max, 360.0f, 0.0f, 1000.0f, "deg/s", real,
     "roll rate at full stick in acro"},
    {"MC_ACRO_P_MAX", &P::mc_acro_p_max, 360.0f, 0.0f, 1000.0f, "deg/s", real,
     "pitch rate at full stick in acro"},
    {"MC_ACRO_Y_MAX", &P::mc_acro_y_max, 360.0f, 0.0f, 1000.0f, "deg/s", real,
     "yaw rate at full stick in acro"},
    {"MC_RATT_TH", &P::mc_ratt_th, 1.0f, 0.0f, 1.0f, "1", real,
     "stick deflection beyond which rattitude flies rates instead of attitude"},
    {"MC_TPA_BREAK", &P::mc_tpa_break, 1.0f, 0.0f, 1.0f, "1", real,
     "thrust above which the proportional rate gain is reduced", from_v1_5_5},
    {"MC_TPA_SLOPE", &P::mc_tpa_slope, 1.0f, 0.0f, 2.0f, "1", real,
     "reduction of the proportional rate gain for each unit of thrust above the break",
     from_v1_5_5},
    {"MC_BAT_SCALE_EN", &P::mc_bat_scale_en, 0.0f, 0.0f, 1.0f, "1", integer,
     "not 0: controls are multiplied by battery_status.scale", from_v1_5_5},
    {"VT_WV_YAWR_SCL", &P::vt_wv_yawr_scl, 0.15f, 0.0f, 1.0f, "1", real,
     "share of MC_YAWRAUTO_MAX that is left while weather-vaning"},
    {"VT_TYPE", &P::vt_type, 0.0f, 0.0f, 2.0f, "1", integer,
     "kind of VTOL: 0 tailsitter, 1 tiltrotor, 2 standard"},
    {"VT_OPT_RECOV_EN", &P::vt_opt_recov_en, 0.0f, 0.0f, 1.0f, "1", integer,
     "not 0: a tailsitter flies the optimal recovery law; read at the first step only"},
    {"CBRK_RATE_CTRL", &P::cbrk_rate_ctrl, 0.0f, 0.0f, 140253.0f, "1", integer,
     "140253: actuator controls are not published"},
}};

}  // namespace

ParameterTable parameter_table() { return all_parameters; }

}  // namespace attest::mc_att_control
