// Wrong outputs: battery scaling and the actuator topic.
#include <algorithm>
#include <cmath>
#include <utility>

#include "controller/faults/groups.hpp"

namespace attest::faults {
namespace {

using Controls = float[8];

template <typename Change>
void change_controls(FaultyLaw& law, Change change) {
  also_after(law, [change](const attest_inputs& in, attest_outputs& out) mutable {
    if (out.actuator_controls_0.published != 0) change(out.actuator_controls_0.control, in);
  });
}

// The law itself scales by 1. `apply` then changes the published controls, given the battery's
// factor.
template <typename Apply>
void scale_otherwise(FaultyLaw& law, Apply apply) {
  auto factor = std::make_shared<float>(1.0f);
  change_stage(law.step.battery_factor, [factor](const auto& then, const Topics& topics,
                                                 const Gains& gains, Profile profile) {
    *factor = then(topics, gains, profile);
    return 1.0f;
  });
  change_controls(
      law, [factor, apply](Controls& control, const attest_inputs&) { apply(control, *factor); });
}

template <typename Factor>
void change_factor(FaultyLaw& law, Factor factor) {
  law.step.battery_factor = [factor](const Topics& topics, const Gains& gains, Profile) {
    return factor(topics.battery_scale, gains.battery_scaling);
  };
}

const Fault battery[] = {
    {"battery-never", "battery", Stage::scaling, "never scales", "scaling switched on",
     "a missing step",
     [](FaultyLaw& law) { change_factor(law, [](float, bool) { return 1.0f; }); }},
    {"battery-always",
     "battery",
     Stage::scaling,
     "scales while scaling is off",
     "a scale with scaling off",
     "a condition dropped",
     [](FaultyLaw& law) {
       change_factor(law, [](float scale, bool) { return scale > 0 ? scale : 1.0f; });
     },
     {},
     mc_att_control::all_profiles},
    {"battery-unguarded", "battery", Stage::scaling, "scales by zero and by negative factors",
     "a scale of 0", "a condition dropped",
     [](FaultyLaw& law) {
       change_factor(law, [](float scale, bool on) { return on ? scale : 1.0f; });
     }},
    {"battery-divides", "battery", Stage::scaling, "divides by the scale", "a scale other than 1",
     "a wrong factor",
     [](FaultyLaw& law) {
       change_factor(law, [](float scale, bool on) { return on && scale > 0 ? 1 / scale : 1.0f; });
     }},
    {"battery-not-below-1", "battery", Stage::scaling, "ignores scales below 1", "a scale of 0.9",
     "wrong branch threshold",
     [](FaultyLaw& law) {
       change_factor(law, [](float scale, bool on) { return on && scale > 1 ? scale : 1.0f; });
     }},
    {"battery-finite-only", "battery", Stage::scaling, "ignores an infinite scale",
     "an infinite scale", "a helpful extra",
     [](FaultyLaw& law) {
       change_factor(law, [](float scale, bool on) {
         return on && scale > 0 && std::isfinite(scale) ? scale : 1.0f;
       });
     }},
    {"battery-not-thrust", "battery", Stage::scaling, "does not scale thrust",
     "a scale other than 1", "wrong axis",
     [](FaultyLaw& law) {
       scale_otherwise(law, [](Controls& control, float factor) {
         for (int i = 0; i < 3; ++i) control[i] *= factor;
       });
     }},
    {"battery-thrust-only", "battery", Stage::scaling, "scales thrust only", "a scale other than 1",
     "wrong axis",
     [](FaultyLaw& law) {
       scale_otherwise(law, [](Controls& control, float factor) { control[3] *= factor; });
     }},
    {"battery-all-8", "battery", Stage::scaling, "scales the landing gear too",
     "a landing gear and a scale", "wrong axis",
     [](FaultyLaw& law) {
       scale_otherwise(law, [](Controls& control, float factor) {
         for (float& c : control) c *= factor;
       });
     }},
    {"battery-clamped",
     "battery",
     Stage::scaling,
     "clamps to 1 after scaling",
     "controls beyond 1 after scaling",
     "misplaced clamp",
     [](FaultyLaw& law) {
       scale_otherwise(law, [](Controls& control, float factor) {
         for (int i = 0; i < 4; ++i)
           control[i] = mc_att_control::clamp(control[i] * factor, -1.0f, 1.0f);
       });
     },
     {},
     mc_att_control::all_profiles},
    {"battery-before-guard", "battery", Stage::scaling, "scales before the check for finite values",
     "an infinite scale", "order of stages",
     [](FaultyLaw& law) {
       scale_otherwise(law, [](Controls& control, float factor) {
         for (int i = 0; i < 4; ++i) {
           const float scaled = control[i] * factor;
           control[i] = std::isfinite(scaled) ? scaled : 0;
         }
       });
     }},
    {"battery-seen-by-gates", "battery", Stage::scaling,
     "gives the scaled controls to the integrator", "a scaled control near a gate", "scaling order",
     [](FaultyLaw& law) {
       auto factor = std::make_shared<float>(1.0f);
       change_stage(law.step.battery_factor,
                    [factor](const auto& then, const Topics& topics, const Gains& gains,
                             Profile profile) { return *factor = then(topics, gains, profile); });
       change_stage(law.rate.integrate_axis,
                    [factor](const auto& then, float integral, float control, float thrust,
                             float growth, bool frozen) {
                      return then(integral, control * *factor, thrust, growth, frozen);
                    });
     }},
    {"battery-first-scale", "battery", Stage::scaling, "keeps the first scale that it receives",
     "a scale that changes", "a latch",
     [](FaultyLaw& law) {
       change_stage(law.step.battery_factor,
                    [kept = 0.0f](const auto& then, const Topics& topics, const Gains& gains,
                                  Profile profile) mutable {
                      if (kept == 0 && topics.battery_scale > 0) kept = topics.battery_scale;
                      Topics held = topics;
                      held.battery_scale = kept;
                      return then(held, gains, profile);
                    });
     }},
};

const Fault actuators[] = {
    {"gear-missing",
     "actuators",
     Stage::output,
     "does not output the landing gear",
     "a landing gear",
     "a missing step",
     [](FaultyLaw& law) {
       change_controls(law, [](Controls& control, const attest_inputs&) { control[7] = 0; });
     },
     {},
     mc_att_control::from_v1_5_5},
    {"gear-only-armed",
     "robustness",
     Stage::output,
     "outputs the landing gear only while armed",
     "a landing gear while disarmed",
     "a helpful extra",
     [](FaultyLaw& law) {
       change_controls(law, [armed = false](Controls& control, const attest_inputs& in) mutable {
         const bool is_new = (in.updated & ATTEST_UPDATED_ACTUATOR_ARMED) != 0;
         armed = is_new ? in.actuator_armed.armed != 0 : armed;
         if (!armed) control[7] = 0;
       });
     },
     {},
     mc_att_control::from_v1_5_5},
    {"gear-on-4",
     "actuators",
     Stage::output,
     "puts the landing gear on control 4",
     "a landing gear",
     "wrong index",
     [](FaultyLaw& law) {
       change_controls(
           law, [](Controls& control, const attest_inputs&) { std::swap(control[4], control[7]); });
     },
     {},
     mc_att_control::from_v1_5_5},
    {"gear-at-once", "actuators", Stage::output, "updates the landing gear in every mode",
     "a setpoint in acro", "a latch",
     [](FaultyLaw& law) {
       change_controls(law, [](Controls& control, const attest_inputs& in) {
         control[7] = in.vehicle_attitude_setpoint.landing_gear;
       });
     }},
    {"gear-clamped",
     "actuators",
     Stage::output,
     "clamps the landing gear to 0 .. 1",
     "a landing gear of -1",
     "misplaced clamp",
     [](FaultyLaw& law) {
       change_controls(law, [](Controls& control, const attest_inputs&) {
         control[7] = mc_att_control::clamp(control[7], 0.0f, 1.0f);
       });
     },
     {},
     mc_att_control::from_v1_5_5},
    {"breaker-ignored", "actuators", Stage::output, "has no circuit breaker", "CBRK_RATE_CTRL",
     "a missing step",
     [](FaultyLaw& law) {
       change_stage(law.step.gains, [](const auto& then, const Parameters& parameters) {
         Gains gains = then(parameters);
         gains.actuators_cut = false;
         return gains;
       });
     }},
    {"breaker-by-any-value", "actuators", Stage::output, "opens the breaker at any value except 0",
     "CBRK_RATE_CTRL of another value", "flag comparison",
     [](FaultyLaw& law) {
       change_stage(law.step.gains, [](const auto& then, const Parameters& parameters) {
         Gains gains = then(parameters);
         gains.actuators_cut = parameters.cbrk_rate_ctrl != 0;
         return gains;
       });
     }},
    {"breaker-stops-status", "actuators", Stage::output,
     "publishes no integrals where it publishes no actuators", "CBRK_RATE_CTRL",
     "a misplaced condition",
     [](FaultyLaw& law) {
       also_after(law,
                  [last = attest_outputs{}](const attest_inputs&, attest_outputs& out) mutable {
                    if (out.actuator_controls_0.published == 0) {
                      out.mc_att_ctrl_status = last.mc_att_ctrl_status;
                      out.mc_att_ctrl_status.published = 0;
                    }
                    last = out;
                  });
     }},
    {"thrust-negated", "actuators", Stage::output, "publishes thrust along z of FRD", "any thrust",
     "handedness",
     [](FaultyLaw& law) {
       change_controls(law,
                       [](Controls& control, const attest_inputs&) { control[3] = -control[3]; });
     }},
    {"thrust-limited", "actuators", Stage::output, "limits thrust to 0 .. 1", "a thrust beyond 1",
     "misplaced clamp",
     [](FaultyLaw& law) {
       change_controls(law, [](Controls& control, const attest_inputs&) {
         control[3] = mc_att_control::clamp(control[3], 0.0f, 1.0f);
       });
     }},
    {"controls-not-cleared", "actuators", Stage::output,
     "leaves arbitrary values in controls 4 to 6", "any step", "uninitialised memory",
     [](FaultyLaw& law) {
       change_controls(law, [](Controls& control, const attest_inputs&) {
         control[4] = control[0];
         control[6] = control[2];
       });
     }},
};

}  // namespace

std::span<const Fault> battery_faults() { return battery; }
std::span<const Fault> actuator_faults() { return actuators; }

}  // namespace attest::faults
