// Wrong integrators: gates that are dropped, moved or made non-strict, and wrong motor limit flags.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "controller/faults/groups.hpp"

namespace attest::faults {
namespace {

using mc_att_control::integral_limit;
using mc_att_control::takeoff_thrust;

// One axis of the integrator, with each gate of the law as a separate function.
struct Gates {
  bool (*by_thrust)(float control, float thrust) = [](float control, float thrust) {
    return std::abs(control) < thrust;
  };
  bool (*by_integral)(float next) = [](float next) {
    return next > -integral_limit && next < integral_limit;
  };
  bool (*by_control)(float control) = [](float control) {
    return control > -integral_limit && control < integral_limit;
  };
  bool obeys_yaw_flag = true;
};

void use_gates(FaultyLaw& law, const Gates& gates) {
  law.rate.integrate_axis = [gates](float integral, float control, float thrust, float growth,
                                    bool frozen) {
    const float next = integral + growth;
    const bool open = gates.by_thrust(control, thrust) && gates.by_integral(next) &&
                      gates.by_control(control) && !(frozen && gates.obeys_yaw_flag);
    return open ? next : integral;
  };
}

// Changes what the first gate sees. Change is void(float& thrust, MotorLimits&).
template <typename Change>
void change_gate(FaultyLaw& law, Change change) {
  change_stage(law.rate.may_integrate,
               [change](const auto& then, float thrust, MotorLimits limits) {
                 change(thrust, limits);
                 return then(thrust, limits);
               });
}

// The first gate is open at a thrust at which `open` is true.
void open_gate(FaultyLaw& law, bool (*open)(float thrust)) {
  change_gate(law, [open](float& thrust, MotorLimits&) {
    if (open(thrust)) thrust = 1;
  });
}

using Flags = decltype(attest_inputs::multirotor_motor_limits);

template <typename Change>
void change_flags(FaultyLaw& law, Change change) {
  also_before(law, [change](attest_inputs& in) mutable { change(in.multirotor_motor_limits, in); });
}

void reset_below_takeoff(FaultyLaw& law) {
  auto below = std::make_shared<bool>(false);
  change_stage(law.rate.may_integrate, [below](const auto& then, float thrust, MotorLimits limits) {
    *below = !(thrust > takeoff_thrust);
    return *below || then(thrust, limits);
  });
  change_stage(law.rate.integrate_axis, [below](const auto& then, float integral, float control,
                                                float thrust, float growth, bool frozen) {
    return *below ? 0.0f : then(integral, control, thrust, growth, frozen);
  });
}

const Fault anti_windup_list[] = {
    {"gate-takeoff-dropped", "anti_windup", Stage::gate, "integrates at any thrust",
     "thrust below 0.2", "a condition dropped",
     [](FaultyLaw& law) { open_gate(law, [](float) { return true; }); }},
    {"gate-takeoff-at-0", "anti_windup", Stage::gate, "integrates above zero thrust",
     "thrust between 0 and 0.2", "wrong branch threshold",
     [](FaultyLaw& law) { open_gate(law, [](float thrust) { return thrust > 0; }); }},
    {"gate-takeoff-at-0.1", "anti_windup", Stage::gate, "integrates from a thrust of 0.1",
     "thrust between 0.1 and 0.2", "wrong branch threshold",
     [](FaultyLaw& law) { open_gate(law, [](float thrust) { return thrust > 0.1f; }); }},
    {"gate-takeoff-not-strict", "anti_windup", Stage::gate, "integrates at a thrust of 0.2",
     "thrust of exactly 0.2", "a condition made non-strict",
     [](FaultyLaw& law) { open_gate(law, [](float thrust) { return thrust == takeoff_thrust; }); }},
    {"gate-takeoff-resets", "anti_windup", Stage::gate,
     "sets the integrals to 0 at a thrust up to 0.2", "thrust below 0.2 after some integration",
     "a helpful extra", reset_below_takeoff},
    {"gate-lower-dropped", "anti_windup", Stage::gate, "integrates at the lower motor limit",
     "the lower limit", "a condition dropped",
     [](FaultyLaw& law) {
       change_gate(law, [](float&, MotorLimits& limits) { limits.lower = false; });
     }},
    {"gate-upper-dropped", "anti_windup", Stage::gate, "integrates at the upper motor limit",
     "the upper limit", "a condition dropped",
     [](FaultyLaw& law) {
       change_gate(law, [](float&, MotorLimits& limits) { limits.upper = false; });
     }},
    {"gate-both-needed", "anti_windup", Stage::gate, "freezes only where both motor limits are set",
     "one of the limits", "a condition changed",
     [](FaultyLaw& law) {
       change_gate(law, [](float&, MotorLimits& limits) {
         limits.lower = limits.upper = limits.lower && limits.upper;
       });
     }},
    {"gate-yaw-dropped",
     "anti_windup",
     Stage::gate,
     "integrates yaw at the yaw limit",
     "the yaw limit",
     "a condition dropped",
     [](FaultyLaw& law) { use_gates(law, {.obeys_yaw_flag = false}); },
     {},
     mc_att_control::from_v1_5_5},
    {"gate-yaw-for-all", "anti_windup", Stage::gate, "freezes all axes at the yaw limit",
     "the yaw limit", "wrong axis",
     [](FaultyLaw& law) {
       change_gate(law,
                   [](float&, MotorLimits& limits) { limits.lower = limits.lower || limits.yaw; });
     }},
    {"gate-roll-by-yaw", "anti_windup", Stage::gate, "freezes roll at the yaw limit, not yaw",
     "the yaw limit", "wrong axis",
     [](FaultyLaw& law) {
       auto state = std::make_shared<std::pair<int, bool>>(0, false);  // axis, yaw flag
       change_stage(law.rate.may_integrate,
                    [state](const auto& then, float thrust, const MotorLimits& limits) {
                      *state = {0, limits.yaw};
                      return then(thrust, limits);
                    });
       change_stage(law.rate.integrate_axis,
                    [state](const auto& then, float integral, float control, float thrust,
                            float growth, bool) {
                      const bool frozen = state->first++ == 0 && state->second;
                      return then(integral, control, thrust, growth, frozen);
                    });
     }},
    {"gate-thrust-dropped", "anti_windup", Stage::gate, "integrates where control exceeds thrust",
     "a control above the thrust", "a condition dropped",
     [](FaultyLaw& law) { use_gates(law, {.by_thrust = [](float, float) { return true; }}); }},
    {"gate-thrust-signed", "anti_windup", Stage::gate, "compares the signed control with thrust",
     "a negative control beyond the thrust", "a sign",
     [](FaultyLaw& law) {
       use_gates(law, {.by_thrust = [](float control, float thrust) { return control < thrust; }});
     }},
    {"gate-thrust-not-strict", "anti_windup", Stage::gate, "integrates where control equals thrust",
     "a control of exactly the thrust", "a condition made non-strict",
     [](FaultyLaw& law) {
       use_gates(law, {.by_thrust = [](float control, float thrust) {
                   return std::abs(control) <= thrust;
                 }});
     }},
    {"gate-thrust-all-axes", "anti_windup", Stage::gate,
     "freezes all axes where one control exceeds thrust", "one axis beyond the thrust",
     "wrong axis",
     [](FaultyLaw& law) {
       auto largest = std::make_shared<float>(0.0f);
       change_stage(law.rate.control, [largest](const auto& then, const Vector& p, const Vector& d,
                                                const Vector& i, const Vector& ff) {
         const Vector control = then(p, d, i, ff);
         *largest = control.cwiseAbs().maxCoeff();
         return control;
       });
       change_stage(
           law.rate.integrate_axis, [largest](const auto& then, float integral, float control,
                                              float thrust, float growth, bool frozen) {
             return then(integral, control, thrust, growth, frozen || !(*largest < thrust));
           });
     }},
    {"gate-integral-dropped", "anti_windup", Stage::gate, "does not bound the integral",
     "an integral of 0.3", "missing clamp",
     [](FaultyLaw& law) {
       use_gates(law, {.by_integral = [](float n) { return std::isfinite(n); }});
     }},
    {"gate-integral-clamped", "anti_windup", Stage::gate,
     "clamps the integral instead of freezing it", "an integral near 0.3", "wrong clamp",
     [](FaultyLaw& law) {
       law.rate.integrate_axis = [](float integral, float control, float thrust, float growth,
                                    bool frozen) {
         const float room = std::clamp(integral + growth, -integral_limit, integral_limit);
         const bool open = std::abs(control) < thrust && std::isfinite(room) &&
                           std::abs(control) < integral_limit && !frozen;
         return open ? room : integral;
       };
     }},
    {"gate-integral-upper-only", "anti_windup", Stage::gate, "bounds positive integrals only",
     "an integral of -0.3", "missing clamp",
     [](FaultyLaw& law) {
       use_gates(law, {.by_integral = [](float n) { return n < integral_limit; }});
     }},
    {"gate-integral-0.25", "anti_windup", Stage::gate, "bounds the integral at 0.25",
     "an integral of 0.25", "wrong branch threshold",
     [](FaultyLaw& law) {
       use_gates(law, {.by_integral = [](float n) { return std::abs(n) < 0.25f; }});
     }},
    {"gate-integral-not-strict", "anti_windup", Stage::gate, "allows an integral of 0.3",
     "an integral of exactly 0.3", "a condition made non-strict",
     [](FaultyLaw& law) {
       use_gates(law, {.by_integral = [](float n) { return std::abs(n) <= integral_limit; }});
     }},
    {"gate-control-dropped", "anti_windup", Stage::gate, "integrates at any control",
     "a control beyond 0.3, but below the thrust", "a condition dropped",
     [](FaultyLaw& law) { use_gates(law, {.by_control = [](float) { return true; }}); }},
    {"gate-control-upper-only", "anti_windup", Stage::gate, "checks positive controls only",
     "a control below -0.3", "a condition dropped",
     [](FaultyLaw& law) {
       use_gates(law, {.by_control = [](float control) { return control < integral_limit; }});
     }},
    {"gate-control-not-strict", "anti_windup", Stage::gate, "integrates at a control of 0.3",
     "a control of exactly 0.3", "a condition made non-strict",
     [](FaultyLaw& law) {
       use_gates(law,
                 {.by_control = [](float control) { return std::abs(control) <= integral_limit; }});
     }},
    {"gate-by-direction", "anti_windup", Stage::gate,
     "integrates at a motor limit if that lowers the integral",
     "a limit while the error changes its sign", "a helpful extra",
     [](FaultyLaw& law) {
       auto limited = std::make_shared<bool>(false);
       law.rate.may_integrate = [limited](float thrust, const MotorLimits& limits) {
         *limited = limits.lower || limits.upper;
         return thrust > takeoff_thrust;
       };
       change_stage(law.rate.integrate_axis,
                    [limited](const auto& then, float integral, float control, float thrust,
                              float growth, bool frozen) {
                      const bool grows = std::abs(integral + growth) >= std::abs(integral);
                      return then(integral, control, thrust, growth, frozen || (*limited && grows));
                    });
     }},
    {"gate-finite-dropped", "anti_windup", Stage::gate, "does not check whether the sum is finite",
     "a NaN", "NaN handling", [](FaultyLaw& law) { use_gates(law, {}); },
     "a NaN or infinity is never within +-0.3, so the bound rejects it, too"},
    {"limits-exchanged", "anti_windup", Stage::gate, "exchanges the lower and the upper limit",
     "one of the limits", "wrong field",
     [](FaultyLaw& law) {
       change_flags(law, [](Flags& flags, const attest_inputs&) {
         std::swap(flags.lower_limit, flags.upper_limit);
       });
     },
     "each of them freezes all axes, and that is their only effect"},
    {"flags-are-1", "anti_windup", Stage::gate, "treats only 1 as true",
     "flags as bit masks 2 and 4", "flag comparison",
     [](FaultyLaw& law) {
       change_flags(law, [](Flags& flags, const attest_inputs&) {
         flags.lower_limit = flags.lower_limit == 1;
         flags.upper_limit = flags.upper_limit == 1;
         flags.yaw = flags.yaw == 1;
       });
     }},
    {"flags-never", "anti_windup", Stage::gate, "does not read the motor limits", "any limit",
     "a missing topic",
     [](FaultyLaw& law) {
       change_flags(law, [](Flags& flags, const attest_inputs&) { flags = {}; });
     }},
    {"flags-latched", "anti_windup", Stage::gate, "never clears the motor limits",
     "a limit that ends", "a latch",
     [](FaultyLaw& law) {
       change_flags(law, [latched = Flags{}](Flags& flags, const attest_inputs&) mutable {
         latched.lower_limit |= flags.lower_limit;
         latched.upper_limit |= flags.upper_limit;
         latched.yaw |= flags.yaw;
         flags = latched;
       });
     }},
    {"flags-fresh-only", "anti_windup", Stage::gate, "clears the motor limits between samples",
     "limits at 50 Hz", "stale flags",
     [](FaultyLaw& law) {
       also_before(law, [](attest_inputs& in) {
         if ((in.updated & ATTEST_UPDATED_MULTIROTOR_MOTOR_LIMITS) == 0) {
           in.multirotor_motor_limits = {};
         }
         in.updated |= ATTEST_UPDATED_MULTIROTOR_MOTOR_LIMITS;
       });
     }},
    {"flags-late", "anti_windup", Stage::gate, "uses the motor limits one tick late",
     "a limit that begins or ends", "one-tick delay",
     [](FaultyLaw& law) {
       also_before(law, [last = Flags{}](attest_inputs& in) mutable {
         std::swap(last, in.multirotor_motor_limits);
         in.updated |= ATTEST_UPDATED_MULTIROTOR_MOTOR_LIMITS;
       });
     }},
    {"frozen-is-zero", "anti_windup", Stage::gate, "returns 0 where the integral is frozen",
     "a gate that closes after some integration", "a wrong return",
     [](FaultyLaw& law) {
       change_stage(law.rate.integrate_axis, [](const auto& then, float integral, float control,
                                                float thrust, float growth, bool frozen) {
         const float next = then(integral, control, thrust, growth, frozen);
         return next == integral && growth != 0 ? 0.0f : next;
       });
     }},
    {"zero-is-not-finite", "anti_windup", Stage::gate,
     "tests `if (x && ...)` instead of isfinite(x)", "an integral that becomes exactly 0",
     "NaN handling",
     [](FaultyLaw& law) {
       use_gates(law, {.by_integral = [](float n) {
                   return n != 0 && n > -integral_limit && n < integral_limit;
                 }});
     }},
    {"integral-decays", "anti_windup", Stage::i, "leaks the integral", "an error that lasts",
     "a helpful extra",
     [](FaultyLaw& law) {
       change_stage(law.rate.integrate_axis, [](const auto& then, float integral, float control,
                                                float thrust, float growth, bool frozen) {
         return then(integral * 0.999f, control, thrust, growth, frozen);
       });
     }},
};

}  // namespace

std::span<const Fault> anti_windup_faults() { return anti_windup_list; }

}  // namespace attest::faults
