// Short forms of the changes that faults of the cascade make.
#pragma once

#include <memory>
#include <optional>
#include <utility>

#include "controller/faults/faulty_law.hpp"

namespace attest::faults::in_cascade {

using QuaternionGains = QuaternionStages::LawGains;
using TorqueGains = TorqueStages::LawGains;
using AttitudeIn = attest_attitude_inputs;
using AttitudeOut = attest_attitude_outputs;
using RateIn = attest_rate_inputs;
using RateOut = attest_rate_outputs;
using V = const Vector&;

inline constexpr auto all = cascade::all_profiles;
inline constexpr auto until_v1_17 = cascade::until_v1_17;
inline constexpr auto from_v1_16_0 = cascade::from_v1_16_0;
inline constexpr auto from_v1_15_4 = cascade::from_v1_15_4;
inline constexpr auto until_v1_15_4 = cascade::until_v1_15_4;
inline constexpr auto only_v1_15_4 = cascade::only_v1_15_4;
inline constexpr auto only_v1_14_4 = cascade::only_v1_14_4;

// Changes the gains that the law computes. Unit is AttitudeUnitLaw or RateUnitLaw. Change has the
// signature void(Gains&, const CascadeParameters&).
template <typename Unit, typename Change>
void change_gains(Unit& unit, Change change) {
  unit.step.gains = [then = unit.step.gains, change](const CascadeParameters& parameters) mutable {
    auto gains = then(parameters);
    change(gains, parameters);
    return gains;
  };
}

// Computes the gains from changed parameters. Change has the signature void(CascadeParameters&).
template <typename Unit, typename Change>
void change_parameters(Unit& unit, Change change) {
  unit.step.gains = [then = unit.step.gains, change](const CascadeParameters& parameters) mutable {
    CascadeParameters changed = parameters;
    change(changed);
    return then(changed);
  };
}

// Changes the traits of the unit's profile. Change has the signature void(CascadeTraits&).
template <typename Unit, typename Change>
void change_traits(Unit& unit, Change change) {
  unit.step.traits = [then = unit.step.traits, change](cascade::Profile profile) {
    CascadeTraits traits = then(profile);
    change(traits);
    return traits;
  };
}

// Sets one trait to `value`, which it has in another profile.
template <bool CascadeTraits::*trait, bool value>
void follow(FaultyLaw& law) {
  const auto change = [](CascadeTraits& traits) { traits.*trait = value; };
  change_traits(law.attitude_unit, change);
  change_traits(law.rate_unit, change);
}

// Uses the value of parameter `from` also for parameter `to`.
template <float CascadeParameters::*to, float CascadeParameters::*from>
void read_from(FaultyLaw& law) {
  const auto change = [](CascadeParameters& p) { p.*to = p.*from; };
  change_parameters(law.attitude_unit, change);
  change_parameters(law.rate_unit, change);
}

// If the first step has no sample of `topic`, adds one. Set, void(Inputs&), writes its fields.
template <typename Unit, typename Set>
void start_with(Unit& unit, std::uint32_t topic, Set set) {
  also_before(unit, [set, topic, is_first = true](typename Unit::Inputs& in) mutable {
    if (!std::exchange(is_first, false) || (in.updated & topic) != 0) return;
    in.updated |= topic;
    set(in);
  });
}

}  // namespace attest::faults::in_cascade
