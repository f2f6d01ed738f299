// Mistakes of the rate unit of the cascade around its law: acro, modes, pending samples.
#include <cmath>

#include "controller/faults/cascade_change.hpp"
#include "controller/faults/groups.hpp"

namespace attest::faults::in_cascade {
namespace {

using RateStepLaw = RateStepStages::Law;
using AcroSticks = RateStepLaw::Sticks;
using AcroGains = cascade::AcroGains<Scalar>;
using AcroSetpoint = RateStepStages::Setpoint;

// Changes the sticks and gains of acro before use. Change is void(AcroSticks&, AcroGains&).
template <typename Change>
void change_acro_input(FaultyLaw& law, Change change) {
  change_stage(law.rate_unit.step.acro,
               [change](const auto& then, AcroSticks sticks, AcroGains gains) {
                 change(sticks, gains);
                 return then(sticks, gains);
               });
}

// Changes the setpoint that acro computes. Change is void(AcroSetpoint&, const AcroSticks&).
template <typename Change>
void change_acro(FaultyLaw& law, Change change) {
  change_stage(law.rate_unit.step.acro,
               [change](const auto& then, const AcroSticks& sticks, const AcroGains& gains) {
                 AcroSetpoint setpoint = then(sticks, gains);
                 change(setpoint, sticks);
                 return setpoint;
               });
}

template <typename Change>
void change_is_acro(FaultyLaw& law, Change change) {
  change_stage(law.rate_unit.step.is_acro, [change](const auto& then, cascade::RateTopics topics) {
    change(topics);
    return then(topics);
  });
}

// A sample of `topic` is lost if the step in which it arrives does not latch it.
template <std::uint32_t topic>
void lose_pending(FaultyLaw& law) {
  change_stage(law.rate_unit.step.pending,
               [](const auto& then, std::uint32_t before, std::uint32_t updated) {
                 return then(before & ~topic, updated);
               });
}

template <std::uint32_t topic>
void latch_rate_topic_always(FaultyLaw& law) {
  also_before(law.rate_unit, [](RateIn& in) { in.updated |= topic; });
}

// Scales the rates. Scale is Scalar(stick, superexpo), both within their limits.
template <typename Scale>
void scale_acro(FaultyLaw& law, Scale scale) {
  change_stage(law.rate_unit.step.acro,
               [scale](const auto& then, const AcroSticks& sticks, const AcroGains& gains) {
                 AcroSetpoint setpoint = then(sticks, gains);
                 const float stick[] = {sticks.roll, -sticks.pitch, sticks.yaw};
                 for (int i = 0; i < 3; ++i) {
                   setpoint.rates_B[i] *= scale(cascade::clamp(stick[i], -1.0f, 1.0f),
                                                cascade::clamp(gains.superexpo[i], 0.0f, 0.99f));
                 }
                 return setpoint;
               });
}

const Fault acro_list[] = {
    {"cascade-acro-expo-ignored", "acro", Stage::sticks, "does not read MC_ACRO_EXPO",
     "an expo and a stick at half", "a missing curve",
     [](FaultyLaw& law) {
       change_acro_input(law, [](AcroSticks&, AcroGains& gains) { gains.expo.setZero(); });
     }},
    {"cascade-acro-superexpo-ignored", "acro", Stage::sticks, "does not read MC_ACRO_SUPEXPO",
     "a superexpo and a stick at half", "a missing curve",
     [](FaultyLaw& law) {
       change_acro_input(law, [](AcroSticks&, AcroGains& gains) { gains.superexpo.setZero(); });
     }},
    {"cascade-acro-superexpo-not-scaled", "acro", Stage::sticks,
     "makes the ends of the stick faster than MC_ACRO_R_MAX instead of the centre slower",
     "a superexpo and a stick at half", "a missing scale",
     [](FaultyLaw& law) {
       scale_acro(law, [](Scalar, Scalar steeper) { return 1 / (1 - steeper); });
     }},
    {"cascade-acro-superexpo-signed", "acro", Stage::sticks,
     "has a superexpo that is flatter for negative sticks: no absolute value",
     "a superexpo and a stick at -0.5", "a sign",
     [](FaultyLaw& law) {
       scale_acro(law, [](Scalar stick, Scalar steeper) {
         return (1 - std::abs(stick) * steeper) / (1 - stick * steeper);
       });
     }},
    {"cascade-acro-expo-of-roll", "acro", Stage::sticks, "has the curve of roll for yaw, too",
     "curves that differ", "wrong axis",
     [](FaultyLaw& law) {
       change_acro_input(law, [](AcroSticks&, AcroGains& gains) {
         gains.expo[2] = gains.expo[0];
         gains.superexpo[2] = gains.superexpo[0];
       });
     }},
    {"cascade-acro-pitch-reversed", "acro", Stage::sticks, "pitches up with the stick forward",
     "the pitch stick", "a sign",
     [](FaultyLaw& law) {
       change_acro_input(law, [](AcroSticks& sticks, AcroGains&) { sticks.pitch = -sticks.pitch; });
     }},
    {"cascade-acro-roll-reversed", "acro", Stage::sticks, "rolls left with the stick right",
     "the roll stick", "a sign",
     [](FaultyLaw& law) {
       change_acro_input(law, [](AcroSticks& sticks, AcroGains&) { sticks.roll = -sticks.roll; });
     }},
    {"cascade-acro-sticks-exchanged", "acro", Stage::sticks,
     "exchanges the sticks of roll and pitch", "sticks that differ", "wrong axis",
     [](FaultyLaw& law) {
       change_acro_input(
           law, [](AcroSticks& sticks, AcroGains&) { std::swap(sticks.roll, sticks.pitch); });
     }},
    {"cascade-acro-yaw-reversed", "acro", Stage::sticks, "yaws left with the stick right",
     "the yaw stick", "a sign",
     [](FaultyLaw& law) {
       change_acro_input(law, [](AcroSticks& sticks, AcroGains&) { sticks.yaw = -sticks.yaw; });
     }},
    {"cascade-acro-in-degrees", "acro", Stage::sticks, "takes MC_ACRO_R_MAX as rad/s", "any stick",
     "degrees",
     [](FaultyLaw& law) {
       change_acro_input(
           law, [](AcroSticks&, AcroGains& gains) { gains.rate_max_rad_s /= 0.0174532924f; });
     }},
    {"cascade-acro-expo-without-x", "acro", Stage::sticks, "squares the stick instead of cubing it",
     "an expo and a stick at half", "another curve",
     [](FaultyLaw& law) {
       change_stage(law.rate_unit.step.acro,
                    [](const auto& then, const AcroSticks& sticks, const AcroGains& gains) {
                      AcroGains plain = gains;
                      plain.expo.setZero();
                      AcroSetpoint setpoint = then(sticks, plain);
                      const float stick[] = {sticks.roll, sticks.pitch, sticks.yaw};
                      for (int i = 0; i < 3; ++i) {
                        const float x = std::abs(cascade::clamp(stick[i], -1.0f, 1.0f));
                        const float share = cascade::clamp(gains.expo[i], 0.0f, 1.0f);
                        setpoint.rates_B[i] *= (1 - share) + share * x;
                      }
                      return setpoint;
                    });
     }},
    {"cascade-acro-thrust-from-0", "acro", Stage::throttle, "takes the throttle for 0 .. 1",
     "throttle 0", "another range",
     [](FaultyLaw& law) {
       change_acro(law, [](AcroSetpoint& setpoint, const AcroSticks& sticks) {
         setpoint.thrust_B[2] = -sticks.throttle;
       });
     }},
    {"cascade-acro-thrust-up", "acro", Stage::throttle, "makes a positive thrust", "any throttle",
     "a sign",
     [](FaultyLaw& law) {
       change_acro(law, [](AcroSetpoint& setpoint, const AcroSticks&) {
         setpoint.thrust_B[2] = -setpoint.thrust_B[2];
       });
     }},
    {"cascade-acro-thrust-clamped", "acro", Stage::throttle, "clamps the thrust",
     "a throttle beyond 1", "a helpful extra",
     [](FaultyLaw& law) {
       change_acro(law, [](AcroSetpoint& setpoint, const AcroSticks&) {
         setpoint.thrust_B[2] = cascade::clamp(setpoint.thrust_B[2], -1.0f, 0.0f);
       });
     }},
    {"cascade-acro-sticks-unclamped", "acro", Stage::sticks, "does not clamp the sticks",
     "a stick beyond 1", "a missing clamp",
     [](FaultyLaw& law) {
       change_acro(law, [](AcroSetpoint& setpoint, const AcroSticks& sticks) {
         const float stick[] = {sticks.roll, sticks.pitch, sticks.yaw};
         for (int i = 0; i < 3; ++i) {
           if (std::abs(stick[i]) > 1) setpoint.rates_B[i] *= std::abs(stick[i]);
         }
       });
     }},
    {"cascade-acro-with-attitude", "acro", Stage::mode,
     "takes the sticks as rates also while the attitude is controlled", "stabilized mode",
     "a missing condition",
     [](FaultyLaw& law) {
       change_is_acro(
           law, [](cascade::RateTopics& topics) { topics.mode.flag_control_attitude_enabled = 0; });
     }},
    {"cascade-acro-without-manual", "acro", Stage::mode,
     "takes the sticks as rates without the manual flag", "offboard rates", "a missing condition",
     [](FaultyLaw& law) {
       change_is_acro(
           law, [](cascade::RateTopics& topics) { topics.mode.flag_control_manual_enabled = 1; });
     }},
    {"cascade-acro-never", "acro", Stage::mode, "has no acro mode", "acro mode", "a missing mode",
     [](FaultyLaw& law) {
       law.rate_unit.step.is_acro = [](const cascade::RateTopics&) { return false; };
     }},
    {"cascade-acro-in-each-step", "acro", Stage::latching,
     "makes a setpoint of the sticks in each step, new or not", "acro without a new sample",
     "a latch", latch_rate_topic_always<ATTEST_RATE_UPDATED_MANUAL_CONTROL_SETPOINT>},
    {"cascade-acro-not-published", "acro", Stage::output,
     "does not publish the rates of the sticks", "acro mode", "a missing output",
     [](FaultyLaw& law) {
       also_after(law.rate_unit,
                  [](const RateIn&, RateOut& out) { out.vehicle_rates_setpoint.published = 0; });
     }},
    {"cascade-acro-sample-lost", "acro", Stage::latching,
     "loses a stick sample that arrives before acro mode", "a change to acro mode",
     "a missing state", lose_pending<ATTEST_RATE_UPDATED_MANUAL_CONTROL_SETPOINT>},
    {"cascade-acro-own-setpoint-waits", "acro", Stage::latching,
     "keeps a pending setpoint from outside rather than that of the sticks",
     "a setpoint from outside in acro mode", "another order",
     [](FaultyLaw& law) { law.rate_unit.step.supersedes_pending = [] { return false; }; }},
    {"cascade-rates-setpoint-lost", "acro", Stage::latching,
     "loses a rates setpoint that arrives in acro mode", "the end of acro mode", "a missing state",
     lose_pending<ATTEST_RATE_UPDATED_VEHICLE_RATES_SETPOINT>},
    {"cascade-saturation-sample-lost", "modes", Stage::latching,
     "loses a sample of control_allocator_status while rates are not controlled",
     "a change of mode", "a missing state",
     lose_pending<ATTEST_RATE_UPDATED_CONTROL_ALLOCATOR_STATUS>},
    {"cascade-rates-setpoint-always-latched", "modes", Stage::latching,
     "reads vehicle_rates_setpoint in each step, new or not", "a sample without its bit", "a latch",
     latch_rate_topic_always<ATTEST_RATE_UPDATED_VEHICLE_RATES_SETPOINT>},
    {"cascade-land-always-latched", "landed", Stage::latching,
     "reads vehicle_land_detected in each step, new or not", "a sample without its bit", "a latch",
     latch_rate_topic_always<ATTEST_RATE_UPDATED_VEHICLE_LAND_DETECTED>},
    {"cascade-rates-flag-ignored", "modes", Stage::mode, "publishes torque without the rates flag",
     "termination", "a missing condition",
     [](FaultyLaw& law) {
       also_before(law.rate_unit,
                   [](RateIn& in) { in.vehicle_control_mode.flag_control_rates_enabled = 1; });
     }},
    {"cascade-rates-flag-holds-torque", "modes", Stage::output,
     "publishes the last torque without the rates flag", "termination", "a missing condition",
     [](FaultyLaw& law) {
       also_after(law.rate_unit, [](const RateIn&, RateOut& out) {
         out.vehicle_torque_setpoint.published = out.vehicle_thrust_setpoint.published = 1;
       });
     }},
    {"cascade-rates-flag-gates-acro", "acro", Stage::mode,
     "does not publish the rates of acro without the rates flag", "acro without the rates flag",
     "a misplaced condition",
     [](FaultyLaw& law) {
       also_after(law.rate_unit, [](const RateIn&, RateOut& out) {
         if (out.vehicle_torque_setpoint.published == 0) out.vehicle_rates_setpoint.published = 0;
       });
     }},
    {"cascade-rate-silent-disarmed", "landed", Stage::arming, "publishes 0 while disarmed",
     "an error while disarmed", "a helpful extra",
     [](FaultyLaw& law) {
       auto armed = std::make_shared<bool>(false);
       change_stage(law.rate_unit.step.resets_integral,
                    [armed](const auto& then, const cascade::RateTopics& topics) {
                      *armed = topics.mode.flag_armed != 0;
                      return then(topics);
                    });
       also_after(law.rate_unit, [armed](const RateIn&, RateOut& out) {
         if (*armed) return;
         for (float& torque : out.vehicle_torque_setpoint.xyz) torque = 0;
       });
     }},
};

}  // namespace

std::span<const Fault> rate_mode_faults() { return acro_list; }

}  // namespace attest::faults::in_cascade
