// Mistakes of the yaw stick in stabilized mode: the lock on the heading and its correction
// (v1.16.0), the integrated stick (until v1.15.4).
#include <cmath>

#include "controller/faults/cascade_change.hpp"
#include "controller/faults/groups.hpp"

namespace attest::faults::in_cascade {
namespace {

using StickLaw = StickStages::Law;

template <typename Rate>
void change_shaped_rate(FaultyLaw& law, Rate rate) {
  law.attitude_unit.sticks.shaped_yaw_rate = [rate](Scalar stick, const StickGains& gains) {
    return rate(stick, gains) * gains.yaw_rate_max_rad_s;
  };
}

template <typename Lock>
void change_lock(FaultyLaw& law, Lock lock) {
  change_stage(law.attitude_unit.sticks.locked_yaw, lock);
}

// Replaces the yaw correction. Correct is bool(state, heading, unaided, dt, traits).
template <typename Correct>
void change_correction(FaultyLaw& law, Correct correct) {
  change_stage(law.attitude_unit.sticks.correct_yaw, correct);
}

// The lock tests the rate that the stick commands, not the filtered rate.
void lock_by_stick(FaultyLaw& law) {
  auto commanded = std::make_shared<Scalar>(0.0f);
  auto& sticks = law.attitude_unit.sticks;
  change_stage(sticks.shaped_yaw_rate,
               [commanded](const auto& then, Scalar stick, const StickGains& gains) {
                 return *commanded = then(stick, gains);
               });
  change_stage(sticks.locked_yaw,
               [commanded](const auto& then, Scalar yaw_sp, Scalar, Scalar heading, Scalar old,
                           Scalar now) { return then(yaw_sp, *commanded, heading, old, now); });
}

// The stick outside the deadzone keeps its slope of 1.
void cut_deadzone_out(FaultyLaw& law) {
  auto& shaped = law.attitude_unit.sticks.shaped_yaw_rate;
  change_stage(shaped, [](const auto& then, Scalar stick, const StickGains& gains) {
    StickGains without_zone = gains;
    without_zone.yaw_deadzone = 0;
    const Scalar width = cascade::clamp(gains.yaw_deadzone, 0.0f, 0.99f);
    return then(cascade::deadzone(stick, gains.yaw_deadzone) * (1 - width), without_zone);
  });
}

const Fault yaw_lock_list[] = {
    {"cascade-yaw-expo-ignored", "sticks", Stage::sticks, "gives the yaw stick no expo",
     "the yaw stick at half", "a missing curve",
     [](FaultyLaw& law) {
       change_shaped_rate(law, [](Scalar stick, const StickGains& gains) {
         return cascade::deadzone(stick, gains.yaw_deadzone);
       });
     }},
    {"cascade-yaw-deadzone-ignored", "sticks", Stage::sticks, "gives the yaw stick no deadzone",
     "the yaw stick at 0.05", "a missing curve",
     [](FaultyLaw& law) {
       change_shaped_rate(law, [](Scalar stick, const StickGains& gains) {
         return cascade::expo(stick, gains.yaw_expo);
       });
     }},
    {"cascade-yaw-deadzone-jumps", "sticks", Stage::sticks,
     "does not scale the stick outside the deadzone: the rate jumps at its end",
     "the yaw stick at half", "a missing scale",
     [](FaultyLaw& law) {
       change_shaped_rate(law, [](Scalar stick, const StickGains& gains) {
         const Scalar outside = std::abs(stick) > gains.yaw_deadzone ? stick : 0.0f;
         return cascade::expo(outside, gains.yaw_expo);
       });
     }},
    {"cascade-yaw-deadzone-not-stretched", "sticks", Stage::sticks,
     "cuts the deadzone out and does not stretch the rest: a full stick gives less than 1",
     "the yaw stick at half", "a missing scale", cut_deadzone_out},
    {"cascade-yaw-expo-before-deadzone", "sticks", Stage::sticks,
     "applies the expo before the deadzone", "the yaw stick at half", "steps exchanged",
     [](FaultyLaw& law) {
       change_shaped_rate(law, [](Scalar stick, const StickGains& gains) {
         return cascade::deadzone(cascade::expo(stick, gains.yaw_expo), gains.yaw_deadzone);
       });
     }},
    {"cascade-yaw-filter-missing", "sticks", Stage::sticks, "does not filter the yaw rate",
     "a yaw stick that moves", "a missing filter",
     [](FaultyLaw& law) {
       change_gains(law.attitude_unit, [](AttitudeUnitGains& gains, const CascadeParameters&) {
         gains.sticks.yaw_tau_s = 0;
       });
     }},
    {"cascade-yaw-filter-in-Hz", "sticks", Stage::sticks,
     "takes MPC_MAN_Y_TAU as a cutoff frequency", "a yaw stick that moves", "a wrong unit",
     [](FaultyLaw& law) {
       change_gains(law.attitude_unit, [](AttitudeUnitGains& gains, const CascadeParameters&) {
         gains.sticks.yaw_tau_s = 1 / (6.28318548f * gains.sticks.yaw_tau_s);
       });
     }},
    {"cascade-yaw-never-locked", "sticks", Stage::yaw_lock, "follows the heading at all times",
     "a centred yaw stick and a heading that drifts", "a missing state",
     [](FaultyLaw& law) {
       change_lock(law, [](const auto&, Scalar, Scalar, Scalar heading, Scalar, Scalar) {
         return heading;
       });
     }},
    {"cascade-yaw-locked-by-stick", "sticks", Stage::yaw_lock,
     "locks the yaw as soon as the stick is centred, while the filtered rate decays",
     "a yaw stick that returns to the centre", "another signal", lock_by_stick},
    {"cascade-yaw-locked-below-0.1", "sticks", Stage::yaw_lock,
     "locks the yaw at rates below 0.1 rad/s", "a yaw stick that returns to the centre",
     "a wrong threshold",
     [](FaultyLaw& law) {
       change_lock(law, [](const auto& then, Scalar yaw_sp, Scalar rate, Scalar heading, Scalar old,
                           Scalar now) {
         return then(yaw_sp, std::abs(rate) < 0.1f ? 0.0f : rate, heading, old, now);
       });
     }},
    {"cascade-yaw-lock-right-only", "sticks", Stage::yaw_lock,
     "does not release the lock for a yaw to the left", "the yaw stick to the left",
     "a missing absolute value",
     [](FaultyLaw& law) {
       change_lock(
           law, [](const auto& then, Scalar yaw_sp, Scalar rate, Scalar heading, Scalar old,
                   Scalar now) { return then(yaw_sp, std::max(rate, 0.0f), heading, old, now); });
     }},
    {"cascade-yaw-lock-of-start", "sticks", Stage::yaw_lock,
     "locks the heading in the first step, instead of turning north",
     "a start in stabilized mode at another heading", "initial state",
     [](FaultyLaw& law) {
       change_lock(law, [is_first = true](const auto& then, Scalar yaw_sp, Scalar rate,
                                          Scalar heading, Scalar old, Scalar now) mutable {
         const bool starts = std::exchange(is_first, false) && yaw_sp == 0;
         return then(starts ? StickLaw::no_yaw() : yaw_sp, rate, heading, old, now);
       });
     }},
    {"cascade-yaw-lock-kept", "sticks", Stage::yaw_lock,
     "returns to the yaw of the last time in stabilized mode", "another mode in between",
     "a missing reset",
     [](FaultyLaw& law) {
       auto last = std::make_shared<Scalar>(StickLaw::no_yaw());
       law.attitude_unit.sticks.no_yaw = [last] { return *last; };
       change_lock(law,
                   [last](const auto& then, Scalar yaw_sp, Scalar rate, Scalar heading, Scalar old,
                          Scalar now) { return *last = then(yaw_sp, rate, heading, old, now); });
     }},
    {"cascade-yaw-not-corrected", "sticks", Stage::yaw_lock, "does not correct the locked yaw",
     "a heading that converges away from the unaided one", "a missing term",
     [](FaultyLaw& law) {
       change_lock(law, [](const auto& then, Scalar yaw_sp, Scalar rate, Scalar heading, Scalar,
                           Scalar) { return then(yaw_sp, rate, heading, 0, 0); });
     }},
    {"cascade-yaw-correction-reversed", "sticks", Stage::yaw_lock,
     "corrects the locked yaw the other way", "a heading that converges", "a sign",
     [](FaultyLaw& law) {
       change_lock(law, [](const auto& then, Scalar yaw_sp, Scalar rate, Scalar heading, Scalar old,
                           Scalar now) { return then(yaw_sp, rate, heading, now, old); });
     }},
    {"cascade-yaw-correction-adds-up", "sticks", Stage::yaw_lock,
     "adds the whole correction in each step, not its change", "a heading that converges",
     "a missing difference",
     [](FaultyLaw& law) {
       change_lock(law, [](const auto& then, Scalar yaw_sp, Scalar rate, Scalar heading, Scalar,
                           Scalar now) { return then(yaw_sp, rate, heading, 0, now); });
     }},
    {"cascade-yaw-correction-at-60-deg", "sticks", Stage::yaw_lock,
     "takes the threshold of convergence as 1 rad", "a heading that converges by 10 deg", "degrees",
     [](FaultyLaw& law) {
       change_correction(law, [](const auto& then, YawCorrection& state, Scalar heading,
                                 Scalar unaided, Scalar dt_s, const CascadeTraits& traits) {
         if (!std::isfinite(unaided)) return then(state, heading, unaided, dt_s, traits);
         const Scalar error = cascade::wrap(heading - unaided);
         const Scalar change = cascade::wrap(error - state.error.state);
         state.error.update(1, dt_s, error, traits);
         const bool was_converging = std::exchange(state.converging, std::abs(change) > 1);
         if (!state.converging) state.reference = error;
         state.value = cascade::wrap(error - state.reference);
         return was_converging && !state.converging;
       });
     }},
    {"cascade-yaw-correction-fast", "sticks", Stage::yaw_lock,
     "filters the error of the heading with 0.1 s, not 1 s", "a heading that converges",
     "a wrong factor",
     [](FaultyLaw& law) {
       change_correction(law, [](const auto& then, YawCorrection& state, Scalar heading,
                                 Scalar unaided, Scalar dt_s, const CascadeTraits& traits) {
         return then(state, heading, unaided, 10 * dt_s, traits);
       });
     }},
    {"cascade-yaw-lock-not-released", "sticks", Stage::yaw_lock,
     "keeps the lock when the heading has converged", "the end of a convergence", "a missing step",
     [](FaultyLaw& law) {
       change_correction(law, [](const auto& then, YawCorrection& state, Scalar heading,
                                 Scalar unaided, Scalar dt_s, const CascadeTraits& traits) {
         then(state, heading, unaided, dt_s, traits);
         return false;
       });
     }},
    {"cascade-yaw-correction-of-nan", "sticks", Stage::yaw_lock,
     "goes on with the yaw correction after a time without unaided heading",
     "an unaided heading that is lost during a convergence", "a missing reset",
     [](FaultyLaw& law) {
       change_correction(law, [](const auto& then, YawCorrection& state, Scalar heading,
                                 Scalar unaided, Scalar dt_s, const CascadeTraits& traits) {
         return std::isfinite(unaided) && then(state, heading, unaided, dt_s, traits);
       });
     }},
    {"cascade-yaw-correction-added", "sticks", Stage::yaw_lock, "adds heading and unaided heading",
     "an unaided heading", "a sign",
     [](FaultyLaw& law) {
       change_correction(law, [](const auto& then, YawCorrection& state, Scalar heading,
                                 Scalar unaided, Scalar dt_s, const CascadeTraits& traits) {
         return then(state, heading, -unaided, dt_s, traits);
       });
     }},
    {"cascade-yaw-bad-heading-ignored",
     "sticks",
     Stage::yaw_lock,
     "keeps the lock while heading_good_for_control is false",
     "a heading that is not good",
     "a missing condition",
     [](FaultyLaw& law) {
       also_before(law.attitude_unit,
                   [](AttitudeIn& in) { in.vehicle_local_position.heading_good_for_control = 1; });
     },
     {},
     until_v1_17},
    {"cascade-yaw-starts-with-bad-heading",
     "sticks",
     Stage::yaw_lock,
     "takes the heading for bad before the first sample of vehicle_local_position",
     "a start without that sample",
     "initial state",
     [](FaultyLaw& law) {
       start_with(law.attitude_unit, ATTEST_ATTITUDE_UPDATED_VEHICLE_LOCAL_POSITION,
                  [](AttitudeIn& in) {
                    in.vehicle_local_position = {NAN, 0};
                  });
     },
     {},
     until_v1_17},
    {"cascade-unaided-starts-at-0", "sticks", Stage::yaw_lock,
     "takes the unaided heading for 0 before the first sample of vehicle_local_position",
     "a start without that sample and a heading that jumps", "initial state",
     [](FaultyLaw& law) {
       start_with(law.attitude_unit, ATTEST_ATTITUDE_UPDATED_VEHICLE_LOCAL_POSITION,
                  [](AttitudeIn& in) {
                    in.vehicle_local_position = {0, 1};
                  });
     }},
    {"cascade-follows-v1.15.4-yaw", "sticks", Stage::yaw_lock,
     "integrates the yaw stick as in v1.15.4", "the yaw stick", "another version",
     follow<&CascadeTraits::locks_yaw, false>},
    {"cascade-follows-v1.16.0-yaw",
     "sticks",
     Stage::yaw_lock,
     "locks the yaw on the heading as in v1.16.0",
     "the yaw stick",
     "another version",
     follow<&CascadeTraits::locks_yaw, true>,
     {},
     until_v1_15_4},
    {"cascade-yaw-stick-without-dt",
     "sticks",
     Stage::sticks,
     "adds the yaw rate of the stick without dt",
     "the yaw stick",
     "a missing factor",
     [](FaultyLaw& law) {
       law.attitude_unit.sticks.integrated_yaw = [](Scalar yaw_sp, Scalar rate, Scalar) {
         return cascade::wrap(yaw_sp + rate);
       };
     },
     {},
     until_v1_15_4},
    {"cascade-yaw-stick-not-wrapped",
     "sticks",
     Stage::sticks,
     "does not wrap the integrated yaw: the quaternion changes its sign",
     "a yaw that passes south",
     "a missing wrap",
     [](FaultyLaw& law) {
       law.attitude_unit.sticks.integrated_yaw = [](Scalar yaw_sp, Scalar rate, Scalar dt_s) {
         return yaw_sp + rate * dt_s;
       };
     },
     {},
     until_v1_15_4},
    {"cascade-yaw-stick-from-north",
     "sticks",
     Stage::sticks,
     "starts the integrated yaw at north",
     "stabilized mode at another heading",
     "initial state",
     [](FaultyLaw& law) {
       law.attitude_unit.step.restarts_yaw = [](bool, const cascade::AttitudeTopics&) {
         return false;
       };
     },
     {},
     until_v1_15_4},
    {"cascade-yaw-stick-kept-in-transition",
     "sticks",
     Stage::sticks,
     "keeps the integrated yaw of a VTOL in transition",
     "a tailsitter in transition",
     "a missing case",
     [](FaultyLaw& law) {
       law.attitude_unit.step.restarts_yaw = [](bool sticks,
                                                const cascade::AttitudeTopics& topics) {
         return !sticks || topics.position.heading_good_for_control == 0;
       };
     },
     {},
     until_v1_15_4},
    {"cascade-yaw-stick-expo",
     "sticks",
     Stage::sticks,
     "gives the yaw stick an expo",
     "the yaw stick at half",
     "a helpful extra",
     [](FaultyLaw& law) {
       law.attitude_unit.sticks.straight_yaw_rate = [](Scalar stick, const StickGains& gains) {
         return cascade::expo(stick, 0.6f) * gains.yaw_rate_max_rad_s;
       };
     },
     {},
     until_v1_15_4},
};

}  // namespace

std::span<const Fault> yaw_lock_faults() { return yaw_lock_list; }

}  // namespace attest::faults::in_cascade
