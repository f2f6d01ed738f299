// Mistakes of the cascade in the throttle of stabilized mode.
#include "controller/faults/cascade_change.hpp"
#include "controller/faults/groups.hpp"

namespace attest::faults::in_cascade {
namespace {

using Curve = cascade::ThrottleCurve;
using StickLaw = StickStages::Law;

// Changes the gains of the sticks, in every profile.
template <typename Change>
void change_throttle_gains(FaultyLaw& law, Change change) {
  change_gains(law.attitude_unit, [change](AttitudeUnitGains& gains, const CascadeParameters& p) {
    change(gains.sticks, p);
  });
}

// Changes the thrust that the law computes from the throttle stick, in every profile.
template <typename Change>
void change_stick_thrust(FaultyLaw& law, Change change) {
  auto& sticks = law.attitude_unit.sticks;
  change_stage(sticks.limited_thrust,
               [change](const auto& then, Scalar thrust, const ThrustLimits& limits) {
                 return change(then(thrust, limits));
               });
  change_stage(sticks.uncentred_throttle,
               [change](const auto& then, Scalar stick, const StickGains& gains) {
                 return change(then(stick, gains));
               });
}

const Fault throttle_list[] = {
    {"cascade-stick-thrust-up", "sticks", Stage::throttle, "publishes a positive thrust",
     "any throttle", "a sign",
     [](FaultyLaw& law) { change_stick_thrust(law, [](Scalar thrust) { return -thrust; }); }},
    {"cascade-stick-thrust-clamped", "sticks", Stage::throttle, "clamps the thrust to 0 .. 0.9",
     "full throttle", "a wrong clamp",
     [](FaultyLaw& law) {
       change_stick_thrust(law, [](Scalar thrust) { return cascade::clamp(thrust, 0.0f, 0.9f); });
     }},
    {"cascade-throttle-straight", "sticks", Stage::throttle, "has the straight curve only",
     "a hover thrust other than the middle", "a missing case",
     [](FaultyLaw& law) {
       change_throttle_gains(law, [](StickGains& gains, const CascadeParameters&) {
         gains.throttle_curve = Curve::straight;
       });
     }},
    {"cascade-throttle-never-straight", "sticks", Stage::throttle,
     "passes through the hover thrust with MPC_THR_CURVE 1, too", "MPC_THR_CURVE 1",
     "a missing case",
     [](FaultyLaw& law) {
       change_throttle_gains(law, [](StickGains& gains, const CascadeParameters&) {
         if (gains.throttle_curve == Curve::straight) {
           gains.throttle_curve = Curve::through_hover_estimate;
         }
       });
     }},
    {"cascade-throttle-to-1", "sticks", Stage::throttle, "does not read MPC_THR_MAX",
     "MPC_THR_MAX 0.8 at full throttle", "a missing parameter",
     [](FaultyLaw& law) {
       change_throttle_gains(
           law, [](StickGains& gains, const CascadeParameters&) { gains.thrust_max = 1; });
     }},
    {"cascade-throttle-from-0", "sticks", Stage::throttle, "does not read MPC_MANTHR_MIN",
     "throttle -1 in flight", "a missing parameter",
     [](FaultyLaw& law) {
       change_throttle_gains(
           law, [](StickGains& gains, const CascadeParameters&) { gains.thrust_min = 0; });
     }},
    {"cascade-straight-throttle-from-0", "sticks", Stage::throttle,
     "starts the straight curve at 0, not at MPC_MANTHR_MIN", "MPC_THR_CURVE 1 in flight",
     "a missing parameter",
     [](FaultyLaw& law) {
       auto& sticks = law.attitude_unit.sticks;
       change_stage(sticks.throttle, [](const auto& then, Scalar stick, const StickGains& gains,
                                        ThrustLimits limits) {
         if (gains.throttle_curve == Curve::straight) limits.min = 0;
         return then(stick, gains, limits);
       });
       change_stage(sticks.uncentred_throttle,
                    [](const auto& then, Scalar stick, StickGains gains) {
                      if (gains.throttle_curve == Curve::straight) gains.thrust_min = 0;
                      return then(stick, gains);
                    });
     }},
    {"cascade-hover-at-half", "sticks", Stage::throttle, "does not read MPC_THR_HOVER",
     "MPC_THR_HOVER 0.4 at throttle 0", "a missing parameter",
     [](FaultyLaw& law) {
       change_throttle_gains(
           law, [](StickGains& gains, const CascadeParameters&) { gains.thrust_hover = 0.5f; });
     }},
};

}  // namespace

std::span<const Fault> throttle_faults() { return throttle_list; }

}  // namespace attest::faults::in_cascade
