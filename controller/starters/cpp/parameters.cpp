/* SPDX-License-Identifier: BSD-3-Clause */
#include "parameters.hpp"

#include <algorithm>
#include <array>

namespace starter {

namespace {

struct Entry {
  std::string_view name;
  float Parameters::*member;
  bool in_v1_3_4 = true;
};

constexpr std::array<Entry, 33> table = {{
    {"MC_ROLL_P", &Parameters::roll_p},
    {"MC_ROLL_TC", &Parameters::roll_tc},
    {"MC_ROLLRATE_P", &Parameters::roll_rate_p},
    {"MC_ROLLRATE_I", &Parameters::roll_rate_i},
    {"MC_ROLLRATE_D", &Parameters::roll_rate_d},
    {"MC_ROLLRATE_FF", &Parameters::roll_rate_ff},
    {"MC_PITCH_P", &Parameters::pitch_p},
    {"MC_PITCH_TC", &Parameters::pitch_tc},
    {"MC_PITCHRATE_P", &Parameters::pitch_rate_p},
    {"MC_PITCHRATE_I", &Parameters::pitch_rate_i},
    {"MC_PITCHRATE_D", &Parameters::pitch_rate_d},
    {"MC_PITCHRATE_FF", &Parameters::pitch_rate_ff},
    {"MC_YAW_P", &Parameters::yaw_p},
    {"MC_YAWRATE_P", &Parameters::yaw_rate_p},
    {"MC_YAWRATE_I", &Parameters::yaw_rate_i},
    {"MC_YAWRATE_D", &Parameters::yaw_rate_d},
    {"MC_YAWRATE_FF", &Parameters::yaw_rate_ff},
    {"MC_YAW_FF", &Parameters::yaw_ff},
    {"MC_ROLLRATE_MAX", &Parameters::roll_rate_max},
    {"MC_PITCHRATE_MAX", &Parameters::pitch_rate_max},
    {"MC_YAWRATE_MAX", &Parameters::yaw_rate_max},
    {"MC_YAWRAUTO_MAX", &Parameters::yaw_auto_max},
    {"MC_ACRO_R_MAX", &Parameters::acro_roll_max},
    {"MC_ACRO_P_MAX", &Parameters::acro_pitch_max},
    {"MC_ACRO_Y_MAX", &Parameters::acro_yaw_max},
    {"MC_RATT_TH", &Parameters::rattitude_threshold},
    {"MC_TPA_BREAK", &Parameters::tpa_break, false},
    {"MC_TPA_SLOPE", &Parameters::tpa_slope, false},
    {"MC_BAT_SCALE_EN", &Parameters::battery_scale_enabled, false},
    {"VT_WV_YAWR_SCL", &Parameters::weather_vane_scale},
    {"VT_TYPE", &Parameters::vtol_type},
    {"VT_OPT_RECOV_EN", &Parameters::recovery_enabled},
    {"CBRK_RATE_CTRL", &Parameters::circuit_breaker},
}};

}  // namespace

std::optional<Profile> profile_of(std::string_view name) noexcept {
  if (name == "px4-v1.5.5") return Profile::px4_v1_5_5;
  if (name == "px4-v1.3.4") return Profile::px4_v1_3_4;
  return std::nullopt;
}

bool Parameters::set(Profile profile, std::string_view name, float value) noexcept {
  const auto found = std::find_if(table.begin(), table.end(),
                                  [name](const Entry& entry) { return entry.name == name; });
  if (found == table.end()) return false;
  if (profile == Profile::px4_v1_3_4 && !found->in_v1_3_4) return false;
  this->*found->member = value;
  return true;
}

Gains::Gains(const Parameters& p) noexcept
    : yaw_ff(p.yaw_ff),
      rattitude_threshold(p.rattitude_threshold),
      tpa_break(p.tpa_break),
      tpa_slope(p.tpa_slope),
      weather_vane_scale(p.weather_vane_scale),
      battery_scale_enabled(p.battery_scale_enabled != 0.0f),
      circuit_breaker_open(p.circuit_breaker == 140253.0f) {  // the key of CBRK_RATE_CTRL
  // A time constant above the default of 0.2 s lowers the gains, except I and FF.
  const float roll = 0.2f / p.roll_tc;
  const float pitch = 0.2f / p.pitch_tc;
  att_p = {{p.roll_p * roll, p.pitch_p * pitch, p.yaw_p}};
  rate_p = {{p.roll_rate_p * roll, p.pitch_rate_p * pitch, p.yaw_rate_p}};
  rate_i = {{p.roll_rate_i, p.pitch_rate_i, p.yaw_rate_i}};
  rate_d = {{p.roll_rate_d * roll, p.pitch_rate_d * pitch, p.yaw_rate_d}};
  rate_ff = {{p.roll_rate_ff, p.pitch_rate_ff, p.yaw_rate_ff}};
  mc_rate_max = {{rad(p.roll_rate_max), rad(p.pitch_rate_max), rad(p.yaw_rate_max)}};
  auto_rate_max = {{mc_rate_max[0], mc_rate_max[1], rad(p.yaw_auto_max)}};
  acro_rate_max = {{rad(p.acro_roll_max), rad(p.acro_pitch_max), rad(p.acro_yaw_max)}};
}

}  // namespace starter
