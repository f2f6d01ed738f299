// The attitude law: from an attitude and its setpoint to a setpoint of body rates.
//
// Tilt and yaw are separated. The tilt is corrected by the shortest rotation of the thrust axis. Of
// the remaining yaw error only a share (MC_YAW_WEIGHT) is corrected, because yaw is slow. The rates
// are proportional to the quaternion error between the attitude and this reduced target. In v1.18
// the law tracks a reference model that follows the setpoint.
//
// Frames: W world NED, B body FRD, D desired body. q_WB maps body into world. Rates [rad/s]. The
// state is the setpoint or the model. No clock, no allocation; one thread at a time.
#pragma once

#include <cmath>
#include <cstdint>
#include <utility>

#include "controller/cascade/gains.hpp"
#include "controller/cascade/reference_model.hpp"
#include "controller/cascade/rotation.hpp"
#include "controller/elementary/elementary.hpp"
#include "controller/mc_att_control/inline.hpp"

namespace attest::cascade {

// The stages of the law. Each is a pure function of its arguments.
template <typename Scalar>
struct AttitudeStages {
  using Vector = Vector3<Scalar>;
  using Q = Quaternion<Scalar>;

  // Normalises the setpoint. The attitude is not normalised anywhere.
  ATTEST_INLINE static Q setpoint(const Q& given) { return unit(given); }

  // The setpoint after a reset of the estimator by the rotation `delta`.
  ATTEST_INLINE static Q adapted(const Q& delta, const Q& q_WD) {
    return unit(product(delta, q_WD));
  }

  // The shortest rotation of the thrust axis to the desired one, in world axes.
  ATTEST_INLINE static Q tilt_rotation(const Q& q_WB, const Q& q_WD) {
    return shortest_rotation(z_axis(q_WB), z_axis(q_WD));
  }

  // Whether the thrust directions are opposite: the shortest rotation is arbitrary there.
  ATTEST_INLINE static bool is_opposite(const Q& tilt) {
    constexpr float almost_one = 0.999989986f;  // 1 - 1e-5
    using std::abs;
    return abs(tilt[1]) > Scalar(almost_one) || abs(tilt[2]) > Scalar(almost_one);
  }

  // The attitude after the tilt alone is corrected.
  ATTEST_INLINE static Q tilted(const Q& tilt, const Q& q_WB) { return product(tilt, q_WB); }

  // The yaw error that remains after the tilt is corrected. Without the canonical form, the two
  // signs of a quaternion would give two different targets.
  ATTEST_INLINE static Q remaining_yaw(const Q& tilted, const Q& q_WD) {
    return canonical(product(inverse(tilted), q_WD));
  }

  // Limits the component, because rounding may take it out of the domain of acos and asin.
  ATTEST_INLINE static Scalar in_domain(Scalar component) {
    return clamp(component, Scalar(-1), Scalar(1));
  }

  // The rotation by the share of the yaw error that is corrected.
  ATTEST_INLINE static Q weighted_yaw(Scalar w, Scalar z, Scalar weight) {
    using elementary::acos;
    using elementary::asin;
    using elementary::cos;
    using elementary::sin;
    return {cos(weight * acos(w)), Scalar(0), Scalar(0), sin(weight * asin(z))};
  }

  ATTEST_INLINE static Q target(const Q& tilted, const Q& yaw) { return product(tilted, yaw); }

  // The shorter rotation from the attitude to the target, in body axes.
  ATTEST_INLINE static Q error(const Q& q_WB, const Q& target) {
    return canonical(product(inverse(q_WB), target));
  }

  ATTEST_INLINE static Vector proportional(const Q& error, const AttitudeGains<Scalar>& gains) {
    const Vector twice = imaginary_part(error) * Scalar(2);
    return twice.cwiseProduct(gains.proportional_1_s);
  }

