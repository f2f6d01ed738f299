// Mistakes of the reference model of v1.18 in its feed-forward and in its parameters.
#include <cmath>
#include <optional>
#include <utility>

#include "controller/faults/cascade_change.hpp"
#include "controller/faults/groups.hpp"

namespace attest::faults::in_cascade {
namespace {

using cascade::imaginary_part;
using cascade::inverse;
using cascade::product;
using AttitudeLaw = QuaternionStages::Law;
using ModelLaw = ModelStages::Law;
using ModelGains = ModelStages::LawGains;
using P = CascadeParameters;

// Replaces the sum that is fed forward. Sum is Vector(V command_B, V rate_B, const ModelGains&).
template <typename Sum>
void change_sum(FaultyLaw& law, Sum sum) {
  auto command_B = std::make_shared<std::optional<Vector>>();
  model_of(law).in_body = [command_B](const Quat& q_WB, const Quat& q_WR, V rate) {
    const Vector rate_B = ModelLaw::in_body(q_WB, q_WR, rate);
    if (*command_B) return rate_B;
    *command_B = rate_B;  // the law turns the command first
    return Vector(Vector::Zero());
  };
  model_of(law).share = [command_B, sum](V rate_B, const ModelGains& gains) {
    return Vector(sum(*std::exchange(*command_B, std::nullopt), rate_B, gains));
  };
}

// Replaces the share of the model's rate. Share is Vector(V rate_B, const ModelGains&).
template <typename Share>
void change_share(FaultyLaw& law, Share share) {
  model_of(law).share = share;
}

Vector limited(V rate, Scalar max) { return rate.cwiseMax(-max).cwiseMin(max); }

// Change is void(ModelGains&, const P&).
template <typename Change>
void change_model_gains(FaultyLaw& law, Change change) {
  change_gains(law.attitude_unit,
               [change](AttitudeUnitGains& gains, const P& p) { change(gains.model, p); });
}

// The law turns the command first, then the rate of the model.
void add_command_unturned(FaultyLaw& law) {
  auto& in_body = model_of(law).in_body;
  change_stage(in_body, [is_command = false](const auto& then, const Quat& q_WB, const Quat& q_WR,
                                             V rate) mutable {
    is_command = !is_command;
    return is_command ? rate : then(q_WB, q_WR, rate);
  });
}

// Takes the world's z axis in the frame of the setpoint.
void command_in_setpoint(FaultyLaw& law) {
  auto q_WD = std::make_shared<Quat>(cascade::identity<Scalar>());
  auto& setpoint = law.attitude_unit.attitude.setpoint;
  change_stage(setpoint,
               [q_WD](const auto& then, const Quat& given) { return *q_WD = then(given); });
  auto& world_z = model_of(law).world_z;
  change_stage(world_z, [q_WD](const auto& then, const Quat&) { return then(*q_WD); });
}

// Adds the commanded yaw rate about the world's z axis in the body, as v1.17 does. The command of
// the model is added too, if `both`.
template <bool both>
void feed_yaw_rate_as_v1_17(FaultyLaw& law) {
  auto rate = std::make_shared<Scalar>(0.0f);
  auto q_WB_seen = std::make_shared<Quat>(cascade::identity<Scalar>());
  also_before(law.attitude_unit, [q_WB_seen](AttitudeIn& in) {
    *q_WB_seen = cascade::quaternion_from<Scalar>(in.vehicle_attitude.q);
  });
  change_sum(law, [rate, q_WB_seen](V command_B, V rate_B, const ModelGains& gains) {
    const Vector as_v1_17 =
        AttitudeLaw::feed_forward(ModelLaw::share(rate_B, gains), *q_WB_seen, *rate);
    return both ? Vector(command_B + as_v1_17) : as_v1_17;
  });
  model_of(law).command = [rate](V z_R, Scalar yaw_rate) {
    *rate = yaw_rate;
    return ModelLaw::command(z_R, yaw_rate);
  };
}

const Fault model_forward_list[] = {
    {"cascade-model-ff-share-of-command", "reference_model", Stage::feed_forward,
     "multiplies the commanded yaw rate with MC_REF_FF too", "a yaw rate", "another term",
     [](FaultyLaw& law) {
       change_sum(law, [](V command_B, V rate_B, const ModelGains& gains) {
         return command_B * gains.feed_forward + ModelLaw::share(rate_B, gains);
       });
     }},
    {"cascade-model-ff-limit-of-command", "reference_model", Stage::feed_forward,
     "limits the commanded yaw rate to MC_REF_FF_MAX, too", "MC_REF_FF_MAX and a fast yaw rate",
     "another limit",
     [](FaultyLaw& law) {
       change_sum(law, [](V command_B, V rate_B, ModelGains gains) {
         const Vector sum = command_B + rate_B * gains.feed_forward;
         gains.feed_forward = 1;
         return ModelLaw::share(sum, gains);
       });
     }},
    {"cascade-model-command-missing", "reference_model", Stage::feed_forward,
     "does not feed the commanded yaw rate forward", "a yaw rate", "a missing term",
     [](FaultyLaw& law) {
       change_sum(law, [](V, V rate_B, const ModelGains& gains) {
         return ModelLaw::share(rate_B, gains);
       });
     }},
    {"cascade-model-command-as-v1.17", "reference_model", Stage::feed_forward,
     "turns the commanded yaw rate into the body with the attitude alone, as in v1.17",
     "a yaw rate while the tilted model turns", "another version", feed_yaw_rate_as_v1_17<false>},
    {"cascade-model-command-twice", "reference_model", Stage::feed_forward,
     "adds the commanded yaw rate of the model and that of v1.17", "a yaw rate", "a term twice",
     feed_yaw_rate_as_v1_17<true>},
    {"cascade-model-command-not-turned", "reference_model", Stage::feed_forward,
     "adds the commanded yaw rate without turning it into the body",
     "a yaw rate and a body tilted apart from the model", "a missing step", add_command_unturned},
    {"cascade-model-command-of-setpoint", "reference_model", Stage::feed_forward,
     "turns the commanded yaw rate into the frame of the setpoint, not of the model",
     "a yaw rate while the model follows a tilt", "another frame", command_in_setpoint},
    {"cascade-model-ff-missing", "reference_model", Stage::feed_forward,
     "does not feed the rate of the model forward", "MC_REF_FF and a setpoint that moves",
     "a missing term",
     [](FaultyLaw& law) {
       change_share(law, [](V, const ModelGains&) { return Vector(Vector::Zero()); });
     }},
    {"cascade-model-ff-in-full", "reference_model", Stage::feed_forward,
     "feeds the whole rate of the model forward, without MC_REF_FF", "a setpoint that moves",
     "a missing factor",
     [](FaultyLaw& law) {
       change_model_gains(law, [](ModelGains& gains, const P&) { gains.feed_forward = 1; });
     }},
    {"cascade-model-ff-unclamped", "reference_model", Stage::parameters,
     "does not clamp MC_REF_FF to 0 .. 1", "MC_REF_FF 1.5", "a missing clamp",
     [](FaultyLaw& law) {
       change_model_gains(law,
                          [](ModelGains& gains, const P& p) { gains.feed_forward = p.mc_ref_ff; });
     }},
    {"cascade-model-ff-not-limited", "reference_model", Stage::feed_forward,
     "does not limit the feed-forward to MC_REF_FF_MAX", "MC_REF_FF and a fast setpoint",
     "a missing clamp",
     [](FaultyLaw& law) {
       change_share(law, [](V rate_B, const ModelGains& gains) {
         return Vector(rate_B * gains.feed_forward);
       });
     }},
    {"cascade-model-ff-limited-before-share", "reference_model", Stage::feed_forward,
     "limits the rate of the model before it is multiplied with MC_REF_FF",
     "MC_REF_FF 0.6 and a fast setpoint", "steps exchanged",
     [](FaultyLaw& law) {
       change_share(law, [](V rate_B, ModelGains gains) {
         const Scalar share = std::exchange(gains.feed_forward, 1.0f);
         return Vector(ModelLaw::share(rate_B, gains) * share);
       });
     }},
    {"cascade-model-ff-limit-0-stops", "reference_model", Stage::feed_forward,
     "takes MC_REF_FF_MAX 0 for a limit of 0", "MC_REF_FF_MAX 0 and a setpoint that moves",
     "a missing case",
     [](FaultyLaw& law) {
       change_share(law, [](V rate_B, const ModelGains& gains) {
         return limited(rate_B * gains.feed_forward, gains.feed_forward_max_rad_s);
       });
     }},
    {"cascade-model-ff-limit-in-degrees", "reference_model", Stage::parameters,
     "takes MC_REF_FF_MAX as rad/s", "MC_REF_FF and a fast setpoint", "degrees",
     [](FaultyLaw& law) {
       change_model_gains(law, [](ModelGains& gains, const P& p) {
         gains.feed_forward_max_rad_s = cascade::max(p.mc_ref_ff_max, 0.0f);
       });
     }},
    {"cascade-model-ff-limit-of-norm", "reference_model", Stage::feed_forward,
     "shortens the vector of the feed-forward, instead of each axis",
     "MC_REF_FF and a fast setpoint about two axes", "another limit",
     [](FaultyLaw& law) {
       change_share(law, [](V rate_B, const ModelGains& gains) {
         const Vector f = rate_B * gains.feed_forward;
         const Scalar max = gains.feed_forward_max_rad_s, length = f.norm();
         return max > 0 && length > max ? Vector(f * (max / length)) : f;
       });
     }},
    {"cascade-model-ff-by-conjugate", "reference_model", Stage::feed_forward,
     "turns the rates of the model with the conjugate of a quaternion for its inverse",
     "MC_REF_FF and an attitude of another norm", "a shortcut",
     [](FaultyLaw& law) {
       model_of(law).in_body = [](const Quat& q_WB, const Quat& q_WR, V rate) {
         const Quat q_BR = product(conjugated(q_WB), q_WR);
         const Quat v(0, rate[0], rate[1], rate[2]);
         return imaginary_part(product(product(q_BR, v), conjugated(q_BR)));
       };
     }},
    {"cascade-model-ff-turned-back", "reference_model", Stage::feed_forward,
     "turns the rates of the model from the body to the model",
     "MC_REF_FF and a body tilted apart from the model", "transposed rotation",
     [](FaultyLaw& law) {
       model_of(law).in_body = [](const Quat& q_WB, const Quat& q_WR, V rate) {
         return turned(product(inverse(q_WR), q_WB), rate);
       };
     }},
    {"cascade-model-ff-not-turned", "reference_model", Stage::feed_forward,
     "adds the rates of the model without turning them into the body",
     "MC_REF_FF and a body tilted apart from the model", "a missing step",
     [](FaultyLaw& law) {
       model_of(law).in_body = [](const Quat&, const Quat&, V rate) { return rate; };
     }},
    {"cascade-model-ff-in-world", "reference_model", Stage::feed_forward,
     "adds the rates of the model in world axes", "MC_REF_FF at a heading", "another frame",
     [](FaultyLaw& law) {
       model_of(law).in_body = [](const Quat&, const Quat& q_WR, V rate) {
         return turned(q_WR, rate);
       };
     }},
    {"cascade-model-natural-in-Hz", "reference_model", Stage::parameters, "takes MC_REF_W_N in Hz",
     "a setpoint that moves", "a wrong unit",
     [](FaultyLaw& law) {
       change_model_gains(law,
                          [](ModelGains& gains, const P&) { gains.natural_rad_s *= 6.28318548f; });
     }},
    {"cascade-model-natural-below-0.1", "reference_model", Stage::parameters,
     "does not bound MC_REF_W_N from below", "MC_REF_W_N 0.02", "a missing clamp",
     [](FaultyLaw& law) {
       change_model_gains(
           law, [](ModelGains& gains, const P& p) { gains.natural_rad_s = p.mc_ref_w_n; });
     }},
    {"cascade-model-natural-from-1", "reference_model", Stage::parameters,
     "limits MC_REF_W_N to 1 or more, the bound of the parameter", "MC_REF_W_N 0.02",
     "a wrong clamp",
     [](FaultyLaw& law) {
       change_model_gains(law, [](ModelGains& gains, const P& p) {
         gains.natural_rad_s = cascade::max(p.mc_ref_w_n, 1.0f);
       });
     }},
};

}  // namespace

std::span<const Fault> model_forward_faults() { return model_forward_list; }

}  // namespace attest::faults::in_cascade
