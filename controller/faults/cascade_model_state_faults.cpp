// Mistakes of the reference model of v1.18 in what it keeps: over a reset of the estimator, a
// pause, another mode, a NaN.
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "controller/faults/cascade_change.hpp"
#include "controller/faults/groups.hpp"

namespace attest::faults::in_cascade {
namespace {

using cascade::product;
using AttitudeLaw = QuaternionStages::Law;
using StepLaw = AttitudeStepStages::Law;
using ModelLaw = ModelStages::Law;
using Decay = ModelStages::Decay;
using P = CascadeParameters;

// The attitude follows the setpoint itself. Only the rates of the model are used.
void follow_setpoint(FaultyLaw& law) {
  const auto q_WD = watch_setpoint(law);
  auto& stages = law.attitude_unit.attitude;
  const auto has_model = watch_for_model(law);
  change_stage(stages.adapted, [q_WD](const auto& then, const Quat& delta, const Quat& q_WR) {
    *q_WD = then(delta, *q_WD);
    return then(delta, q_WR);
  });
  change_stage(stages.tilt_rotation,
               [q_WD, has_model](const auto& then, const Quat& q_WB, const Quat& q_WR) {
                 return then(q_WB, *has_model ? *q_WD : q_WR);
               });
  change_stage(stages.remaining_yaw,
               [q_WD, has_model](const auto& then, const Quat& tilted, const Quat& q_WR) {
                 return then(tilted, *has_model ? *q_WD : q_WR);
               });
}

// From a reset of the estimator to the next setpoint, the rates of the model are changed. Change is
// Vector(const Quat& delta, V rate).
template <typename Change>
void change_rates_at_reset(FaultyLaw& law, Change change) {
  auto delta = std::make_shared<std::optional<Quat>>();
  change_stage(law.attitude_unit.attitude.adapted,
               [delta](const auto& then, const Quat& turn, const Quat& q_WR) {
                 *delta = *delta ? product(turn, **delta) : turn;
                 return then(turn, q_WR);
               });
  const auto changed = [delta, change](V rate) {
    return *delta ? Vector(change(**delta, rate)) : rate;
  };
  ModelStages& model = model_of(law);
  change_stage(model.in_body, [changed](const auto& then, const Quat& q_WB, const Quat& q_WR,
                                        V rate) { return then(q_WB, q_WR, changed(rate)); });
  change_stage(model.turn, [changed](const auto& then, V error, V rate, V command, Scalar elapsed_s,
                                     const Decay& left) {
    return then(error, changed(rate), command, elapsed_s, left);
  });
  change_stage(model.rate, [delta, changed](const auto& then, V error, V rate, const Decay& left) {
    const Vector old = changed(rate);
    delta->reset();
    return then(error, old, left);
  });
}

// If the value is set to true, the next setpoint places the model, as if it were the first one.
std::shared_ptr<bool> make_restart(FaultyLaw& law) {
  auto restarts = std::make_shared<bool>(false);
  model_of(law).is_first = [restarts](std::uint64_t last_us) {
    return std::exchange(*restarts, false) || ModelLaw::is_first(last_us);
  };
  return restarts;
}

void restart_at_parameters(FaultyLaw& law) {
  change_stage(law.attitude_unit.step.gains,
               [restarts = make_restart(law)](const auto& then, const P& parameters) {
                 *restarts = true;
                 return then(parameters);
               });
}

void restart_after_pause(FaultyLaw& law) {
  change_stage(law.attitude_unit.step.is_newer,
               [restarts = make_restart(law)](const auto& then, std::uint64_t setpoint_us,
                                              std::uint64_t last_us) {
                 const bool newer = then(setpoint_us, last_us);
                 *restarts = newer && setpoint_us - last_us > 500'000;
                 return newer;
               });
}

void restart_in_other_modes(FaultyLaw& law) {
  change_stage(
      law.attitude_unit.step.runs,
      [restarts = make_restart(law)](const auto& then, const cascade::AttitudeTopics& topics) {
        const bool runs = then(topics);
        if (!runs) *restarts = true;
        return runs;
      });
}

void restart_with_sticks(FaultyLaw& law) {
  change_stage(
      law.attitude_unit.step.follows_sticks,
      [restarts = make_restart(law)](const auto& then, const cascade::AttitudeTopics& topics) {
        *restarts = then(topics);
        return *restarts;
      });
}

void restart_at_reset(FaultyLaw& law) {
  change_stage(
      law.attitude_unit.attitude.adapted,
      [restarts = make_restart(law)](const auto& then, const Quat& delta, const Quat& q_WR) {
        *restarts = true;
        return then(delta, q_WR);
      });
}

// A model that is NaN is placed on the next setpoint.
void forget_nan(FaultyLaw& law) {
  const auto q_WD = watch_setpoint(law);
  ModelStages& model = model_of(law);
  change_stage(model.world_z, [q_WD](const auto& then, const Quat& q_WR) {
    return then(std::isfinite(q_WR.sum()) ? q_WR : *q_WD);
  });
  change_stage(model.rate, [](const auto& then, V error, V rate, const Decay& left) {
    const Vector moved = then(error, rate, left);
    return moved.allFinite() ? moved : Vector(Vector::Zero());
  });
  change_stage(model.turned, [q_WD](const auto& then, const Quat& q_WR, V turn) {
    return std::isfinite(q_WR.sum()) ? then(q_WR, turn) : *q_WD;
  });
}

// A turn that is not finite leaves the model as it is.
void guard_turn(FaultyLaw& law) {
  ModelStages& model = model_of(law);
  change_stage(model.rate, [](const auto& then, V error, V rate, const Decay& left) {
    const Vector moved = then(error, rate, left);
    return moved.allFinite() ? moved : rate;
  });
  change_stage(model.turned, [](const auto& then, const Quat& q_WR, V turn) {
    return turn.allFinite() ? then(q_WR, turn) : q_WR;
  });
}

void delay_thrust(FaultyLaw& law) {
  also_after(law.attitude_unit, [has_model = watch_for_model(law), last = std::array<float, 3>{}](
                                    const AttitudeIn&, AttitudeOut& out) mutable {
    auto& rates = out.vehicle_rates_setpoint;
    if (!*has_model || rates.published == 0) return;
    for (std::size_t i = 0; i < 3; ++i) std::swap(rates.thrust_body[i], last[i]);
  });
}

const Fault model_state_list[] = {
    {"cascade-follows-v1.17-setpoint", "reference_model", Stage::reference_model,
     "follows the setpoint without a model, as in v1.17", "a setpoint that moves",
     "another version", follow<&CascadeTraits::follows_reference_model, false>},
    {"cascade-model-not-followed", "reference_model", Stage::reference_model,
     "corrects the attitude to the setpoint, and uses the rates of the model only",
     "a setpoint that moves", "another attitude", follow_setpoint},
    {"cascade-model-reset-turns-rates", "reference_model", Stage::estimator_reset,
     "turns the rates of the model too at a reset of the estimator",
     "a reset while the model moves", "a step too many",
     [](FaultyLaw& law) { change_rates_at_reset(law, turned); }},
    {"cascade-model-reset-stops", "reference_model", Stage::estimator_reset,
     "sets the rates of the model to 0 at a reset of the estimator",
     "a reset while the model moves", "a step too many",
     [](FaultyLaw& law) {
       change_rates_at_reset(law, [](const Quat&, V) { return Vector(Vector::Zero()); });
     }},
    {"cascade-model-reset-restarts", "reference_model", Stage::estimator_reset,
     "places the model on the next setpoint after a reset of the estimator",
     "a reset while model and setpoint differ", "a step too many", restart_at_reset},
    {"cascade-model-restarts-after-pause", "reference_model", Stage::reference_model,
     "places the model on a setpoint that comes more than 0.5 s after the last one",
     "a pause and a large step", "a helpful extra", restart_after_pause},
    {"cascade-model-restarts-in-modes", "reference_model", Stage::mode,
     "places the model on the first setpoint after the attitude was not controlled",
     "a mode without attitude control", "a helpful extra", restart_in_other_modes},
    {"cascade-model-restarts-with-parameters", "reference_model", Stage::parameters,
     "places the model on the next setpoint when parameters change",
     "a parameter that changes in flight", "a helpful extra", restart_at_parameters},
    {"cascade-model-without-sticks", "reference_model", Stage::reference_model,
     "follows setpoints of the sticks at once, without the model", "a stick that moves",
     "a missing case", restart_with_sticks},
    {"cascade-model-forgets-nan", "robustness", Stage::guard,
     "places a model that is NaN on the next setpoint, as v1.17 forgets a NaN",
     "a setpoint of NaN and a good one", "a guard too many", forget_nan},
    {"cascade-model-guards-turn", "robustness", Stage::guard,
     "leaves the model as it is if its turn is not finite", "a setpoint of NaN", "a guard too many",
     guard_turn},
    {"cascade-model-delays-thrust", "reference_model", Stage::output,
     "passes on the thrust of a setpoint one step late", "a thrust that changes", "one-tick delay",
     delay_thrust},
};

}  // namespace

std::span<const Fault> model_state_faults() { return model_state_list; }

}  // namespace attest::faults::in_cascade
