// Mistakes of the cascade that concern its low-passes together: those of tilt and yaw stick, of the
// heading's error and of the yaw torque.
#include <cmath>
#include <utility>

#include "controller/faults/cascade_change.hpp"
#include "controller/faults/groups.hpp"

namespace attest::faults::in_cascade {
namespace {

using LowPass = cascade::LowPass<Scalar>;

// What the low-pass of the tilt needs, and the states of a port's own.
struct TiltFilter {
  LowPass roll, pitch;
  Scalar roll_stick = 0, pitch_stick = 0, dt_s = 0;
  CascadeTraits traits{};
};

// Replaces the low-pass of the tilt. Filter is void(TiltFilter&, const StickGains&): it updates the
// states, and returns the tilt of roll and pitch stick [rad].
template <typename Filter>
void change_tilt_filter(FaultyLaw& law, Filter filter) {
  auto own = std::make_shared<TiltFilter>();
  auto& unit = law.attitude_unit;
  change_traits(unit, [own](CascadeTraits& traits) { own->traits = traits; });
  also_before(unit, [own](AttitudeIn& in) {
    if ((in.updated & ATTEST_ATTITUDE_UPDATED_MANUAL_CONTROL_SETPOINT) == 0) return;
    own->roll_stick = in.manual_control_setpoint.roll;
    own->pitch_stick = in.manual_control_setpoint.pitch;
  });
  change_stage(unit.step.step_time, [own](const auto& then, std::uint64_t now, std::uint64_t last) {
    return own->dt_s = then(now, last);
  });
  change_stage(unit.sticks.clears_tilt,
               [own](const auto& then, bool runs, const CascadeTraits& traits) {
                 const bool clears = then(runs, traits);
                 if (clears) own->roll.state = own->pitch.state = 0;
                 return clears;
               });
  change_stage(unit.sticks.limited_tilt,
               [own, filter](const auto& then, Scalar, Scalar, const StickGains& gains) mutable {
                 const auto [roll, pitch] = filter(*own, gains);
                 return then(roll, -pitch, gains);
               });
}

// Replaces the low-pass of the yaw stick. Filter is Scalar(LowPass&, tau_s, dt_s, input). The law's
// own low-pass gets the input with which it gives the same output.
template <typename Filter>
void change_yaw_stick_filter(FaultyLaw& law, Filter filter) {
  auto dt_s = std::make_shared<Scalar>(0.0f);
  auto& unit = law.attitude_unit;
  change_stage(unit.step.step_time, [dt_s](const auto& then, std::uint64_t now,
                                           std::uint64_t last) { return *dt_s = then(now, last); });
  change_stage(unit.sticks.shaped_yaw_rate,
               [dt_s, filter, own = LowPass{}](const auto& then, Scalar stick,
                                               const StickGains& gains) mutable {
                 const Scalar before = own.state, tau_s = gains.yaw_tau_s;
                 const Scalar after = filter(own, tau_s, *dt_s, then(stick, gains));
                 return before + (after - before) * ((tau_s + *dt_s) / *dt_s);
               });
}

// Replaces all low-passes. Filter is Scalar(LowPass&, tau_s, dt_s, input); each has its own copy.
template <typename Filter>
void change_low_passes(FaultyLaw& law, Filter filter) {
  change_tilt_filter(
      law, [of_roll = filter, of_pitch = filter](TiltFilter& own, const StickGains& gains) mutable {
        const Scalar max = gains.tilt_max_rad, tau_s = gains.tilt_tau_s;
        return std::pair(of_roll(own.roll, tau_s, own.dt_s, own.roll_stick * max),
                         of_pitch(own.pitch, tau_s, own.dt_s, own.pitch_stick * max));
      });
  change_yaw_stick_filter(law, filter);
  auto& correct = law.attitude_unit.sticks.correct_yaw;
  change_stage(correct, [filter](const auto& then, YawCorrection& state, Scalar heading,
                                 Scalar unaided, Scalar dt_s, const CascadeTraits& traits) mutable {
    const bool filters = std::isfinite(unaided) && !state.lost;
    LowPass error = state.error;
    const bool converged = then(state, heading, unaided, dt_s, traits);
    if (filters) state.error.state = filter(error, 1, dt_s, cascade::wrap(heading - unaided));
    return converged;
  });
  law.rate_unit.step.filtered_yaw = [filter](LowPass& torque_filter, Scalar torque, Scalar dt_s,
                                             const RateUnitGains& gains,
                                             const CascadeTraits&) mutable {
    return filter(torque_filter, gains.yaw_torque_tau_s, dt_s, torque);
  };
}

Scalar weighted_by_exp(LowPass& filter, Scalar tau_s, Scalar dt_s, Scalar input) {
  const double ratio = static_cast<double>(dt_s) / static_cast<double>(tau_s);
  const Scalar weight = tau_s > 0 ? static_cast<Scalar>(-std::expm1(-ratio)) : 1.0f;
  return filter.state += weight * (input - filter.state);
}

auto from_first_sample() {
  return [is_first = true](LowPass& filter, Scalar tau_s, Scalar dt_s, Scalar input) mutable {
    if (std::exchange(is_first, false)) filter.state = input;
    return filter.update(tau_s, dt_s, input, CascadeTraits{});
  };
}

const Fault filter_list[] = {
    {"cascade-low-pass-by-exp", "sticks", Stage::sticks,
     "weighs the samples of every low-pass by 1 - exp(-dt / tau)",
     "MC_MAN_TILT_TAU and a stick that moves", "another filter",
     [](FaultyLaw& law) { change_low_passes(law, weighted_by_exp); }},
    {"cascade-low-pass-from-first-sample", "sticks", Stage::sticks,
     "starts every low-pass at its first sample, not at 0", "MC_MAN_TILT_TAU and a stick at first",
     "initial state", [](FaultyLaw& law) { change_low_passes(law, from_first_sample()); }},
    {"cascade-tilt-filter-shared", "sticks", Stage::sticks,
     "filters roll and pitch stick with one low-pass", "MC_MAN_TILT_TAU and one of the sticks",
     "a state shared",
     [](FaultyLaw& law) {
       change_tilt_filter(law, [](TiltFilter& own, const StickGains& gains) {
         const auto filtered = [&](Scalar stick) {
           return own.roll.update(gains.tilt_tau_s, own.dt_s, stick * gains.tilt_max_rad,
                                  own.traits);
         };
         const Scalar roll = filtered(own.roll_stick);
         return std::pair(roll, filtered(own.pitch_stick));
       });
     }},
};

}  // namespace

std::span<const Fault> filter_faults() { return filter_list; }

}  // namespace attest::faults::in_cascade
