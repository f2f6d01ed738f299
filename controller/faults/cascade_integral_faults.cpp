// Mistakes of the cascade in what stops or resets the integral: saturation, limit, landing, arming.
#include <algorithm>
#include <cmath>

#include "controller/faults/cascade_change.hpp"
#include "controller/faults/groups.hpp"

namespace attest::faults::in_cascade {
namespace {

using RateLaw = TorqueStages::Law;
using Allocation = RateLaw::Allocation;
using cascade::Saturation;

// Changes the saturation flags that the law computes from a sample.
template <typename Change>
void change_saturation(FaultyLaw& law, Change change) {
  auto& stage = law.rate_unit.rate.saturation;
  change_stage(stage, [change](const auto& then, const Allocation& status) mutable {
    Saturation flags = then(status);
    change(flags, status);
    return flags;
  });
}

// Replaces what an axis integrates. Error is Scalar(error, positive, negative), with its flags.
template <typename Error>
void change_unsaturated(FaultyLaw& law, Error error) {
  law.rate_unit.rate.unsaturated = error;
}

Saturation flags_beyond(const Allocation& status, float threshold) {
  Saturation flags;
  if (status.torque_setpoint_achieved != 0) return flags;
  for (std::size_t i = 0; i < 3; ++i) {
    flags.positive[i] = status.unallocated_torque[i] > threshold;
    flags.negative[i] = status.unallocated_torque[i] < -threshold;
  }
  return flags;
}

// Not only the integral but also P uses the error that the saturation flags limit.
void saturate_p(FaultyLaw& law) {
  auto now = std::make_shared<Saturation>();
  auto& stages = law.rate_unit.rate;
  change_saturation(law, [now](Saturation& flags, const Allocation&) { *now = flags; });
  change_stage(stages.either, [now](const auto& then, const Saturation& up,
                                    const Saturation& down) { return *now = then(up, down); });
  change_stage(
      stages.proportional, [now](const auto& then, Vector error, const TorqueGains& gains) {
        for (int i = 0; i < 3; ++i) {
          const auto axis = static_cast<std::size_t>(i);
          error[i] = RateLaw::unsaturated(error[i], now->positive[axis], now->negative[axis]);
        }
        return then(error, gains);
      });
}

template <typename Limit>
void change_integral_limit(FaultyLaw& law, Limit limit) {
  change_stage(law.rate_unit.rate.limited, limit);
}

// Changes the two flags that stop the integral on the ground. Change is void(landed, maybe).
template <typename Change>
void change_landed(FaultyLaw& law, Change change) {
  change_stage(law.rate_unit.rate.may_integrate,
               [change](const auto& then, bool landed, bool maybe) {
                 change(landed, maybe);
                 return then(landed, maybe);
               });
}

// Also resets the integral while the newest vehicle_land_detected has landed or maybe_landed set,
// and before its first sample.
void reset_when_landed(FaultyLaw& law) {
  auto landed = std::make_shared<bool>(true);
  also_before(law.rate_unit, [landed](RateIn& in) {
    if ((in.updated & ATTEST_RATE_UPDATED_VEHICLE_LAND_DETECTED) != 0) {
      *landed = in.vehicle_land_detected.landed != 0 || in.vehicle_land_detected.maybe_landed != 0;
    }
  });
  auto& resets = law.rate_unit.step.resets_integral;
  change_stage(resets, [landed](const auto& then, const cascade::RateTopics& topics) {
    return then(topics) || *landed;
  });
}

// Also resets the integral while the thrust is below 5%, as firmwares for races do.
void reset_when_idle(FaultyLaw& law) {
  auto is_idle = std::make_shared<bool>(true);
  also_before(law.rate_unit, [is_idle](RateIn& in) {
    if ((in.updated & ATTEST_RATE_UPDATED_VEHICLE_RATES_SETPOINT) == 0) return;
    *is_idle = in.vehicle_rates_setpoint.thrust_body[2] > -0.05f;
  });
  auto& step = law.rate_unit.step;
  change_stage(step.acro, [is_idle](const auto& then, const auto& sticks, const auto& gains) {
    const auto setpoint = then(sticks, gains);
    *is_idle = setpoint.thrust_B[2] > -0.05f;
    return setpoint;
  });
  change_stage(step.resets_integral, [is_idle](const auto& then, const cascade::RateTopics& in) {
    return then(in) || *is_idle;
  });
}

template <typename Change>
void change_reset_topics(FaultyLaw& law, Change change) {
  auto& resets = law.rate_unit.step.resets_integral;
  change_stage(resets, [change](const auto& then, cascade::RateTopics in) mutable {
    change(in);
    return then(in);
  });
}

const Fault integral_list[] = {
    {"cascade-saturation-ignored", "saturation", Stage::saturation,
     "integrates into saturated actuators", "a saturated axis", "a missing condition",
     [](FaultyLaw& law) {
       change_saturation(law, [](Saturation& flags, const Allocation&) { flags = {}; });
     }},
    {"cascade-saturation-reversed", "saturation", Stage::saturation,
     "exchanges the saturated directions", "a saturated axis", "a sign",
     [](FaultyLaw& law) {
       change_saturation(law, [](Saturation& flags, const Allocation&) {
         std::swap(flags.positive, flags.negative);
       });
     }},
    {"cascade-saturation-of-any-axis", "saturation", Stage::saturation,
     "stops the integral of all axes if one is saturated", "one saturated axis", "axes combined",
     [](FaultyLaw& law) {
       change_saturation(law, [](Saturation& flags, const Allocation&) {
         for (auto* side : {&flags.positive, &flags.negative}) {
           side->fill((*side)[0] || (*side)[1] || (*side)[2]);
         }
       });
     }},
    {"cascade-saturation-freezes", "saturation", Stage::saturation,
     "stops the integral of a saturated axis in both directions",
     "a saturated axis whose error changes its sign", "a missing direction",
     [](FaultyLaw& law) {
       change_saturation(law, [](Saturation& flags, const Allocation&) {
         for (std::size_t i = 0; i < 3; ++i) {
           const bool either = flags.positive[i] || flags.negative[i];
           flags.positive[i] = flags.negative[i] = either;
         }
       });
     }},
    {"cascade-saturation-achieved-ignored", "saturation", Stage::saturation,
     "does not read torque_setpoint_achieved", "an achieved torque with a small remainder",
     "a missing condition",
     [](FaultyLaw& law) {
       change_saturation(law, [](Saturation& flags, Allocation status) {
         status.torque_setpoint_achieved = 0;
         flags = RateLaw::saturation(status);
       });
     }},
    {"cascade-saturation-achieved-keeps", "saturation", Stage::saturation,
     "keeps the old flags when the torque is achieved", "a saturation that ends", "a missing reset",
     [](FaultyLaw& law) {
       change_saturation(
           law, [last = Saturation{}](Saturation& flags, const Allocation& status) mutable {
             if (status.torque_setpoint_achieved != 0) flags = last;
             last = flags;
           });
     }},
    {"cascade-saturation-stays", "saturation", Stage::saturation,
     "never clears a flag of saturation", "a saturation that ends", "a missing reset",
     [](FaultyLaw& law) {
       change_saturation(law, [all = Saturation{}](Saturation& flags, const Allocation&) mutable {
         for (std::size_t i = 0; i < 3; ++i) {
           flags.positive[i] = all.positive[i] = all.positive[i] || flags.positive[i];
           flags.negative[i] = all.negative[i] = all.negative[i] || flags.negative[i];
         }
       });
     }},
    {"cascade-saturation-from-0.05", "saturation", Stage::saturation,
     "sees a saturation from 0.05 of unallocated torque on", "an unallocated torque of 0.01",
     "a wrong threshold",
     [](FaultyLaw& law) {
       change_saturation(law, [](Saturation& flags, const Allocation& status) {
         flags = flags_beyond(status, 0.05f);
       });
     }},
    {"cascade-saturation-not-yaw", "saturation", Stage::saturation,
     "does not read the saturation of yaw", "a saturated yaw", "a missing axis",
     [](FaultyLaw& law) {
       change_saturation(law, [](Saturation& flags, const Allocation&) {
         flags.positive[2] = flags.negative[2] = false;
       });
     }},
    {"cascade-saturation-axes-exchanged", "saturation", Stage::saturation,
     "exchanges the saturation of roll and pitch", "a saturated roll", "wrong axis",
     [](FaultyLaw& law) {
       change_saturation(law, [](Saturation& flags, const Allocation&) {
         std::swap(flags.positive[0], flags.positive[1]);
         std::swap(flags.negative[0], flags.negative[1]);
       });
     }},
    {"cascade-saturation-of-one-step", "saturation", Stage::latching,
     "forgets the saturation in a step without a sample of control_allocator_status",
     "an allocator that is slower than the unit", "a missing latch",
     [](FaultyLaw& law) {
       also_before(law.rate_unit, [](RateIn& in) {
         if ((in.updated & ATTEST_RATE_UPDATED_CONTROL_ALLOCATOR_STATUS) != 0) return;
         in.updated |= ATTEST_RATE_UPDATED_CONTROL_ALLOCATOR_STATUS;
         in.control_allocator_status = {};
       });
     }},
    {"cascade-saturation-of-p", "saturation", Stage::p,
     "takes the error without the saturated direction for P, too", "a saturated axis",
     "a misplaced step", saturate_p},
    {"cascade-saturation-cuts-wrong-side", "saturation", Stage::saturation,
     "clamps the error of a saturated axis to the wrong side", "a saturated axis",
     "min and max exchanged",
     [](FaultyLaw& law) {
       change_unsaturated(law, [](Scalar error, bool positive, bool negative) {
         if (positive) error = cascade::max(error, 0.0f);
         if (negative) error = cascade::min(error, 0.0f);
         return error;
       });
     }},
    {"cascade-integral-unlimited", "integral_limit", Stage::i, "does not limit the integral",
     "an error that lasts", "a missing clamp",
     [](FaultyLaw& law) {
       change_integral_limit(law, [](const auto&, Scalar next, Scalar before, Scalar) {
         return std::isfinite(next) ? next : before;
       });
     }},
    {"cascade-integral-limited-above", "integral_limit", Stage::i,
     "limits a positive integral only", "a negative error that lasts", "a missing clamp",
     [](FaultyLaw& law) {
       change_integral_limit(law, [](const auto&, Scalar next, Scalar before, Scalar max) {
         return std::isfinite(next) ? std::min(next, max) : before;
       });
     }},
    {"cascade-integral-stops-at-limit", "integral_limit", Stage::i,
     "drops the step that would pass the limit", "an integral that reaches the limit",
     "another limit",
     [](FaultyLaw& law) {
       change_integral_limit(law, [](const auto&, Scalar next, Scalar before, Scalar max) {
         return std::abs(next) <= max ? next : before;
       });
     }},
    {"cascade-integral-limit-of-1", "integral_limit", Stage::i, "limits the integral to 1",
     "an error that lasts", "a wrong constant",
     [](FaultyLaw& law) {
       change_integral_limit(law, [](const auto& then, Scalar next, Scalar before, Scalar) {
         return then(next, before, 1.0f);
       });
     }},
    {"cascade-integral-limit-with-k", "integral_limit", Stage::parameters,
     "multiplies the limits by K", "a K other than 1 and an error that lasts", "a misplaced factor",
     [](FaultyLaw& law) {
       change_gains(law.rate_unit, [](RateUnitGains& gains, const CascadeParameters& p) {
         gains.rate.integral_max[0] *= p.mc_rollrate_k;
         gains.rate.integral_max[1] *= p.mc_pitchrate_k;
         gains.rate.integral_max[2] *= p.mc_yawrate_k;
       });
     }},
    {"cascade-integral-of-nan-is-0", "robustness", Stage::i,
     "sets an integral that is not finite to 0 instead of keeping the old one",
     "one NaN of the gyro", "another guard",
     [](FaultyLaw& law) {
       change_integral_limit(law, [](const auto& then, Scalar next, Scalar, Scalar max) {
         return then(next, 0.0f, max);
       });
     }},
    {"cascade-integral-of-nan-kept", "robustness", Stage::guard, "lets the integral become NaN",
     "one NaN of the gyro", "a missing guard",
     [](FaultyLaw& law) {
       change_integral_limit(law, [](const auto&, Scalar next, Scalar, Scalar max) {
         return cascade::clamp(next, -max, max);
       });
     }},
    {"cascade-integral-on-the-ground", "landed", Stage::gate, "integrates on the ground",
     "an error while landed", "a missing condition",
     [](FaultyLaw& law) {
       change_landed(law, [](bool& landed, bool& maybe) { landed = maybe = false; });
     }},
    {"cascade-maybe-landed-ignored", "landed", Stage::gate, "does not read maybe_landed",
     "maybe_landed alone", "a missing condition",
     [](FaultyLaw& law) { change_landed(law, [](bool&, bool& maybe) { maybe = false; }); }},
    {"cascade-landed-ignored", "landed", Stage::gate, "does not read landed", "landed alone",
     "a missing condition",
     [](FaultyLaw& law) { change_landed(law, [](bool& landed, bool&) { landed = false; }); }},
    {"cascade-landed-needs-both", "landed", Stage::gate,
     "freezes the integral only if landed and maybe_landed are set", "one of the flags",
     "and for or",
     [](FaultyLaw& law) {
       change_landed(law, [](bool& landed, bool& maybe) { landed = maybe = landed && maybe; });
     }},
    {"cascade-landed-resets", "landed", Stage::gate,
     "sets the integral to 0 on the ground instead of freezing it", "a landing with an integral",
     "a reset too many", reset_when_landed},
    {"cascade-rate-starts-in-flight", "landed", Stage::latching,
     "counts as flying before the first sample of vehicle_land_detected",
     "a start without that sample", "initial state",
     [](FaultyLaw& law) {
       start_with(law.rate_unit, ATTEST_RATE_UPDATED_VEHICLE_LAND_DETECTED, [](RateIn& in) {
         in.vehicle_land_detected = {0, 0};
       });
     }},
    {"cascade-idle-resets", "modes", Stage::gate, "resets the integral at a thrust below 5%",
     "a thrust of 0", "a helpful extra", reset_when_idle},
    {"cascade-disarmed-keeps-integral", "landed", Stage::arming,
     "does not reset the integral while disarmed", "disarming with an integral", "a missing reset",
     [](FaultyLaw& law) {
       change_reset_topics(law, [](cascade::RateTopics& topics) { topics.mode.flag_armed = 1; });
     }},
    {"cascade-disarmed-resets-once", "landed", Stage::arming,
     "resets the integral when it is disarmed, not in each step", "an error while disarmed",
     "an edge for a level",
     [](FaultyLaw& law) {
       change_stage(law.rate_unit.step.resets_integral,
                    [was = false](const auto& then, const cascade::RateTopics& topics) mutable {
                      const bool resets = then(topics);
                      return resets && !std::exchange(was, resets);
                    });
     }},
    {"cascade-disarmed-freezes", "landed", Stage::arming, "does not integrate while disarmed",
     "an error while disarmed and not landed", "a misplaced reset",
     [](FaultyLaw& law) {
       auto resets = std::make_shared<bool>(false);
       change_stage(law.rate_unit.step.resets_integral,
                    [resets](const auto& then, const cascade::RateTopics& topics) {
                      return *resets = then(topics);
                    });
       change_landed(law, [resets](bool& landed, bool&) { landed = landed || *resets; });
     }},
    {"cascade-fixed-wing-integrates", "landed", Stage::arming,
     "keeps the integral of a VTOL that flies as fixed wing", "a vehicle that is no rotary wing",
     "a missing condition",
     [](FaultyLaw& law) {
       change_reset_topics(law, [](cascade::RateTopics& topics) { topics.is_rotary_wing = true; });
     }},
    {"cascade-rate-starts-as-fixed-wing", "landed", Stage::latching,
     "resets the integral before the first sample of vehicle_status", "a start without that sample",
     "initial state",
     [](FaultyLaw& law) {
       start_with(law.rate_unit, ATTEST_RATE_UPDATED_VEHICLE_STATUS,
                  [](RateIn& in) { in.vehicle_status.is_rotary_wing = 0; });
     }},
};

}  // namespace

std::span<const Fault> integral_faults() { return integral_list; }

}  // namespace attest::faults::in_cascade
