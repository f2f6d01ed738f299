// The two units of the cascade with every stage replaceable, in the same way as the controller
// (faulty_law.hpp): each stage is a function, that of the law or that of a fault.
#pragma once

#include <functional>

#include "controller/cascade/attitude_unit.hpp"
#include "controller/cascade/rate_unit.hpp"

// Compiled once, in attest_cascade: the catalogue only takes their addresses.
namespace attest::cascade {

extern template struct AttitudeStages<float>;
extern template struct AttitudeStepStages<float>;
extern template struct RateStages<float>;
extern template struct RateStepStages<float>;
extern template struct ReferenceModelStages<float>;
extern template struct StickStages<float>;

}  // namespace attest::cascade

namespace attest::faults {

using Scalar = float;
using Vector = mc_att_control::Vector3<Scalar>;
using Quat = cascade::Quaternion<Scalar>;
using CascadeTraits = cascade::ProfileTraits;
using CascadeParameters = cascade::Parameters;
using YawCorrection = cascade::YawCorrection<Scalar>;
using ThrustLimits = cascade::ThrustLimits<Scalar>;
using StickGains = cascade::StickGains<Scalar>;
using AttitudeUnitGains = cascade::AttitudeUnitGains<Scalar>;
using RateUnitGains = cascade::RateUnitGains<Scalar>;

// Each struct of stages has the functions of the law's struct `Law`, with the same names. This
// struct has those of cascade::AttitudeStages.
struct QuaternionStages {
  using Law = cascade::AttitudeStages<Scalar>;
  using LawGains = cascade::AttitudeGains<Scalar>;
  std::function<Quat(const Quat&)> setpoint = Law::setpoint;
  std::function<Quat(const Quat&, const Quat&)> adapted = Law::adapted;
  std::function<Quat(const Quat&, const Quat&)> tilt_rotation = Law::tilt_rotation;
  std::function<bool(const Quat&)> is_opposite = Law::is_opposite;
  std::function<Quat(const Quat&, const Quat&)> tilted = Law::tilted;
  std::function<Quat(const Quat&, const Quat&)> remaining_yaw = Law::remaining_yaw;
  std::function<Scalar(Scalar)> in_domain = Law::in_domain;
  std::function<Quat(Scalar, Scalar, Scalar)> weighted_yaw = Law::weighted_yaw;
  std::function<Quat(const Quat&, const Quat&)> target = Law::target;
  std::function<Quat(const Quat&, const Quat&)> error = Law::error;
  std::function<Vector(const Quat&, const LawGains&)> proportional = Law::proportional;
  std::function<Vector(const Vector&, const Quat&, Scalar)> feed_forward = Law::feed_forward;
  std::function<Vector(const Vector&, const LawGains&)> limit = Law::limit;
};

struct ModelStages {
  using Law = cascade::ReferenceModelStages<Scalar>;
  using LawGains = cascade::ReferenceModelGains<Scalar>;
  using Decay = cascade::ModelDecay<Scalar>;
  std::function<bool(std::uint64_t)> is_first = Law::is_first;
  std::function<Scalar(std::uint64_t)> elapsed = Law::elapsed;
  std::function<Vector(const Quat&)> world_z = Law::world_z;
  std::function<Vector(const Vector&, Scalar)> command = Law::command;
  std::function<Vector(const Quat&, const Quat&)> error = Law::error;
  std::function<Decay(Scalar, const LawGains&)> decay = Law::decay;
  std::function<Vector(const Vector&, const Vector&, const Vector&, Scalar, const Decay&)> turn =
      Law::turn;
  std::function<Vector(const Vector&, const Vector&, const Decay&)> rate = Law::rate;
  std::function<Vector(const Vector&, const Vector&, Scalar)> without_yaw = Law::without_yaw;
  std::function<Quat(const Quat&, const Vector&)> turned = Law::turned;
  std::function<Vector(const Quat&, const Quat&, const Vector&)> in_body = Law::in_body;
  std::function<Vector(const Vector&, const LawGains&)> share = Law::share;
};

struct StickStages {
  using Law = cascade::StickStages<Scalar>;
  std::function<Scalar()> no_yaw = Law::no_yaw;
  std::function<Scalar(const Quat&, const CascadeTraits&)> heading = Law::heading;
  std::function<bool(Scalar, const StickGains&)> is_lowest_throttle = Law::is_lowest_throttle;
  std::function<bool(YawCorrection&, Scalar, Scalar, Scalar, const CascadeTraits&)> correct_yaw =
      Law::correct_yaw;
  std::function<Scalar(Scalar, const StickGains&)> shaped_yaw_rate = Law::shaped_yaw_rate;
  std::function<Scalar(Scalar, const StickGains&)> straight_yaw_rate = Law::straight_yaw_rate;
  std::function<Scalar(Scalar, Scalar, Scalar, Scalar, Scalar)> locked_yaw = Law::locked_yaw;
  std::function<Scalar(Scalar, Scalar, Scalar)> integrated_yaw = Law::integrated_yaw;
  std::function<Scalar(Scalar, Scalar)> turned = Law::turned;
  std::function<Vector(Scalar, Scalar, const StickGains&)> limited_tilt = Law::limited_tilt;
  std::function<Quat(const Vector&)> tilt = Law::tilt;
  std::function<Quat(const Quat&, const Quat&, const Quat&)> tilt_for_yaw_error =
      Law::tilt_for_yaw_error;
  std::function<Quat(const Quat&, const Quat&)> desired_attitude = Law::desired_attitude;
  std::function<bool(bool, const CascadeTraits&)> clears_tilt = Law::clears_tilt;
  std::function<Scalar(Scalar, const StickGains&, const ThrustLimits&)> throttle = Law::throttle;
  std::function<Scalar(Scalar, const ThrustLimits&)> limited_thrust = Law::limited_thrust;
  std::function<Scalar(Scalar, const StickGains&)> uncentred_throttle = Law::uncentred_throttle;
};

struct AttitudeStepStages {
  using Law = cascade::AttitudeStepStages<Scalar>;
  using Topics = cascade::AttitudeTopics;
  using HoverSample = decltype(attest_attitude_inputs::hover_thrust_estimate);
  std::function<CascadeTraits(cascade::Profile)> traits = Law::traits;
  std::function<AttitudeUnitGains(const CascadeParameters&)> gains = Law::gains;
  std::function<Scalar(std::uint64_t, std::uint64_t)> step_time = Law::step_time;
  std::function<Scalar(const HoverSample&, const StickGains&)> hover_estimate = Law::hover_estimate;
  std::function<bool(std::uint64_t, const Law::Status&, Scalar)> is_spooled = Law::is_spooled;
  std::function<bool(const Topics&)> runs = Law::runs;
  std::function<bool(const Topics&)> follows_sticks = Law::follows_sticks;
  std::function<bool(bool, bool)> is_pending = Law::is_pending;
  std::function<bool()> supersedes_pending = Law::supersedes_pending;
  std::function<bool(std::uint64_t, std::uint64_t)> is_newer = Law::is_newer;
  std::function<bool(std::uint64_t, std::uint64_t)> precedes_reset = Law::precedes_reset;
  std::function<Vector(const Vector&, const Topics&, std::uint64_t, const CascadeTraits&)>
      autotuned = Law::autotuned;
  std::function<Scalar(Scalar, Scalar, bool, const StickGains&)> thrust_min = Law::thrust_min;
  std::function<Scalar(Scalar, Scalar, bool)> thrust_max = Law::thrust_max;
  std::function<Scalar(Scalar, Scalar, Scalar)> hover_thrust = Law::hover_thrust;
  std::function<bool(bool, const Topics&)> restarts_yaw = Law::restarts_yaw;
};

struct TorqueStages {
  using Law = cascade::RateStages<Scalar>;
  using LawGains = cascade::RateGains<Scalar>;
  std::function<cascade::Saturation(const Law::Allocation&)> saturation = Law::saturation;
  std::function<cascade::Saturation(const cascade::Saturation&, const cascade::Saturation&)>
      either = Law::either;
  std::function<Vector(const Vector&, const Vector&)> error = Law::error;
  std::function<Vector(const Vector&, const LawGains&)> proportional = Law::proportional;
  std::function<Vector(const Vector&, const LawGains&)> derivative = Law::derivative;
  std::function<Vector(const Vector&, const LawGains&)> feed_forward = Law::feed_forward;
  std::function<Vector(const Vector&, const Vector&)> in_torque = Law::in_torque;
  std::function<Vector(const Vector&, const Vector&, const Vector&, const Vector&)> torque =
      Law::torque;
  std::function<bool(bool, bool)> may_integrate = Law::may_integrate;
  std::function<Scalar(Scalar, bool, bool)> unsaturated = Law::unsaturated;
  std::function<Scalar(Scalar)> i_factor = Law::i_factor;
  std::function<Scalar(Scalar, Scalar, Scalar, Scalar, Scalar)> integrated = Law::integrated;
  std::function<Scalar(Scalar, Scalar, Scalar)> limited = Law::limited;
};

struct RateStepStages {
  using Law = cascade::RateStepStages<Scalar>;
  using LowPass = cascade::LowPass<Scalar>;
  using Setpoint = cascade::RatesSetpoint<Scalar>;
  using Battery = decltype(attest_rate_inputs::battery_status);
  std::function<CascadeTraits(cascade::Profile)> traits = Law::traits;
  std::function<RateUnitGains(const CascadeParameters&)> gains = Law::gains;
  std::function<Scalar(std::uint64_t, std::uint64_t)> step_time = Law::step_time;
  std::function<bool(const cascade::RateTopics&)> is_acro = Law::is_acro;
  std::function<Setpoint(const Law::Sticks&, const cascade::AcroGains<Scalar>&)> acro = Law::acro;
  std::function<std::uint32_t(std::uint32_t, std::uint32_t)> pending = Law::pending;
  std::function<bool()> supersedes_pending = Law::supersedes_pending;
  std::function<Scalar(Scalar, Scalar)> commanded = Law::commanded;
  std::function<bool(const cascade::RateTopics&)> resets_integral = Law::resets_integral;
  std::function<Scalar(LowPass&, Scalar, Scalar, const RateUnitGains&, const CascadeTraits&)>
      filtered_yaw = Law::filtered_yaw;
  std::function<Scalar(Scalar)> guarded = Law::guarded;
  std::function<Scalar(Scalar, const Battery&)> battery_scale = Law::battery_scale;
  std::function<Scalar(Scalar, Scalar)> scaled = Law::scaled;
};

// Changes to the inputs before the law and to the outputs after it.
template <typename In, typename Out>
struct Around {
  using Inputs = In;
  using Outputs = Out;
  std::function<void(In&)> before = [](In&) {};
  std::function<void(const In&, Out&)> after = [](const In&, Out&) {};
};

// Replaces cascade::AttitudeUnitLaw.
struct AttitudeUnitLaw : Around<attest_attitude_inputs, attest_attitude_outputs> {
  using Unit = cascade::AttitudeUnit<Scalar, AttitudeUnitLaw>;
  AttitudeStepStages step;
  StickStages sticks;
  QuaternionStages attitude;
  ModelStages model;
};

// Replaces cascade::RateUnitLaw.
struct RateUnitLaw : Around<attest_rate_inputs, attest_rate_outputs> {
  using Unit = cascade::RateUnit<Scalar, RateUnitLaw>;
  RateStepStages step;
  TorqueStages rate;
};

}  // namespace attest::faults
