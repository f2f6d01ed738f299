// The rate loop: from body rates and their setpoint to dimensionless torque controls.
//
// The law of PX4 v1.5.5 mc_att_control, control_attitude_rates(): P with throttle attenuation, D on
// the measured rates, an integral that is frozen near saturation, and a feed-forward.
//
// Body axes FRD, in the order roll, pitch, yaw; rates [rad/s], time [s], thrust [0..1]. The state
// is the integral and the samples of the last update. No clock, no allocation; one thread at a
// time.
#pragma once

#include <cmath>
#include <utility>

#include "controller/mc_att_control/gains.hpp"
#include "controller/mc_att_control/inline.hpp"
#include "controller/mc_att_control/ordered.hpp"
#include "controller/mc_att_control/profile.hpp"

namespace attest::mc_att_control {

// An axis integrates only while its new integral and its control are inside +- this bound.
inline constexpr float integral_limit = 0.3f;

// Up to this thrust the vehicle is assumed to stand on the ground, where integrals would wind up.
inline constexpr float takeoff_thrust = 0.2f;

// Saturation reported by the mixer: see multirotor_motor_limits in attest_unit.h.
struct MotorLimits {
  bool lower = false;
  bool upper = false;
  bool yaw = false;
};

template <typename Scalar>
struct RateInput {
  Vector3<Scalar> rates_B;
  Vector3<Scalar> rates_sp_B;
  Scalar thrust_sp;            // thrust of this step
  Scalar published_thrust_sp;  // thrust in the latched copy of vehicle_rates_setpoint
  Scalar dt_s;
  MotorLimits limits;
  bool flying;  // armed as a rotary wing; otherwise each step sets the integral to 0 first
};

// The stages of the law. Each is a pure function of its arguments.
template <typename Scalar>
struct RateStages {
  using Vector = Vector3<Scalar>;

  // Factor on the P term. A NaN thrust gives 1, because `factor < one` is then false.
  ATTEST_INLINE static Scalar throttle_attenuation(Scalar thrust, const RateGains<Scalar>& gains) {
    const Scalar one = 1;
    using std::abs;
    const Scalar factor = one - gains.tpa_slope * (abs(thrust) - gains.tpa_break);
    const Scalar at_most_one = factor < one ? factor : one;
    return at_most_one > Scalar(0) ? at_most_one : Scalar(0);
  }

  ATTEST_INLINE static Vector proportional(const Vector& error, Scalar attenuation,
                                           const RateGains<Scalar>& gains) {
    return gains.proportional.cwiseProduct(error * attenuation);
  }

  // The setpoint that this step uses: that of the attitude law in the same step.
  ATTEST_INLINE static Vector setpoint(const Vector& rates_sp) { return rates_sp; }

  // D acts on the measured rates, so that a step of the setpoint gives no kick.
  ATTEST_INLINE static Vector derivative(const Vector& rates_prev, const Vector& rates, Scalar dt_s,
                                         const RateGains<Scalar>& gains) {
    return gains.derivative.cwiseProduct(rates_prev - rates) / dt_s;
  }

  ATTEST_INLINE static Vector feed_forward(const Vector& rates_sp, const RateGains<Scalar>& gains) {
    return gains.feed_forward.cwiseProduct(rates_sp);
  }

  // v1.3.4: the change of the setpoint is fed forward.
  ATTEST_INLINE static Vector feed_forward_change(const Vector& rates_sp,
                                                  const Vector& rates_sp_prev, Scalar dt_s,
                                                  const RateGains<Scalar>& gains) {
    return gains.feed_forward.cwiseProduct(rates_sp - rates_sp_prev) / dt_s;
  }

  ATTEST_INLINE static Vector control(const Vector& p, const Vector& d, const Vector& integral,
                                      const Vector& ff) {
    return ((p + d) + integral) + ff;
  }

  // The control that is published, with the integrals before and after this step's update.
  ATTEST_INLINE static Vector published(const Vector& control, const Vector&, const Vector&) {
    return control;
  }

  ATTEST_INLINE static bool may_integrate(Scalar thrust_sp, const MotorLimits& limits) {
    return thrust_sp > Scalar(takeoff_thrust) && !limits.lower && !limits.upper;
  }

  // One axis of the integral after this step: unchanged unless all conditions hold.
  ATTEST_INLINE static Scalar integrate_axis(Scalar integral, Scalar control, Scalar thrust_sp,
                                             Scalar growth, bool frozen) {
    const Scalar limit = Scalar(integral_limit);
    using std::abs;
    if (!(abs(control) < thrust_sp)) return integral;
    const Scalar next = integral + growth;
    const bool inside = next > -limit && next < limit && control > -limit && control < limit;
    return inside && !frozen ? next : integral;
  }

