// Mistakes of the reference model of v1.18 with the commanded yaw rate.
#include <cmath>

#include "controller/faults/cascade_change.hpp"
#include "controller/faults/groups.hpp"

namespace attest::faults::in_cascade {
namespace {

using ModelLaw = ModelStages::Law;
using Decay = ModelStages::Decay;

bool is_commanded(Scalar yaw_rate) {
  return std::isfinite(yaw_rate) && std::abs(yaw_rate) > cascade::epsilon;
}

// Places the model on the first setpoint, but keeps the yaw rate of that setpoint.
void keep_first_yaw_rate(FaultyLaw& law) {
  const auto target = watch_setpoint(law);
  auto first = std::make_shared<bool>(false);
  ModelStages& model = model_of(law);
  change_stage(model.is_first, [first](const auto& then, std::uint64_t last_us) {
    *first = then(last_us);
    return false;
  });
  change_stage(model.elapsed, [first](const auto& then, std::uint64_t elapsed_us) {
    return *first ? 0.0f : then(elapsed_us);
  });
  change_stage(model.world_z, [first, target](const auto& then, const Quat& q_WR) {
    return then(*first ? *target : q_WR);
  });
  change_stage(model.turned, [first, target](const auto& then, const Quat& q_WR, V turn) {
    return *first ? *target : then(q_WR, turn);
  });
}

// Removes the part of the rate about z if Test, bool(Scalar yaw_rate), is true.
template <typename Test>
void change_without_yaw(FaultyLaw& law, Test test) {
  model_of(law).without_yaw = [test](V rate, V z_R, Scalar yaw_rate) {
    return test(yaw_rate) ? Vector(rate - z_R * cascade::dot(rate, z_R)) : rate;
  };
}

// Removes the part that the rate had before it moved.
void remove_old_yaw(FaultyLaw& law) {
  auto old = std::make_shared<Vector>(Vector::Zero());
  model_of(law).rate = [old](V error, V rate, const Decay& left) {
    *old = rate;
    return ModelLaw::rate(error, rate, left);
  };
  model_of(law).without_yaw = [old](V rate, V z_R, Scalar yaw_rate) {
    return is_commanded(yaw_rate) ? Vector(rate - z_R * cascade::dot(*old, z_R)) : rate;
  };
}

const Fault model_yaw_list[] = {
    {"cascade-model-first-yaw-rate", "reference_model", Stage::reference_model,
     "keeps the yaw rate of the first setpoint", "a first setpoint with a yaw rate",
     "a missing reset", keep_first_yaw_rate},
    {"cascade-model-not-turned-by-yaw-rate", "reference_model", Stage::reference_model,
     "does not turn the model by the commanded yaw rate", "a yaw rate", "a missing term",
     [](FaultyLaw& law) {
       model_of(law).turn = [](V error, V rate, V, Scalar elapsed_s, const Decay& left) {
         return ModelLaw::turn(error, rate, Vector::Zero(), elapsed_s, left);
       };
     }},
    {"cascade-model-yaw-rate-decays", "reference_model", Stage::reference_model,
     "turns the model by the commanded yaw rate as if it were a rate of the model that decays",
     "a yaw rate", "another term",
     [](FaultyLaw& law) {
       model_of(law).turn = [](V error, V rate, V command, Scalar elapsed_s, const Decay& left) {
         return ModelLaw::turn(error, rate + command, Vector::Zero(), elapsed_s, left);
       };
     }},
    {"cascade-model-yaw-rate-without-dt", "reference_model", Stage::reference_model,
     "turns the model by the commanded yaw rate without the time", "a yaw rate", "a missing factor",
     [](FaultyLaw& law) {
       model_of(law).turn = [](V error, V rate, V command, Scalar elapsed_s, const Decay& left) {
         return Vector(ModelLaw::turn(error, rate, Vector::Zero(), elapsed_s, left) + command);
       };
     }},
    {"cascade-model-yaw-rate-in-degrees", "reference_model", Stage::reference_model,
     "takes the commanded yaw rate in deg/s", "a yaw rate", "degrees",
     [](FaultyLaw& law) {
       model_of(law).command = [](V z_R, Scalar yaw_rate) {
         return ModelLaw::command(z_R, cascade::radians(yaw_rate));
       };
     }},
    {"cascade-model-yaw-rate-of-nan", "reference_model", Stage::guard,
     "does not ignore a commanded yaw rate that is not finite", "a yaw rate of NaN",
     "a missing guard",
     [](FaultyLaw& law) {
       model_of(law).command = [](V z_R, Scalar yaw_rate) { return Vector(z_R * yaw_rate); };
     }},
    {"cascade-model-yaw-rate-of-infinity", "reference_model", Stage::guard,
     "does not ignore an infinite yaw rate: it tests for NaN only", "an infinite yaw rate",
     "isnan for isfinite",
     [](FaultyLaw& law) {
       model_of(law).command = [](V z_R, Scalar yaw_rate) {
         return std::isnan(yaw_rate) ? Vector(Vector::Zero()) : Vector(z_R * yaw_rate);
       };
     }},
    {"cascade-model-z-transposed", "reference_model", Stage::reference_model,
     "takes the model's z axis in the world instead of the world's in the model",
     "a yaw rate while the model is tilted", "transposed rotation",
     [](FaultyLaw& law) {
       model_of(law).world_z = [](const Quat& q_WR) { return cascade::z_axis(q_WR); };
     }},
    {"cascade-model-z-of-model", "reference_model", Stage::reference_model,
     "turns the model about its own z axis by the commanded yaw rate",
     "a yaw rate while the model is tilted", "another frame",
     [](FaultyLaw& law) { model_of(law).world_z = [](const Quat&) { return Vector(0, 0, 1); }; }},
    {"cascade-model-z-of-body", "reference_model", Stage::reference_model,
     "takes the world's z axis in the body for that in the model",
     "a yaw rate while body and model are tilted apart", "another attitude",
     [](FaultyLaw& law) {
       auto q_WB = std::make_shared<Quat>(cascade::identity<Scalar>());
       also_before(law.attitude_unit, [q_WB](AttitudeIn& in) {
         *q_WB = cascade::quaternion_from<Scalar>(in.vehicle_attitude.q);
       });
       model_of(law).world_z = [q_WB](const Quat&) { return ModelLaw::world_z(*q_WB); };
     }},
    {"cascade-model-yaw-not-removed", "reference_model", Stage::reference_model,
     "keeps the yaw of the model's rate while a yaw rate is commanded",
     "MC_REF_FF, a yaw rate and a setpoint that yaws", "a missing step",
     [](FaultyLaw& law) { change_without_yaw(law, [](Scalar) { return false; }); }},
    {"cascade-model-yaw-always-removed", "reference_model", Stage::reference_model,
     "removes the yaw of the model's rate also without a yaw rate",
     "MC_REF_FF and a setpoint that yaws", "a missing condition",
     [](FaultyLaw& law) { change_without_yaw(law, [](Scalar) { return true; }); }},
    {"cascade-model-yaw-removed-to-the-right", "reference_model", Stage::reference_model,
     "removes the yaw of the model's rate only while a yaw to the right is commanded",
     "MC_REF_FF, a yaw rate to the left and a setpoint that yaws", "a missing absolute value",
     [](FaultyLaw& law) {
       change_without_yaw(law, [](Scalar yaw_rate) {
         return std::isfinite(yaw_rate) && yaw_rate > cascade::epsilon;
       });
     }},
    {"cascade-model-yaw-removed-from-0.1", "reference_model", Stage::reference_model,
     "keeps the yaw of the model's rate while less than 0.1 rad/s is commanded",
     "MC_REF_FF, a small yaw rate and a setpoint that yaws", "a wrong threshold",
     [](FaultyLaw& law) {
       change_without_yaw(law, [](Scalar yaw_rate) {
         return std::isfinite(yaw_rate) && std::abs(yaw_rate) > 0.1f;
       });
     }},
    {"cascade-model-yaw-removed-for-infinity", "reference_model", Stage::guard,
     "removes the yaw of the model's rate also for an infinite yaw rate",
     "MC_REF_FF, an infinite yaw rate and a setpoint that yaws", "a missing guard",
     [](FaultyLaw& law) {
       change_without_yaw(law,
                          [](Scalar yaw_rate) { return std::abs(yaw_rate) > cascade::epsilon; });
     }},
    {"cascade-model-old-yaw-removed", "reference_model", Stage::reference_model,
     "removes the yaw that the model's rate had before it moved",
     "MC_REF_FF, a yaw rate and a setpoint that yaws", "steps exchanged", remove_old_yaw},
    {"cascade-model-stops-with-yaw-rate", "reference_model", Stage::reference_model,
     "removes the whole rate of the model while a yaw rate is commanded",
     "a yaw rate and a setpoint that tilts", "a missing axis",
     [](FaultyLaw& law) {
       model_of(law).without_yaw = [](V rate, V, Scalar yaw_rate) {
         return is_commanded(yaw_rate) ? Vector(Vector::Zero()) : rate;
       };
     }},
};

}  // namespace

std::span<const Fault> model_yaw_faults() { return model_yaw_list; }

}  // namespace attest::faults::in_cascade
