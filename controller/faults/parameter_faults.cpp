// Parameters that are read wrongly: not at all, from another name, or at another time.
#include <cmath>
#include <optional>
#include <utility>

#include "controller/faults/groups.hpp"

namespace attest::faults {
namespace {

using P = Parameters;

// Computes the gains from changed parameters.
template <typename Change>
void change_parameters(FaultyLaw& law, Change change) {
  change_stage(law.step.gains, [change](const auto& then, const Parameters& parameters) {
    Parameters changed = parameters;
    change(changed);
    return then(changed);
  });
}

// Uses the value of parameter `from` also for parameter `to`.
template <float P::*to, float P::*from>
void read_from(FaultyLaw& law) {
  change_parameters(law, [](Parameters& p) { p.*to = p.*from; });
}

template <float P::*one, float P::*other>
void exchange(FaultyLaw& law) {
  change_parameters(law, [](Parameters& p) { std::swap(p.*one, p.*other); });
}

// One parameter always has its default.
template <float P::*member>
void never_read(FaultyLaw& law) {
  change_parameters(
      law, [](Parameters& p) { p.*member = mc_att_control::default_parameters().*member; });
}

template <typename Change>
void change_gains(FaultyLaw& law, Change change) {
  change_stage(law.step.gains, [change](const auto& then, const Parameters& parameters) {
    Gains gains = then(parameters);
    change(gains, parameters);
    return gains;
  });
}

constexpr const char* wrong_name = "a wrong parameter";
constexpr const char* not_read = "a missing parameter";

constexpr Fault axis_fault(std::string_view id, std::string_view what, void (*inject)(FaultyLaw&)) {
  return {id, "parameters", Stage::parameters, what, "values that differ", "wrong axis", inject};
}

const Fault parameter_list[] = {
    {"param-at-start-only", "parameters", Stage::parameters, "reads parameters once",
     "a parameter that changes in flight", "a latch",
     [](FaultyLaw& law) {
       change_stage(law.step.gains, [first = std::optional<Parameters>{}](
                                        const auto& then, const Parameters& p) mutable {
         if (!first) first = p;
         return then(*first);
       });
     }},
    {"param-one-update-late", "parameters", Stage::parameters,
     "uses the parameters of the previous update", "a parameter that changes in flight",
     "one-tick delay",
     [](FaultyLaw& law) {
       change_stage(law.step.gains, [last = std::optional<Parameters>{}](
                                        const auto& then, const Parameters& p) mutable {
         return then(std::exchange(last, p).value_or(p));
       });
     }},
    {"tc-ignored", "parameters", Stage::parameters, "does not read the time constants",
     "a time constant other than 0.2", not_read,
     [](FaultyLaw& law) {
       change_parameters(law, [](Parameters& p) { p.mc_roll_tc = p.mc_pitch_tc = 0.2f; });
     }},
    {"tc-inverted", "parameters", Stage::parameters, "multiplies by TC / 0.2",
     "a time constant other than 0.2", "a wrong factor",
     [](FaultyLaw& law) {
       change_parameters(law, [](Parameters& p) {
         p.mc_roll_tc = 0.04f / p.mc_roll_tc;
         p.mc_pitch_tc = 0.04f / p.mc_pitch_tc;
       });
     }},
    {"tc-exchanged", "parameters", Stage::parameters, "exchanges the time constants",
     "time constants that differ", "wrong axis",
     [](FaultyLaw& law) {
       change_parameters(law, [](Parameters& p) { std::swap(p.mc_roll_tc, p.mc_pitch_tc); });
     }},
    {"tc-of-roll-for-pitch", "parameters", Stage::parameters,
     "reads MC_ROLL_TC instead of MC_PITCH_TC", "time constants that differ", wrong_name,
     read_from<&P::mc_pitch_tc, &P::mc_roll_tc>},
    {"i-in-ideal-form", "rates", Stage::parameters, "multiplies the integral gain by the P gain",
     "an error that lasts", "a misplaced factor",
     [](FaultyLaw& law) {
       change_gains(law, [](Gains& gains, const Parameters& p) {
         gains.rate.integral[0] *= p.mc_rollrate_p;
         gains.rate.integral[1] *= p.mc_pitchrate_p;
         gains.rate.integral[2] *= p.mc_yawrate_p;
       });
     }},
    {"yawrate-max-in-degrees", "rate_limit", Stage::limit,
     "leaves the limits of the yaw rate in degrees", "a yaw rate beyond the limit", "degrees",
     [](FaultyLaw& law) {
       change_gains(law, [](Gains& gains, const Parameters& p) {
         gains.attitude.rate_max_rad_s[2] = p.mc_yawrate_max;
         gains.attitude.auto_rate_max_rad_s[2] = p.mc_yawrauto_max;
       });
     }},
    {"tc-on-i", "parameters", Stage::parameters, "scales the integral gain too",
     "a time constant other than 0.2", "a misplaced factor",
     [](FaultyLaw& law) {
       change_gains(law, [](Gains& gains, const Parameters& p) {
         gains.rate.integral[0] *= 0.2f / p.mc_roll_tc;
         gains.rate.integral[1] *= 0.2f / p.mc_pitch_tc;
       });
     }},
    {"tc-on-ff", "parameters", Stage::parameters, "scales the feed-forward too",
     "a time constant other than 0.2 and a feed-forward", "a misplaced factor",
     [](FaultyLaw& law) {
       change_gains(law, [](Gains& gains, const Parameters& p) {
         gains.rate.feed_forward[0] *= 0.2f / p.mc_roll_tc;
         gains.rate.feed_forward[1] *= 0.2f / p.mc_pitch_tc;
       });
     }},
    {"tc-on-yaw", "parameters", Stage::parameters, "scales yaw by the roll time constant",
     "a time constant other than 0.2", "wrong axis",
     [](FaultyLaw& law) {
       change_gains(law, [](Gains& gains, const Parameters& p) {
         gains.attitude.proportional_1_s[2] *= 0.2f / p.mc_roll_tc;
         gains.rate.proportional[2] *= 0.2f / p.mc_roll_tc;
       });
     }},
    {"tc-not-on-d", "parameters", Stage::parameters, "does not scale the D gain",
     "a time constant other than 0.2", "a missing factor",
     [](FaultyLaw& law) {
       change_gains(law, [](Gains& gains, const Parameters& p) {
         gains.rate.derivative[0] = p.mc_rollrate_d;
         gains.rate.derivative[1] = p.mc_pitchrate_d;
       });
     }},
    {"tc-not-on-attitude", "parameters", Stage::parameters, "does not scale the attitude gain",
     "a time constant other than 0.2", "a missing factor",
     [](FaultyLaw& law) {
       change_gains(law, [](Gains& gains, const Parameters& p) {
         gains.attitude.proportional_1_s[0] = p.mc_roll_p;
         gains.attitude.proportional_1_s[1] = p.mc_pitch_p;
       });
     }},
    {"tc-not-on-rate-p", "parameters", Stage::parameters, "does not scale the rate gain",
     "a time constant other than 0.2", "a missing factor",
     [](FaultyLaw& law) {
       change_gains(law, [](Gains& gains, const Parameters& p) {
         gains.rate.proportional[0] = p.mc_rollrate_p;
         gains.rate.proportional[1] = p.mc_pitchrate_p;
       });
     }},
    {"pitch-p-of-roll", "parameters", Stage::parameters, "reads MC_ROLL_P instead of MC_PITCH_P",
     "gains that differ", wrong_name, read_from<&P::mc_pitch_p, &P::mc_roll_p>},
    {"yaw-p-of-roll", "parameters", Stage::parameters, "reads MC_ROLL_P instead of MC_YAW_P",
     "gains that differ", wrong_name, read_from<&P::mc_yaw_p, &P::mc_roll_p>},
    {"pitchrate-p-of-roll", "parameters", Stage::parameters, "reads the roll rate gain for pitch",
     "gains that differ", wrong_name, read_from<&P::mc_pitchrate_p, &P::mc_rollrate_p>},
    {"pitchrate-i-of-roll", "parameters", Stage::parameters,
     "reads the roll integral gain for pitch", "gains that differ", wrong_name,
     read_from<&P::mc_pitchrate_i, &P::mc_rollrate_i>},
    {"pitchrate-d-of-roll", "parameters", Stage::parameters, "reads the roll D gain for pitch",
     "gains that differ", wrong_name, read_from<&P::mc_pitchrate_d, &P::mc_rollrate_d>},
    {"pitchrate-ff-of-roll", "parameters", Stage::parameters,
     "reads the roll feed-forward for pitch", "gains that differ", wrong_name,
     read_from<&P::mc_pitchrate_ff, &P::mc_rollrate_ff>},
    {"yawrate-d-of-roll", "parameters", Stage::parameters, "reads the roll D gain for yaw",
     "yaw rates that change", wrong_name, read_from<&P::mc_yawrate_d, &P::mc_rollrate_d>},
    {"yawrate-i-of-p", "parameters", Stage::parameters,
     "reads MC_YAWRATE_P instead of MC_YAWRATE_I", "an error in yaw that lasts", wrong_name,
     read_from<&P::mc_yawrate_i, &P::mc_yawrate_p>},
    {"pitchrate-max-of-roll", "parameters", Stage::parameters, "reads the roll limit for pitch",
     "limits that differ", wrong_name, read_from<&P::mc_pitchrate_max, &P::mc_rollrate_max>},
    {"yawrauto-of-yawrate", "parameters", Stage::parameters,
     "reads MC_YAWRATE_MAX instead of MC_YAWRAUTO_MAX", "a large yaw error on a mission",
     wrong_name, read_from<&P::mc_yawrauto_max, &P::mc_yawrate_max>},
    {"acro-p-of-r", "parameters", Stage::parameters, "reads MC_ACRO_R_MAX instead of MC_ACRO_P_MAX",
     "acro limits that differ", wrong_name, read_from<&P::mc_acro_p_max, &P::mc_acro_r_max>},
    {"acro-y-of-r", "parameters", Stage::parameters, "reads MC_ACRO_R_MAX instead of MC_ACRO_Y_MAX",
     "acro limits that differ", wrong_name, read_from<&P::mc_acro_y_max, &P::mc_acro_r_max>},
    {"roll-p-not-read", "parameters", Stage::parameters, "does not read MC_ROLL_P", "another value",
     not_read, never_read<&P::mc_roll_p>},
    {"yaw-p-not-read", "parameters", Stage::parameters, "does not read MC_YAW_P", "another value",
     not_read, never_read<&P::mc_yaw_p>},
    {"yaw-ff-not-read", "parameters", Stage::parameters, "does not read MC_YAW_FF", "another value",
     not_read, never_read<&P::mc_yaw_ff>},
    {"rollrate-p-not-read", "parameters", Stage::parameters, "does not read MC_ROLLRATE_P",
     "another value", not_read, never_read<&P::mc_rollrate_p>},
    {"rollrate-i-not-read", "parameters", Stage::parameters, "does not read MC_ROLLRATE_I",
     "another value", not_read, never_read<&P::mc_rollrate_i>},
    {"rollrate-d-not-read", "parameters", Stage::parameters, "does not read MC_ROLLRATE_D",
     "another value", not_read, never_read<&P::mc_rollrate_d>},
    {"rollrate-ff-not-read", "parameters", Stage::parameters, "does not read MC_ROLLRATE_FF",
     "another value", not_read, never_read<&P::mc_rollrate_ff>},
    {"yawrate-p-not-read", "parameters", Stage::parameters, "does not read MC_YAWRATE_P",
     "another value", not_read, never_read<&P::mc_yawrate_p>},
    {"yawrate-ff-not-read", "parameters", Stage::parameters, "does not read MC_YAWRATE_FF",
     "another value", not_read, never_read<&P::mc_yawrate_ff>},
    {"rollrate-max-not-read", "parameters", Stage::parameters, "does not read MC_ROLLRATE_MAX",
     "another value", not_read, never_read<&P::mc_rollrate_max>},
    {"yawrate-max-not-read", "parameters", Stage::parameters, "does not read MC_YAWRATE_MAX",
     "another value", not_read, never_read<&P::mc_yawrate_max>},
    {"acro-r-not-read", "parameters", Stage::parameters, "does not read MC_ACRO_R_MAX",
     "another value", not_read, never_read<&P::mc_acro_r_max>},
    {"ratt-th-not-read", "parameters", Stage::parameters, "does not read MC_RATT_TH",
     "another value", not_read, never_read<&P::mc_ratt_th>},
    {"tpa-break-not-read",
     "parameters",
     Stage::parameters,
     "does not read MC_TPA_BREAK",
     "another value",
     not_read,
     never_read<&P::mc_tpa_break>,
     {},
     mc_att_control::from_v1_5_5},
    {"tpa-slope-not-read",
     "parameters",
     Stage::parameters,
     "does not read MC_TPA_SLOPE",
     "another value",
     not_read,
     never_read<&P::mc_tpa_slope>,
     {},
     mc_att_control::from_v1_5_5},
    {"vane-scale-not-read", "parameters", Stage::parameters, "does not read VT_WV_YAWR_SCL",
     "another value", not_read, never_read<&P::vt_wv_yawr_scl>},
    {"battery-enable-is-1",
     "parameters",
     Stage::parameters,
     "scales for MC_BAT_SCALE_EN of 1 only",
     "MC_BAT_SCALE_EN of 2",
     "flag comparison",
     [](FaultyLaw& law) {
       change_gains(law, [](Gains& gains, const Parameters& p) {
         gains.battery_scaling = p.mc_bat_scale_en == 1;
       });
     },
     {},
     mc_att_control::from_v1_5_5},
    {"gains-in-8-bits", "parameters", Stage::parameters, "holds gains in 8 bits", "any gain",
     "fixed point",
     [](FaultyLaw& law) {
       change_gains(law, [](Gains& gains, const Parameters&) {
         for (Vector* v :
              {&gains.rate.proportional, &gains.rate.integral, &gains.rate.derivative}) {
           for (int i = 0; i < 3; ++i) (*v)[i] = std::round((*v)[i] * 256) / 256;
         }
       });
     }},
    axis_fault("p-exchanged", "exchanges MC_ROLL_P and MC_PITCH_P",
               exchange<&P::mc_roll_p, &P::mc_pitch_p>),
    axis_fault("rate-p-exchanged", "exchanges MC_ROLLRATE_P and MC_PITCHRATE_P",
               exchange<&P::mc_rollrate_p, &P::mc_pitchrate_p>),
    axis_fault("rate-i-exchanged", "exchanges MC_ROLLRATE_I and MC_PITCHRATE_I",
               exchange<&P::mc_rollrate_i, &P::mc_pitchrate_i>),
    axis_fault("rate-d-exchanged", "exchanges MC_ROLLRATE_D and MC_PITCHRATE_D",
               exchange<&P::mc_rollrate_d, &P::mc_pitchrate_d>),
    axis_fault("rate-ff-exchanged", "exchanges MC_ROLLRATE_FF and MC_PITCHRATE_FF",
               exchange<&P::mc_rollrate_ff, &P::mc_pitchrate_ff>),
    axis_fault("rate-p-roll-yaw", "exchanges MC_ROLLRATE_P and MC_YAWRATE_P",
               exchange<&P::mc_rollrate_p, &P::mc_yawrate_p>),
    axis_fault("rate-i-roll-yaw", "exchanges MC_ROLLRATE_I and MC_YAWRATE_I",
               exchange<&P::mc_rollrate_i, &P::mc_yawrate_i>),
    axis_fault("rate-d-roll-yaw", "exchanges MC_ROLLRATE_D and MC_YAWRATE_D",
               exchange<&P::mc_rollrate_d, &P::mc_yawrate_d>),
    axis_fault("rate-max-roll-yaw", "exchanges MC_ROLLRATE_MAX and MC_YAWRATE_MAX",
               exchange<&P::mc_rollrate_max, &P::mc_yawrate_max>),
    axis_fault("rate-max-pitch-yaw", "exchanges MC_PITCHRATE_MAX and MC_YAWRATE_MAX",
               exchange<&P::mc_pitchrate_max, &P::mc_yawrate_max>),
    axis_fault("acro-max-exchanged", "exchanges MC_ACRO_R_MAX and MC_ACRO_P_MAX",
               exchange<&P::mc_acro_r_max, &P::mc_acro_p_max>),
    axis_fault("roll-p-of-pitch", "reads MC_PITCH_P instead of MC_ROLL_P",
               read_from<&P::mc_roll_p, &P::mc_pitch_p>),
    axis_fault("rollrate-p-of-pitch", "reads the pitch rate gain for roll",
               read_from<&P::mc_rollrate_p, &P::mc_pitchrate_p>),
    axis_fault("rollrate-i-of-pitch", "reads the pitch integral gain for roll",
               read_from<&P::mc_rollrate_i, &P::mc_pitchrate_i>),
    axis_fault("rollrate-d-of-pitch", "reads the pitch D gain for roll",
               read_from<&P::mc_rollrate_d, &P::mc_pitchrate_d>),
    axis_fault("rollrate-ff-of-pitch", "reads the pitch feed-forward for roll",
               read_from<&P::mc_rollrate_ff, &P::mc_pitchrate_ff>),
    axis_fault("rollrate-max-of-pitch", "reads the pitch limit for roll",
               read_from<&P::mc_rollrate_max, &P::mc_pitchrate_max>),
    axis_fault("yawrate-p-of-roll", "reads the roll rate gain for yaw",
               read_from<&P::mc_yawrate_p, &P::mc_rollrate_p>),
    axis_fault("yawrate-i-of-roll", "reads the roll integral gain for yaw",
               read_from<&P::mc_yawrate_i, &P::mc_rollrate_i>),
    axis_fault("yawrate-ff-of-roll", "reads the roll feed-forward for yaw",
               read_from<&P::mc_yawrate_ff, &P::mc_rollrate_ff>),
    axis_fault("yawrate-max-of-roll", "reads the roll limit for yaw",
               read_from<&P::mc_yawrate_max, &P::mc_rollrate_max>),
};

}  // namespace

std::span<const Fault> parameter_faults() { return parameter_list; }

}  // namespace attest::faults
