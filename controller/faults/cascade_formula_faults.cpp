// Formulas of the attitude law and of the rate law of the cascade that ports write in another form:
// another mix of rotations, another root, another rule of integration, another unit.
#include <bit>
#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>

#include "controller/faults/cascade_change.hpp"
#include "controller/faults/groups.hpp"

namespace attest::faults::in_cascade {
namespace {

using cascade::inverse;
using cascade::product;
using cascade::z_axis;

// A linear mix of the identity and of a rotation by the remaining yaw, not normalised.
Quat mixed_yaw(Scalar w, Scalar z, Scalar weight) {
  return {(1 - weight) + weight * w, 0, 0, weight * z};
}

// Replaces the shortest rotation that turns one vector into another. Between is Quat(V a, V b).
template <typename Between>
void change_rotation_between(FaultyLaw& law, Between between) {
  law.attitude_unit.attitude.tilt_rotation = [between](const Quat& q_WB, const Quat& q_WD) {
    return between(z_axis(q_WB), z_axis(q_WD));
  };
  law.attitude_unit.sticks.tilt_for_yaw_error = [between](const Quat& tilt, const Quat& desired_yaw,
                                                          const Quat& q_WB) {
    const Vector up(0, 0, 1);
    const Quat yaw = product(inverse(between(up, z_axis(q_WB))), q_WB);
    return between(up, z_axis(product(product(inverse(desired_yaw), yaw), tilt)));
  };
}

// cascade::shortest_rotation() before its quaternion is normalised. `norms` is |a| |b|.
Quat unnormalised_rotation(V a, V b, Scalar norms) {
  const Vector axis = cascade::cross<Scalar>(a, b);
  const Scalar cosine = cascade::dot(a, b);
  if (cosine < 0 && cascade::length(axis) < 1e-5f) {
    const Vector half_turn = cascade::cross<Scalar>(a, cascade::farthest_axis<Scalar>(a));
    return {0, half_turn[0], half_turn[1], half_turn[2]};
  }
  return {cosine + norms, axis[0], axis[1], axis[2]};
}

// Norm 1 by the well-known fast inverse square root, with one step of Newton's method.
Quat roughly_unit(const Quat& q) {
  const float n = cascade::squared_norm(q);
  const auto guess = std::bit_cast<float>(0x5f3759dfu - (std::bit_cast<std::uint32_t>(n) >> 1));
  return cascade::scaled(q, guess * (1.5f - 0.5f * n * guess * guess));
}

void normalise_roughly(FaultyLaw& law) {
  auto& stages = law.attitude_unit.attitude;
  stages.setpoint = roughly_unit;
  stages.adapted = [](const Quat& delta, const Quat& q_WD) {
    return roughly_unit(product(delta, q_WD));
  };
  model_of(law).turned = [](const Quat& q_WR, V turn) {
    return roughly_unit(product(q_WR, cascade::rotation_about<Scalar>(turn)));
  };
  change_rotation_between(law, [](V a, V b) {
    const Scalar norms = std::sqrt(cascade::dot(a, a) * cascade::dot(b, b));
    return roughly_unit(unnormalised_rotation(a, b, norms));
  });
}

// Changes dt in all parts of the rate unit that use it. Change is Scalar(dt_s).
template <typename Change>
void change_rate_dt(FaultyLaw& law, Change change) {
  change_stage(law.rate_unit.rate.integrated,
               [change](const auto& then, Scalar integral, Scalar factor, Scalar gain, Scalar error,
                        Scalar dt_s) { return then(integral, factor, gain, error, change(dt_s)); });
  change_stage(law.rate_unit.step.filtered_yaw,
               [change](const auto& then, RateStepStages::LowPass& filter, Scalar torque,
                        Scalar dt_s, const RateUnitGains& gains, const CascadeTraits& traits) {
                 return then(filter, torque, change(dt_s), gains, traits);
               });
}

// Each step integrates the mean of its error and of that of the step before.
void integrate_trapezoids(FaultyLaw& law) {
  struct Errors {
    Vector now = Vector::Zero(), last = Vector::Zero();
    int axis = 0;  // the next one that is integrated
  };
  auto errors = std::make_shared<Errors>();
  auto& stages = law.rate_unit.rate;
  change_stage(stages.error, [errors](const auto& then, V rates_sp, V rates) {
    errors->last = std::exchange(errors->now, then(rates_sp, rates));
    errors->axis = 0;
    return errors->now;
  });
  change_stage(stages.unsaturated,
               [errors](const auto& then, Scalar error, bool positive, bool negative) {
                 return then(0.5f * (error + errors->last[errors->axis++]), positive, negative);
               });
}

void feed_measured_rates_forward(FaultyLaw& law) {
  auto measured = std::make_shared<Vector>(Vector::Zero());
  auto& stages = law.rate_unit.rate;
  change_stage(stages.error, [measured](const auto& then, V rates_sp, V rates) {
    *measured = rates;
    return then(rates_sp, rates);
  });
  change_stage(stages.feed_forward, [measured](const auto& then, V, const TorqueGains& gains) {
    return then(*measured, gains);
  });
}

// The factor between x |x| and x^3 in an expo curve.
Scalar squared_for_cubed(Scalar stick, Scalar share) {
  const Scalar x = std::abs(cascade::clamp(stick, -1.0f, 1.0f));
  const Scalar curved = cascade::clamp(share, 0.0f, 1.0f);
  const Scalar cubic = (1 - curved) + curved * x * x;
  return cubic > 0 ? ((1 - curved) + curved * x) / cubic : 1.0f;
}

void square_in_expo(FaultyLaw& law) {
  change_stage(law.rate_unit.step.acro,
               [](const auto& then, const RateStepStages::Law::Sticks& sticks,
                  const cascade::AcroGains<Scalar>& gains) {
                 RateStepStages::Setpoint setpoint = then(sticks, gains);
                 const float stick[] = {sticks.roll, sticks.pitch, sticks.yaw};
                 for (int i = 0; i < 3; ++i)
                   setpoint.rates_B[i] *= squared_for_cubed(stick[i], gains.expo[i]);
                 return setpoint;
               });
  auto& shaped = law.attitude_unit.sticks.shaped_yaw_rate;
  change_stage(shaped, [](const auto& then, Scalar stick, const StickGains& gains) {
    const Scalar x = cascade::deadzone(stick, gains.yaw_deadzone);
    return then(stick, gains) * squared_for_cubed(x, gains.yaw_expo);
  });
}

const Fault formula_list[] = {
    {"cascade-yaw-weight-by-nlerp", "yaw_weight", Stage::blend,
     "takes the share of the yaw from a linear mix of quaternions, normalised",
     "a yaw error of 120 deg", "another weight",
     [](FaultyLaw& law) {
       law.attitude_unit.attitude.weighted_yaw = [](Scalar w, Scalar z, Scalar weight) {
         return cascade::unit(mixed_yaw(w, z, weight));
       };
     }},
    {"cascade-yaw-weight-by-lerp", "yaw_weight", Stage::blend,
     "takes the share of the yaw from a linear mix of quaternions, not normalised",
     "a large error of tilt and yaw", "another weight",
     [](FaultyLaw& law) { law.attitude_unit.attitude.weighted_yaw = mixed_yaw; }},
    {"cascade-yaw-angle-halved", "yaw_weight", Stage::blend,
     "halves the angle of the yaw once more for the quaternion", "any yaw error", "a factor twice",
     [](FaultyLaw& law) {
       auto& weighted = law.attitude_unit.attitude.weighted_yaw;
       change_stage(weighted, [](const auto& then, Scalar w, Scalar z, Scalar weight) {
         return then(w, z, weight * 0.5f);
       });
     }},
    {"cascade-yaw-gain-by-default-weight", "yaw_weight", Stage::parameters,
     "divides the yaw gain by 0.4, the default of MC_YAW_WEIGHT", "another MC_YAW_WEIGHT",
     "a constant for a parameter",
     [](FaultyLaw& law) {
       change_gains(law.attitude_unit, [](AttitudeUnitGains& gains, const CascadeParameters& p) {
         const bool divides = gains.attitude.yaw_weight > 1e-4f;
         gains.attitude.proportional_1_s[2] = divides ? p.mc_yaw_p * 2.5f : p.mc_yaw_p;
       });
     }},
    {"cascade-yawrate-max-in-degrees", "rate_limit", Stage::limit,
     "takes the limit of the yaw rate as rad/s", "a large yaw error", "degrees",
     [](FaultyLaw& law) {
       change_gains(law.attitude_unit, [](AttitudeUnitGains& gains, const CascadeParameters& p) {
         gains.attitude.rate_max_rad_s[2] = p.mc_yawrate_max;
       });
     }},
    {"cascade-rotation-of-unit-vectors", "robustness", Stage::tilt,
     "takes the thrust axes for vectors of norm 1", "an attitude of another norm", "a shortcut",
     [](FaultyLaw& law) {
       change_rotation_between(
           law, [](V a, V b) { return cascade::unit(unnormalised_rotation(a, b, 1)); });
     }},
    {"cascade-fast-inverse-root", "attitude", Stage::tilt,
     "normalises quaternions with the fast inverse square root", "any tilt error", "a shortcut",
     normalise_roughly},
    {"cascade-rate-dt-as-ms", "rates", Stage::timing,
     "takes dt of the rate law for milliseconds, and divides it by 1000", "an error that lasts",
     "a wrong unit",
     [](FaultyLaw& law) { change_rate_dt(law, [](Scalar dt_s) { return dt_s * 0.001f; }); }},
    {"cascade-ff-of-rates", "rates", Stage::ff, "feeds the measured rates forward",
     "a feed-forward gain and a rate error", "another signal", feed_measured_rates_forward},
    {"cascade-int-lim-0.3", "parameters", Stage::i, "limits the integral of every axis to 0.3",
     "another limit", "a constant for a parameter",
     [](FaultyLaw& law) {
       change_stage(law.rate_unit.rate.limited, [](const auto& then, Scalar next, Scalar before,
                                                   Scalar) { return then(next, before, 0.3f); });
     }},
    {"cascade-i-in-ideal-form", "rates", Stage::parameters,
     "multiplies the integral gain by the P gain", "an error that lasts", "a misplaced factor",
     [](FaultyLaw& law) {
       change_gains(law.rate_unit, [](RateUnitGains& gains, const CascadeParameters& p) {
         gains.rate.integral[0] *= p.mc_rollrate_p;
         gains.rate.integral[1] *= p.mc_pitchrate_p;
         gains.rate.integral[2] *= p.mc_yawrate_p;
       });
     }},
    {"cascade-i-by-trapezoids", "rates", Stage::i, "integrates with the trapezoidal rule",
     "an error that changes", "another integration", integrate_trapezoids},
    {"cascade-expo-squared", "acro", Stage::sticks,
     "squares the stick in the expo of acro and of the yaw stick", "an expo and a stick at half",
     "another curve", square_in_expo},
};

}  // namespace

std::span<const Fault> formula_faults() { return formula_list; }

}  // namespace attest::faults::in_cascade