  // The commanded yaw rate is about the world's z axis. A yaw rate that is not finite is ignored.
  ATTEST_INLINE static Vector feed_forward(const Vector& rates, const Q& q_WB, Scalar yaw_rate) {
    if (!is_finite(yaw_rate)) return rates;
    const Vector z_W_B = z_axis(inverse(q_WB));
    return rates + z_W_B * yaw_rate;
  }

  // Limits the sum with the feed-forward.
  ATTEST_INLINE static Vector limit(const Vector& rates, const AttitudeGains<Scalar>& gains) {
    const Vector& max = gains.rate_max_rad_s;
    return {clamp(rates[0], -max[0], max[0]), clamp(rates[1], -max[1], max[1]),
            clamp(rates[2], -max[2], max[2])};
  }
};

// Stages and ModelStages are policies: the stages of the law, or copies with one replaced.
template <typename Scalar, typename Stages = AttitudeStages<Scalar>,
          typename ModelStages = ReferenceModelStages<Scalar>>
class AttitudeLaw {
 public:
  using Q = Quaternion<Scalar>;
  using Vector = Vector3<Scalar>;

  explicit AttitudeLaw(bool follows_model = false, Stages stages = {},
                       ModelStages model_stages = {})
      : follows_model_(follows_model),
        model_(std::move(model_stages)),
        stages_(std::move(stages)) {}

  void set_gains(const AttitudeUnitGains<Scalar>& gains) {
    gains_ = gains.attitude;
    model_.set_gains(gains.model);
  }

  // q_d may have any norm; norm 0 makes the setpoint NaN. The yaw rate [rad/s] is about the world's
  // z axis. Times are those of this setpoint and of the last one, which is 0 for the first.
  // REQUIRES: set_gains() was called.
  void set_setpoint(const Q& q_d, Scalar yaw_rate, std::uint64_t time_us, std::uint64_t last_us) {
    const Q target = stages_.setpoint(q_d);
    if (!follows_model_) {
      q_WD_ = target;
      yaw_rate_ = yaw_rate;
    } else if (model_.is_first(last_us)) {
      q_WD_ = model_.start(target);
    } else {
      q_WD_ = model_.follow(q_WD_, target, yaw_rate, time_us - last_us);
    }
  }

  void adapt_setpoint(const Q& delta) { q_WD_ = stages_.adapted(delta, q_WD_); }

  // The setpoint of the body rates [rad/s]. REQUIRES: set_gains() was called.
  Vector update(const Q& q_WB) const {
    const Vector rates = stages_.proportional(error(q_WB), gains_);
    return stages_.limit(follows_model_ ? model_.feed_forward(rates, q_WB, q_WD_)
                                        : stages_.feed_forward(rates, q_WB, yaw_rate_),
                         gains_);
  }

 private:
  Q error(const Q& q_WB) const;

  bool follows_model_;
  AttitudeGains<Scalar> gains_{};
  Q q_WD_ = identity<Scalar>();  // the setpoint, or the attitude of the reference model
  Scalar yaw_rate_ = Scalar(0);
  ReferenceModel<Scalar, ModelStages> model_;
  [[no_unique_address]] Stages stages_;
};

// The rotation that the law corrects, in body axes: to the setpoint with a share of its yaw error.
template <typename Scalar, typename Stages, typename ModelStages>
ATTEST_INLINE Quaternion<Scalar> AttitudeLaw<Scalar, Stages, ModelStages>::error(
    const Q& q_WB) const {
  const Q tilt = stages_.tilt_rotation(q_WB, q_WD_);
  const Q tilted = stages_.is_opposite(tilt) ? q_WD_ : stages_.tilted(tilt, q_WB);
  const Q yaw = stages_.remaining_yaw(tilted, q_WD_);
  const Scalar w = stages_.in_domain(yaw[0]);
  const Scalar z = stages_.in_domain(yaw[3]);
  const Q target = stages_.target(tilted, stages_.weighted_yaw(w, z, gains_.yaw_weight));
  return stages_.error(q_WB, target);
}

}  // namespace attest::cascade
