// Mistakes of the rate unit of the cascade in battery scaling and in the guards of its inputs and
// outputs.
#include <cmath>

#include "controller/faults/cascade_change.hpp"
#include "controller/faults/groups.hpp"

namespace attest::faults::in_cascade {
namespace {

using RateStepLaw = RateStepStages::Law;
using Battery = RateStepStages::Battery;

template <typename Scale>
void change_battery_scale(FaultyLaw& law, Scale scale) {
  change_stage(law.rate_unit.step.battery_scale, scale);
}

template <typename Scaled>
void change_scaled(FaultyLaw& law, Scaled scaled) {
  law.rate_unit.step.scaled = scaled;
}

// Scales only the torque if `torque` is true, otherwise only the thrust. The law calls scaled() for
// torque and thrust of an axis in turn, torque first.
void scale_half(FaultyLaw& law, bool torque) {
  change_scaled(law, [torque, is_torque = false](Scalar control, Scalar scale) mutable {
    is_torque = !is_torque;
    return is_torque == torque ? RateStepLaw::scaled(control, scale) : control;
  });
}

// Scales only in a step that takes a new sample.
void scale_with_sample(FaultyLaw& law) {
  auto is_new = std::make_shared<bool>(false);
  also_before(law.rate_unit, [is_new](RateIn&) { *is_new = false; });
  auto& step = law.rate_unit.step;
  change_stage(step.battery_scale, [is_new](const auto& then, Scalar, const Battery& sample) {
    *is_new = true;
    return then(0, sample);
  });
  change_stage(step.scaled, [is_new](const auto& then, Scalar control, Scalar scale) {
    return *is_new ? then(control, scale) : control;
  });
}

const Fault battery_list[] = {
    {"cascade-battery-missing", "battery", Stage::scaling, "does not scale by the battery",
     "MC_BAT_SCALE_EN 1", "a missing step",
     [](FaultyLaw& law) {
       change_gains(law.rate_unit, [](RateUnitGains& gains, const CascadeParameters&) {
         gains.battery_scaling = false;
       });
     }},
    {"cascade-battery-always", "battery", Stage::scaling,
     "scales by the battery also with MC_BAT_SCALE_EN 0", "MC_BAT_SCALE_EN 0",
     "a missing condition",
     [](FaultyLaw& law) {
       change_gains(law.rate_unit, [](RateUnitGains& gains, const CascadeParameters&) {
         gains.battery_scaling = true;
       });
     }},
    {"cascade-battery-divides", "battery", Stage::scaling, "divides by the scale",
     "MC_BAT_SCALE_EN 1", "an inverse factor",
     [](FaultyLaw& law) {
       change_scaled(law, [](Scalar control, Scalar scale) {
         return RateStepLaw::scaled(control, 1 / scale);
       });
     }},
    {"cascade-battery-unclamped", "battery", Stage::scaling, "does not clamp the scaled controls",
     "a large control", "a missing clamp",
     [](FaultyLaw& law) {
       change_scaled(law, [](Scalar control, Scalar scale) { return control * scale; });
     }},
    {"cascade-battery-clamped-from-0", "battery", Stage::scaling,
     "clamps the scaled controls to 0 .. 1", "a negative control", "a wrong clamp",
     [](FaultyLaw& law) {
       change_scaled(law, [](Scalar control, Scalar scale) {
         return cascade::clamp(control * scale, 0.0f, 1.0f);
       });
     }},
    {"cascade-battery-not-thrust", "battery", Stage::scaling, "does not scale the thrust",
     "MC_BAT_SCALE_EN 1", "a missing output", [](FaultyLaw& law) { scale_half(law, true); }},
    {"cascade-battery-not-torque", "battery", Stage::scaling, "does not scale the torque",
     "MC_BAT_SCALE_EN 1", "a missing output", [](FaultyLaw& law) { scale_half(law, false); }},
    {"cascade-battery-not-connected", "battery", Stage::scaling,
     "uses the scale of a battery that is not connected", "a battery that is not connected",
     "a missing condition",
     [](FaultyLaw& law) {
       change_battery_scale(law, [](const auto& then, Scalar before, Battery sample) {
         sample.connected = 1;
         return then(before, sample);
       });
     }},
    {"cascade-battery-forgotten", "battery", Stage::scaling,
     "does not scale after a battery is no longer connected", "a battery that is disconnected",
     "a missing latch",
     [](FaultyLaw& law) {
       change_battery_scale(
           law, [](const auto& then, Scalar, const Battery& sample) { return then(0, sample); });
     }},
    {"cascade-battery-with-sample-only", "battery", Stage::scaling,
     "scales only in a step with a new battery sample", "a step without a sample",
     "a missing latch", scale_with_sample},
    {"cascade-battery-scale-0", "battery", Stage::scaling, "uses a scale that is not positive",
     "a scale of 0 after another", "a missing condition",
     [](FaultyLaw& law) {
       change_battery_scale(law, [](const auto&, Scalar before, const Battery& sample) {
         return sample.connected != 0 ? sample.scale : before;
       });
     }},
    {"cascade-battery-first-scale", "battery", Stage::scaling,
     "keeps the first scale that it receives", "a scale that changes", "a latch",
     [](FaultyLaw& law) {
       change_battery_scale(law, [](const auto& then, Scalar before, const Battery& sample) {
         return before > 0 ? before : then(before, sample);
       });
     }},
    {"cascade-battery-not-below-1", "battery", Stage::scaling, "ignores scales below 1",
     "a scale of 0.9", "a helpful extra",
     [](FaultyLaw& law) {
       change_battery_scale(law, [](const auto& then, Scalar before, const Battery& sample) {
         return sample.scale < 1 ? before : then(before, sample);
       });
     }},
    {"cascade-battery-finite-only", "robustness", Stage::scaling, "ignores an infinite scale",
     "a scale of infinity", "a helpful extra",
     [](FaultyLaw& law) {
       change_battery_scale(law, [](const auto& then, Scalar before, const Battery& sample) {
         return std::isfinite(sample.scale) ? then(before, sample) : before;
       });
     }},
    {"cascade-battery-enable-is-1", "battery", Stage::parameters,
     "scales for MC_BAT_SCALE_EN of 1 only", "MC_BAT_SCALE_EN of 2", "flag comparison",
     [](FaultyLaw& law) {
       change_gains(law.rate_unit, [](RateUnitGains& gains, const CascadeParameters& p) {
         gains.battery_scaling = p.mc_bat_scale_en == 1;
       });
     }},
    {"cascade-battery-sample-lost", "battery", Stage::latching,
     "loses a battery sample that arrives while scaling is off", "MC_BAT_SCALE_EN set in flight",
     "a missing state",
     [](FaultyLaw& law) {
       change_stage(law.rate_unit.step.pending,
                    [](const auto& then, std::uint32_t before, std::uint32_t updated) {
                      constexpr std::uint32_t battery = ATTEST_RATE_UPDATED_BATTERY_STATUS;
                      return then(before & ~battery, updated);
                    });
     }},
    {"cascade-torque-not-guarded", "robustness", Stage::guard,
     "publishes a torque that is not finite", "one NaN of the gyro", "a missing guard",
     [](FaultyLaw& law) { law.rate_unit.step.guarded = [](Scalar torque) { return torque; }; }},
    {"cascade-torque-guard-nan-only", "robustness", Stage::guard, "publishes an infinite torque",
     "an infinite rate", "isnan for isfinite",
     [](FaultyLaw& law) {
       law.rate_unit.step.guarded = [](Scalar torque) { return std::isnan(torque) ? 0 : torque; };
     }},
    {"cascade-torque-held", "robustness", Stage::guard,
     "publishes the last torque in place of one that is not finite", "one NaN of the gyro",
     "another fallback",
     [](FaultyLaw& law) {
       law.rate_unit.step.guarded = [held = Vector(Vector::Zero()),
                                     axis = 2](Scalar torque) mutable {
         axis = (axis + 1) % 3;  // the law guards the axes in their order
         return held[axis] = std::isfinite(torque) ? torque : held[axis];
       };
     }},
    {"cascade-thrust-guarded", "robustness", Stage::guard,
     "publishes 0 for a thrust that is not finite", "a thrust of NaN", "a guard too many",
     [](FaultyLaw& law) {
       also_after(law.rate_unit, [](const RateIn&, RateOut& out) {
         for (float& thrust : out.vehicle_thrust_setpoint.xyz) {
           if (!std::isfinite(thrust)) thrust = 0;
         }
       });
     }},
    {"cascade-rate-nan-is-0", "robustness", Stage::input,
     "takes a rates setpoint that is not finite for 0, not for the measured rate",
     "a rates setpoint of NaN", "another fallback",
     [](FaultyLaw& law) {
       law.rate_unit.step.commanded = [](Scalar rate_sp, Scalar) {
         return std::isfinite(rate_sp) ? rate_sp : 0.0f;
       };
     }},
    {"cascade-rate-nan-not-checked", "robustness", Stage::input,
     "does not replace a rates setpoint that is not finite", "a rates setpoint of NaN",
     "a missing guard",
     [](FaultyLaw& law) {
       law.rate_unit.step.commanded = [](Scalar rate_sp, Scalar) { return rate_sp; };
     }},
    {"cascade-rate-infinite-kept", "robustness", Stage::input,
     "replaces a rates setpoint of NaN, but not an infinite one", "an infinite rates setpoint",
     "isnan for isfinite",
     [](FaultyLaw& law) {
       law.rate_unit.step.commanded = [](Scalar rate_sp, Scalar rate) {
         return std::isnan(rate_sp) ? rate : rate_sp;
       };
     }},
};

}  // namespace

std::span<const Fault> battery_faults() { return battery_list; }

}  // namespace attest::faults::in_cascade
