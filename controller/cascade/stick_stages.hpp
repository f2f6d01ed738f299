// The stages of the stabilized mode: what each stick means.
//
// Sticks [-1..1], angles [rad], yaw rates [rad/s] about the world's z axis, thrust [0..1]. Pure
// functions of their arguments; any thread.
#pragma once

#include <limits>

#include "controller/cascade/gains.hpp"
#include "controller/cascade/rotation.hpp"
#include "controller/mc_att_control/inline.hpp"

namespace attest::cascade {

// The thrust limits that follow landing and arming, and the hover thrust.
template <typename Scalar>
struct ThrustLimits {
  Scalar min = Scalar(0);
  Scalar max = Scalar(0);
  Scalar hover = Scalar(0);
};

// How far the heading has moved since the estimator began to converge to a new heading, measured
// against a heading of the gyros alone. The vehicle must not follow this movement.
template <typename Scalar>
struct YawCorrection {
  LowPass<Scalar> error;  // heading minus unaided heading [rad]
  Scalar reference = Scalar(0);
  Scalar value = Scalar(0);
  bool converging = false;
  bool lost = false;  // v1.18: the unaided heading was not available in the last step of the sticks
};

template <typename Scalar>
struct StickStages {
  using Vector = Vector3<Scalar>;
  using Q = Quaternion<Scalar>;
  using Gains = StickGains<Scalar>;

  ATTEST_INLINE static Scalar no_yaw() { return Scalar(std::numeric_limits<float>::quiet_NaN()); }

  static Scalar heading(const Q& q_WB, const ProfileTraits& law) {
    return cascade::heading(q_WB, law);
  }

  // At the lowest throttle the vehicle may stand on the ground, where it must not turn.
  ATTEST_INLINE static bool is_lowest_throttle(Scalar throttle, const Gains& gains) {
    return throttle < Scalar(-0.9f) && !gains.yaws_at_lowest_throttle;
  }

  // Updates `state`. Returns true if the estimator has just converged, or if the unaided heading is
  // back: the locked yaw must then be released.
  static bool correct_yaw(YawCorrection<Scalar>& state, Scalar heading, Scalar unaided, Scalar dt_s,
                          const ProfileTraits& law) {
    if (!is_finite(unaided)) {
      if (law.keeps_lost_correction) {
        state.lost = true;
      } else {
        state.value = Scalar(0);
      }
      return false;
    }
    const Scalar error = wrap(heading - unaided);
    if (state.lost) {
      state = {.error = {error, state.error.weight}, .reference = error};
      return true;
    }
    constexpr float converged_rad = 0.0174532924f, tau_s = 1.0f;
    const Scalar change = wrap(error - state.error.state);
    state.error.update(Scalar(tau_s), dt_s, error, law);
    const bool was_converging = state.converging;
    using std::abs;
    state.converging = abs(change) > Scalar(converged_rad);
    if (!state.converging) state.reference = error;
    state.value = wrap(error - state.reference);
    return was_converging && !state.converging;
  }

  // From v1.16.0: the commanded yaw rate, with a deadzone and an expo, before the low-pass.
  ATTEST_INLINE static Scalar shaped_yaw_rate(Scalar stick, const Gains& gains) {
    return expo(deadzone(stick, gains.yaw_deadzone), gains.yaw_expo) * gains.yaw_rate_max_rad_s;
  }

  ATTEST_INLINE static Scalar straight_yaw_rate(Scalar stick, const Gains& gains) {
    return stick * gains.yaw_rate_max_rad_s;
  }

  // From v1.16.0: while a yaw rate is commanded, no yaw is held. The first step without a yaw rate
  // takes the heading, which is then held. The held yaw moves with the correction.
  ATTEST_INLINE static Scalar locked_yaw(Scalar yaw_sp, Scalar rate, Scalar heading,
                                         Scalar old_correction, Scalar correction) {
    using std::abs;
    if (abs(rate) > Scalar(epsilon)) return no_yaw();
    if (!is_finite(yaw_sp)) return heading;
    return wrap((yaw_sp - old_correction) + correction);
  }

