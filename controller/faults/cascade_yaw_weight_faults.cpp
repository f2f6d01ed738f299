// Mistakes of the attitude law of the cascade in the weight of yaw, the feed-forward of the yaw
// rate and the limits.
#include <algorithm>
#include <cmath>

#include "controller/elementary/elementary.hpp"
#include "controller/faults/cascade_change.hpp"
#include "controller/faults/groups.hpp"

namespace attest::faults::in_cascade {
namespace {

// Replaces half the angle of the yaw rotation [rad]. Angle is Scalar(w, z, weight).
template <typename Angle>
void change_yaw_angle(FaultyLaw& law, Angle angle) {
  law.attitude_unit.attitude.weighted_yaw = [angle](Scalar w, Scalar z, Scalar weight) {
    const Scalar half = angle(w, z, weight);
    return Quat(elementary::cos(half), 0, 0, elementary::sin(half));
  };
}

// Replaces the yaw gain. Gain is Scalar(MC_YAW_P, weight).
template <typename Gain>
void change_yaw_gain(FaultyLaw& law, Gain gain) {
  change_gains(law.attitude_unit, [gain](AttitudeUnitGains& gains, const CascadeParameters& p) {
    gains.attitude.proportional_1_s[2] = gain(p.mc_yaw_p, gains.attitude.yaw_weight);
  });
}

template <typename FeedForward>
void change_yaw_feed_forward(FaultyLaw& law, FeedForward feed_forward) {
  law.attitude_unit.attitude.feed_forward = [feed_forward](const Vector& rates, const Quat& q_WB,
                                                           Scalar yaw_rate) {
    if (!std::isfinite(yaw_rate)) return rates;
    return Vector(rates + feed_forward(q_WB, yaw_rate));
  };
}

template <typename Limit>
void change_rate_limit(FaultyLaw& law, Limit limit) {
  law.attitude_unit.attitude.limit = [limit](const Vector& rates, const QuaternionGains& gains) {
    return Vector(limit(rates, gains.rate_max_rad_s));
  };
}

// Limits the rates before the feed-forward.
void limit_early(FaultyLaw& law) {
  auto& stages = law.attitude_unit.attitude;
  change_stage(stages.proportional,
               [](const auto& then, const Quat& error, const QuaternionGains& gains) {
                 return QuaternionStages::Law::limit(then(error, gains), gains);
               });
  stages.limit = [](const Vector& rates, const QuaternionGains&) { return rates; };
}

// The limits do not hold in manual modes.
void limit_without_sticks(FaultyLaw& law) {
  auto sticks = std::make_shared<bool>(false);
  change_stage(law.attitude_unit.step.follows_sticks,
               [sticks](const auto& then, const cascade::AttitudeTopics& topics) {
                 *sticks = topics.mode.flag_control_manual_enabled != 0;
                 return then(topics);
               });
  change_stage(law.attitude_unit.attitude.limit,
               [sticks](const auto& then, const Vector& rates, const QuaternionGains& gains) {
                 return *sticks ? rates : then(rates, gains);
               });
}

Vector clamped(const Vector& rates, const Vector& max) {
  return rates.cwiseMax(-max).cwiseMin(max);
}

// The rotation about body z is that of the weighted yaw alone, the others are those of the tilt.
void take_apart(FaultyLaw& law) {
  struct Parts {
    Quat tilted = cascade::identity<Scalar>();
    Scalar yaw = 0;
  };
  auto parts = std::make_shared<Parts>();
  auto& stages = law.attitude_unit.attitude;
  change_stage(stages.target, [parts](const auto& then, const Quat& tilted, const Quat& yaw) {
    *parts = {tilted, yaw[3]};
    return then(tilted, yaw);
  });
  change_stage(stages.error, [parts](const auto& then, const Quat& q_WB, const Quat&) {
    Quat error = then(q_WB, parts->tilted);
    error[3] = parts->yaw;
    return error;
  });
}

const Fault yaw_weight_list[] = {
    {"cascade-yaw-weight-ignored", "yaw_weight", Stage::blend, "corrects the whole yaw error",
     "any yaw error", "a missing weight",
     [](FaultyLaw& law) {
       change_yaw_angle(law, [](Scalar, Scalar z, Scalar) { return elementary::asin(z); });
     }},
    {"cascade-yaw-dropped", "yaw_weight", Stage::blend, "does not correct yaw", "any yaw error",
     "a missing term",
     [](FaultyLaw& law) { change_yaw_angle(law, [](Scalar, Scalar, Scalar) { return 0.0f; }); }},
    {"cascade-yaw-by-acos", "yaw_weight", Stage::blend, "takes the yaw angle from acos: no sign",
     "a yaw error to the left", "a sign",
     [](FaultyLaw& law) {
       change_yaw_angle(
           law, [](Scalar w, Scalar, Scalar weight) { return weight * elementary::acos(w); });
     }},
    {"cascade-yaw-weight-on-sine", "yaw_weight", Stage::blend,
     "weighs the sine of the yaw, not its angle", "a yaw error of 120 deg", "another weight",
     [](FaultyLaw& law) {
       change_yaw_angle(
           law, [](Scalar, Scalar z, Scalar weight) { return elementary::asin(weight * z); });
     }},
    {"cascade-yaw-weight-twice", "yaw_weight", Stage::blend, "applies the weight twice",
     "any yaw error", "a factor twice",
     [](FaultyLaw& law) {
       change_yaw_angle(law, [](Scalar, Scalar z, Scalar weight) {
         return weight * weight * elementary::asin(z);
       });
     }},
    {"cascade-yaw-weight-inverted", "yaw_weight", Stage::blend,
     "takes MC_YAW_WEIGHT for the share that is not corrected", "any yaw error", "a complement",
     [](FaultyLaw& law) {
       change_parameters(law.attitude_unit, [](CascadeParameters& p) {
         p.mc_yaw_weight = 1 - cascade::clamp(p.mc_yaw_weight, 0.0f, 1.0f);
       });
     }},
    {"cascade-not-reduced", "yaw_weight", Stage::blend,
     "corrects the whole error in one rotation, without priority of the tilt", "a yaw error",
     "a missing step",
     [](FaultyLaw& law) {
       law.attitude_unit.attitude.is_opposite = [](const Quat&) { return true; };
     }},
    {"cascade-yaw-weight-of-gains", "yaw_weight", Stage::parameters,
     "takes the ratio of the yaw gain and the other gains as the weight", "any yaw error",
     "another version",
     [](FaultyLaw& law) {
       change_gains(law.attitude_unit, [](AttitudeUnitGains& gains, const CascadeParameters& p) {
         const float others = (p.mc_roll_p + p.mc_pitch_p) / 2;
         gains.attitude.yaw_weight = std::clamp(p.mc_yaw_p / others, 0.0f, 1.0f);
         gains.attitude.proportional_1_s[2] = others;
       });
     }},
    {"cascade-tilt-and-yaw-apart", "yaw_weight", Stage::blend,
     "corrects tilt and yaw each for itself, and does not join the two rotations",
     "an error of tilt and yaw", "a missing step", take_apart},
    {"cascade-not-reduced-undivided", "yaw_weight", Stage::blend,
     "corrects the whole error in one rotation, and does not divide the yaw gain by the weight",
     "a yaw error", "another law",
     [](FaultyLaw& law) {
       law.attitude_unit.attitude.is_opposite = [](const Quat&) { return true; };
       change_yaw_gain(law, [](Scalar gain, Scalar) { return gain; });
     }},
    {"cascade-yaw-gain-undivided", "yaw_weight", Stage::parameters,
     "does not divide the yaw gain by the weight", "any yaw error", "a missing factor",
     [](FaultyLaw& law) { change_yaw_gain(law, [](Scalar gain, Scalar) { return gain; }); }},
    {"cascade-yaw-gain-multiplied", "yaw_weight", Stage::parameters,
     "multiplies the yaw gain by the weight", "any yaw error", "an inverse factor",
     [](FaultyLaw& law) {
       change_yaw_gain(law, [](Scalar gain, Scalar weight) { return gain * weight; });
     }},
    {"cascade-yaw-gain-divided-by-0", "yaw_weight", Stage::parameters,
     "divides the yaw gain also by a weight of 0", "MC_YAW_WEIGHT 0 and a yaw error",
     "a missing guard",
     [](FaultyLaw& law) {
       change_yaw_gain(law, [](Scalar gain, Scalar weight) { return gain / weight; });
     }},
    {"cascade-yaw-gain-kept-below-0.1", "yaw_weight", Stage::parameters,
     "does not divide the yaw gain by a weight below 0.1", "MC_YAW_WEIGHT 0.05",
     "a wrong threshold",
     [](FaultyLaw& law) {
       change_yaw_gain(
           law, [](Scalar gain, Scalar weight) { return weight > 0.1f ? gain / weight : gain; });
     }},
    {"cascade-yaw-weight-unclamped", "yaw_weight", Stage::parameters,
     "does not clamp MC_YAW_WEIGHT", "MC_YAW_WEIGHT 1.5 and a yaw error", "a missing clamp",
     [](FaultyLaw& law) {
       change_gains(law.attitude_unit, [](AttitudeUnitGains& gains, const CascadeParameters& p) {
         gains.attitude.yaw_weight = p.mc_yaw_weight;
         if (p.mc_yaw_weight > 1e-4f) {
           gains.attitude.proportional_1_s[2] = p.mc_yaw_p / p.mc_yaw_weight;
         }
       });
     }},
    {"cascade-limit-missing", "rate_limit", Stage::limit, "does not limit the rates",
     "a large error", "a missing clamp",
     [](FaultyLaw& law) {
       change_rate_limit(law, [](const Vector& rates, const Vector&) { return rates; });
     }},
    {"cascade-limit-before-ff", "rate_limit", Stage::limit,
     "limits the rates before the feed-forward", "a large yaw error and a yaw rate",
     "steps exchanged", limit_early},
    {"cascade-limit-not-yaw", "rate_limit", Stage::limit, "does not limit the yaw rate",
     "a large yaw error", "a missing axis",
     [](FaultyLaw& law) {
       change_rate_limit(law, [](const Vector& rates, const Vector& max) {
         Vector limited = clamped(rates, max);
         limited[2] = rates[2];
         return limited;
       });
     }},
    {"cascade-limit-upper-only", "rate_limit", Stage::limit, "limits positive rates only",
     "a large negative error", "a missing clamp",
     [](FaultyLaw& law) {
       change_rate_limit(
           law, [](const Vector& rates, const Vector& max) { return Vector(rates.cwiseMin(max)); });
     }},
    {"cascade-limit-of-norm", "rate_limit", Stage::limit,
     "shortens the vector of the rates, instead of each axis", "a large error of two axes",
     "another limit",
     [](FaultyLaw& law) {
       change_rate_limit(law, [](const Vector& rates, const Vector& max) {
         const float excess = rates.cwiseQuotient(max).cwiseAbs().maxCoeff();
         return excess > 1 ? Vector(rates / excess) : rates;
       });
     }},
    {"cascade-limit-ellipse", "rate_limit", Stage::limit,
     "shortens the vector of the rates to a common ellipse", "a large error of two axes",
     "another limit",
     [](FaultyLaw& law) {
       change_rate_limit(law, [](const Vector& rates, const Vector& max) {
         const float excess = cascade::length(Vector(rates.cwiseQuotient(max)));
         return excess > 1 ? Vector(rates / excess) : rates;
       });
     }},
    {"cascade-limit-57.3", "rate_limit", Stage::limit, "takes 180 / pi as 57.3", "a large error",
     "a rounded constant",
     [](FaultyLaw& law) {
       change_rate_limit(law, [](const Vector& rates, const Vector& max) {
         return clamped(rates, Vector(max * (57.2957795f / 57.3f)));
       });
     }},
    {"cascade-limit-in-degrees", "rate_limit", Stage::limit, "takes the limits as rad/s",
     "a large error", "degrees",
     [](FaultyLaw& law) {
       change_gains(law.attitude_unit, [](AttitudeUnitGains& gains, const CascadeParameters& p) {
         gains.attitude.rate_max_rad_s =
             cascade::each<Scalar>(p.mc_rollrate_max, p.mc_pitchrate_max, p.mc_yawrate_max);
       });
     }},
    {"cascade-limit-not-with-sticks", "modes", Stage::limit,
     "does not limit the rates in manual modes", "a large error in stabilized mode",
     "a missing mode", limit_without_sticks},
    {"cascade-limit-of-autotune", "modes", Stage::autotune,
     "limits the rates after autotune is added", "autotune near the limit", "steps exchanged",
     [](FaultyLaw& law) {
       auto max = std::make_shared<Vector>(Vector::Zero());
       change_gains(law.attitude_unit, [max](AttitudeUnitGains& g, const CascadeParameters&) {
         *max = g.attitude.rate_max_rad_s;
       });
       change_stage(
           law.attitude_unit.step.autotuned,
           [max](const auto& then, const Vector& rates, const cascade::AttitudeTopics& topics,
                 std::uint64_t now_us, const CascadeTraits& traits) {
             return clamped(then(rates, topics, now_us, traits), *max);
           });
     }},
};

// In v1.18 the reference model feeds the yaw rate forward (cascade_model_forward_faults.cpp).
const Fault yaw_feed_forward_list[] = {
    {"cascade-yaw-ff-limited", "rate_limit", Stage::feed_forward,
     "limits the commanded yaw rate before it is added", "a yaw rate beyond the limit",
     "another limit",
     [](FaultyLaw& law) {
       auto max = std::make_shared<Scalar>(0.0f);
       change_gains(law.attitude_unit, [max](AttitudeUnitGains& gains, const CascadeParameters&) {
         *max = gains.attitude.rate_max_rad_s[2];
       });
       change_stage(law.attitude_unit.attitude.feed_forward,
                    [max](const auto& then, V rates, const Quat& q_WB, Scalar yaw_rate) {
                      const Scalar limited =
                          std::isfinite(yaw_rate) ? std::clamp(yaw_rate, -*max, *max) : yaw_rate;
                      return then(rates, q_WB, limited);
                    });
     }},
    {"cascade-yaw-ff-missing", "rate_limit", Stage::feed_forward,
     "does not add the commanded yaw rate", "a yaw rate", "a missing term",
     [](FaultyLaw& law) {
       change_yaw_feed_forward(law, [](const Quat&, Scalar) { return Vector(Vector::Zero()); });
     }},
    {"cascade-yaw-ff-on-body-z", "rate_limit", Stage::feed_forward,
     "adds the commanded yaw rate to the body's yaw rate only", "a yaw rate while tilted",
     "another frame",
     [](FaultyLaw& law) {
       change_yaw_feed_forward(law,
                               [](const Quat&, Scalar yaw_rate) { return Vector(0, 0, yaw_rate); });
     }},
    {"cascade-yaw-ff-transposed", "rate_limit", Stage::feed_forward,
     "takes the body's z axis in the world instead of the world's in the body",
     "a yaw rate while tilted", "transposed rotation",
     [](FaultyLaw& law) {
       change_yaw_feed_forward(law, [](const Quat& q_WB, Scalar yaw_rate) {
         return Vector(cascade::z_axis(q_WB) * yaw_rate);
       });
     }},
    {"cascade-yaw-ff-reversed", "rate_limit", Stage::feed_forward,
     "adds the commanded yaw rate with the other sign", "a yaw rate", "a sign",
     [](FaultyLaw& law) {
       change_yaw_feed_forward(law, [](const Quat& q_WB, Scalar yaw_rate) {
         return Vector(cascade::z_axis(cascade::inverse(q_WB)) * -yaw_rate);
       });
     }},
    {"cascade-yaw-ff-at-setpoint", "rate_limit", Stage::feed_forward,
     "turns about the z axis as seen from the desired attitude", "a yaw rate and a tilt error",
     "another attitude",
     [](FaultyLaw& law) {
       auto q_WD = std::make_shared<Quat>(cascade::identity<Scalar>());
       change_stage(law.attitude_unit.attitude.error,
                    [q_WD](const auto& then, const Quat& q_WB, const Quat& target) {
                      *q_WD = target;
                      return then(q_WB, target);
                    });
       change_yaw_feed_forward(law, [q_WD](const Quat&, Scalar yaw_rate) {
         return Vector(cascade::z_axis(cascade::inverse(*q_WD)) * yaw_rate);
       });
     }},
    {"cascade-yaw-ff-in-degrees", "rate_limit", Stage::feed_forward,
     "takes the commanded yaw rate in deg/s", "a yaw rate", "degrees",
     [](FaultyLaw& law) {
       change_yaw_feed_forward(law, [](const Quat& q_WB, Scalar yaw_rate) {
         return Vector(cascade::z_axis(cascade::inverse(q_WB)) * cascade::radians(yaw_rate));
       });
     }},
    {"cascade-yaw-ff-of-nan", "rate_limit", Stage::feed_forward,
     "adds a commanded yaw rate that is not finite", "a yaw rate of NaN", "a missing guard",
     [](FaultyLaw& law) {
       law.attitude_unit.attitude.feed_forward = [](const Vector& rates, const Quat& q_WB,
                                                    Scalar yaw_rate) {
         return Vector(rates + cascade::z_axis(cascade::inverse(q_WB)) * yaw_rate);
       };
     }},
    {"cascade-yaw-ff-of-infinity", "rate_limit", Stage::feed_forward,
     "adds an infinite yaw rate: it tests for NaN only", "an infinite yaw rate",
     "isnan for isfinite",
     [](FaultyLaw& law) {
       law.attitude_unit.attitude.feed_forward = [](const Vector& rates, const Quat& q_WB,
                                                    Scalar yaw_rate) {
         if (std::isnan(yaw_rate)) return rates;
         return Vector(rates + cascade::z_axis(cascade::inverse(q_WB)) * yaw_rate);
       };
     }},
};

}  // namespace

std::span<const Fault> yaw_weight_faults() { return yaw_weight_list; }
std::span<const Fault> yaw_feed_forward_faults() { return yaw_feed_forward_list; }

}  // namespace attest::faults::in_cascade
