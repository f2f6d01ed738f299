// Mistakes of the yaw lock of v1.18 when the unaided heading is lost and comes back.
#include <cmath>
#include <utility>

#include "controller/faults/cascade_change.hpp"
#include "controller/faults/groups.hpp"

namespace attest::faults::in_cascade {
namespace {

using StickLaw = StickStages::Law;
using StepLaw = AttitudeStepStages::Law;

// Replaces the yaw correction of the profiles that keep it while the heading is lost. Correct is
// bool(YawCorrection& state, Scalar heading, Scalar unaided, Scalar dt_s, const CascadeTraits&).
template <typename Correct>
void change_kept_correction(FaultyLaw& law, Correct correct) {
  change_stage(law.attitude_unit.sticks.correct_yaw,
               [correct](const auto& then, YawCorrection& state, Scalar heading, Scalar unaided,
                         Scalar dt_s, const CascadeTraits& traits) mutable {
                 return traits.keeps_lost_correction
                            ? correct(then, state, heading, unaided, dt_s, traits)
                            : then(state, heading, unaided, dt_s, traits);
               });
}

// Changes the state after the step in which the heading is back. Change is
// void(YawCorrection& now, const YawCorrection& before).
template <typename Change>
void change_return(FaultyLaw& law, Change change) {
  change_kept_correction(law, [change](const auto& then, YawCorrection& state, Scalar heading,
                                       Scalar unaided, Scalar dt_s, const CascadeTraits& traits) {
    const YawCorrection before = state;
    const bool released = then(state, heading, unaided, dt_s, traits);
    if (before.lost && !state.lost) change(state, before);
    return released;
  });
}

// The heading is also lost in steps without sticks.
void lose_without_sticks(FaultyLaw& law) {
  auto lost = std::make_shared<bool>(false);
  change_stage(law.attitude_unit.step.runs,
               [lost](const auto& then, const cascade::AttitudeTopics& topics) {
                 if (!std::isfinite(topics.position.unaided_heading)) *lost = true;
                 return then(topics);
               });
  change_kept_correction(law, [lost](const auto& then, YawCorrection& state, Scalar heading,
                                     Scalar unaided, Scalar dt_s, const CascadeTraits& traits) {
    if (std::exchange(*lost, false)) state.lost = true;
    return then(state, heading, unaided, dt_s, traits);
  });
}

// A step without sticks ends the loss of the heading.
void find_without_sticks(FaultyLaw& law) {
  auto released = std::make_shared<bool>(false);
  change_stage(law.attitude_unit.sticks.clears_tilt,
               [released](const auto& then, bool runs, const CascadeTraits& traits) {
                 *released = true;
                 return then(runs, traits);
               });
  change_kept_correction(law, [released](const auto& then, YawCorrection& state, Scalar heading,
                                         Scalar unaided, Scalar dt_s, const CascadeTraits& traits) {
    if (std::exchange(*released, false)) state.lost = false;
    return then(state, heading, unaided, dt_s, traits);
  });
}

const Fault lost_heading_list[] = {
    {"cascade-follows-v1.17-heading-good", "sticks", Stage::yaw_lock,
     "releases the lock while heading_good_for_control is false, as in v1.17",
     "a heading that is not good", "another version",
     follow<&CascadeTraits::reads_heading_good, true>},
    {"cascade-follows-v1.17-lost-heading", "sticks", Stage::yaw_lock,
     "sets the yaw correction to 0 while the unaided heading is lost, as in v1.17",
     "an unaided heading that ends during a correction", "another version",
     follow<&CascadeTraits::keeps_lost_correction, false>},
    {"cascade-lost-heading-keeps-lock", "sticks", Stage::yaw_lock,
     "keeps the lock when the unaided heading is back",
     "an unaided heading that comes back after a turn", "a missing step",
     [](FaultyLaw& law) {
       change_kept_correction(law, [](const auto& then, YawCorrection& state, Scalar heading,
                                      Scalar unaided, Scalar dt_s, const CascadeTraits& traits) {
         const bool was_lost = state.lost;
         return then(state, heading, unaided, dt_s, traits) && !was_lost;
       });
     }},
    {"cascade-lost-heading-keeps-filter", "sticks", Stage::yaw_lock,
     "keeps the state of the filter of the heading's error when the unaided heading is back",
     "an unaided heading that comes back with another error", "a missing reset",
     [](FaultyLaw& law) {
       change_return(law, [](YawCorrection& now, const YawCorrection& before) {
         now.error.state = before.error.state;
       });
     }},
    {"cascade-lost-heading-keeps-reference", "sticks", Stage::yaw_lock,
     "keeps the reference of the yaw correction when the unaided heading is back",
     "an unaided heading that comes back with another error, and a convergence", "a missing reset",
     [](FaultyLaw& law) {
       change_return(law, [](YawCorrection& now, const YawCorrection& before) {
         now.reference = before.reference;
       });
     }},
    {"cascade-lost-heading-keeps-correction", "sticks", Stage::yaw_lock,
     "keeps the value of the yaw correction when the unaided heading is back",
     "an unaided heading that comes back during a correction", "a missing reset",
     [](FaultyLaw& law) {
       change_return(
           law, [](YawCorrection& now, const YawCorrection& before) { now.value = before.value; });
     }},
    {"cascade-lost-heading-keeps-converging", "sticks", Stage::yaw_lock,
     "does not end a convergence when the unaided heading is back",
     "an unaided heading that is lost during a convergence", "a missing reset",
     [](FaultyLaw& law) {
       change_return(law, [](YawCorrection& now, const YawCorrection& before) {
         now.converging = before.converging;
       });
     }},
    {"cascade-lost-heading-at-start", "sticks", Stage::yaw_lock,
     "takes the unaided heading for lost before the first step with sticks",
     "a start in stabilized mode with an unaided heading", "initial state",
     [](FaultyLaw& law) {
       change_kept_correction(law, [is_first = true](const auto& then, YawCorrection& state,
                                                     Scalar heading, Scalar unaided, Scalar dt_s,
                                                     const CascadeTraits& traits) mutable {
         if (std::exchange(is_first, false)) state.lost = true;
         return then(state, heading, unaided, dt_s, traits);
       });
     }},
    {"cascade-lost-heading-in-all-modes", "sticks", Stage::yaw_lock,
     "loses the unaided heading also in steps without sticks",
     "an unaided heading that is lost and back in another mode", "a missing condition",
     lose_without_sticks},
    {"cascade-lost-heading-found-in-all-modes", "sticks", Stage::yaw_lock,
     "forgets in steps without sticks that the unaided heading was lost",
     "an unaided heading that is lost before another mode", "a reset too many",
     find_without_sticks},
};

}  // namespace

std::span<const Fault> lost_heading_faults() { return lost_heading_list; }

}  // namespace attest::faults::in_cascade
