// Mistakes of both units of the cascade in what passes from one step to the next: samples that are
// used one step late or not kept, and integrals that a mode resets.
#include <cmath>
#include <utility>

#include "controller/faults/cascade_change.hpp"
#include "controller/faults/groups.hpp"

namespace attest::faults::in_cascade {
namespace {

// Publishes the outputs one step late.
template <typename Unit>
void delay_outputs(Unit& unit) {
  using Out = typename Unit::Outputs;
  also_after(unit, [before = Out{}](const typename Unit::Inputs&, Out& out) mutable {
    std::swap(before, out);
  });
}

// Uses the value of the step before; in the first step that of this step.
template <typename Value>
auto delayed() {
  return [before = std::optional<Value>{}](Value& value) mutable {
    const Value now = value;
    value = std::exchange(before, now).value_or(now);
  };
}

void delay_attitude(FaultyLaw& law) {
  also_before(law.attitude_unit,
              [delay = delayed<decltype(AttitudeIn::vehicle_attitude)>()](AttitudeIn& in) mutable {
                auto sample = in.vehicle_attitude;
                delay(sample);
                std::copy_n(sample.q, 4, in.vehicle_attitude.q);
              });
}

void delay_gyro(FaultyLaw& law) {
  also_before(law.rate_unit,
              [delay = delayed<decltype(RateIn::vehicle_angular_velocity)>()](RateIn& in) mutable {
                auto sample = in.vehicle_angular_velocity;
                delay(sample);
                std::copy_n(sample.xyz, 3, in.vehicle_angular_velocity.xyz);
              });
}

constexpr std::uint32_t new_rate_mode = ATTEST_RATE_UPDATED_VEHICLE_CONTROL_MODE;

// Resets the integral also after each sample of vehicle_control_mode for which `resets` is true.
// Resets is bool(mode, mode before).
template <typename Resets>
void reset_with_mode(FaultyLaw& law, Resets resets) {
  auto waits = std::make_shared<bool>(false);
  also_before(law.rate_unit, [waits, resets, before = decltype(RateIn::vehicle_control_mode){}](
                                 RateIn& in) mutable {
    if ((in.updated & new_rate_mode) == 0) return;
    if (resets(in.vehicle_control_mode, before)) *waits = true;
    before = in.vehicle_control_mode;
  });
  change_stage(law.rate_unit.step.resets_integral,
               [waits](const auto& then, const cascade::RateTopics& topics) {
                 return then(topics) || std::exchange(*waits, false);
               });
}

// Whether the newest vehicle_control_mode of the rate unit has flag_armed set.
std::shared_ptr<bool> watch_armed(FaultyLaw& law) {
  auto armed = std::make_shared<bool>(false);
  also_before(law.rate_unit, [armed](RateIn& in) {
    if ((in.updated & new_rate_mode) != 0) *armed = in.vehicle_control_mode.flag_armed != 0;
  });
  return armed;
}

constexpr const char* late = "one-tick delay";

const Fault step_list[] = {
    {"cascade-attitude-outputs-late", "attitude", Stage::output,
     "publishes the outputs of the attitude unit one step late", "any change", late,
     [](FaultyLaw& law) { delay_outputs(law.attitude_unit); }},
    {"cascade-rate-outputs-late", "rates", Stage::output,
     "publishes the outputs of the rate unit one step late", "any change", late,
     [](FaultyLaw& law) { delay_outputs(law.rate_unit); }},
    {"cascade-attitude-late", "attitude", Stage::input, "uses the attitude of the step before",
     "an attitude that changes", late, delay_attitude},
    {"cascade-gyro-late", "rates", Stage::input, "uses the gyro sample of the step before",
     "a rate that changes", late, delay_gyro},
    {"cascade-attitude-setpoint-late", "attitude", Stage::latching,
     "uses the attitude setpoint one step late", "a setpoint that changes", late,
     [](FaultyLaw& law) {
       delay<&AttitudeIn::vehicle_attitude_setpoint,
             ATTEST_ATTITUDE_UPDATED_VEHICLE_ATTITUDE_SETPOINT>(law.attitude_unit);
     }},
    {"cascade-attitude-mode-late", "modes", Stage::mode,
     "changes the mode of the attitude unit one step late", "a change of mode", late,
     [](FaultyLaw& law) {
       delay<&AttitudeIn::vehicle_control_mode, ATTEST_ATTITUDE_UPDATED_VEHICLE_CONTROL_MODE>(
           law.attitude_unit);
     }},
    {"cascade-rate-mode-late", "modes", Stage::mode,
     "changes the mode of the rate unit one step late", "a change of mode", late,
     [](FaultyLaw& law) { delay<&RateIn::vehicle_control_mode, new_rate_mode>(law.rate_unit); }},
    {"cascade-sticks-late", "sticks", Stage::sticks, "uses the sticks one step late",
     "sticks that move", late,
     [](FaultyLaw& law) {
       delay<&AttitudeIn::manual_control_setpoint, ATTEST_ATTITUDE_UPDATED_MANUAL_CONTROL_SETPOINT>(
           law.attitude_unit);
     }},
    {"cascade-acro-sticks-late", "acro", Stage::sticks, "uses the sticks of acro one step late",
     "sticks that move", late,
     [](FaultyLaw& law) {
       delay<&RateIn::manual_control_setpoint, ATTEST_RATE_UPDATED_MANUAL_CONTROL_SETPOINT>(
           law.rate_unit);
     }},
    {"cascade-saturation-late", "saturation", Stage::saturation,
     "uses control_allocator_status one step late", "a saturation that changes", late,
     [](FaultyLaw& law) {
       delay<&RateIn::control_allocator_status, ATTEST_RATE_UPDATED_CONTROL_ALLOCATOR_STATUS>(
           law.rate_unit);
     }},
    {"cascade-saturation-armed-only", "saturation", Stage::latching,
     "drops samples of control_allocator_status while disarmed", "a saturation before arming",
     "a helpful extra",
     [](FaultyLaw& law) {
       also_before(law.rate_unit, [armed = watch_armed(law)](RateIn& in) {
         if (!*armed) in.updated &= ~std::uint32_t{ATTEST_RATE_UPDATED_CONTROL_ALLOCATOR_STATUS};
       });
     }},
    {"cascade-rates-setpoint-not-kept", "rates", Stage::latching,
     "uses a rates setpoint only in the step in which it arrives", "a step without a setpoint",
     "a missing latch",
     [](FaultyLaw& law) {
       also_before(law.rate_unit, [](RateIn& in) {
         if ((in.updated & ATTEST_RATE_UPDATED_VEHICLE_RATES_SETPOINT) != 0) return;
         in.updated |= ATTEST_RATE_UPDATED_VEHICLE_RATES_SETPOINT;
         in.vehicle_rates_setpoint = {};
       });
     }},
    {"cascade-rates-flag-resets", "modes", Stage::i,
     "resets the integral where rates are not controlled", "termination with an integral",
     "a reset too many",
     [](FaultyLaw& law) {
       reset_with_mode(
           law, [](const auto& mode, const auto&) { return mode.flag_control_rates_enabled == 0; });
     }},
    {"cascade-mode-resets", "modes", Stage::i, "resets the integral when the mode changes",
     "a change of mode with an integral", "a reset too many",
     [](FaultyLaw& law) {
       reset_with_mode(law, [](const auto& mode, const auto& before) {
         return mode.flag_control_manual_enabled != before.flag_control_manual_enabled ||
                mode.flag_control_attitude_enabled != before.flag_control_attitude_enabled;
       });
     }},
    {"cascade-rates-flag-zeroes", "modes", Stage::output,
     "publishes a torque and a thrust of 0 where rates are not controlled", "termination",
     "a helpful extra",
     [](FaultyLaw& law) {
       also_after(law.rate_unit, [](const RateIn&, RateOut& out) {
         if (out.vehicle_torque_setpoint.published != 0) return;
         out.vehicle_torque_setpoint = {{0, 0, 0}, 1};
         out.vehicle_thrust_setpoint = {{0, 0, 0}, 1};
       });
     }},
    {"cascade-integral-reset-needs-both", "landed", Stage::arming,
     "resets the integral only of a fixed wing that is disarmed", "one of both", "and for or",
     [](FaultyLaw& law) {
       law.rate_unit.step.resets_integral = [](const cascade::RateTopics& topics) {
         return topics.mode.flag_armed == 0 && !topics.is_rotary_wing;
       };
     }},
    {"cascade-arming-resets", "landed", Stage::arming,
     "resets the integral at arming, not while disarmed", "an error while disarmed",
     "an edge for a level",
     [](FaultyLaw& law) {
       law.rate_unit.step.resets_integral = [was =
                                                 false](const cascade::RateTopics& topics) mutable {
         const bool armed = topics.mode.flag_armed != 0;
         const bool is_arming = armed && !std::exchange(was, armed);
         was = armed;
         return is_arming || !topics.is_rotary_wing;
       };
     }},
    {"cascade-rate-unpublished-disarmed", "landed", Stage::arming,
     "publishes no torque while disarmed", "a vehicle that is not armed", "a helpful extra",
     [](FaultyLaw& law) {
       also_after(law.rate_unit, [armed = watch_armed(law)](const RateIn&, RateOut& out) {
         if (!*armed) out.vehicle_torque_setpoint.published = 0;
       });
     }},
    {"cascade-nan-stops-the-step", "robustness", Stage::guard,
     "publishes nothing for an attitude that is not finite", "an attitude of NaN",
     "a helpful extra",
     [](FaultyLaw& law) {
       also_after(law.attitude_unit, [](const AttitudeIn& in, AttitudeOut& out) {
         const auto& q = in.vehicle_attitude.q;
         if (std::isfinite(q[0] + q[1] + q[2] + q[3])) return;
         out.vehicle_rates_setpoint.published = out.vehicle_attitude_setpoint.published = 0;
       });
     }},
};

}  // namespace

std::span<const Fault> step_faults() { return step_list; }

}  // namespace attest::faults::in_cascade
