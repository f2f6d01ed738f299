// Mistakes of the cascade in the limits of the thrust that follow arming and landing.
#include "controller/faults/cascade_change.hpp"
#include "controller/faults/groups.hpp"

namespace attest::faults::in_cascade {
namespace {

using StepLaw = AttitudeStepStages::Law;
using StickLaw = StickStages::Law;

template <typename Spooled>
void change_spooled(FaultyLaw& law, Spooled spooled) {
  law.attitude_unit.step.is_spooled = spooled;
}

template <typename Max>
void change_thrust_max(FaultyLaw& law, Max max) {
  change_stage(law.attitude_unit.step.thrust_max, max);
}

template <typename Min>
void change_thrust_min(FaultyLaw& law, Min min) {
  change_stage(law.attitude_unit.step.thrust_min, min);
}

using Status = StepLaw::Status;

// Updates the limits of the thrust only while the mode is stabilized.
void move_limits_with_sticks(FaultyLaw& law) {
  auto used = std::make_shared<bool>(false);
  auto& unit = law.attitude_unit;
  also_before(unit, [used](AttitudeIn&) { *used = false; });
  change_stage(unit.sticks.throttle, [used](const auto& then, Scalar stick, const StickGains& gains,
                                            const ThrustLimits& limits) {
    *used = true;
    return then(stick, gains, limits);
  });
  change_stage(unit.step.thrust_min, [used](const auto& then, Scalar before, Scalar dt, bool landed,
                                            const StickGains& gains) {
    return *used ? then(before, dt, landed, gains) : before;
  });
  change_stage(unit.step.thrust_max,
               [used](const auto& then, Scalar before, Scalar dt, bool spooled) {
                 return *used ? then(before, dt, spooled) : before;
               });
}

// Applies the upper limit after it has moved in this step. The law applies it before.
void move_limits_before_use(FaultyLaw& law) {
  struct Seen {
    Scalar dt_s = 0, spooled = 0;
  };
  auto seen = std::make_shared<Seen>();
  auto& unit = law.attitude_unit;
  change_stage(unit.step.step_time,
               [seen](const auto& then, std::uint64_t now, std::uint64_t last) {
                 return seen->dt_s = then(now, last);
               });
  change_stage(unit.step.is_spooled, [seen](const auto& then, std::uint64_t now,
                                            const Status& status, Scalar spoolup_us) {
    const bool spooled = then(now, status, spoolup_us);
    seen->spooled = spooled ? 1 : 0;
    return spooled;
  });
  change_stage(unit.sticks.limited_thrust,
               [seen](const auto& then, Scalar thrust, ThrustLimits limits) {
                 limits.max = StepLaw::thrust_max(limits.max, seen->dt_s, seen->spooled != 0);
                 return then(thrust, limits);
               });
}

// The lowest thrust starts at MPC_MANTHR_MIN, not at 0.
void start_at_lowest_thrust(FaultyLaw& law) {
  auto is_first = std::make_shared<bool>(true);
  auto& unit = law.attitude_unit;
  change_stage(unit.sticks.throttle, [is_first](const auto& then, Scalar stick,
                                                const StickGains& gains, ThrustLimits limits) {
    if (*is_first) limits.min = gains.thrust_min;
    return then(stick, gains, limits);
  });
  change_stage(unit.step.thrust_min, [is_first](const auto& then, Scalar before, Scalar dt_s,
                                                bool landed, const StickGains& gains) {
    const Scalar from = std::exchange(*is_first, false) ? gains.thrust_min : before;
    return then(from, dt_s, landed, gains);
  });
}

const Fault spool_up_list[] = {
    {"cascade-spool-up-missing", "spool_up", Stage::throttle, "has no spool-up",
     "throttle directly after arming", "a missing step",
     [](FaultyLaw& law) {
       law.attitude_unit.sticks.limited_thrust = [](Scalar thrust, const ThrustLimits&) {
         return thrust;
       };
     }},
    {"cascade-spool-up-ends-at-arming", "spool_up", Stage::throttle,
     "does not wait for COM_SPOOLUP_TIME", "throttle directly after arming", "a missing condition",
     [](FaultyLaw& law) {
       change_spooled(
           law, [](std::uint64_t, const Status& status, Scalar) { return status.armed != 0; });
     }},
    {"cascade-spool-up-disarmed", "spool_up", Stage::throttle,
     "ends the spool-up of a vehicle that is not armed", "throttle while disarmed",
     "a missing condition",
     [](FaultyLaw& law) {
       change_spooled(law, [](std::uint64_t now, const Status& status, Scalar spoolup_us) {
         return static_cast<Scalar>(now - status.armed_time) > spoolup_us;
       });
     }},
    {"cascade-spool-up-since-start", "spool_up", Stage::throttle,
     "counts the spool-up from the start of the clock, not from arming",
     "throttle directly after arming", "another time",
     [](FaultyLaw& law) {
       change_spooled(law, [](std::uint64_t now, const Status& status, Scalar spoolup_us) {
         return status.armed != 0 && static_cast<Scalar>(now) > spoolup_us;
       });
     }},
    {"cascade-spool-up-in-ms", "spool_up", Stage::throttle, "takes COM_SPOOLUP_TIME as ms",
     "throttle 0.5 s after arming", "a wrong unit",
     [](FaultyLaw& law) {
       change_gains(law.attitude_unit, [](AttitudeUnitGains& gains, const CascadeParameters&) {
         gains.spoolup_us *= 1e-3f;
       });
     }},
    {"cascade-spool-up-judged-always", "spool_up", Stage::latching,
     "ends the spool-up in any step, not with a sample of vehicle_status",
     "a spool-up that ends between two samples", "a latch",
     [](FaultyLaw& law) {
       auto status = std::make_shared<std::optional<Status>>();
       also_before(law.attitude_unit, [status](AttitudeIn& in) {
         if ((in.updated & ATTEST_ATTITUDE_UPDATED_VEHICLE_STATUS) != 0) {
           *status = in.vehicle_status;
         } else if (*status) {
           in.vehicle_status = **status;
           in.updated |= ATTEST_ATTITUDE_UPDATED_VEHICLE_STATUS;
         }
       });
     }},
    {"cascade-spool-up-at-once", "spool_up", Stage::throttle,
     "gives full thrust at the end of the spool-up, without the ramp",
     "throttle during the ramp of 2 s", "a missing ramp",
     [](FaultyLaw& law) {
       change_thrust_max(
           law, [](const auto&, Scalar, Scalar, bool spooled) { return spooled ? 1.0f : 0.0f; });
     }},
    {"cascade-spool-up-in-1-s", "spool_up", Stage::throttle, "raises the thrust in 1 s, not in 2 s",
     "throttle during the ramp", "a wrong factor",
     [](FaultyLaw& law) {
       change_thrust_max(law, [](const auto&, Scalar before, Scalar dt_s, bool spooled) {
         return spooled ? cascade::slewed(before, 1.0f, dt_s, 1.0f) : 0.0f;
       });
     }},
    {"cascade-spool-down-slow", "spool_up", Stage::throttle,
     "lowers the thrust along the ramp after disarming", "disarming at full throttle",
     "a ramp too many",
     [](FaultyLaw& law) {
       change_thrust_max(law, [](const auto&, Scalar before, Scalar dt_s, bool spooled) {
         return cascade::slewed(before, 0.5f, dt_s, spooled ? 1.0f : 0.0f);
       });
     }},
    {"cascade-spool-up-once", "spool_up", Stage::throttle, "keeps the thrust limit after disarming",
     "arming for a second time", "a missing reset",
     [](FaultyLaw& law) {
       change_thrust_max(law, [](const auto& then, Scalar before, Scalar dt_s, bool spooled) {
         return spooled ? then(before, dt_s, true) : before;
       });
     }},
    {"cascade-spool-up-with-sticks-only", "spool_up", Stage::throttle,
     "moves the limits of the thrust in stabilized mode only",
     "arming in another mode, then stabilized mode", "a misplaced step", move_limits_with_sticks},
    {"cascade-spool-up-before-use", "spool_up", Stage::throttle,
     "moves the limit of the thrust before it is used", "throttle during the ramp",
     "steps exchanged", move_limits_before_use},
    {"cascade-spool-up-scales", "spool_up", Stage::throttle,
     "multiplies the thrust by the limit instead of limiting it", "throttle during the ramp",
     "another limit",
     [](FaultyLaw& law) {
       law.attitude_unit.sticks.limited_thrust = [](Scalar thrust, const ThrustLimits& limits) {
         return thrust * limits.max;
       };
     }},
    {"cascade-min-thrust-landed", "spool_up", Stage::throttle,
     "keeps the minimum thrust on the ground", "throttle -1 while landed", "a missing case",
     [](FaultyLaw& law) {
       change_thrust_min(
           law, [](const auto& then, Scalar before, Scalar dt_s, bool, const StickGains& gains) {
             return then(before, dt_s, false, gains);
           });
     }},
    {"cascade-min-thrust-at-once", "spool_up", Stage::throttle,
     "has the minimum thrust at take-off at once", "throttle -1 after take-off", "a missing ramp",
     [](FaultyLaw& law) {
       change_thrust_min(law,
                         [](const auto&, Scalar, Scalar, bool landed, const StickGains& gains) {
                           return landed ? 0.0f : gains.thrust_min;
                         });
     }},
    {"cascade-min-thrust-fast", "spool_up", Stage::throttle,
     "moves the lowest thrust by 0.5 in each second, not by 0.05", "takeoff at throttle -1",
     "a wrong factor",
     [](FaultyLaw& law) {
       auto& thrust_min = law.attitude_unit.step.thrust_min;
       change_stage(thrust_min,
                    [](const auto& then, Scalar before, Scalar dt_s, bool landed,
                       const StickGains& gains) { return then(before, dt_s * 10, landed, gains); });
     }},
    {"cascade-min-thrust-from-parameter", "spool_up", Stage::throttle,
     "starts the lowest thrust at MPC_MANTHR_MIN, not at 0", "throttle -1 at the start",
     "initial state", start_at_lowest_thrust},
    {"cascade-min-thrust-missing", "spool_up", Stage::throttle, "has no minimum thrust in flight",
     "throttle -1 in flight", "a missing term",
     [](FaultyLaw& law) {
       change_thrust_min(law,
                         [](const auto&, Scalar, Scalar, bool, const StickGains&) { return 0.0f; });
     }},
    {"cascade-min-thrust-drops", "spool_up", Stage::throttle,
     "drops the minimum thrust at touch-down at once", "throttle -1 at touch-down",
     "a missing ramp",
     [](FaultyLaw& law) {
       change_thrust_min(law, [](const auto& then, Scalar before, Scalar dt_s, bool landed,
                                 const StickGains& gains) {
         return landed ? 0.0f : then(before, dt_s, false, gains);
       });
     }},
    {"cascade-starts-in-flight", "spool_up", Stage::latching,
     "counts as flying before the first sample of vehicle_land_detected",
     "a start without that sample", "initial state",
     [](FaultyLaw& law) {
       start_with(law.attitude_unit, ATTEST_ATTITUDE_UPDATED_VEHICLE_LAND_DETECTED,
                  [](AttitudeIn& in) { in.vehicle_land_detected.landed = 0; });
     }},
    {"cascade-follows-v1.14.4-throttle", "spool_up", Stage::throttle,
     "takes the throttle as in v1.14.4: no spool-up", "throttle directly after arming",
     "another version", follow<&CascadeTraits::spools_up, false>},
    {"cascade-follows-v1.15.4-throttle",
     "sticks",
     Stage::throttle,
     "spools up as in v1.15.4",
     "throttle directly after arming",
     "another version",
     follow<&CascadeTraits::spools_up, true>,
     {},
     only_v1_14_4},
};

}  // namespace

std::span<const Fault> spool_up_faults() { return spool_up_list; }

}  // namespace attest::faults::in_cascade
