// Wrong limits of the rates setpoint, and wrong yaw feed-forwards after them.
#include <algorithm>
#include <cmath>

#include "controller/faults/groups.hpp"

namespace attest::faults {
namespace {

using Mode = decltype(Topics::mode);

// Limits the rates to another bound.
template <typename Bound>
void change_bound(FaultyLaw& law, Bound bound) {
  law.attitude.limit = [bound](const Vector& rates, bool autonomous, const AttitudeGains& gains) {
    return mc_att_control::clamp_each<float>(rates, bound(autonomous, gains));
  };
}

Vector bound_of(bool autonomous, const AttitudeGains& gains) {
  return autonomous ? gains.auto_rate_max_rad_s : gains.rate_max_rad_s;
}

template <typename Autonomous>
void change_autonomous(FaultyLaw& law, Autonomous autonomous) {
  law.step.is_autonomous = [autonomous](const Mode& mode, Profile) { return autonomous(mode); };
}

const Fault limit_faults[] = {
    {"limit-missing", "rate_limit", Stage::limit, "does not limit the rates setpoint",
     "a setpoint beyond the limit", "missing clamp",
     [](FaultyLaw& law) {
       law.attitude.limit = [](const Vector& rates, bool, const AttitudeGains&) { return rates; };
     }},
    {"limit-radial", "rate_limit", Stage::limit, "limits the length of the vector",
     "one axis at its limit", "wrong clamp",
     [](FaultyLaw& law) {
       law.attitude.limit = [](const Vector& rates, bool autonomous, const AttitudeGains& gains) {
         const Vector bound = bound_of(autonomous, gains);
         const float over = (rates.cwiseQuotient(bound)).norm();
         return over > 1 ? Vector(rates / over) : rates;
       };
     }},
    {"limit-scales-all", "rate_limit", Stage::limit, "scales all axes when one is too fast",
     "one axis at its limit", "wrong clamp",
     [](FaultyLaw& law) {
       law.attitude.limit = [](const Vector& rates, bool autonomous, const AttitudeGains& gains) {
         const float over =
             (rates.cwiseQuotient(bound_of(autonomous, gains))).cwiseAbs().maxCoeff();
         return over > 1 ? Vector(rates / over) : rates;
       };
     }},
    {"limit-upper-only", "rate_limit", Stage::limit, "limits positive rates only",
     "a negative rate beyond the limit", "missing clamp",
     [](FaultyLaw& law) {
       law.attitude.limit = [](const Vector& rates, bool autonomous, const AttitudeGains& gains) {
         return Vector(rates.cwiseMin(bound_of(autonomous, gains)));
       };
     }},
    {"limit-lower-only", "rate_limit", Stage::limit, "limits negative rates only",
     "a positive rate beyond the limit", "missing clamp",
     [](FaultyLaw& law) {
       law.attitude.limit = [](const Vector& rates, bool autonomous, const AttitudeGains& gains) {
         return Vector(rates.cwiseMax(-bound_of(autonomous, gains)));
       };
     }},
    {"limit-in-degrees", "rate_limit", Stage::limit, "leaves the limits in degrees",
     "a setpoint beyond the limit", "degrees",
     [](FaultyLaw& law) {
       change_bound(law, [](bool autonomous, const AttitudeGains& gains) {
         return Vector(bound_of(autonomous, gains) * (180 / pi));
       });
     }},
    {"limit-57.3", "rate_limit", Stage::limit, "uses 57.3 as 180 / pi",
     "a setpoint beyond a high limit", "degrees",
     [](FaultyLaw& law) {
       change_bound(law, [](bool autonomous, const AttitudeGains& gains) {
         return Vector(bound_of(autonomous, gains) * (180 / pi) / 57.3f);
       });
     }},
    {"limit-roll-for-all", "rate_limit", Stage::limit, "uses the roll limit for all axes",
     "limits that differ", "wrong axis",
     [](FaultyLaw& law) {
       change_bound(law, [](bool, const AttitudeGains& gains) {
         return Vector(Vector::Constant(gains.rate_max_rad_s[0]));
       });
     }},
    {"limit-not-yaw", "rate_limit", Stage::limit, "does not limit yaw", "a large yaw error",
     "missing clamp",
     [](FaultyLaw& law) {
       change_stage(law.attitude.limit, [](const auto& then, const Vector& rates, bool autonomous,
                                           const AttitudeGains& gains) {
         Vector limited = then(rates, autonomous, gains);
         limited[2] = rates[2];
         return limited;
       });
     }},
    {"limit-manual-always", "rate_limit", Stage::limit, "uses the pilot's limits in all modes",
     "a large yaw error on a mission", "wrong branch",
     [](FaultyLaw& law) {
       change_bound(law, [](bool, const AttitudeGains& gains) { return gains.rate_max_rad_s; });
     }},
    {"limit-auto-always", "rate_limit", Stage::limit, "uses the autonomous limits in all modes",
     "a large yaw error under a pilot", "wrong branch",
     [](FaultyLaw& law) {
       change_bound(law,
                    [](bool, const AttitudeGains& gains) { return gains.auto_rate_max_rad_s; });
     }},
    {"limit-exchanged", "rate_limit", Stage::limit, "exchanges the limits of roll and pitch",
     "limits that differ", "wrong axis",
     [](FaultyLaw& law) {
       change_bound(law, [](bool autonomous, const AttitudeGains& gains) {
         const Vector bound = bound_of(autonomous, gains);
         return Vector(bound[1], bound[0], bound[2]);
       });
     }},
    {"auto-by-velocity",
     "rate_limit",
     Stage::mode,
     "treats only velocity control as autonomous",
     "DESCEND, which has no velocity control",
     "a condition dropped",
     [](FaultyLaw& law) {
       change_autonomous(law, [](const Mode& mode) {
         return mode.flag_control_velocity_enabled != 0 && mode.flag_control_manual_enabled == 0;
       });
     },
     {},
     mc_att_control::from_v1_5_5},
    {"auto-by-auto", "rate_limit", Stage::mode, "treats only the auto flag as autonomous",
     "velocity control without the auto flag", "a condition dropped",
     [](FaultyLaw& law) {
       change_autonomous(law, [](const Mode& mode) {
         return mode.flag_control_auto_enabled != 0 && mode.flag_control_manual_enabled == 0;
       });
     }},
    {"auto-by-both", "rate_limit", Stage::mode, "requires both the velocity and the auto flag",
     "one of the two flags alone", "a condition changed",
     [](FaultyLaw& law) {
       change_autonomous(law, [](const Mode& mode) {
         return mode.flag_control_auto_enabled != 0 && mode.flag_control_velocity_enabled != 0 &&
                mode.flag_control_manual_enabled == 0;
       });
     }},
    {"auto-despite-pilot", "rate_limit", Stage::mode, "is autonomous despite the manual flag",
     "POSCTL: velocity control under a pilot", "a condition dropped",
     [](FaultyLaw& law) {
       change_autonomous(law, [](const Mode& mode) {
         return mode.flag_control_velocity_enabled != 0 || mode.flag_control_auto_enabled != 0;
       });
     }},
    {"auto-without-pilot", "rate_limit", Stage::mode, "is autonomous in every mode without a pilot",
     "OFFBOARD attitude", "a condition dropped",
     [](FaultyLaw& law) {
       change_autonomous(law,
                         [](const Mode& mode) { return mode.flag_control_manual_enabled == 0; });
     }},
};

// Replaces what the feed-forward adds to the yaw rate.
template <typename Addition>
void change_yaw_feed_forward(FaultyLaw& law, Addition addition) {
  law.attitude.yaw_feed_forward = [addition](float yaw, float move_rate, float weight,
                                             const AttitudeGains& gains) {
    return yaw + addition(move_rate, weight, gains.yaw_feed_forward);
  };
}

const Fault feed_forward_faults[] = {
    {"yaw-ff-missing", "yaw_feed_forward", Stage::feed_forward, "feeds no yaw rate forward",
     "a commanded yaw rate", "missing feed-forward",
     [](FaultyLaw& law) {
       change_yaw_feed_forward(law, [](float, float, float) { return 0.0f; });
     }},
    {"yaw-ff-reversed", "yaw_feed_forward", Stage::feed_forward,
     "has the feed-forward's sign wrong", "a commanded yaw rate", "a sign",
     [](FaultyLaw& law) {
       change_yaw_feed_forward(law, [](float rate, float w, float k) { return -rate * w * k; });
     }},
    {"yaw-ff-unweighted", "yaw_feed_forward", Stage::feed_forward,
     "does not weigh the feed-forward", "a commanded yaw rate with a tilted setpoint",
     "wrong weight",
     [](FaultyLaw& law) {
       change_yaw_feed_forward(law, [](float rate, float, float k) { return rate * k; });
     }},
    {"yaw-ff-weighted-twice", "yaw_feed_forward", Stage::feed_forward,
     "weighs the feed-forward twice", "a commanded yaw rate with a tilted setpoint", "wrong weight",
     [](FaultyLaw& law) {
       change_yaw_feed_forward(law, [](float rate, float w, float k) { return rate * w * w * k; });
     }},
    {"yaw-ff-whole", "yaw_feed_forward", Stage::feed_forward, "feeds the whole rate forward",
     "a commanded yaw rate", "a missing factor",
     [](FaultyLaw& law) {
       change_yaw_feed_forward(law, [](float rate, float w, float) { return rate * w; });
     }},
    {"yaw-ff-in-degrees", "yaw_feed_forward", Stage::feed_forward,
     "treats the commanded yaw rate as deg/s", "a commanded yaw rate", "degrees",
     [](FaultyLaw& law) {
       change_yaw_feed_forward(
           law, [](float rate, float w, float k) { return rate * w * k * pi / 180; });
     }},
    {"yaw-ff-instead", "yaw_feed_forward", Stage::feed_forward,
     "replaces the yaw rate by the feed-forward", "a yaw error and a commanded rate",
     "a missing term",
     [](FaultyLaw& law) {
       law.attitude.yaw_feed_forward = [](float yaw, float rate, float w,
                                          const AttitudeGains& gains) {
         return rate != 0 ? rate * w * gains.yaw_feed_forward : yaw;
       };
     }},
    {"yaw-ff-by-p", "yaw_feed_forward", Stage::feed_forward,
     "adds the commanded rate before the gain", "a commanded yaw rate", "order of stages",
     [](FaultyLaw& law) {
       law.attitude.yaw_feed_forward = [](float yaw, float rate, float w,
                                          const AttitudeGains& gains) {
         return yaw + rate * w * gains.yaw_feed_forward * gains.proportional_1_s[2];
       };
     }},
    {"yaw-ff-before-limit", "yaw_feed_forward", Stage::feed_forward,
     "limits yaw after the feed-forward", "a yaw rate at its limit and a commanded rate",
     "misplaced clamp",
     [](FaultyLaw& law) {
       auto bound = std::make_shared<float>(0.0f);
       change_stage(law.attitude.limit, [bound](const auto& then, const Vector& rates,
                                                bool autonomous, const AttitudeGains& gains) {
         *bound = bound_of(autonomous, gains)[2];
         Vector limited = then(rates, autonomous, gains);
         limited[2] = rates[2];
         return limited;
       });
       change_stage(law.attitude.yaw_feed_forward, [bound](const auto& then, float yaw, float rate,
                                                           float w, const AttitudeGains& gains) {
         const float fed = then(yaw, rate, w, gains);
         return mc_att_control::clamp(fed, -*bound, *bound);
       });
     }},
    {"yaw-ff-limited-again", "yaw_feed_forward", Stage::feed_forward,
     "limits yaw once more after the feed-forward", "a yaw rate near its limit", "misplaced clamp",
     [](FaultyLaw& law) {
       auto bound = std::make_shared<float>(0.0f);
       change_stage(law.attitude.limit, [bound](const auto& then, const Vector& rates,
                                                bool autonomous, const AttitudeGains& gains) {
         *bound = bound_of(autonomous, gains)[2];
         return then(rates, autonomous, gains);
       });
       change_stage(law.attitude.yaw_feed_forward, [bound](const auto& then, float yaw, float rate,
                                                           float w, const AttitudeGains& gains) {
         const float fed = then(yaw, rate, w, gains);
         return std::clamp(fed, -*bound, *bound);
       });
     }},
    {"yaw-ff-pilot-only", "yaw_feed_forward", Stage::feed_forward,
     "feeds forward under a pilot only", "a commanded yaw rate on a mission", "wrong branch",
     [](FaultyLaw& law) {
       auto autonomous_now = std::make_shared<bool>(false);
       change_stage(law.attitude.limit,
                    [autonomous_now](const auto& then, const Vector& rates, bool autonomous,
                                     const AttitudeGains& gains) {
                      *autonomous_now = autonomous;
                      return then(rates, autonomous, gains);
                    });
       change_stage(law.attitude.yaw_feed_forward,
                    [autonomous_now](const auto& then, float yaw, float rate, float w,
                                     const AttitudeGains& gains) {
                      return *autonomous_now ? yaw : then(yaw, rate, w, gains);
                    });
     }},
};

}  // namespace

std::span<const Fault> rate_limit_faults() { return limit_faults; }
std::span<const Fault> yaw_feed_forward_faults() { return feed_forward_faults; }

}  // namespace attest::faults
