// Mistakes in the weather-vane, which lets the wind turn the nose.
#include "controller/faults/groups.hpp"

namespace attest::faults {
namespace {

using Setpoint = decltype(Topics::attitude_setpoint);

template <typename Flag>
void change_weathervane(FaultyLaw& law, Flag flag) {
  law.step.is_weathervaning = flag;
}

// Applies the weather-vane's limit without its reset of the integral.
void limit_without_reset(FaultyLaw& law) {
  auto vaning = std::make_shared<bool>(false);
  change_stage(law.step.is_weathervaning,
               [vaning](const auto& then, bool autonomous, const Setpoint& setpoint) {
                 *vaning = then(autonomous, setpoint);
                 return false;
               });
  change_stage(law.attitude.yaw_feed_forward, [vaning](const auto& then, float yaw, float rate,
                                                       float w, const AttitudeGains& gains) {
    const float fed = then(yaw, rate, w, gains);
    return *vaning ? AttitudeStages::Law::weathervane_limit(fed, gains) : fed;
  });
}

void limit_to(FaultyLaw& law, float (*bound)(const AttitudeGains&)) {
  law.attitude.weathervane_limit = [bound](float yaw, const AttitudeGains& gains) {
    return mc_att_control::clamp(yaw, -bound(gains), bound(gains));
  };
}

const Fault weathervane_list[] = {
    {"vane-missing", "weathervane", Stage::weathervane, "has no weather-vane",
     "weather-vaning with a yaw error", "missing weather-vane",
     [](FaultyLaw& law) { change_weathervane(law, [](bool, const Setpoint&) { return false; }); }},
    {"vane-no-limit", "weathervane", Stage::weathervane, "does not limit yaw",
     "weather-vaning with a yaw error", "missing clamp",
     [](FaultyLaw& law) {
       law.attitude.weathervane_limit = [](float yaw, const AttitudeGains&) { return yaw; };
     }},
    {"vane-limit-converted-twice", "weathervane", Stage::weathervane,
     "converts the limit of yaw from degrees although it is in rad/s", "weather-vaning",
     "wrong unit",
     [](FaultyLaw& law) {
       limit_to(law, [](const AttitudeGains& gains) {
         return mc_att_control::radians(gains.auto_rate_max_rad_s[2] * gains.weathervane_scale);
       });
     }},
    {"vane-no-reset", "weathervane", Stage::weathervane, "keeps the yaw integral",
     "weather-vaning after yaw was integrated", "a missing reset", limit_without_reset},
    {"vane-despite-pilot", "weathervane", Stage::weathervane, "weather-vanes under a pilot",
     "the flag under a pilot", "a condition dropped",
     [](FaultyLaw& law) {
       change_weathervane(law, [](bool, const Setpoint& setpoint) {
         return setpoint.disable_mc_yaw_control != 0;
       });
     }},
    {"vane-without-flag", "weathervane", Stage::weathervane, "weather-vanes on every mission",
     "a mission without the flag", "a condition dropped",
     [](FaultyLaw& law) {
       change_weathervane(law, [](bool autonomous, const Setpoint&) { return autonomous; });
     }},
    {"vane-flag-is-1", "weathervane", Stage::weathervane, "treats only 1 as true",
     "a true flag with a value other than 1", "flag comparison",
     [](FaultyLaw& law) {
       change_weathervane(law, [](bool autonomous, const Setpoint& setpoint) {
         return autonomous && setpoint.disable_mc_yaw_control == 1;
       });
     }},
    {"vane-latched", "weathervane", Stage::weathervane, "stays active after the flag is cleared",
     "the flag set and cleared", "a latch",
     [](FaultyLaw& law) {
       law.step.is_weathervaning = [latched = false](bool autonomous,
                                                     const Setpoint& setpoint) mutable {
         latched = latched || setpoint.disable_mc_yaw_control != 0;
         return autonomous && latched;
       };
     }},
    {"vane-unscaled", "weathervane", Stage::weathervane, "does not scale the limit",
     "weather-vaning with a yaw error", "a missing factor",
     [](FaultyLaw& law) {
       limit_to(law, [](const AttitudeGains& gains) { return gains.auto_rate_max_rad_s[2]; });
     }},
    {"vane-scales-pilot-limit", "weathervane", Stage::weathervane, "scales the pilot's limit",
     "weather-vaning with a yaw error", "wrong branch",
     [](FaultyLaw& law) {
       limit_to(law, [](const AttitudeGains& gains) {
         return gains.rate_max_rad_s[2] * gains.weathervane_scale;
       });
     }},
    {"vane-stops-yaw", "weathervane", Stage::weathervane, "sets the yaw rate to 0",
     "weather-vaning with a yaw error", "wrong clamp",
     [](FaultyLaw& law) {
       law.attitude.weathervane_limit = [](float, const AttitudeGains&) { return 0.0f; };
     }},
    {"vane-before-ff", "weathervane", Stage::weathervane, "limits before the feed-forward only",
     "weather-vaning with a commanded yaw rate", "misplaced clamp",
     [](FaultyLaw& law) {
       auto vaning = std::make_shared<bool>(false);
       change_stage(law.step.is_weathervaning,
                    [vaning](const auto& then, bool autonomous, const Setpoint& setpoint) {
                      return *vaning = then(autonomous, setpoint);
                    });
       law.attitude.weathervane_limit = [](float yaw, const AttitudeGains&) { return yaw; };
       change_stage(law.attitude.yaw_feed_forward, [vaning](const auto& then, float yaw, float rate,
                                                            float w, const AttitudeGains& gains) {
         const float limited = *vaning ? AttitudeStages::Law::weathervane_limit(yaw, gains) : yaw;
         return then(limited, rate, w, gains);
       });
     }},
    {"vane-resets-all", "weathervane", Stage::weathervane, "resets all integrals",
     "weather-vaning after roll was integrated", "wrong axis",
     [](FaultyLaw& law) {
       auto vaning = std::make_shared<bool>(false);
       change_stage(law.step.is_weathervaning,
                    [vaning](const auto& then, bool autonomous, const Setpoint& setpoint) {
                      return *vaning = then(autonomous, setpoint);
                    });
       change_stage(law.rate.integrate_axis,
                    [vaning](const auto& then, float integral, float control, float thrust,
                             float growth, bool frozen) {
                      const float kept = *vaning ? 0.0f : integral;
                      return then(kept, control, thrust, growth, frozen);
                    });
     }},
    {"vane-freezes-yaw", "weathervane", Stage::weathervane,
     "holds the yaw integral at 0 within the step", "weather-vaning with a yaw rate error",
     "order of stages",
     [](FaultyLaw& law) {
       auto vaning = std::make_shared<bool>(false);
       change_stage(law.step.is_weathervaning,
                    [vaning](const auto& then, bool autonomous, const Setpoint& setpoint) {
                      return *vaning = then(autonomous, setpoint);
                    });
       change_stage(law.rate.growth, [vaning](const auto& then, const Vector& error, float dt,
                                              const RateGains& gains) {
         Vector growth = then(error, dt, gains);
         if (*vaning) growth[2] = 0;
         return growth;
       });
     }},
};

}  // namespace

std::span<const Fault> weathervane_faults() { return weathervane_list; }

}  // namespace attest::faults
