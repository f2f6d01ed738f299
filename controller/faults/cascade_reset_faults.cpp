// Mistakes of the cascade after a reset of the estimator, and in the estimated hover thrust.
#include <algorithm>
#include <cmath>

#include "controller/faults/cascade_change.hpp"
#include "controller/faults/groups.hpp"

namespace attest::faults::in_cascade {
namespace {

using cascade::product;
using StepLaw = AttitudeStepStages::Law;
using HoverSample = AttitudeStepStages::HoverSample;

template <typename Adapt>
void change_adapted(FaultyLaw& law, Adapt adapt) {
  law.attitude_unit.attitude.adapted = adapt;
}

template <typename Change>
void change_reset(FaultyLaw& law, Change change) {
  also_before(law.attitude_unit, [change](AttitudeIn& in) mutable { change(in.vehicle_attitude); });
}
using AttitudeTopic = decltype(AttitudeIn::vehicle_attitude);

// The estimator's reset leaves out one of the three angles that it turns. `which` is 0 for the yaw
// setpoint, 1 for the filtered error of the heading, 2 for the reference of the yaw correction.
template <int which>
void keep_angle(FaultyLaw& law) {
  change_stage(law.attitude_unit.sticks.turned,
               [count = 0](const auto& then, Scalar angle, Scalar turn) mutable {
                 const int index = count++ % 3;
                 return then(angle, index == which ? 0.0f : turn);
               });
}

const Fault reset_list[] = {
    {"cascade-reset-ignored", "estimator_reset", Stage::estimator_reset,
     "does not follow resets of the estimator", "a reset", "a missing step",
     [](FaultyLaw& law) {
       change_reset(law, [](AttitudeTopic& topic) { topic.quat_reset_counter = 0; });
     }},
    {"cascade-reset-in-each-step", "estimator_reset", Stage::estimator_reset,
     "applies delta_q_reset in each step", "a reset", "a missing comparison",
     [](FaultyLaw& law) {
       change_reset(law, [odd = false](AttitudeTopic& topic) mutable {
         odd = !odd;
         if (topic.quat_reset_counter != 0) topic.quat_reset_counter = odd ? 1 : 2;
       });
     }},
    {"cascade-reset-counter-grows", "estimator_reset", Stage::estimator_reset,
     "sees a reset only if the counter grows", "a counter that wraps from 255 to 0",
     "another comparison",
     [](FaultyLaw& law) {
       change_reset(law, [highest = std::uint8_t{0}](AttitudeTopic& topic) mutable {
         highest = std::max(highest, topic.quat_reset_counter);
         topic.quat_reset_counter = highest;
       });
     }},
    {"cascade-reset-first-counter-seen", "estimator_reset", Stage::estimator_reset,
     "takes the counter of the first step for known", "a first step with a counter other than 0",
     "initial state",
     [](FaultyLaw& law) {
       change_reset(law, [first = std::optional<std::uint8_t>{}](AttitudeTopic& topic) mutable {
         if (!first) first = topic.quat_reset_counter;
         topic.quat_reset_counter = static_cast<std::uint8_t>(topic.quat_reset_counter - *first);
       });
     }},
    {"cascade-reset-of-new-setpoint", "estimator_reset", Stage::estimator_reset,
     "turns also a setpoint that is newer than the attitude", "a new setpoint with a reset",
     "a missing comparison",
     [](FaultyLaw& law) {
       law.attitude_unit.step.precedes_reset = [](std::uint64_t, std::uint64_t) { return true; };
     }},
    {"cascade-reset-not-of-setpoint", "estimator_reset", Stage::estimator_reset,
     "does not turn the attitude setpoint", "a reset after the setpoint", "a missing step",
     [](FaultyLaw& law) {
       law.attitude_unit.step.precedes_reset = [](std::uint64_t, std::uint64_t) { return false; };
     }},
    {"cascade-reset-by-sample-time", "estimator_reset", Stage::estimator_reset,
     "compares the setpoint with the time of the sample, not of the attitude",
     "a setpoint between the two", "another time",
     [](FaultyLaw& law) {
       auto sample_us = std::make_shared<std::uint64_t>(0);
       also_before(law.attitude_unit, [sample_us](AttitudeIn& in) {
         *sample_us = in.vehicle_attitude.timestamp_sample;
       });
       law.attitude_unit.step.precedes_reset = [sample_us](std::uint64_t last, std::uint64_t) {
         return *sample_us > last;
       };
     }},
    {"cascade-reset-in-body", "estimator_reset", Stage::estimator_reset,
     "turns the setpoint about its own axes", "a reset of yaw with a tilted setpoint",
     "factors exchanged",
     [](FaultyLaw& law) {
       change_adapted(law, [](const Quat& delta, const Quat& q_WD) {
         return cascade::unit(product(q_WD, delta));
       });
     }},
    {"cascade-reset-backwards", "estimator_reset", Stage::estimator_reset,
     "turns the setpoint the other way", "a reset", "a sign",
     [](FaultyLaw& law) {
       change_adapted(law, [](const Quat& delta, const Quat& q_WD) {
         return cascade::unit(product(cascade::inverse(delta), q_WD));
       });
     }},
    {"cascade-reset-quat-order", "estimator_reset", Stage::estimator_reset,
     "takes delta_q_reset as x, y, z, w", "a reset", "quaternion order",
     [](FaultyLaw& law) {
       change_reset(law, [](AttitudeTopic& topic) {
         std::rotate(topic.delta_q_reset, topic.delta_q_reset + 3, topic.delta_q_reset + 4);
       });
     }},
    {"cascade-reset-replaces", "estimator_reset", Stage::estimator_reset,
     "takes delta_q_reset as the new setpoint", "a reset", "another meaning",
     [](FaultyLaw& law) {
       change_adapted(law, [](const Quat& delta, const Quat&) { return cascade::unit(delta); });
     }},
    {"cascade-reset-not-normalised", "estimator_reset", Stage::estimator_reset,
     "does not normalise the turned setpoint", "a delta_q_reset of another norm", "a missing step",
     [](FaultyLaw& law) {
       change_adapted(law,
                      [](const Quat& delta, const Quat& q_WD) { return product(delta, q_WD); });
     }},
    {"cascade-reset-not-of-yaw", "estimator_reset", Stage::estimator_reset,
     "does not turn the yaw of the sticks", "a reset in stabilized mode", "a missing step",
     keep_angle<0>},
    {"cascade-reset-not-of-filter",
     "estimator_reset",
     Stage::estimator_reset,
     "does not turn the state of the filter of the heading's error",
     "a reset with an unaided heading",
     "a missing step",
     keep_angle<1>,
     {},
     from_v1_16_0},
    {"cascade-reset-not-of-reference",
     "estimator_reset",
     Stage::estimator_reset,
     "does not turn the reference of the yaw correction",
     "a reset during a convergence",
     "a missing step",
     keep_angle<2>,
     {},
     from_v1_16_0},
    {"cascade-reset-yaw-backwards", "estimator_reset", Stage::estimator_reset,
     "turns the yaw of the sticks the other way", "a reset in stabilized mode", "a sign",
     [](FaultyLaw& law) {
       law.attitude_unit.sticks.turned = [](Scalar angle, Scalar turn) {
         return cascade::wrap(angle - turn);
       };
     }},
    {"cascade-reset-not-wrapped",
     "estimator_reset",
     Stage::estimator_reset,
     "does not wrap the filter and the reference of the yaw correction after a reset",
     "a reset that passes south, with an unaided heading",
     "a missing wrap",
     [](FaultyLaw& law) {
       change_stage(law.attitude_unit.sticks.turned,
                    [count = 0](const auto& then, Scalar angle, Scalar turn) mutable {
                      return count++ % 3 == 0 ? then(angle, turn) : angle + turn;
                    });
     },
     {},
     from_v1_16_0},
    {"cascade-follows-v1.14.4-latching",
     "estimator_reset",
     Stage::latching,
     "latches setpoint and reset in every step, before the sticks, as in v1.14.4",
     "a reset while the unit does not run",
     "another version",
     follow<&CascadeTraits::latches_in_every_step, true>,
     {},
     from_v1_15_4},
    {"cascade-follows-v1.15.4-latching",
     "estimator_reset",
     Stage::latching,
     "latches setpoint and reset only while it runs, as in v1.15.4",
     "a reset while the unit does not run",
     "another version",
     follow<&CascadeTraits::latches_in_every_step, false>,
     {},
     only_v1_14_4},
    {"cascade-hover-estimate-ignored",
     "spool_up",
     Stage::throttle,
     "does not use the estimated hover thrust",
     "an estimate and throttle 0",
     "another version",
     follow<&CascadeTraits::follows_hover_estimate, false>,
     {},
     from_v1_16_0},
    {"cascade-hover-estimate-invalid",
     "spool_up",
     Stage::throttle,
     "uses an estimate that is not valid",
     "an estimate that is not valid",
     "a missing condition",
     [](FaultyLaw& law) {
       change_stage(law.attitude_unit.step.hover_estimate,
                    [](const auto& then, HoverSample sample, const StickGains& gains) {
                      sample.valid = 1;
                      return then(sample, gains);
                    });
     },
     {},
     from_v1_16_0},
    {"cascade-hover-estimate-kept",
     "spool_up",
     Stage::throttle,
     "keeps the last estimate when it is no longer valid",
     "an estimate that becomes invalid",
     "a missing fallback",
     [](FaultyLaw& law) {
       change_stage(law.attitude_unit.step.hover_estimate,
                    [last = static_cast<Scalar>(NAN)](const auto& then, const HoverSample& sample,
                                                      const StickGains& gains) mutable {
                      if (sample.valid != 0) last = then(sample, gains);
                      return last;
                    });
     },
     {},
     from_v1_16_0},
    {"cascade-hover-estimate-unclamped",
     "spool_up",
     Stage::throttle,
     "does not clamp the estimate to 0.05 .. 0.9",
     "an estimate of 0.95",
     "a missing clamp",
     [](FaultyLaw& law) {
       law.attitude_unit.step.hover_estimate = [](const HoverSample& sample,
                                                  const StickGains& gains) {
         return sample.valid != 0 ? sample.hover_thrust : gains.thrust_hover;
       };
     },
     {},
     from_v1_16_0},
    {"cascade-hover-estimate-from-0.1",
     "spool_up",
     Stage::throttle,
     "clamps the estimate to 0.1 .. 0.8, the bounds of the parameter",
     "an estimate of 0.85",
     "a wrong clamp",
     [](FaultyLaw& law) {
       law.attitude_unit.step.hover_estimate = [](const HoverSample& sample,
                                                  const StickGains& gains) {
         return sample.valid != 0 ? cascade::clamp(sample.hover_thrust, 0.1f, 0.8f)
                                  : gains.thrust_hover;
       };
     },
     {},
     from_v1_16_0},
    {"cascade-hover-thrust-at-once",
     "spool_up",
     Stage::throttle,
     "follows the estimate at once, not by 0.05 in each second",
     "an estimate and throttle 0",
     "a missing ramp",
     [](FaultyLaw& law) {
       law.attitude_unit.step.hover_thrust = [](Scalar before, Scalar, Scalar estimate) {
         return std::isfinite(estimate) ? estimate : before;
       };
     },
     {},
     from_v1_16_0},
    {"cascade-hover-thrust-fast",
     "spool_up",
     Stage::throttle,
     "follows the estimate by 0.5 in each second",
     "an estimate and throttle 0",
     "a wrong factor",
     [](FaultyLaw& law) {
       law.attitude_unit.step.hover_thrust = [](Scalar before, Scalar dt_s, Scalar estimate) {
         return std::isfinite(estimate) ? cascade::slewed(before, 0.5f, dt_s, estimate) : before;
       };
     },
     {},
     from_v1_16_0},
    {"cascade-hover-estimate-with-curve-2",
     "sticks",
     Stage::throttle,
     "follows the estimate also with MPC_THR_CURVE 2",
     "MPC_THR_CURVE 2 and an estimate",
     "a missing case",
     [](FaultyLaw& law) {
       change_gains(law.attitude_unit, [](AttitudeUnitGains& gains, const CascadeParameters&) {
         auto& curve = gains.sticks.throttle_curve;
         if (curve == cascade::ThrottleCurve::through_hover_parameter) {
           curve = cascade::ThrottleCurve::through_hover_estimate;
         }
       });
     },
     {},
     from_v1_16_0},
};

}  // namespace

std::span<const Fault> reset_faults() { return reset_list; }

}  // namespace attest::faults::in_cascade
