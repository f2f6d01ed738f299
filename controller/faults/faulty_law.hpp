// The law with every stage replaceable. Each stage is a function: that of the reference, or that of
// a fault. McAttControl<float, FaultyLaw> is then the reference with that mistake.
//
// A function may have state. Each FaultyController makes its own law, and so has its own state.
#pragma once

#include <functional>
#include <memory>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>

#include "controller/actuation/battery_status.hpp"
#include "controller/actuation/mixer.hpp"
#include "controller/faults/fault.hpp"
#include "controller/faults/faulty_cascade.hpp"
#include "controller/mc_att_control/mc_att_control.hpp"

// Compiled once, in attest_mc_att_control.
namespace attest::mc_att_control {

extern template struct AttitudeStages<float>;
extern template struct RateStages<float>;
extern template struct StepStages<float>;

}  // namespace attest::mc_att_control

namespace attest::faults {

using Matrix = mc_att_control::Matrix3<Scalar>;
using Quaternion = mc_att_control::Quaternion<Scalar>;
using Tilt = mc_att_control::TiltError<Scalar>;
using AttitudeGains = mc_att_control::AttitudeGains<Scalar>;
using RateGains = mc_att_control::RateGains<Scalar>;
using Gains = mc_att_control::Gains<Scalar>;
using RateCommand = mc_att_control::RateCommand<Scalar>;
using RecoveryTilt = mc_att_control::RecoveryTilt<Scalar>;
using mc_att_control::MotorLimits;
using mc_att_control::Parameters;
using mc_att_control::Topics;

inline constexpr Scalar pi = std::numbers::pi_v<Scalar>;

// Each struct of stages has the functions of the law's struct `Law`, with the same names. This
// struct has those of mc_att_control::AttitudeStages.
struct AttitudeStages {
  using Law = mc_att_control::AttitudeStages<Scalar>;
  std::function<Tilt(const Matrix&, const Matrix&)> tilt_error = Law::tilt_error;
  std::function<Vector(const Matrix&, const Tilt&)> nose_after_tilt = Law::nose_after_tilt;
  std::function<Scalar(const Matrix&)> yaw_weight = Law::yaw_weight;
  std::function<Scalar(const Vector&, const Matrix&, Scalar)> yaw_error = Law::yaw_error;
  std::function<Vector(const Matrix&, const Matrix&)> direct_error = Law::direct_error;
  std::function<bool(Scalar)> is_upset = Law::is_upset;
  std::function<Vector(const Vector&, const Vector&, Scalar, Scalar)> blend = Law::blend;
  std::function<Vector(const Vector&, const AttitudeGains&)> proportional = Law::proportional;
  std::function<Vector(const Vector&, bool, const AttitudeGains&)> limit = Law::limit;
  std::function<Scalar(Scalar, Scalar, Scalar, const AttitudeGains&)> yaw_feed_forward =
      Law::yaw_feed_forward;
  std::function<Scalar(Scalar, const AttitudeGains&)> weathervane_limit = Law::weathervane_limit;
};

struct RateStages {
  using Law = mc_att_control::RateStages<Scalar>;
  std::function<Scalar(Scalar, const RateGains&)> throttle_attenuation = Law::throttle_attenuation;
  std::function<Vector(const Vector&)> setpoint = Law::setpoint;
  std::function<Vector(const Vector&, Scalar, const RateGains&)> proportional = Law::proportional;
  std::function<Vector(const Vector&, const Vector&, Scalar, const RateGains&)> derivative =
      Law::derivative;
  std::function<Vector(const Vector&, const RateGains&)> feed_forward = Law::feed_forward;
  std::function<Vector(const Vector&, const Vector&, Scalar, const RateGains&)>
      feed_forward_change = Law::feed_forward_change;
  std::function<Vector(const Vector&, const Vector&, const Vector&, const Vector&)> control =
      Law::control;
  std::function<Vector(const Vector&, const Vector&, const Vector&)> published = Law::published;
  std::function<bool(Scalar, const MotorLimits&)> may_integrate = Law::may_integrate;
  std::function<Vector(const Vector&, Scalar, const RateGains&)> growth = Law::growth;
  std::function<Scalar(Scalar, Scalar, Scalar, Scalar, bool)> integrate_axis = Law::integrate_axis;
};

struct RecoveryStages {
  using Law = mc_att_control::RecoveryStages<Scalar>;
  std::function<RecoveryTilt(const Quaternion&, const Quaternion&)> tilt = Law::tilt;
  std::function<bool(bool, Scalar)> latch = Law::latch;
  std::function<Vector(const RecoveryTilt&)> optimal_rates = Law::optimal_rates;
  std::function<Vector(const Quaternion&, const Quaternion&, const AttitudeGains&)>
      quaternion_rates = Law::quaternion_rates;
  std::function<Scalar(Scalar, Scalar, const Quaternion&, const AttitudeGains&)> yaw_feed_forward =
      Law::yaw_feed_forward;
  std::function<Vector(const Vector&, const AttitudeGains&)> limit = Law::limit;
};

struct StepStages {
  using Law = mc_att_control::StepStages<Scalar>;
  std::function<Scalar(std::uint64_t, std::uint64_t)> step_time = Law::step_time;
  std::function<Gains(const Parameters&)> gains = Law::gains;
  std::function<bool(const decltype(Topics::manual)&, Scalar)> sticks_beyond = Law::sticks_beyond;
  std::function<bool(const decltype(Topics::mode)&, Profile)> is_autonomous = Law::is_autonomous;
  std::function<bool(bool, const decltype(Topics::attitude_setpoint)&)> is_weathervaning =
      Law::is_weathervaning;
  std::function<bool(bool)> supersedes_pending = Law::supersedes_pending;
  std::function<RateCommand(const decltype(Topics::manual)&, const Gains&)> acro = Law::acro;
  std::function<bool(const Topics&)> is_flying = Law::is_flying;
  std::function<float(float)> guarded = Law::guarded;
  std::function<float(const Topics&, const Gains&, Profile)> battery_factor = Law::battery_factor;
};

struct MixerStages {
  using Law = actuation::MixerStages<Scalar>;
  using Controls = Law::Controls;
  using Fit = Law::Fit;
  std::function<Controls(const Controls&, const Law::Scales&)> scaled = Law::scaled;
  std::function<Scalar(const actuation::Rotor&, const Controls&, Scalar)> without_yaw =
      Law::without_yaw;
  std::function<actuation::Saturation(Scalar, Scalar)> saturation = Law::saturation;
  std::function<Fit(Scalar, Scalar, Scalar)> fit = Law::fit;
  std::function<bool(std::span<const actuation::Rotor>, Controls&, const Fit&)> yield_yaw =
      Law::yield_yaw;
  std::function<Scalar(const actuation::Rotor&, const Controls&, const Fit&, Scalar)> command =
      Law::command;
  std::function<bool(Scalar)> starts_at_0 = Law::starts_at_0;
  std::function<Scalar(Scalar, Scalar, Scalar)> slew = Law::slew;
};

struct BatteryStages {
  using Law = actuation::BatteryStages<Scalar>;
  using Options = actuation::BatteryOptions;
  using Sample = actuation::BatterySample;
  std::function<Scalar(Scalar, Scalar)> low_passed = Law::low_passed;  // for the voltage only
  std::function<Scalar(const Sample&, const Options&)> load_drop_V = Law::load_drop_V;
  std::function<Scalar(const Sample&, Scalar, const Options&)> measured = Law::measured;
  std::function<Scalar(Scalar, Scalar)> remaining = Law::remaining;
  std::function<Scalar(Scalar, const Options&)> scale = Law::scale;
  std::function<bool(Scalar)> is_plugged_in = Law::is_plugged_in;
};

struct FaultyLaw : Around<attest_inputs, attest_outputs> {
  StepStages step;
  AttitudeStages attitude;
  RateStages rate;
  RecoveryStages recovery;
  MixerStages mixer;
  BatteryStages battery;
  AttitudeUnitLaw attitude_unit;
  RateUnitLaw rate_unit;
};

// Changes a stage of a law. `changed` gets the present function of the stage, and then the
// arguments, so that two faults of one stage can act at once.
template <typename Result, typename... Arguments, typename Changed>
void change_stage(std::function<Result(Arguments...)>& stage, Changed changed) {
  stage = [then = std::move(stage), changed](Arguments... arguments) mutable -> Result {
    return changed(std::as_const(then), std::forward<Arguments>(arguments)...);
  };
}

// also_before() and also_after() keep the present function and call `added` after it, so that two
// faults can act at once. Law is FaultyLaw, AttitudeUnitLaw or RateUnitLaw.
template <typename Law, typename Added>
void also_before(Law& law, Added added) {
  change_stage(law.before, [added](const auto& then, typename Law::Inputs& in) mutable {
    then(in);
    added(in);
  });
}
template <typename Law, typename Added>
void also_after(Law& law, Added added) {
  change_stage(law.after, [added](const auto& then, const typename Law::Inputs& in,
                                  typename Law::Outputs& out) mutable {
    then(in, out);
    added(in, out);
  });
}

}  // namespace attest::faults
