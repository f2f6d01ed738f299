// Short forms of the changes that faults of the cascade make.
#pragma once

#include <memory>
#include <optional>
#include <type_traits>
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
inline constexpr auto from_v1_18 = cascade::from_v1_18;
inline constexpr auto from_v1_17 = cascade::from_v1_17;
inline constexpr auto until_v1_17 = cascade::until_v1_17;
inline constexpr auto from_v1_16_0 = cascade::from_v1_16_0;
inline constexpr auto from_v1_15_4 = cascade::from_v1_15_4;
inline constexpr auto until_v1_15_4 = cascade::until_v1_15_4;
inline constexpr auto only_v1_15_4 = cascade::only_v1_15_4;
inline constexpr auto only_v1_14_4 = cascade::only_v1_14_4;

inline ModelStages& model_of(FaultyLaw& law) { return law.attitude_unit.model; }

// The vector v, turned by q.
inline Vector turned(const Quat& q, V v) {
  using cascade::product;
  return cascade::imaginary_part(
      product(product(q, Quat(0, v[0], v[1], v[2])), cascade::inverse(q)));
}

inline Quat conjugated(const Quat& q) { return {q[0], -q[1], -q[2], -q[3]}; }

// Changes the gains that the law computes. Unit is AttitudeUnitLaw or RateUnitLaw. Change has the
// signature void(Gains&, const CascadeParameters&).
template <typename Unit, typename Change>
void change_gains(Unit& unit, Change change) {
  change_stage(unit.step.gains,
               [change](const auto& then, const CascadeParameters& parameters) mutable {
                 auto gains = then(parameters);
                 change(gains, parameters);
                 return gains;
               });
}

// Computes the gains from changed parameters. Change has the signature void(CascadeParameters&).
template <typename Unit, typename Change>
void change_parameters(Unit& unit, Change change) {
  change_stage(unit.step.gains,
               [change](const auto& then, const CascadeParameters& parameters) mutable {
                 CascadeParameters changed = parameters;
                 change(changed);
                 return then(changed);
               });
}

// Changes the traits of the unit's profile. Change has the signature void(CascadeTraits&).
template <typename Unit, typename Change>
void change_traits(Unit& unit, Change change) {
  change_stage(unit.step.traits, [change](const auto& then, cascade::Profile profile) {
    CascadeTraits traits = then(profile);
    change(traits);
    return traits;
  });
}

// Sets one trait to `value`, which it has in another profile.
template <bool CascadeTraits::*trait, bool value>
void follow(FaultyLaw& law) {
  const auto change = [](CascadeTraits& traits) { traits.*trait = value; };
  change_traits(law.attitude_unit, change);
  change_traits(law.rate_unit, change);
}

// Whether the unit's profile has a reference model. A change outside the stages of the model must
// leave the other profiles as they are.
inline std::shared_ptr<bool> watch_for_model(FaultyLaw& law) {
  auto has_model = std::make_shared<bool>(false);
  change_traits(law.attitude_unit, [has_model](CascadeTraits& traits) {
    *has_model = traits.follows_reference_model;
  });
  return has_model;
}

// The attitude setpoint that was taken last, of norm 1.
inline std::shared_ptr<Quat> watch_setpoint(FaultyLaw& law) {
  auto q_WD = std::make_shared<Quat>(cascade::identity<Scalar>());
  law.attitude_unit.attitude.setpoint = [q_WD](const Quat& given) {
    return *q_WD = QuaternionStages::Law::setpoint(given);
  };
  return q_WD;
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

// Uses each sample of a topic one step late. `member` has the topic, and `bit` shows a new sample.
template <auto member, std::uint32_t bit, typename Unit>
void delay(Unit& unit) {
  using Inputs = typename Unit::Inputs;
  using Sample = std::remove_cvref_t<decltype(std::declval<Inputs>().*member)>;
  also_before(unit, [sample = Sample{}, arrived = std::uint32_t{0}](Inputs& in) mutable {
    std::swap(sample, in.*member);
    in.updated = (in.updated & ~bit) | std::exchange(arrived, in.updated & bit);
  });
}

}  // namespace attest::faults::in_cascade
