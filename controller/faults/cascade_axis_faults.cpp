// Parameters of the cascade that are read for a wrong axis: two of them exchanged, one for another
// axis, or one for all axes.
#include <utility>

#include "controller/faults/cascade_change.hpp"
#include "controller/faults/groups.hpp"

namespace attest::faults::in_cascade {
namespace {

using P = CascadeParameters;

template <float P::*one, float P::*other>
void exchange(FaultyLaw& law) {
  const auto change = [](P& p) { std::swap(p.*one, p.*other); };
  change_parameters(law.attitude_unit, change);
  change_parameters(law.rate_unit, change);
}

// Changes the limits of the rates where they are used, because the pure law does not read them as
// parameters.
template <typename Change>
void change_rate_max(FaultyLaw& law, Change change) {
  change_stage(law.attitude_unit.attitude.limit,
               [change](const auto& then, const Vector& rates, QuaternionGains gains) {
                 change(gains.rate_max_rad_s);
                 return then(rates, gains);
               });
}
template <int one, int other>
void exchange_rate_max(FaultyLaw& law) {
  change_rate_max(law, [](Vector& max) { std::swap(max[one], max[other]); });
}

template <float P::*from, float P::*pitch, float P::*yaw>
void read_for_all(FaultyLaw& law) {
  read_from<pitch, from>(law);
  read_from<yaw, from>(law);
}

constexpr Fault axis_fault(std::string_view id, std::string_view what, void (*inject)(FaultyLaw&)) {
  return {id, "parameters", Stage::parameters, what, "values that differ", "wrong axis", inject};
}

const Fault axis_list[] = {
    axis_fault("cascade-roll-pitch-gains", "exchanges MC_ROLL_P and MC_PITCH_P",
               exchange<&P::mc_roll_p, &P::mc_pitch_p>),
    axis_fault("cascade-rate-max-exchanged", "exchanges MC_ROLLRATE_MAX and MC_PITCHRATE_MAX",
               exchange_rate_max<0, 1>),
    axis_fault("cascade-rate-max-roll-yaw", "exchanges MC_ROLLRATE_MAX and MC_YAWRATE_MAX",
               exchange_rate_max<0, 2>),
    axis_fault("cascade-rate-max-pitch-yaw", "exchanges MC_PITCHRATE_MAX and MC_YAWRATE_MAX",
               exchange_rate_max<1, 2>),
    axis_fault("cascade-rate-p-exchanged", "exchanges MC_ROLLRATE_P and MC_PITCHRATE_P",
               exchange<&P::mc_rollrate_p, &P::mc_pitchrate_p>),
    axis_fault("cascade-rate-p-roll-yaw", "exchanges MC_ROLLRATE_P and MC_YAWRATE_P",
               exchange<&P::mc_rollrate_p, &P::mc_yawrate_p>),
    axis_fault("cascade-rate-i-exchanged", "exchanges MC_ROLLRATE_I and MC_PITCHRATE_I",
               exchange<&P::mc_rollrate_i, &P::mc_pitchrate_i>),
    axis_fault("cascade-rate-i-roll-yaw", "exchanges MC_ROLLRATE_I and MC_YAWRATE_I",
               exchange<&P::mc_rollrate_i, &P::mc_yawrate_i>),
    axis_fault("cascade-rate-d-exchanged", "exchanges MC_ROLLRATE_D and MC_PITCHRATE_D",
               exchange<&P::mc_rollrate_d, &P::mc_pitchrate_d>),
    axis_fault("cascade-rate-d-roll-yaw", "exchanges MC_ROLLRATE_D and MC_YAWRATE_D",
               exchange<&P::mc_rollrate_d, &P::mc_yawrate_d>),
    axis_fault("cascade-rate-ff-exchanged", "exchanges MC_ROLLRATE_FF and MC_PITCHRATE_FF",
               exchange<&P::mc_rollrate_ff, &P::mc_pitchrate_ff>),
    axis_fault("cascade-rate-k-exchanged", "exchanges MC_ROLLRATE_K and MC_PITCHRATE_K",
               exchange<&P::mc_rollrate_k, &P::mc_pitchrate_k>),
    axis_fault("cascade-int-lim-exchanged", "exchanges MC_RR_INT_LIM and MC_PR_INT_LIM",
               exchange<&P::mc_rr_int_lim, &P::mc_pr_int_lim>),
    axis_fault("cascade-acro-max-exchanged", "exchanges MC_ACRO_R_MAX and MC_ACRO_P_MAX",
               exchange<&P::mc_acro_r_max, &P::mc_acro_p_max>),
    axis_fault("cascade-roll-p-of-pitch", "reads MC_PITCH_P instead of MC_ROLL_P",
               read_from<&P::mc_roll_p, &P::mc_pitch_p>),
    axis_fault("cascade-rollrate-max-of-pitch", "reads MC_PITCHRATE_MAX instead of MC_ROLLRATE_MAX",
               [](FaultyLaw& law) { change_rate_max(law, [](Vector& max) { max[0] = max[1]; }); }),
    axis_fault("cascade-rollrate-p-of-pitch", "reads the pitch rate gain for roll",
               read_from<&P::mc_rollrate_p, &P::mc_pitchrate_p>),
    axis_fault("cascade-rollrate-i-of-pitch", "reads the pitch integral gain for roll",
               read_from<&P::mc_rollrate_i, &P::mc_pitchrate_i>),
    axis_fault("cascade-rollrate-d-of-pitch", "reads the pitch D gain for roll",
               read_from<&P::mc_rollrate_d, &P::mc_pitchrate_d>),
    axis_fault("cascade-rollrate-ff-of-pitch", "reads the pitch feed-forward for roll",
               read_from<&P::mc_rollrate_ff, &P::mc_pitchrate_ff>),
    axis_fault("cascade-rollrate-k-of-pitch", "reads MC_PITCHRATE_K instead of MC_ROLLRATE_K",
               read_from<&P::mc_rollrate_k, &P::mc_pitchrate_k>),
    axis_fault("cascade-rr-int-lim-of-pitch", "reads MC_PR_INT_LIM for roll",
               read_from<&P::mc_rr_int_lim, &P::mc_pr_int_lim>),
    axis_fault("cascade-yawrate-p-of-roll", "reads the roll rate gain for yaw",
               read_from<&P::mc_yawrate_p, &P::mc_rollrate_p>),
    axis_fault("cascade-yawrate-i-of-roll", "reads the roll integral gain for yaw",
               read_from<&P::mc_yawrate_i, &P::mc_rollrate_i>),
    axis_fault("cascade-yawrate-ff-of-roll", "reads the roll feed-forward for yaw",
               read_from<&P::mc_yawrate_ff, &P::mc_rollrate_ff>),
    axis_fault("cascade-yawrate-k-of-roll", "reads MC_ROLLRATE_K instead of MC_YAWRATE_K",
               read_from<&P::mc_yawrate_k, &P::mc_rollrate_k>),
    axis_fault("cascade-yr-int-lim-of-roll", "reads MC_RR_INT_LIM for yaw",
               read_from<&P::mc_yr_int_lim, &P::mc_rr_int_lim>),
    axis_fault("cascade-gain-of-roll-for-all", "reads MC_ROLL_P for all axes",
               read_for_all<&P::mc_roll_p, &P::mc_pitch_p, &P::mc_yaw_p>),
    axis_fault(
        "cascade-rate-max-of-roll-for-all", "reads MC_ROLLRATE_MAX for all axes",
        [](FaultyLaw& law) { change_rate_max(law, [](Vector& max) { max.setConstant(max[0]); }); }),
    axis_fault("cascade-int-lim-of-roll-for-all", "reads MC_RR_INT_LIM for all axes",
               read_for_all<&P::mc_rr_int_lim, &P::mc_pr_int_lim, &P::mc_yr_int_lim>),
};

}  // namespace

std::span<const Fault> axis_faults() { return axis_list; }

}  // namespace attest::faults::in_cascade
