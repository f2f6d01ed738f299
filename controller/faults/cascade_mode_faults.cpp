// Mistakes of the cascade's attitude unit in modes, in the latching of topics and in autotune.
#include "controller/faults/cascade_change.hpp"
#include "controller/faults/groups.hpp"

namespace attest::faults::in_cascade {
namespace {

using Topics = cascade::AttitudeTopics;
using StepLaw = AttitudeStepStages::Law;

// Decides from changed topics whether the unit runs. Change is void(Topics&).
template <typename Change>
void change_runs(FaultyLaw& law, Change change) {
  change_stage(law.attitude_unit.step.runs, [change](const auto& then, Topics topics) {
    change(topics);
    return then(topics);
  });
}

template <typename Change>
void change_follows_sticks(FaultyLaw& law, Change change) {
  change_stage(law.attitude_unit.step.follows_sticks, [change](const auto& then, Topics topics) {
    change(topics);
    return then(topics);
  });
}

// Changes what decides whether autotune is active. Change is void(Topics&, std::uint64_t& now_us).
template <typename Change>
void change_autotune(FaultyLaw& law, Change change) {
  change_stage(law.attitude_unit.step.autotuned,
               [change](const auto& then, const Vector& rates, Topics topics, std::uint64_t now_us,
                        const CascadeTraits& traits) mutable {
                 change(topics, now_us);
                 return then(rates, topics, now_us, traits);
               });
}

// Another state, which is in the list already, takes its place.
template <std::size_t state>
void leave_out_autotune_state(FaultyLaw& law) {
  change_traits(law.attitude_unit, [](CascadeTraits& traits) {
    traits.autotune_states[state] = traits.autotune_states.front();
  });
}

// Autotune acts only in the step in which its sample arrives.
void autotune_of_new_sample(FaultyLaw& law) {
  auto is_new = std::make_shared<bool>(false);
  also_before(law.attitude_unit, [is_new](AttitudeIn& in) {
    *is_new = (in.updated & ATTEST_ATTITUDE_UPDATED_AUTOTUNE_ATTITUDE_CONTROL_STATUS) != 0;
  });
  change_autotune(law, [is_new](Topics& topics, std::uint64_t&) {
    if (!*is_new) topics.autotune.state = 0;
  });
}

const Fault mode_list[] = {
    {"cascade-attitude-always-runs", "modes", Stage::mode, "runs without the attitude flag",
     "a mode that controls rates only", "a missing condition",
     [](FaultyLaw& law) {
       change_runs(law, [](Topics& topics) { topics.mode.flag_control_attitude_enabled = 1; });
     }},
    {"cascade-runs-as-fixed-wing", "modes", Stage::mode, "runs while a VTOL flies as fixed wing",
     "a vehicle that is no rotary wing", "a missing condition",
     [](FaultyLaw& law) {
       change_runs(law, [](Topics& topics) { topics.status.is_rotary_wing = 1; });
     }},
    {"cascade-runs-in-transition", "modes", Stage::mode, "runs in the transition of every VTOL",
     "a transition", "a missing condition",
     [](FaultyLaw& law) {
       change_runs(law, [](Topics& topics) { topics.status.in_transition_mode = 0; });
     }},
    {"cascade-tailsitter-ignored", "modes", Stage::mode,
     "does not run in the transition of a tailsitter", "a tailsitter in transition",
     "a missing case",
     [](FaultyLaw& law) {
       change_runs(law, [](Topics& topics) { topics.status.is_vtol_tailsitter = 0; });
     }},
    {"cascade-tailsitter-always-runs", "modes", Stage::mode, "runs for a tailsitter as fixed wing",
     "a tailsitter as fixed wing", "a missing condition",
     [](FaultyLaw& law) {
       change_runs(law, [](Topics& topics) {
         if (topics.status.is_vtol_tailsitter != 0) topics.status.is_rotary_wing = 1;
       });
     }},
    {"cascade-not-run-before-status", "modes", Stage::latching,
     "does not run before the first sample of vehicle_status", "a start without that sample",
     "initial state",
     [](FaultyLaw& law) {
       start_with(law.attitude_unit, ATTEST_ATTITUDE_UPDATED_VEHICLE_STATUS,
                  [](AttitudeIn& in) { in.vehicle_status = {}; });
     }},
    {"cascade-not-run-disarmed", "modes", Stage::mode, "does not run while disarmed",
     "a vehicle that is not armed", "a helpful extra",
     [](FaultyLaw& law) {
       change_runs(law, [](Topics& topics) {
         if (topics.status.armed == 0) topics.mode.flag_control_attitude_enabled = 0;
       });
     }},
    {"cascade-sticks-in-auto", "modes", Stage::mode, "follows the sticks without the manual flag",
     "offboard attitude", "a missing condition",
     [](FaultyLaw& law) {
       change_follows_sticks(law,
                             [](Topics& topics) { topics.mode.flag_control_manual_enabled = 1; });
     }},
    {"cascade-sticks-in-altitude", "modes", Stage::mode, "follows the sticks in altitude mode",
     "altitude mode", "a missing condition",
     [](FaultyLaw& law) {
       change_follows_sticks(law,
                             [](Topics& topics) { topics.mode.flag_control_altitude_enabled = 0; });
     }},
    {"cascade-sticks-with-velocity", "modes", Stage::mode,
     "follows the sticks while velocity is controlled", "the velocity flag alone",
     "a missing condition",
     [](FaultyLaw& law) {
       change_follows_sticks(law,
                             [](Topics& topics) { topics.mode.flag_control_velocity_enabled = 0; });
     }},
    {"cascade-sticks-with-position", "modes", Stage::mode,
     "follows the sticks while position is controlled", "the position flag alone",
     "a missing condition",
     [](FaultyLaw& law) {
       change_follows_sticks(law,
                             [](Topics& topics) { topics.mode.flag_control_position_enabled = 0; });
     }},
    {"cascade-sticks-never", "modes", Stage::mode, "does not follow the sticks", "stabilized mode",
     "a missing mode",
     [](FaultyLaw& law) {
       law.attitude_unit.step.follows_sticks = [](const Topics&) { return false; };
     }},
    {"cascade-flags-equal-1", "robustness", Stage::mode, "takes a flag for set if it is 1",
     "a flag of 2", "flag comparison",
     [](FaultyLaw& law) {
       const auto exact = [](Topics& topics) {
         auto& mode = topics.mode;
         mode.flag_control_attitude_enabled = mode.flag_control_attitude_enabled == 1;
         mode.flag_control_manual_enabled = mode.flag_control_manual_enabled == 1;
       };
       change_runs(law, exact);
       change_follows_sticks(law, exact);
     }},
    {"cascade-setpoint-of-any-time", "modes", Stage::latching,
     "takes an attitude setpoint that is not newer than the last one", "an old setpoint",
     "a missing condition",
     [](FaultyLaw& law) {
       law.attitude_unit.step.is_newer = [](std::uint64_t, std::uint64_t) { return true; };
     }},
    {"cascade-setpoint-of-same-time", "modes", Stage::latching,
     "takes an attitude setpoint of the same time as the last one", "two setpoints of one time",
     "a comparison with equality",
     [](FaultyLaw& law) {
       law.attitude_unit.step.is_newer = [](std::uint64_t now, std::uint64_t last) {
         return now >= last;
       };
     }},
    {"cascade-setpoint-not-pending",
     "modes",
     Stage::latching,
     "loses an attitude setpoint that arrives while the unit does not run",
     "a setpoint before a change of mode",
     "a missing state",
     [](FaultyLaw& law) {
       law.attitude_unit.step.is_pending = [](bool, bool updated) { return updated; };
     },
     {},
     from_v1_15_4},
    {"cascade-own-setpoint-waits",
     "modes",
     Stage::latching,
     "uses a pending setpoint from outside rather than that of the sticks",
     "a setpoint from outside in stabilized mode",
     "another order",
     [](FaultyLaw& law) { law.attitude_unit.step.supersedes_pending = [] { return false; }; },
     {},
     from_v1_15_4},
    {"cascade-own-setpoint-not-published", "modes", Stage::output,
     "does not publish the attitude setpoint of the sticks", "stabilized mode", "a missing output",
     [](FaultyLaw& law) {
       also_after(law.attitude_unit, [](const AttitudeIn&, AttitudeOut& out) {
         out.vehicle_attitude_setpoint.published = 0;
       });
     }},
    {"cascade-rates-always-published", "modes", Stage::output,
     "publishes the last rates in every step", "a mode without attitude control",
     "a missing condition",
     [](FaultyLaw& law) {
       also_after(law.attitude_unit, [](const AttitudeIn&, AttitudeOut& out) {
         out.vehicle_rates_setpoint.published = 1;
       });
     }},
    {"cascade-follows-v1.14.4-own-setpoint",
     "robustness",
     Stage::latching,
     "uses the sticks' setpoint directly as in v1.14.4",
     "a setpoint of the future before stabilized mode",
     "another version",
     follow<&CascadeTraits::flies_own_setpoint_directly, true>,
     {},
     from_v1_15_4},
    {"cascade-follows-v1.15.4-own-setpoint",
     "modes",
     Stage::latching,
     "uses the sticks' setpoint through its topic: one step late",
     "any stick that moves",
     "another version",
     follow<&CascadeTraits::flies_own_setpoint_directly, false>,
     {},
     only_v1_14_4},
    {"cascade-autotune-ignored", "modes", Stage::autotune, "does not add the rates of autotune",
     "autotune", "a missing term",
     [](FaultyLaw& law) {
       change_autotune(law, [](Topics& topics, std::uint64_t&) { topics.autotune.state = 0; });
     }},
    {"cascade-autotune-replaces", "modes", Stage::autotune,
     "takes the rates of autotune instead of adding them", "autotune with an attitude error",
     "a missing sum",
     [](FaultyLaw& law) {
       change_stage(law.attitude_unit.step.autotuned,
                    [](const auto& then, const Vector& rates, const Topics& topics,
                       std::uint64_t now_us, const CascadeTraits& traits) {
                      const Vector zero = Vector::Zero();
                      const Vector added = then(zero, topics, now_us, traits);
                      return added == zero ? rates : added;
                    });
     }},
    {"cascade-autotune-in-any-state", "modes", Stage::autotune,
     "adds the rates of autotune in every state", "autotune in state 5", "a missing condition",
     [](FaultyLaw& law) {
       change_stage(law.attitude_unit.step.autotuned,
                    [](const auto& then, const Vector& rates, Topics topics, std::uint64_t now_us,
                       const CascadeTraits& traits) {
                      topics.autotune.state = traits.autotune_states.front();
                      return then(rates, topics, now_us, traits);
                    });
     }},
    {"cascade-follows-v1.16.0-autotune",
     "modes",
     Stage::autotune,
     "adds the rates of autotune in the states of v1.16.0",
     "autotune of roll",
     "another version",
     [](FaultyLaw& law) {
       change_traits(law.attitude_unit, [](CascadeTraits& traits) {
         traits.autotune_states = cascade::traits_of(cascade::Profile::px4_v1_16_0).autotune_states;
       });
     },
     {},
     from_v1_17},
    {"cascade-autotune-not-in-test", "modes", Stage::autotune,
     "does not add the rates of autotune in the test of its gains", "autotune in its test",
     "a missing case", leave_out_autotune_state<3>},
    {"cascade-autotune-not-of-yaw", "modes", Stage::autotune,
     "does not add the rates of autotune while it excites yaw", "autotune of yaw", "a missing case",
     leave_out_autotune_state<2>},
    {"cascade-autotune-never-old", "modes", Stage::autotune,
     "adds the rates of an autotune sample of any age", "a sample of 1.5 s ago",
     "a missing timeout",
     [](FaultyLaw& law) {
       change_autotune(
           law, [](Topics& topics, std::uint64_t& now_us) { now_us = topics.autotune.timestamp; });
     }},
    {"cascade-autotune-old-after-0.1-s", "modes", Stage::autotune,
     "drops autotune samples after 0.1 s", "a sample of 0.5 s ago", "a wrong timeout",
     [](FaultyLaw& law) {
       change_autotune(law, [](Topics& topics, std::uint64_t& now_us) {
         if (now_us - topics.autotune.timestamp >= 100000) topics.autotune.state = 0;
       });
     }},
    {"cascade-autotune-old-after-1-ms", "modes", Stage::autotune,
     "drops autotune samples after 1 ms", "a sample of 10 ms ago", "a wrong unit",
     [](FaultyLaw& law) {
       change_autotune(law, [](Topics& topics, std::uint64_t& now_us) {
         if (now_us - topics.autotune.timestamp >= 1000) topics.autotune.state = 0;
       });
     }},
    {"cascade-autotune-once", "modes", Stage::latching,
     "adds the rates of autotune only in the step of the sample", "one autotune sample",
     "a missing latch", autotune_of_new_sample},
};

}  // namespace

std::span<const Fault> attitude_mode_faults() { return mode_list; }

}  // namespace attest::faults::in_cascade