  // Until v1.15.4: the yaw setpoint is the integral of the commanded yaw rate.
  ATTEST_INLINE static Scalar integrated_yaw(Scalar yaw_sp, Scalar rate, Scalar dt_s) {
    return wrap(yaw_sp + rate * dt_s);
  }

  // The angle after a reset of the estimator that turned the heading by `turn`. NaN stays NaN.
  ATTEST_INLINE static Scalar turned(Scalar angle, Scalar turn) { return wrap(angle + turn); }

  // Roll and pitch stick together give no more tilt than one stick alone. Returns a rotation
  // vector.
  ATTEST_INLINE static Vector limited_tilt(Scalar x, Scalar y, const Gains& gains) {
    const Vector v(x, y, Scalar(0));
    const Scalar angle = length(v);
    return angle > gains.tilt_max_rad ? Vector(v * (gains.tilt_max_rad / angle)) : v;
  }

  ATTEST_INLINE static Q tilt(const Vector& rotation) { return rotation_about(rotation); }

  // A VTOL corrects yaw slowly, so the sticks command a tilt relative to its present yaw. Returns
  // that tilt relative to the desired yaw.
  static Q tilt_for_yaw_error(const Q& tilt, const Q& desired_yaw, const Q& q_WB) {
    const Vector up(Scalar(0), Scalar(0), Scalar(1));
    const Q yaw = product(inverse(shortest_rotation(up, z_axis(q_WB))), q_WB);
    return shortest_rotation(up, z_axis(product(product(inverse(desired_yaw), yaw), tilt)));
  }

  // Applies first the tilt, then the yaw. The published quaternion is not normalised.
  ATTEST_INLINE static Q desired_attitude(const Q& yaw, const Q& tilt) {
    return product(yaw, tilt);
  }

  // Whether a step outside stabilized mode clears the low-pass of the tilt. `runs`: the unit
  // controls the attitude in this step.
  ATTEST_INLINE static bool clears_tilt(bool runs, const ProfileTraits& law) {
    return runs || law.locks_yaw;
  }

  // The thrust of a stick of -1..1: one straight line, or two that meet at the hover thrust.
  static Scalar throttle(Scalar stick, const Gains& gains, const ThrustLimits<Scalar>& limits) {
    const Scalar idle = -1, centre = 0, full = 1;
    if (gains.throttle_curve == ThrottleCurve::straight) {
      return Line<Scalar>{idle, full, limits.min, gains.thrust_max}.at(stick);
    }
    const bool fixed = gains.throttle_curve == ThrottleCurve::through_hover_parameter;
    const Scalar hover = fixed ? gains.thrust_hover : limits.hover;
    return stick > centre ? Line<Scalar>{centre, full, hover, gains.thrust_max}.at(stick)
                          : Line<Scalar>{idle, centre, limits.min, hover}.at(stick);
  }

  ATTEST_INLINE static Scalar limited_thrust(Scalar thrust, const ThrustLimits<Scalar>& limits) {
    return min(thrust, limits.max);
  }

  // v1.14.4: the stick becomes a position of 0..1. The firmware's int(2 * position) is undefined
  // from 2^31 on and for NaN. Here these values use the lower line, as on x86-64.
  static Scalar uncentred_throttle(Scalar stick, const Gains& gains) {
    const Scalar idle = 0, full = 1, centre = Scalar(0.5f);
    const Scalar position = (stick + Scalar(1)) * Scalar(0.5f);
    if (gains.throttle_curve == ThrottleCurve::straight) {
      return Line<Scalar>{idle, full, gains.thrust_min, gains.thrust_max}.at(position);
    }
    const Scalar part = position * Scalar(2);
    const bool upper = part >= Scalar(1) && part < Scalar(2147483648.0f);
    return upper ? Line<Scalar>{centre, full, gains.thrust_hover, gains.thrust_max}.at(position)
                 : Line<Scalar>{idle, centre, gains.thrust_min, gains.thrust_hover}.at(position);
  }
};

}  // namespace attest::cascade
