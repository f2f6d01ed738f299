// Wrong terms of the rate loop.
#include <algorithm>
#include <cmath>
#include <utility>

#include "controller/faults/groups.hpp"
#include "controller/faults/seen.hpp"

namespace attest::faults {
namespace {

// Changes the published controls.
template <typename Change>
void change_controls(FaultyLaw& law, Change change) {
  also_after(law, [change](const attest_inputs&, attest_outputs& out) {
    if (out.actuator_controls_0.published != 0) change(out.actuator_controls_0.control);
  });
}

using V = const Vector&;

// Each step integrates the mean of its error and of that of the step before.
void integrate_trapezoids(FaultyLaw& law) {
  struct Errors {
    Vector now = Vector::Zero(), last = Vector::Zero();
  };
  auto errors = std::make_shared<Errors>();
  auto& stages = law.rate;
  change_stage(stages.proportional,
               [errors](const auto& then, V error, float attenuation, const RateGains& gains) {
                 errors->last = std::exchange(errors->now, error);
                 return then(error, attenuation, gains);
               });
  change_stage(stages.growth,
               [errors](const auto& then, V error, float dt_s, const RateGains& gains) {
                 return then(0.5f * (error + errors->last), dt_s, gains);
               });
}

void feed_measured_rates_forward(FaultyLaw& law) {
  auto measured = std::make_shared<Vector>(Vector::Zero());
  auto& stages = law.rate;
  change_stage(stages.derivative,
               [measured](const auto& then, V prev, V rates, float dt_s, const RateGains& gains) {
                 *measured = rates;
                 return then(prev, rates, dt_s, gains);
               });
  change_stage(stages.feed_forward, [measured](const auto& then, V, const RateGains& gains) {
    return then(*measured, gains);
  });
}

void take_dt_as_ms(FaultyLaw& law) {
  auto& stages = law.rate;
  change_stage(stages.growth, [](const auto& then, V error, float dt_s, const RateGains& gains) {
    return then(error, dt_s * 0.001f, gains);
  });
  for (auto* change : {&stages.derivative, &stages.feed_forward_change}) {
    *change = [then = *change](V one, V other, float dt_s, const RateGains& gains) {
      return then(one, other, dt_s * 0.001f, gains);
    };
  }
}

const Fault rate_list[] = {
    {"p-missing", "rates", Stage::p, "has no P term", "a rate error", "a missing term",
     [](FaultyLaw& law) { change_terms(law, [](ControlTerms& t) { t.p.setZero(); }); }},
    {"d-missing", "rates", Stage::d, "has no D term", "rates that change", "a missing term",
     [](FaultyLaw& law) { change_terms(law, [](ControlTerms& t) { t.d.setZero(); }); }},
    {"i-missing", "rates", Stage::i, "does not add the integral", "an error that lasts",
     "a missing term",
     [](FaultyLaw& law) { change_terms(law, [](ControlTerms& t) { t.i.setZero(); }); }},
    {"ff-missing", "rates", Stage::ff, "has no rate feed-forward", "a feed-forward gain",
     "missing feed-forward",
     [](FaultyLaw& law) { change_terms(law, [](ControlTerms& t) { t.ff.setZero(); }); }},
    {"d-subtracted", "rates", Stage::d, "subtracts the D term", "rates that change", "a sign",
     [](FaultyLaw& law) { change_terms(law, [](ControlTerms& t) { t.d *= -1; }); }},
    {"i-subtracted", "rates", Stage::i, "subtracts the integral", "an error that lasts", "a sign",
     [](FaultyLaw& law) { change_terms(law, [](ControlTerms& t) { t.i *= -1; }); }},
    {"d-and-i-subtracted", "rates", Stage::d, "subtracts the D term and the integral",
     "rates that change", "a sign",
     [](FaultyLaw& law) {
       change_terms(law, [](ControlTerms& t) {
         t.d *= -1;
         t.i *= -1;
       });
     }},
    {"error-reversed", "rates", Stage::p, "computes rates minus setpoint", "a rate error", "a sign",
     [](FaultyLaw& law) {
       change_stage(law.rate.proportional,
                    [](const auto& then, V error, float attenuation, const RateGains& gains) {
                      return Vector(-then(error, attenuation, gains));
                    });
     }},
    {"rates-setpoint-late", "rates", Stage::input,
     "controls the rates to the setpoint of the step before", "a setpoint that changes",
     "one-tick delay",
     [](FaultyLaw& law) {
       law.rate.setpoint = [last = Vector(Vector::Zero())](const Vector& rates_sp) mutable {
         return std::exchange(last, rates_sp);
       };
     }},
    {"rate-dt-as-ms", "rates", Stage::timing,
     "takes dt of the rate loop for milliseconds, and divides it by 1000", "rates that change",
     "a wrong unit", take_dt_as_ms},
    {"i-by-trapezoids", "rates", Stage::i, "integrates with the trapezoidal rule",
     "an error that changes", "another integration", integrate_trapezoids},
    {"ff-of-rates",
     "rates",
     Stage::ff,
     "feeds the measured rates forward",
     "a feed-forward gain and a rate error",
     "another signal",
     feed_measured_rates_forward,
     {},
     mc_att_control::from_v1_5_5},
    {"i-never", "rates", Stage::i, "has no integral: it stays 0", "an error that lasts",
     "a missing term",
     [](FaultyLaw& law) {
       law.rate.may_integrate = [](float, const MotorLimits&) { return false; };
     }},
    {"d-on-error", "rates", Stage::d, "takes the derivative of the error",
     "a setpoint that changes", "D on error",
     [](FaultyLaw& law) {
       auto seen = watch(law);
       law.rate.derivative = [seen](V, V, float dt, const RateGains& gains) {
         const Vector change = seen->error - seen->last;
         seen->last = seen->error;
         return Vector(gains.derivative.cwiseProduct(change) / dt);
       };
     }},
    {"d-without-dt", "rates", Stage::d, "does not divide by dt", "rates that change",
     "a missing factor",
     [](FaultyLaw& law) {
       law.rate.derivative = [](V prev, V rates, float, const RateGains& gains) {
         return Vector(gains.derivative.cwiseProduct(prev - rates));
       };
     }},
    {"d-times-dt", "rates", Stage::d, "multiplies by dt", "rates that change", "a wrong factor",
     [](FaultyLaw& law) {
       law.rate.derivative = [](V prev, V rates, float dt, const RateGains& gains) {
         return Vector(gains.derivative.cwiseProduct(prev - rates) * dt);
       };
     }},
    {"d-over-two-ticks", "rates", Stage::d, "uses the rates of two ticks ago", "rates that change",
     "one-tick delay",
     [](FaultyLaw& law) {
       change_stage(law.rate.derivative,
                    [older = Vector(Vector::Zero())](const auto& then, V prev, V rates, float dt,
                                                     const RateGains& gains) mutable {
                      const Vector before = older;
                      older = prev;
                      return then(before, rates, dt, gains);
                    });
     }},
    {"d-no-first-kick", "rates", Stage::d, "has no D term in the first step",
     "a first step that turns", "initial state",
     [](FaultyLaw& law) {
       change_stage(law.rate.derivative, [first = true](const auto& then, V prev, V rates, float dt,
                                                        const RateGains& gains) mutable {
         const Vector before = first ? rates : prev;
         first = false;
         return then(before, rates, dt, gains);
       });
     }},
    {"d-filtered", "rates", Stage::d, "low-passes the D term", "rates that change",
     "a helpful extra",
     [](FaultyLaw& law) {
       change_stage(law.rate.derivative,
                    [filtered = Vector(Vector::Zero())](const auto& then, V prev, V rates, float dt,
                                                        const RateGains& gains) mutable {
                      filtered += 0.5f * (then(prev, rates, dt, gains) - filtered);
                      return filtered;
                    });
     }},
    {"ff-of-change",
     "rates",
     Stage::ff,
     "feeds the setpoint's change forward, as v1.3.4 does",
     "a feed-forward gain",
     "another version of the law",
     [](FaultyLaw& law) {
       auto seen = watch(law);
       law.rate.feed_forward = [seen](V rates_sp, const RateGains& gains) {
         const Vector ff =
             RateStages::Law::feed_forward_change(rates_sp, seen->last, seen->dt_s, gains);
         seen->last = rates_sp;
         return ff;
       };
     },
     {},
     mc_att_control::from_v1_5_5},
    {"ff-on-error",
     "rates",
     Stage::ff,
     "feeds the error forward",
     "a feed-forward gain",
     "a wrong input",
     [](FaultyLaw& law) {
       auto seen = watch(law);
       change_stage(law.rate.feed_forward, [seen](const auto& then, V, const RateGains& gains) {
         return then(seen->error, gains);
       });
     },
     {},
     mc_att_control::from_v1_5_5},
    {"i-before-control", "rates", Stage::i,
     "adds this step's error to the integral before the control", "a rate error", "order of stages",
     [](FaultyLaw& law) {
       auto growth = std::make_shared<Vector>(Vector::Zero());
       auto dt_s = std::make_shared<float>(0.0f);
       change_stage(law.rate.derivative,
                    [dt_s](const auto& then, V prev, V rates, float dt, const RateGains& gains) {
                      *dt_s = dt;
                      return then(prev, rates, dt, gains);
                    });
       change_stage(law.rate.proportional,
                    [growth](const auto& then, V error, float attenuation, const RateGains& gains) {
                      *growth = gains.integral.cwiseProduct(error);
                      return then(error, attenuation, gains);
                    });
       law.rate.control = [growth, dt_s](V p, V d, V i, V ff) {
         return Vector(p + d + i + *growth * *dt_s + ff);
       };
     }},
    {"i-of-this-step", "rates", Stage::i, "publishes the controls with this step's integral",
     "a rate error", "order of stages",
     [](FaultyLaw& law) {
       law.rate.published = [](V control, V before, V after) {
         return Vector((control - before) + after);
       };
     }},
    {"i-fixed-dt", "rates", Stage::i, "integrates as if every step took 4 ms",
     "any rate except 250 Hz", "a fixed rate",
     [](FaultyLaw& law) {
       change_stage(law.rate.growth, [](const auto& then, V error, float, const RateGains& gains) {
         return then(error, 0.004f, gains);
       });
     }},
    {"i-without-dt", "rates", Stage::i, "does not multiply by dt", "an error that lasts",
     "a missing factor",
     [](FaultyLaw& law) {
       change_stage(law.rate.growth, [](const auto& then, V error, float, const RateGains& gains) {
         return then(error, 1, gains);
       });
     }},
    {"controls-limited", "rates", Stage::output, "limits the controls to 1", "a control beyond 1",
     "misplaced clamp",
     [](FaultyLaw& law) {
       change_stage(law.rate.control, [](const auto& then, V p, V d, V i, V ff) {
         return Vector(then(p, d, i, ff).cwiseMin(1).cwiseMax(-1));
       });
     }},
    {"roll-pitch-exchanged", "rates", Stage::output, "exchanges roll and pitch",
     "roll and pitch that differ", "wrong axis",
     [](FaultyLaw& law) {
       change_controls(law, [](float(&control)[8]) { std::swap(control[0], control[1]); });
     }},
    {"yaw-control-reversed", "rates", Stage::output, "has yaw's sign wrong", "a yaw control",
     "handedness",
     [](FaultyLaw& law) {
       change_controls(law, [](float(&control)[8]) { control[2] = -control[2]; });
     }},
    {"pitch-control-reversed", "rates", Stage::output, "has pitch's sign wrong", "a pitch control",
     "handedness",
     [](FaultyLaw& law) {
       change_controls(law, [](float(&control)[8]) { control[1] = -control[1]; });
     }},
    {"gyro-in-degrees", "rates", Stage::input, "takes body rates in deg/s", "rates", "degrees",
     [](FaultyLaw& law) {
       also_before(law, [](attest_inputs& in) {
         constexpr float degrees = 57.29578f;
         in.control_state.roll_rate *= degrees;
         in.control_state.pitch_rate *= degrees;
         in.control_state.yaw_rate *= degrees;
       });
     }},
    {"gyro-yaw-reversed", "rates", Stage::input, "takes the yaw rate as in FLU", "a yaw rate",
     "handedness",
     [](FaultyLaw& law) {
       also_before(
           law, [](attest_inputs& in) { in.control_state.yaw_rate = -in.control_state.yaw_rate; });
     }},
    {"gyro-in-10-bits", "rates", Stage::input, "holds body rates in 10 bits", "rates",
     "fixed point",
     [](FaultyLaw& law) {
       also_before(law, [](attest_inputs& in) {
         in.control_state.roll_rate = std::round(in.control_state.roll_rate * 64) / 64;
         in.control_state.pitch_rate = std::round(in.control_state.pitch_rate * 64) / 64;
         in.control_state.yaw_rate = std::round(in.control_state.yaw_rate * 64) / 64;
       });
     }},
    {"controls-in-8-bits", "rates", Stage::output, "holds controls in 8 bits", "any control",
     "fixed point",
     [](FaultyLaw& law) {
       change_controls(law, [](float(&control)[8]) {
         for (int i = 0; i < 4; ++i) control[i] = std::round(control[i] * 128) / 128;
       });
     }},
    {"integral-in-12-bits", "rates", Stage::i, "holds the integrals in 12 bits",
     "an error that lasts", "fixed point",
     [](FaultyLaw& law) {
       change_stage(law.rate.integrate_axis, [](const auto& then, float integral, float control,
                                                float thrust, float growth, bool frozen) {
         const float next = then(integral, control, thrust, growth, frozen);
         return std::round(next * 4096) / 4096;
       });
     }},
};

}  // namespace

std::span<const Fault> rate_faults() { return rate_list; }

}  // namespace attest::faults
