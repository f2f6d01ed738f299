// Mistakes of the reference model of v1.18 when it moves towards a setpoint: its time, its error
// and its decay.
#include <cmath>
#include <utility>

#include "controller/elementary/elementary.hpp"
#include "controller/faults/cascade_change.hpp"
#include "controller/faults/groups.hpp"

namespace attest::faults::in_cascade {
namespace {

using cascade::canonical;
using cascade::imaginary_part;
using cascade::inverse;
using cascade::product;
using ModelLaw = ModelStages::Law;
using ModelGains = ModelStages::LawGains;
using Decay = ModelStages::Decay;

// Measures the time between two setpoints by the samples of the attitude.
void measure_by_samples(FaultyLaw& law) {
  struct Clock {
    std::uint64_t now_us = 0, last_us = 0;
  };
  auto clock = std::make_shared<Clock>();
  also_before(law.attitude_unit,
              [clock](AttitudeIn& in) { clock->now_us = in.vehicle_attitude.timestamp_sample; });
  model_of(law).is_first = [clock](std::uint64_t last_us) {
    const bool first = ModelLaw::is_first(last_us);
    if (first) clock->last_us = clock->now_us;
    return first;
  };
  model_of(law).elapsed = [clock](std::uint64_t) {
    return ModelLaw::elapsed(clock->now_us - std::exchange(clock->last_us, clock->now_us));
  };
}

// Moves the model by dt of the step that takes the setpoint.
void measure_by_step(FaultyLaw& law) {
  auto dt_s = std::make_shared<Scalar>(0.0f);
  change_stage(law.attitude_unit.step.step_time,
               [dt_s](const auto& then, std::uint64_t now_us, std::uint64_t last_us) {
                 return *dt_s = then(now_us, last_us);
               });
  model_of(law).elapsed = [dt_s](std::uint64_t) { return *dt_s; };
}

// Counts the time from the last setpoint that came, although it was dropped.
void measure_from_dropped(FaultyLaw& law) {
  auto times_us = std::make_shared<std::pair<std::uint64_t, std::uint64_t>>();  // last, this
  change_stage(law.attitude_unit.step.is_newer,
               [times_us](const auto& then, std::uint64_t setpoint_us, std::uint64_t last_us) {
                 *times_us = {times_us->second, setpoint_us};
                 return then(setpoint_us, last_us);
               });
  model_of(law).elapsed = [times_us](std::uint64_t) {
    return ModelLaw::elapsed(times_us->second - times_us->first);
  };
}

// Takes the last setpoint again in each step, with the time of the step.
void move_in_each_step(FaultyLaw& law) {
  using Setpoint = decltype(AttitudeIn::vehicle_attitude_setpoint);
  const auto has_model = watch_for_model(law);
  also_before(law.attitude_unit, [has_model, last = Setpoint{}](AttitudeIn& in) mutable {
    constexpr auto bit = ATTEST_ATTITUDE_UPDATED_VEHICLE_ATTITUDE_SETPOINT;
    auto& setpoint = in.vehicle_attitude_setpoint;
    if ((in.updated & bit) != 0 && setpoint.timestamp > last.timestamp) last = setpoint;
    if (!*has_model || last.timestamp == 0) return;
    in.updated |= bit;
    setpoint = last;
    setpoint.timestamp = in.timestamp;
  });
}

// The error of the model. Error is Vector(const Quat& q_RD), the turn to the setpoint in R.
template <typename Error>
void change_error(FaultyLaw& law, Error error) {
  model_of(law).error = [error](const Quat& q_WR, const Quat& q_WD) {
    return Vector(error(product(inverse(q_WR), q_WD)));
  };
}

// Change is void(Decay&, Scalar elapsed_s, Scalar natural_rad_s, Scalar E), E the decay itself.
template <typename Change>
void change_decay(FaultyLaw& law, Change change) {
  model_of(law).decay = [change](Scalar elapsed_s, const ModelGains& gains) {
    Decay left = ModelLaw::decay(elapsed_s, gains);
    const Scalar natural = gains.natural_rad_s;
    change(left, elapsed_s, natural, elementary::exp(-(natural * elapsed_s)));
    return left;
  };
}

// Takes the mean rate of the last turn for the rate of the model.
void take_mean_rate(FaultyLaw& law) {
  auto mean = std::make_shared<Vector>(Vector::Zero());
  model_of(law).turn = [mean](V error, V rate, V command, Scalar elapsed_s, const Decay& left) {
    const Vector own = ModelLaw::turn(error, rate, Vector::Zero(), elapsed_s, left);
    *mean = own / elapsed_s;
    return Vector(own + command * elapsed_s);
  };
  model_of(law).rate = [mean](V, V, const Decay&) { return *mean; };
}

const Fault model_list[] = {
    {"cascade-model-moves-in-each-step", "reference_model", Stage::reference_model,
     "moves the model in each step, not only when a setpoint is taken",
     "setpoints at a lower rate than the attitude", "another time", move_in_each_step},
    {"cascade-model-first-not-placed", "reference_model", Stage::reference_model,
     "moves the model from level and north to the first setpoint, instead of placing it",
     "a first setpoint that is not level", "a missing case",
     [](FaultyLaw& law) { model_of(law).is_first = [](std::uint64_t) { return false; }; }},
    {"cascade-model-dt-to-20-ms", "reference_model", Stage::reference_model,
     "limits the time between setpoints to 0.2 .. 20 ms, like dt of the unit",
     "setpoints more than 20 ms apart", "a helpful extra",
     [](FaultyLaw& law) {
       model_of(law).elapsed = [](std::uint64_t elapsed_us) {
         return cascade::clamp(ModelLaw::elapsed(elapsed_us), 0.0002f, 0.02f);
       };
     }},
    {"cascade-model-dt-to-1-s", "reference_model", Stage::reference_model,
     "limits the time between setpoints to 1 s", "a yaw rate over a pause", "a helpful extra",
     [](FaultyLaw& law) {
       model_of(law).elapsed = [](std::uint64_t elapsed_us) {
         return std::min(ModelLaw::elapsed(elapsed_us), 1.0f);
       };
     }},
    {"cascade-model-dt-of-step", "reference_model", Stage::reference_model,
     "moves the model by dt of the step, not by the time between setpoints",
     "setpoints at a lower rate than the attitude", "another time", measure_by_step},
    {"cascade-model-dt-of-samples", "reference_model", Stage::reference_model,
     "measures the time between setpoints by the samples of the attitude", "setpoints with jitter",
     "another time", measure_by_samples},
    {"cascade-model-dt-from-dropped", "reference_model", Stage::reference_model,
     "counts the time from a setpoint that it dropped", "an old setpoint", "another state",
     measure_from_dropped},
    {"cascade-model-decay-linear", "reference_model", Stage::reference_model,
     "takes 1 - k, at least 0, for exp(-k)", "any error", "an approximation",
     [](FaultyLaw& law) {
       change_decay(law, [](Decay& left, Scalar elapsed_s, Scalar natural, Scalar) {
         const Scalar k = natural * elapsed_s, E = std::max(1 - k, 0.0f);
         left = {(1 + k) * E, elapsed_s * E, ((natural * natural) * elapsed_s) * E, (1 - k) * E};
       });
     }},
    {"cascade-model-dt-fixed", "reference_model", Stage::reference_model,
     "takes 4 ms for the time between setpoints", "setpoints at a rate other than 250 Hz",
     "a fixed rate",
     [](FaultyLaw& law) { model_of(law).elapsed = [](std::uint64_t) { return 0.004f; }; }},
    {"cascade-model-dt-in-us", "reference_model", Stage::reference_model,
     "takes the time between setpoints in microseconds", "a setpoint that moves", "a wrong unit",
     [](FaultyLaw& law) {
       model_of(law).elapsed = [](std::uint64_t us) { return static_cast<Scalar>(us); };
     }},
    {"cascade-model-error-is-angle", "reference_model", Stage::reference_model,
     "takes the angle of the error instead of twice the sine of its half", "a step of 90 deg",
     "another error",
     [](FaultyLaw& law) {
       change_error(law, [](const Quat& q_RD) {
         const Quat error = canonical(q_RD);
         const Vector axis = imaginary_part(error);
         const float sine = cascade::length(axis);
         if (sine < 1e-9f) return Vector(2 * axis);
         return Vector(axis * (2 * elementary::atan2(sine, error[0]) / sine));
       });
     }},
    {"cascade-model-error-is-sine", "reference_model", Stage::reference_model,
     "takes the sine of the whole error, not of its half", "a step of 90 deg", "another error",
     [](FaultyLaw& law) {
       change_error(law,
                    [](const Quat& q_RD) { return Vector(imaginary_part(q_RD) * (2 * q_RD[0])); });
     }},
    {"cascade-model-error-not-doubled", "reference_model", Stage::reference_model,
     "takes the imaginary part of the error once, not twice", "a setpoint that moves",
     "a missing factor",
     [](FaultyLaw& law) {
       change_error(law, [](const Quat& q_RD) { return imaginary_part(canonical(q_RD)); });
     }},
    {"cascade-model-error-not-canonical", "reference_model", Stage::reference_model,
     "computes the error without the canonical form",
     "a setpoint with the other sign of the quaternion", "two signs of a quaternion",
     [](FaultyLaw& law) {
       change_error(law, [](const Quat& q_RD) { return Vector(2 * imaginary_part(q_RD)); });
     }},
    {"cascade-model-error-in-world", "reference_model", Stage::reference_model,
     "computes the error in world axes", "a setpoint that moves at a heading", "another frame",
     [](FaultyLaw& law) {
       model_of(law).error = [](const Quat& q_WR, const Quat& q_WD) {
         return Vector(2 * imaginary_part(canonical(product(q_WD, inverse(q_WR)))));
       };
     }},
    {"cascade-model-error-reversed", "reference_model", Stage::reference_model,
     "turns the model away from the setpoint", "a setpoint that moves", "a sign",
     [](FaultyLaw& law) {
       change_error(law,
                    [](const Quat& q_RD) { return Vector(-2 * imaginary_part(canonical(q_RD))); });
     }},
    {"cascade-model-grows", "reference_model", Stage::reference_model,
     "takes exp(k) instead of exp(-k)", "a setpoint that moves", "a sign",
     [](FaultyLaw& law) {
       change_decay(law, [](Decay& left, Scalar, Scalar, Scalar E) {
         const Scalar grown = 1 / (E * E);
         left = {left.error_of_error * grown, left.error_of_rate * grown,
                 left.rate_of_error * grown, left.rate_of_rate * grown};
       });
     }},
    {"cascade-model-error-decays-by-exp", "reference_model", Stage::reference_model,
     "lets the error decay by exp(-k), without the factor 1 + k", "a setpoint that moves",
     "a missing factor",
     [](FaultyLaw& law) {
       change_decay(law, [](Decay& left, Scalar, Scalar, Scalar E) { left.error_of_error = E; });
     }},
    {"cascade-model-turn-of-rate-without-dt", "reference_model", Stage::reference_model,
     "does not multiply the turn by the rate of the model with the time", "a setpoint that moves",
     "a missing factor",
     [](FaultyLaw& law) {
       change_decay(law, [](Decay& left, Scalar, Scalar, Scalar E) { left.error_of_rate = E; });
     }},
    {"cascade-model-natural-not-squared", "reference_model", Stage::reference_model,
     "accelerates the model by W instead of its square", "MC_REF_FF and a setpoint that moves",
     "a missing power",
     [](FaultyLaw& law) {
       change_decay(law, [](Decay& left, Scalar elapsed_s, Scalar natural, Scalar E) {
         left.rate_of_error = natural * elapsed_s * E;
       });
     }},
    {"cascade-model-acceleration-without-natural", "reference_model", Stage::reference_model,
     "accelerates the model without the factor W", "MC_REF_FF and a setpoint that moves",
     "a missing factor",
     [](FaultyLaw& law) {
       change_decay(law, [](Decay& left, Scalar elapsed_s, Scalar, Scalar E) {
         left.rate_of_error = elapsed_s * E;
       });
     }},
    {"cascade-model-rate-decays-by-exp", "reference_model", Stage::reference_model,
     "lets the rate of the model decay by exp(-k), without the factor 1 - k",
     "MC_REF_FF and a setpoint that moves", "a missing factor",
     [](FaultyLaw& law) {
       change_decay(law, [](Decay& left, Scalar, Scalar, Scalar E) { left.rate_of_rate = E; });
     }},
    {"cascade-model-rate-decays-by-1-plus-k", "reference_model", Stage::reference_model,
     "lets the rate of the model decay with the factor 1 + k, like the error",
     "MC_REF_FF and a setpoint that moves", "a sign",
     [](FaultyLaw& law) {
       change_decay(law, [](Decay& left, Scalar, Scalar, Scalar) {
         left.rate_of_rate = left.error_of_error;
       });
     }},
    {"cascade-model-by-euler", "reference_model", Stage::reference_model,
     "moves the model by one step of Euler, not by the exact solution", "a setpoint that moves",
     "another integration",
     [](FaultyLaw& law) {
       change_decay(law, [](Decay& left, Scalar elapsed_s, Scalar natural, Scalar) {
         const Scalar k = natural * elapsed_s;
         left = {1 - k * k, (1 - 2 * k) * elapsed_s, natural * k, 1 - 2 * k};
       });
     }},
    {"cascade-model-of-first-order", "reference_model", Stage::reference_model,
     "follows the setpoint as a system of first order", "a setpoint that moves", "another model",
     [](FaultyLaw& law) {
       change_decay(law, [](Decay& left, Scalar, Scalar natural, Scalar E) {
         left = {E, 0, natural * E, 0};
       });
     }},
    {"cascade-model-turns-by-new-rate", "reference_model", Stage::reference_model,
     "turns the model by its new rate, not by the old one", "a setpoint that moves",
     "steps exchanged",
     [](FaultyLaw& law) {
       model_of(law).turn = [](V error, V rate, V command, Scalar elapsed_s, const Decay& left) {
         return ModelLaw::turn(error, ModelLaw::rate(error, rate, left), command, elapsed_s, left);
       };
     }},
    {"cascade-model-turns-without-rate", "reference_model", Stage::reference_model,
     "turns the model by the error alone, without its rate", "a setpoint that moves",
     "a missing term",
     [](FaultyLaw& law) {
       model_of(law).turn = [](V error, V, V command, Scalar elapsed_s, const Decay& left) {
         return ModelLaw::turn(error, Vector::Zero(), command, elapsed_s, left);
       };
     }},
    {"cascade-model-rate-is-mean", "reference_model", Stage::reference_model,
     "takes the mean rate of the last turn for the rate of the model",
     "MC_REF_FF and a setpoint that moves", "another rate", take_mean_rate},
    {"cascade-model-turned-in-world", "reference_model", Stage::reference_model,
     "turns the model about the world's axes", "a setpoint that moves at a heading",
     "factors exchanged",
     [](FaultyLaw& law) {
       model_of(law).turned = [](const Quat& q_WR, V turn) {
         return cascade::unit(product(cascade::rotation_about(turn), q_WR));
       };
     }},
    {"cascade-model-turn-not-halved", "reference_model", Stage::reference_model,
     "does not halve the angle of the turn for the quaternion", "a setpoint that moves",
     "a missing factor",
     [](FaultyLaw& law) {
       model_of(law).turned = [](const Quat& q_WR, V turn) {
         return ModelLaw::turned(q_WR, 2 * turn);
       };
     }},
    {"cascade-model-turn-is-small", "reference_model", Stage::reference_model,
     "turns the model as by a small angle: {1, half the turn}", "a step of 90 deg", "a shortcut",
     [](FaultyLaw& law) {
       model_of(law).turned = [](const Quat& q_WR, V turn) {
         return cascade::unit(product(q_WR, Quat(1, turn[0] / 2, turn[1] / 2, turn[2] / 2)));
       };
     }},
};

}  // namespace

std::span<const Fault> model_faults() { return model_list; }

}  // namespace attest::faults::in_cascade
