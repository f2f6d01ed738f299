// The rate law: from body rates and their setpoint to dimensionless torques.
//
// P, I and D with a feed-forward of the setpoint. D acts on the angular acceleration, which the
// host filters. The larger the error, the smaller the share of it that is integrated. The integral
// does not move in a direction in which the actuators are saturated. While landed or maybe_landed
// is set, update() does not change it.
//
// Body axes FRD, in the order roll, pitch, yaw; rates [rad/s], acceleration [rad/s^2], time [s].
// The state is the integral and the saturation. No clock, no allocation; one thread at a time.
#pragma once

#include <array>
#include <utility>

#include "controller/attest_cascade.h"
#include "controller/cascade/gains.hpp"
#include "controller/cascade/rotation.hpp"
#include "controller/mc_att_control/inline.hpp"

namespace attest::cascade {

template <typename Scalar>
struct RateInput {
  Vector3<Scalar> rates_B;
  Vector3<Scalar> rates_sp_B;
  Vector3<Scalar> acceleration_B;
  Scalar dt_s;
  bool maybe_landed;
  bool landed;
};

// A flag is true if the actuators cannot give more torque about that axis in that direction.
struct Saturation {
  std::array<bool, 3> positive{};
  std::array<bool, 3> negative{};
};

// The stages of the law. Each is a pure function of its arguments.
template <typename Scalar>
struct RateStages {
  using Vector = Vector3<Scalar>;
  using Allocation = decltype(attest_rate_inputs::control_allocator_status);

  ATTEST_INLINE static Saturation saturation(const Allocation& status) {
    Saturation flags;
    if (status.torque_setpoint_achieved != 0) return flags;
    for (std::size_t i = 0; i < 3; ++i) {
      flags.positive[i] = status.unallocated_torque[i] > epsilon;
      flags.negative[i] = status.unallocated_torque[i] < -epsilon;
    }
    return flags;
  }

  // The flags of two samples, of which each has one direction.
  ATTEST_INLINE static Saturation either(Saturation up, const Saturation& down) {
    for (std::size_t i = 0; i < 3; ++i) {
      up.positive[i] = up.positive[i] || down.positive[i];
      up.negative[i] = up.negative[i] || down.negative[i];
    }
    return up;
  }

  ATTEST_INLINE static Vector error(const Vector& rates_sp, const Vector& rates) {
    return rates_sp - rates;
  }

  ATTEST_INLINE static Vector proportional(const Vector& error, const RateGains<Scalar>& gains) {
    return gains.proportional.cwiseProduct(error);
  }

  ATTEST_INLINE static Vector derivative(const Vector& acceleration,
                                         const RateGains<Scalar>& gains) {
    return gains.derivative.cwiseProduct(acceleration);
  }

  ATTEST_INLINE static Vector feed_forward(const Vector& rates_sp, const RateGains<Scalar>& gains) {
    return gains.feed_forward.cwiseProduct(rates_sp);
  }

  // The integral that is part of the torque: that of before this step's update.
  ATTEST_INLINE static Vector in_torque(const Vector& before, const Vector&) { return before; }

  ATTEST_INLINE static Vector torque(const Vector& p, const Vector& integral, const Vector& d,
                                     const Vector& ff) {
    return ((p + integral) - d) + ff;
  }

  ATTEST_INLINE static bool may_integrate(bool landed, bool maybe_landed) {
    return !landed && !maybe_landed;
  }

  // The error of one axis, or 0 if it points in a saturated direction. If a direction is saturated,
  // a NaN becomes 0.
  ATTEST_INLINE static Scalar unsaturated(Scalar error, bool positive, bool negative) {
    if (positive) error = min(error, Scalar(0));
    if (negative) error = max(error, Scalar(0));
    return error;
  }

  // The share of the error that is integrated: 1 without error, 0 from 400 deg/s on. After a large
  // disturbance the integral would otherwise make the axis bounce back.
  ATTEST_INLINE static Scalar i_factor(Scalar error) {
    constexpr float error_max_rad_s = 6.98131704f;
    const Scalar share = error / Scalar(error_max_rad_s);
    return max(Scalar(0), Scalar(1) - share * share);
  }

  ATTEST_INLINE static Scalar integrated(Scalar integral, Scalar factor, Scalar gain, Scalar error,
                                         Scalar dt_s) {
    return integral + ((factor * gain) * error) * dt_s;
  }

  ATTEST_INLINE static Scalar limited(Scalar next, Scalar before, Scalar max) {
    return is_finite(next) ? clamp(next, -max, max) : before;
  }
};

// Stages is a policy: the stages of the law, or a copy with one replaced.
template <typename Scalar, typename Stages = RateStages<Scalar>>
class RateLaw {
 public:
  using Allocation = decltype(attest_rate_inputs::control_allocator_status);

  explicit RateLaw(Stages stages = {}) : stages_(std::move(stages)) {}

  // Does not change the integral.
  void set_gains(const RateGains<Scalar>& gains) { gains_ = gains; }

  void set_saturation(const Allocation& status) { saturation_ = stages_.saturation(status); }
  void set_saturation(const Saturation& flags) { saturation_ = flags; }

  void reset_integral() { integral_.setZero(); }

  // The torques: not limited, NaN where an input was NaN. REQUIRES: set_gains() was called.
  Vector3<Scalar> update(const RateInput<Scalar>& in);

  const Vector3<Scalar>& integral() const { return integral_; }

 private:
  void integrate(const Vector3<Scalar>& error, Scalar dt_s);

  RateGains<Scalar> gains_{};
  Vector3<Scalar> integral_ = Vector3<Scalar>::Zero();
  Saturation saturation_;
  [[no_unique_address]] Stages stages_;
};

template <typename Scalar, typename Stages>
ATTEST_INLINE Vector3<Scalar> RateLaw<Scalar, Stages>::update(const RateInput<Scalar>& in) {
  const Vector3<Scalar> error = stages_.error(in.rates_sp_B, in.rates_B);
  const Vector3<Scalar> p = stages_.proportional(error, gains_);
  const Vector3<Scalar> d = stages_.derivative(in.acceleration_B, gains_);
  const Vector3<Scalar> ff = stages_.feed_forward(in.rates_sp_B, gains_);
  const Vector3<Scalar> before = integral_;
  if (stages_.may_integrate(in.landed, in.maybe_landed)) integrate(error, in.dt_s);
  return stages_.torque(p, stages_.in_torque(before, integral_), d, ff);
}

template <typename Scalar, typename Stages>
ATTEST_INLINE void RateLaw<Scalar, Stages>::integrate(const Vector3<Scalar>& error, Scalar dt_s) {
  for (int i = 0; i < 3; ++i) {
    const std::size_t axis = static_cast<std::size_t>(i);
    const Scalar usable =
        stages_.unsaturated(error[i], saturation_.positive[axis], saturation_.negative[axis]);
    const Scalar factor = stages_.i_factor(usable);
    const Scalar next = stages_.integrated(integral_[i], factor, gains_.integral[i], usable, dt_s);
    integral_[i] = stages_.limited(next, integral_[i], gains_.integral_max[i]);
  }
}

}  // namespace attest::cascade