  ATTEST_INLINE static Vector growth(const Vector& error, Scalar dt_s,
                                     const RateGains<Scalar>& gains) {
    return gains.integral.cwiseProduct(error) * dt_s;
  }
};

// Stages is a policy: the stages of the law, or a copy with one replaced (controller/faults).
template <typename Scalar, typename Stages = RateStages<Scalar>>
class RateControl {
 public:
  explicit RateControl(Profile profile, Stages stages = {})
      : profile_(profile), stages_(std::move(stages)) {}

  void set_gains(const RateGains<Scalar>& gains) { gains_ = gains; }

  // The torque controls: dimensionless, not limited, NaN where an input was NaN.
  // REQUIRES: set_gains() was called.
  Vector3<Scalar> update(const RateInput<Scalar>& in);

  // Replaces what the last update() was given.
  void set_previous(const Vector3<Scalar>& rates, const Vector3<Scalar>& rates_sp) {
    rates_prev_ = rates;
    rates_sp_prev_ = rates_sp;
  }

  void reset_yaw_integral() { integral_[2] = Scalar(0); }

  const Vector3<Scalar>& integral() const { return integral_; }

 private:
  Vector3<Scalar> feed_forward(const Vector3<Scalar>& rates_sp, Scalar dt_s) const;
  Vector3<Scalar> integrate(const Vector3<Scalar>& control, const Vector3<Scalar>& error,
                            const RateInput<Scalar>& in) const;

  Profile profile_;
  RateGains<Scalar> gains_{};
  Vector3<Scalar> integral_ = Vector3<Scalar>::Zero();
  Vector3<Scalar> rates_prev_ = Vector3<Scalar>::Zero();
  Vector3<Scalar> rates_sp_prev_ = Vector3<Scalar>::Zero();
  [[no_unique_address]] Stages stages_;
};

template <typename Scalar, typename Stages>
ATTEST_INLINE Vector3<Scalar> RateControl<Scalar, Stages>::feed_forward(
    const Vector3<Scalar>& rates_sp, Scalar dt_s) const {
  if (traits_of(profile_).feeds_forward_rates) return stages_.feed_forward(rates_sp, gains_);
  return stages_.feed_forward_change(rates_sp, rates_sp_prev_, dt_s, gains_);
}

template <typename Scalar, typename Stages>
ATTEST_INLINE Vector3<Scalar> RateControl<Scalar, Stages>::integrate(
    const Vector3<Scalar>& control, const Vector3<Scalar>& error,
    const RateInput<Scalar>& in) const {
  if (!stages_.may_integrate(in.thrust_sp, in.limits)) return integral_;
  const Vector3<Scalar> growth = stages_.growth(error, in.dt_s, gains_);
  const auto axis = [&](int i, bool frozen) {
    return stages_.integrate_axis(integral_[i], control[i], in.thrust_sp, growth[i], frozen);
  };
  const bool yaw_frozen = traits_of(profile_).freezes_yaw_integral && in.limits.yaw;
  return {axis(0, false), axis(1, false), axis(2, yaw_frozen)};
}

template <typename Scalar, typename Stages>
ATTEST_INLINE Vector3<Scalar> RateControl<Scalar, Stages>::update(const RateInput<Scalar>& in) {
  if (!in.flying) integral_.setZero();
  const Scalar attenuation = traits_of(profile_).attenuates_by_throttle
                                 ? stages_.throttle_attenuation(in.published_thrust_sp, gains_)
                                 : Scalar(1);
  const Vector3<Scalar> rates_sp = stages_.setpoint(in.rates_sp_B);
  const Vector3<Scalar> error = rates_sp - in.rates_B;
  const Vector3<Scalar> p = stages_.proportional(error, attenuation, gains_);
  const Vector3<Scalar> d = stages_.derivative(rates_prev_, in.rates_B, in.dt_s, gains_);
  const Vector3<Scalar> control = stages_.control(p, d, integral_, feed_forward(rates_sp, in.dt_s));
  rates_prev_ = in.rates_B;
  rates_sp_prev_ = rates_sp;
  const Vector3<Scalar> before = integral_;
  integral_ = integrate(control, error, in);
  return stages_.published(control, before, integral_);
}

}  // namespace attest::mc_att_control
