// Parameters of the cascade that are read wrongly: from another name, in another unit, at another
// time.
#include <optional>
#include <utility>

#include "controller/faults/cascade_change.hpp"
#include "controller/faults/groups.hpp"

namespace attest::faults::in_cascade {
namespace {

using P = CascadeParameters;

template <float P::*member>
void keep_at(FaultyLaw& law, float value) {
  const auto change = [value](P& p) { p.*member = value; };
  change_parameters(law.attitude_unit, change);
  change_parameters(law.rate_unit, change);
}

// The default parameters of the unit's profile, which is known when the unit is made. A law alone
// has gains as inputs and no defaults: there they are those of v1.16.0.
template <typename Unit>
std::shared_ptr<const P> defaults_of(Unit& unit, cascade::ParameterTable table) {
  auto defaults = std::make_shared<P>(default_parameters(table, cascade::Profile::px4_v1_16_0));
  change_stage(unit.step.traits, [defaults, table](const auto& then, cascade::Profile profile) {
    *defaults = default_parameters(table, profile);
    return then(profile);
  });
  return defaults;
}

// One parameter always has its default.
template <float P::*member>
void keep_default(FaultyLaw& law) {
  const auto keep = [](auto& unit, cascade::ParameterTable table) {
    change_parameters(
        unit, [defaults = defaults_of(unit, table)](P& p) { p.*member = (*defaults).*member; });
  };
  keep(law.attitude_unit, cascade::attitude_parameters());
  keep(law.rate_unit, cascade::rate_parameters());
}

// One parameter has another default. A value that was set to the default is changed, too.
template <float P::*member>
void change_default(FaultyLaw& law, float other) {
  const auto defaults = defaults_of(law.attitude_unit, cascade::attitude_parameters());
  change_parameters(law.attitude_unit, [defaults, other](P& p) {
    if (p.*member == (*defaults).*member) p.*member = other;
  });
}

// A case that sets one parameter of acro sets all, so they change only if all have their defaults.
void use_old_acro_defaults(FaultyLaw& law) {
  static constexpr float P::*members[] = {
      &P::mc_acro_r_max,  &P::mc_acro_p_max,   &P::mc_acro_y_max,   &P::mc_acro_expo,
      &P::mc_acro_expo_y, &P::mc_acro_supexpo, &P::mc_acro_supexpoy};
  const auto table = cascade::rate_parameters();
  const P old = default_parameters(table, cascade::Profile::px4_v1_14_4);
  change_parameters(law.rate_unit, [old, defaults = defaults_of(law.rate_unit, table)](P& p) {
    for (const auto member : members) {
      if (p.*member != (*defaults).*member) return;
    }
    for (const auto member : members) p.*member = old.*member;
  });
}

// Whether the rate unit was armed before the present step.
std::shared_ptr<const bool> watch_armed(FaultyLaw& law) {
  auto was_armed = std::make_shared<bool>(false);
  also_before(law.rate_unit, [was_armed, armed = false](RateIn& in) mutable {
    *was_armed = armed;
    if ((in.updated & ATTEST_RATE_UPDATED_VEHICLE_CONTROL_MODE) != 0) {
      armed = in.vehicle_control_mode.flag_armed != 0;
    }
  });
  return was_armed;
}

// An update that arrives while armed is lost. The step that arms still takes one.
void read_while_disarmed(FaultyLaw& law) {
  also_before(law.rate_unit, [was_armed = watch_armed(law)](RateIn& in) {
    if (*was_armed) in.updated &= ~std::uint32_t{ATTEST_RATE_UPDATED_PARAMETER_UPDATE};
  });
}

// The same for the numbers that are computed from parameters. The others are used as they are.
void compute_while_disarmed(FaultyLaw& law) {
  auto& gains = law.rate_unit.step.gains;
  change_stage(gains, [was_armed = watch_armed(law), old = std::optional<RateUnitGains>{}](
                          const auto& then, const P& p) mutable {
    RateUnitGains next = then(p);
    if (*was_armed && old) {
      const Vector integral_max = next.rate.integral_max;
      next.rate = old->rate;
      next.rate.integral_max = integral_max;
      next.acro.rate_max_rad_s = old->acro.rate_max_rad_s;
      next.yaw_torque_tau_s = old->yaw_torque_tau_s;
    }
    old = next;
    return next;
  });
}

template <typename Unit>
void read_once(Unit& unit) {
  unit.step.gains = [first = std::optional<P>{}](const P& p) mutable {
    if (!first) first = p;
    return decltype(unit.step)::Law::gains(*first);
  };
}

template <typename Unit>
void read_late(Unit& unit) {
  unit.step.gains = [last = std::optional<P>{}](const P& p) mutable {
    return decltype(unit.step)::Law::gains(std::exchange(last, p).value_or(p));
  };
}

constexpr const char* wrong_name = "a wrong parameter";
constexpr const char* not_read = "a missing parameter";
constexpr const char* old_default = "a default of another version";

const Fault parameter_list[] = {
    {"cascade-attitude-param-once", "parameters", Stage::parameters,
     "reads the parameters of the attitude unit once", "a parameter that changes in flight",
     "a latch", [](FaultyLaw& law) { read_once(law.attitude_unit); }},
    {"cascade-rate-param-once", "parameters", Stage::parameters,
     "reads the parameters of the rate unit once", "a parameter that changes in flight", "a latch",
     [](FaultyLaw& law) { read_once(law.rate_unit); }},
    {"cascade-rate-param-disarmed-only", "parameters", Stage::parameters,
     "reads changed parameters of the rate unit only while disarmed",
     "a parameter that changes in flight", "a missing update", read_while_disarmed},
    {"cascade-rate-gains-disarmed-only", "parameters", Stage::parameters,
     "takes changed gains of the rate unit only while disarmed", "a gain that changes in flight",
     "a missing update", compute_while_disarmed},
    {"cascade-attitude-param-late", "parameters", Stage::parameters,
     "uses the parameters of the previous update in the attitude unit",
     "a parameter that changes in flight", "one-tick delay",
     [](FaultyLaw& law) { read_late(law.attitude_unit); }},
    {"cascade-rate-param-late", "parameters", Stage::parameters,
     "uses the parameters of the previous update in the rate unit",
     "a parameter that changes in flight", "one-tick delay",
     [](FaultyLaw& law) { read_late(law.rate_unit); }},
    {"cascade-attitude-param-at-once",
     "robustness",
     Stage::parameters,
     "reads the parameters of the attitude unit in each step",
     "an estimated hover thrust that becomes NaN",
     "a latch",
     [](FaultyLaw& law) {
       also_before(law.attitude_unit,
                   [](AttitudeIn& in) { in.updated |= ATTEST_ATTITUDE_UPDATED_PARAMETER_UPDATE; });
     },
     {},
     from_v1_16_0},
    {"cascade-pitch-p-of-roll", "parameters", Stage::parameters,
     "reads MC_ROLL_P instead of MC_PITCH_P", "gains that differ", wrong_name,
     read_from<&P::mc_pitch_p, &P::mc_roll_p>},
    {"cascade-yaw-p-of-roll", "parameters", Stage::parameters,
     "reads MC_ROLL_P instead of MC_YAW_P", "any yaw error", wrong_name,
     read_from<&P::mc_yaw_p, &P::mc_roll_p>},
    {"cascade-pitchrate-max-of-roll", "parameters", Stage::parameters,
     "reads MC_ROLLRATE_MAX instead of MC_PITCHRATE_MAX", "limits that differ", wrong_name,
     read_from<&P::mc_pitchrate_max, &P::mc_rollrate_max>},
    {"cascade-yawrate-max-of-roll", "parameters", Stage::parameters,
     "reads MC_ROLLRATE_MAX instead of MC_YAWRATE_MAX", "a large yaw error", wrong_name,
     read_from<&P::mc_yawrate_max, &P::mc_rollrate_max>},
    {"cascade-man-yaw-of-yawrate-max", "parameters", Stage::parameters,
     "reads MC_YAWRATE_MAX instead of MPC_MAN_Y_MAX", "the yaw stick", wrong_name,
     read_from<&P::mpc_man_y_max, &P::mc_yawrate_max>},
    {"cascade-roll-p-not-read", "parameters", Stage::parameters, "does not read MC_ROLL_P",
     "another value", not_read, keep_default<&P::mc_roll_p>},
    {"cascade-yaw-p-not-read", "parameters", Stage::parameters, "does not read MC_YAW_P",
     "another value", not_read, keep_default<&P::mc_yaw_p>},
    {"cascade-yaw-weight-not-read", "parameters", Stage::parameters, "does not read MC_YAW_WEIGHT",
     "another value", not_read, keep_default<&P::mc_yaw_weight>},
    {"cascade-rollrate-max-not-read", "parameters", Stage::parameters,
     "does not read MC_ROLLRATE_MAX", "another value", not_read, keep_default<&P::mc_rollrate_max>},
    {"cascade-yawrate-max-not-read", "parameters", Stage::parameters,
     "does not read MC_YAWRATE_MAX", "another value", not_read, keep_default<&P::mc_yawrate_max>},
    {"cascade-tilt-max-not-read", "parameters", Stage::parameters, "does not read MPC_MAN_TILT_MAX",
     "another value", not_read, keep_default<&P::mpc_man_tilt_max>},
    {"cascade-man-yaw-not-read", "parameters", Stage::parameters, "does not read MPC_MAN_Y_MAX",
     "another value", not_read, keep_default<&P::mpc_man_y_max>},
    {"cascade-spoolup-time-not-read",
     "spool_up",
     Stage::parameters,
     "does not read COM_SPOOLUP_TIME",
     "another value",
     not_read,
     keep_default<&P::com_spoolup_time>,
     {},
     from_v1_15_4},
    {"cascade-pitchrate-p-of-roll", "parameters", Stage::parameters,
     "reads the roll rate gain for pitch", "gains that differ", wrong_name,
     read_from<&P::mc_pitchrate_p, &P::mc_rollrate_p>},
    {"cascade-pitchrate-i-of-roll", "parameters", Stage::parameters,
     "reads the roll integral gain for pitch", "gains that differ", wrong_name,
     read_from<&P::mc_pitchrate_i, &P::mc_rollrate_i>},
    {"cascade-pitchrate-d-of-roll", "parameters", Stage::parameters,
     "reads the roll D gain for pitch", "gains that differ", wrong_name,
     read_from<&P::mc_pitchrate_d, &P::mc_rollrate_d>},
    {"cascade-pitchrate-ff-of-roll", "parameters", Stage::parameters,
     "reads the roll feed-forward for pitch", "gains that differ", wrong_name,
     read_from<&P::mc_pitchrate_ff, &P::mc_rollrate_ff>},
    {"cascade-pitchrate-k-of-roll", "parameters", Stage::parameters,
     "reads MC_ROLLRATE_K instead of MC_PITCHRATE_K", "gains that differ", wrong_name,
     read_from<&P::mc_pitchrate_k, &P::mc_rollrate_k>},
    {"cascade-yawrate-d-of-roll", "parameters", Stage::parameters, "reads the roll D gain for yaw",
     "a yaw acceleration", wrong_name, read_from<&P::mc_yawrate_d, &P::mc_rollrate_d>},
    {"cascade-yawrate-i-of-p", "parameters", Stage::parameters,
     "reads MC_YAWRATE_P instead of MC_YAWRATE_I", "a yaw rate error that lasts", wrong_name,
     read_from<&P::mc_yawrate_i, &P::mc_yawrate_p>},
    {"cascade-int-lim-of-roll", "parameters", Stage::parameters, "reads MC_RR_INT_LIM for pitch",
     "limits that differ", wrong_name, read_from<&P::mc_pr_int_lim, &P::mc_rr_int_lim>},
    {"cascade-acro-pitch-of-roll", "parameters", Stage::parameters,
     "reads MC_ACRO_R_MAX instead of MC_ACRO_P_MAX", "acro limits that differ", wrong_name,
     read_from<&P::mc_acro_p_max, &P::mc_acro_r_max>},
    {"cascade-acro-yaw-of-roll", "parameters", Stage::parameters,
     "reads MC_ACRO_R_MAX instead of MC_ACRO_Y_MAX", "acro limits that differ", wrong_name,
     read_from<&P::mc_acro_y_max, &P::mc_acro_r_max>},
    {"cascade-rollrate-p-not-read", "parameters", Stage::parameters, "does not read MC_ROLLRATE_P",
     "another value", not_read, keep_default<&P::mc_rollrate_p>},
    {"cascade-rollrate-i-not-read", "parameters", Stage::parameters, "does not read MC_ROLLRATE_I",
     "another value", not_read, keep_default<&P::mc_rollrate_i>},
    {"cascade-rollrate-d-not-read", "parameters", Stage::parameters, "does not read MC_ROLLRATE_D",
     "another value", not_read, keep_default<&P::mc_rollrate_d>},
    {"cascade-rollrate-ff-not-read", "parameters", Stage::parameters,
     "does not read MC_ROLLRATE_FF", "another value", not_read, keep_default<&P::mc_rollrate_ff>},
    {"cascade-rollrate-k-not-read", "parameters", Stage::parameters, "does not read MC_ROLLRATE_K",
     "another value", not_read, keep_default<&P::mc_rollrate_k>},
    {"cascade-yawrate-p-not-read", "parameters", Stage::parameters, "does not read MC_YAWRATE_P",
     "another value", not_read, keep_default<&P::mc_yawrate_p>},
    {"cascade-yawrate-k-not-read", "parameters", Stage::parameters, "does not read MC_YAWRATE_K",
     "another value", not_read, keep_default<&P::mc_yawrate_k>},
    {"cascade-rr-int-lim-not-read", "parameters", Stage::parameters, "does not read MC_RR_INT_LIM",
     "another value", not_read, keep_default<&P::mc_rr_int_lim>},
    {"cascade-yaw-tq-cutoff-not-read",
     "yaw_filter",
     Stage::parameters,
     "does not read MC_YAW_TQ_CUTOFF",
     "another value",
     not_read,
     keep_default<&P::mc_yaw_tq_cutoff>,
     {},
     from_v1_16_0},
    {"cascade-roll-p-of-v1.16.0",
     "attitude",
     Stage::parameters,
     "has the default 6.5 for MC_ROLL_P",
     "a roll error",
     old_default,
     [](FaultyLaw& law) { change_default<&P::mc_roll_p>(law, 6.5f); },
     {},
     from_v1_17},
    {"cascade-pitch-p-of-v1.16.0",
     "attitude",
     Stage::parameters,
     "has the default 6.5 for MC_PITCH_P",
     "a pitch error",
     old_default,
     [](FaultyLaw& law) { change_default<&P::mc_pitch_p>(law, 6.5f); },
     {},
     from_v1_17},
    {"cascade-acro-defaults-of-v1.14.4",
     "acro",
     Stage::parameters,
     "has the defaults of v1.14.4 for the parameters of acro",
     "any stick",
     old_default,
     use_old_acro_defaults,
     {},
     from_v1_15_4},
    {"cascade-yaw-deadzone-not-read",
     "sticks",
     Stage::parameters,
     "does not read MAN_DEADZONE, in v1.16.0 MPC_HOLD_DZ",
     "another value",
     not_read,
     keep_default<&P::man_deadzone>,
     {},
     from_v1_16_0},
    {"cascade-yaw-deadzone-default-0",
     "sticks",
     Stage::parameters,
     "has the default 0 for the deadzone of the yaw stick",
     "the yaw stick at half",
     "a wrong default",
     [](FaultyLaw& law) { change_default<&P::man_deadzone>(law, 0.0f); },
     {},
     from_v1_16_0},
    {"cascade-yaw-expo-0.69",
     "sticks",
     Stage::parameters,
     "gives the yaw stick an expo of 0.69, the default of acro in v1.14.4",
     "the yaw stick at half",
     "a wrong factor",
     [](FaultyLaw& law) { keep_at<&P::mpc_yaw_expo>(law, 0.69f); },
     {},
     from_v1_16_0},
    {"cascade-ref-w-n-not-read",
     "reference_model",
     Stage::parameters,
     "does not read MC_REF_W_N",
     "another value",
     not_read,
     keep_default<&P::mc_ref_w_n>,
     {},
     from_v1_18},
    {"cascade-ref-ff-max-not-read",
     "reference_model",
     Stage::parameters,
     "does not read MC_REF_FF_MAX",
     "another value",
     not_read,
     keep_default<&P::mc_ref_ff_max>,
     {},
     from_v1_18},
    {"cascade-ref-ff-max-default-0",
     "reference_model",
     Stage::parameters,
     "has the default 0 for MC_REF_FF_MAX: no limit",
     "MC_REF_FF and a fast setpoint",
     "a wrong default",
     [](FaultyLaw& law) { change_default<&P::mc_ref_ff_max>(law, 0.0f); },
     {},
     from_v1_18},
};

}  // namespace

std::span<const Fault> parameter_faults() { return parameter_list; }

}  // namespace attest::faults::in_cascade
