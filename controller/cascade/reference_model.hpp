// The reference model of v1.18: an attitude that follows the setpoint as a critically damped system
// of second order would, with a rate that the law feeds forward. The attitude itself is with the
// law, which tracks it.
//
// The model moves only when a setpoint is taken, by the time between the timestamps of two
// setpoints. Between setpoints it stands still. A NaN never leaves it.
//
// Frames: W world NED, B body FRD, R reference model. q_WR maps R into world. Rates [rad/s], times
// [s]. No clock, no allocation; one thread at a time.
#pragma once

#include <cmath>
#include <cstdint>
#include <utility>

#include "controller/cascade/gains.hpp"
#include "controller/cascade/rotation.hpp"
#include "controller/elementary/elementary.hpp"
#include "controller/mc_att_control/inline.hpp"

namespace attest::cascade {

// How much of an error and of a rate at the begin of a span of time is left at its end.
template <typename Scalar>
struct ModelDecay {
  Scalar error_of_error;  // 1
  Scalar error_of_rate;   // [s]
  Scalar rate_of_error;   // [1/s]
  Scalar rate_of_rate;    // 1
};

// The stages of the model. Each is a pure function of its arguments.
template <typename Scalar>
struct ReferenceModelStages {
  using Vector = Vector3<Scalar>;
  using Q = Quaternion<Scalar>;
  using Gains = ReferenceModelGains<Scalar>;

  // Whether no setpoint was taken before.
  ATTEST_INLINE static bool is_first(std::uint64_t last_us) { return last_us == 0; }

  // The time since the last setpoint [s]. It is rounded to Scalar before it is scaled, and has no
  // limits.
  ATTEST_INLINE static Scalar elapsed(std::uint64_t elapsed_us) {
    return Scalar(elapsed_us) * Scalar(1e-6f);
  }

  // The world's z axis in R.
  ATTEST_INLINE static Vector world_z(const Q& q_WR) { return z_axis(inverse(q_WR)); }

  // The commanded rate in R. A yaw rate that is not finite is ignored.
  ATTEST_INLINE static Vector command(const Vector& z_R, Scalar yaw_rate) {
    return is_finite(yaw_rate) ? Vector(z_R * yaw_rate) : Vector(Vector::Zero());
  }

  // Twice the sine of half the angle to the setpoint, about its axis in R.
  ATTEST_INLINE static Vector error(const Q& q_WR, const Q& q_WD) {
    return Scalar(2) * imaginary_part(canonical(product(inverse(q_WR), q_WD)));
  }

  static ModelDecay<Scalar> decay(Scalar elapsed_s, const Gains& gains) {
    using elementary::exp;
    const Scalar natural = gains.natural_rad_s;
    const Scalar k = natural * elapsed_s;
    const Scalar E = exp(-k);
    return {(Scalar(1) + k) * E, elapsed_s * E, ((natural * natural) * elapsed_s) * E,
            (Scalar(1) - k) * E};
  }

  // The rotation vector in R by which the model turns.
  ATTEST_INLINE static Vector turn(const Vector& error, const Vector& rate, const Vector& command,
                                   Scalar elapsed_s, const ModelDecay<Scalar>& left) {
    return ((Scalar(1) - left.error_of_error) * error + left.error_of_rate * rate) +
           command * elapsed_s;
  }

  ATTEST_INLINE static Vector rate(const Vector& error, const Vector& rate,
                                   const ModelDecay<Scalar>& left) {
    return left.rate_of_error * error + left.rate_of_rate * rate;
  }

  // While a yaw rate is commanded, the model's own rate has no part about the world's z axis.
  ATTEST_INLINE static Vector without_yaw(const Vector& rate, const Vector& z_R, Scalar yaw_rate) {
    using std::abs;
    if (!is_finite(yaw_rate) || !(abs(yaw_rate) > Scalar(epsilon))) return rate;
    return rate - z_R * dot(rate, z_R);
  }

  ATTEST_INLINE static Q turned(const Q& q_WR, const Vector& turn) {
    return unit(product(q_WR, rotation_about(turn)));
  }

  // `rate` of R in the body frame.
  ATTEST_INLINE static Vector in_body(const Q& q_WB, const Q& q_WR, const Vector& rate) {
    const Q q_BR = product(inverse(q_WB), q_WR);
    const Q v{Scalar(0), rate[0], rate[1], rate[2]};
    return imaginary_part(product(product(q_BR, v), inverse(q_BR)));
  }

  // The share of the model's own rate that is fed forward. A limit of 0 means no limit.
  ATTEST_INLINE static Vector share(const Vector& rate_B, const Gains& gains) {
    const Vector f = rate_B * gains.feed_forward;
    const Scalar max = gains.feed_forward_max_rad_s;
    if (!(max > Scalar(0))) return f;
    return {clamp(f[0], -max, max), clamp(f[1], -max, max), clamp(f[2], -max, max)};
  }
};

// Stages is a policy: the stages of the model, or a copy with one replaced.
template <typename Scalar, typename Stages = ReferenceModelStages<Scalar>>
class ReferenceModel {
 public:
  using Vector = Vector3<Scalar>;
  using Q = Quaternion<Scalar>;

  explicit ReferenceModel(Stages stages = {}) : stages_(std::move(stages)) {}

  void set_gains(const ReferenceModelGains<Scalar>& gains) { gains_ = gains; }

  bool is_first(std::uint64_t last_us) const { return stages_.is_first(last_us); }

  // Takes the first setpoint. Returns the attitude of the model, which is the setpoint.
  Q start(const Q& q_WD) {
    rate_R_ = command_R_ = Vector::Zero();
    return q_WD;
  }

  // Takes another setpoint, of norm 1: the model moves from q_WR towards it. Returns its new
  // attitude. REQUIRES: set_gains() was called.
  Q follow(const Q& q_WR, const Q& q_WD, Scalar yaw_rate, std::uint64_t elapsed_us) {
    const Scalar elapsed_s = stages_.elapsed(elapsed_us);
    const Vector z_R = stages_.world_z(q_WR);
    command_R_ = stages_.command(z_R, yaw_rate);
    const Vector error = stages_.error(q_WR, q_WD);
    const ModelDecay<Scalar> left = stages_.decay(elapsed_s, gains_);
    const Vector turn = stages_.turn(error, rate_R_, command_R_, elapsed_s, left);
    rate_R_ = stages_.without_yaw(stages_.rate(error, rate_R_, left), z_R, yaw_rate);
    return stages_.turned(q_WR, turn);
  }

  // `rates` of the body with those of the model at q_WR. The command is added in full, in the frame
  // that the model has now, although it was computed for the frame before the model turned.
  Vector feed_forward(const Vector& rates, const Q& q_WB, const Q& q_WR) const {
    const Vector commanded = rates + stages_.in_body(q_WB, q_WR, command_R_);
    return commanded + stages_.share(stages_.in_body(q_WB, q_WR, rate_R_), gains_);
  }

 private:
  ReferenceModelGains<Scalar> gains_{};
  Vector rate_R_ = Vector::Zero();     // the model's own rate, without the commanded one
  Vector command_R_ = Vector::Zero();  // the commanded yaw rate
  [[no_unique_address]] Stages stages_;
};

}  // namespace attest::cascade
