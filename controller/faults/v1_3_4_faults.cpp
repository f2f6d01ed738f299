// Mistakes where v1.3.4 differs from v1.5.5: a port of the wrong version, or an inexact one. Some
// are mistakes in v1.5.5 too.
#include <memory>
#include <utility>

#include "controller/faults/groups.hpp"

namespace attest::faults {
namespace {

using mc_att_control::only_v1_3_4;
using V = const Vector&;

template <typename FeedForward>
void change_feed_forward(FaultyLaw& law, FeedForward feed_forward) {
  law.rate.feed_forward_change = [feed_forward](V sp, V prev, float dt, const RateGains& gains) {
    return Vector(gains.feed_forward.cwiseProduct(feed_forward(sp, prev, dt)));
  };
}

// Applies the weather-vane's clamp once: after the feed-forward if `after`, otherwise before it.
void clamp_once(FaultyLaw& law, bool after) {
  auto fed = std::make_shared<bool>(false);
  change_stage(law.attitude.limit,
               [fed](const auto& then, V rates_sp, bool autonomous, const AttitudeGains& gains) {
                 *fed = false;
                 return then(rates_sp, autonomous, gains);
               });
  change_stage(law.attitude.yaw_feed_forward, [fed](const auto& then, float yaw, float rate,
                                                    float weight, const AttitudeGains& gains) {
    *fed = true;
    return then(yaw, rate, weight, gains);
  });
  change_stage(law.attitude.weathervane_limit,
               [fed, after](const auto& then, float yaw, const AttitudeGains& gains) {
                 return *fed == after ? then(yaw, gains) : yaw;
               });
}

void freeze_yaw_by_its_flag(FaultyLaw& law) {
  struct Turn {
    bool yaw_limited = false;
    int axis = 0;
  };
  auto turn = std::make_shared<Turn>();
  change_stage(law.rate.may_integrate,
               [turn](const auto& then, float thrust_sp, const MotorLimits& limits) {
                 *turn = {limits.yaw, 0};
                 return then(thrust_sp, limits);
               });
  change_stage(law.rate.integrate_axis, [turn](const auto& then, float integral, float control,
                                               float thrust_sp, float growth, bool frozen) {
    const bool is_yaw = turn->axis++ == 2;
    return then(integral, control, thrust_sp, growth, frozen || (is_yaw && turn->yaw_limited));
  });
}

// Attenuates P by thrust, as v1.5.5 does with its defaults: a break at full thrust, a slope of 1.
void attenuate_by_thrust(FaultyLaw& law) {
  auto thrust = std::make_shared<float>(0.0f);
  also_before(law, [thrust](const attest_inputs& in) {
    const auto& mode = in.vehicle_control_mode;
    *thrust = in.vehicle_rates_setpoint.thrust;
    if (mode.flag_control_manual_enabled != 0) *thrust = in.manual_control_setpoint.z;
    if (mode.flag_control_attitude_enabled != 0) *thrust = in.vehicle_attitude_setpoint.thrust;
  });
  change_stage(law.rate.proportional, [thrust](const auto& then, V error, float, RateGains gains) {
    gains.tpa_break = gains.tpa_slope = 1;
    const float attenuation = RateStages::Law::throttle_attenuation(*thrust, gains);
    return then(error, attenuation, gains);
  });
}

void scale_by_battery(FaultyLaw& law) {
  also_after(law, [](const attest_inputs& in, attest_outputs& out) {
    const float scale = in.battery_status.scale;
    if (out.actuator_controls_0.published == 0 || !(scale > 0)) return;
    for (int i = 0; i < 4; ++i) out.actuator_controls_0.control[i] *= scale;
  });
}

const Fault v1_3_4_list[] = {
    {"v1.3.4-ff-of-setpoint",
     "rates",
     Stage::ff,
     "feeds the setpoint forward instead of its change",
     "a feed-forward gain",
     "another version",
     [](FaultyLaw& law) { change_feed_forward(law, [](V sp, V, float) { return sp; }); },
     {},
     only_v1_3_4},
    {"v1.3.4-ff-without-dt",
     "rates",
     Stage::ff,
     "does not divide the change by dt",
     "a feed-forward gain and a setpoint that changes",
     "a missing factor",
     [](FaultyLaw& law) {
       change_feed_forward(law, [](V sp, V prev, float) { return Vector(sp - prev); });
     },
     {},
     only_v1_3_4},
    {"v1.3.4-ff-backwards",
     "rates",
     Stage::ff,
     "feeds the change forward with the other sign",
     "a feed-forward gain and a setpoint that changes",
     "a sign",
     [](FaultyLaw& law) {
       change_feed_forward(law, [](V sp, V prev, float dt) { return Vector((prev - sp) / dt); });
     },
     {},
     only_v1_3_4},
    {"v1.3.4-ff-from-0",
     "rates",
     Stage::ff,
     "never stores the previous setpoint",
     "a feed-forward gain and a setpoint that stays",
     "a missing step",
     [](FaultyLaw& law) {
       change_feed_forward(law, [](V sp, V, float dt) { return Vector(sp / dt); });
     },
     {},
     only_v1_3_4},
    {"v1.3.4-ff-no-first-kick",
     "rates",
     Stage::ff,
     "has no feed-forward in the first step",
     "a feed-forward gain and a setpoint at the start",
     "a helpful extra",
     [](FaultyLaw& law) {
       change_stage(
           law.rate.feed_forward_change, [is_first = true](const auto& then, V sp, V prev, float dt,
                                                           const RateGains& gains) mutable {
             const Vector before = std::exchange(is_first, false) ? Vector(sp) : Vector(prev);
             return then(sp, before, dt, gains);
           });
     },
     {},
     only_v1_3_4},
    {"v1.3.4-yaw-flag-freezes",
     "anti_windup",
     Stage::gate,
     "freezes the yaw integral while yaw is limited",
     "the yaw limit alone",
     "another version",
     freeze_yaw_by_its_flag,
     {},
     only_v1_3_4},
    {"v1.3.4-vane-after-only",
     "weathervane",
     Stage::weathervane,
     "limits yaw only after the feed-forward",
     "weather-vaning against a commanded yaw rate",
     "another version",
     [](FaultyLaw& law) { clamp_once(law, true); },
     {},
     only_v1_3_4},
    {"vane-before-only", "weathervane", Stage::weathervane,
     "limits yaw only before the feed-forward", "weather-vaning with a commanded yaw rate",
     "a missing clamp", [](FaultyLaw& law) { clamp_once(law, false); }},
    {"v1.3.4-auto-by-flag",
     "rate_limit",
     Stage::limit,
     "treats every auto mode as autonomous, not only those with velocity control",
     "an auto mode without velocity control",
     "another version",
     [](FaultyLaw& law) {
       change_stage(law.step.is_autonomous,
                    [](const auto& then, const decltype(Topics::mode)& mode, Profile) {
                      return then(mode, Profile::px4_v1_5_5);
                    });
     },
     {},
     only_v1_3_4},
    {"gear-unlatched", "actuators", Stage::output, "outputs the landing gear",
     "a landing gear that is not 0", "another version",
     [](FaultyLaw& law) {
       also_after(law, [](const attest_inputs& in, attest_outputs& out) {
         out.actuator_controls_0.control[7] = in.vehicle_attitude_setpoint.landing_gear;
       });
     }},
    {"battery-always-scales", "battery", Stage::scaling, "scales the controls by the battery",
     "a battery scale", "another version", scale_by_battery},
    {"tpa-by-defaults", "tpa", Stage::tpa, "attenuates P by thrust", "thrust beyond 1",
     "another version", attenuate_by_thrust},
};

}  // namespace

std::span<const Fault> v1_3_4_faults() { return v1_3_4_list; }

}  // namespace attest::faults
