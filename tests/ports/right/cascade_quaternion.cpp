// The cascade from one quaternion, the attitude error in body axes. Its swing is the tilt and its
// twist is the torsion: no thrust axis is turned, and the law's six products and inverses are one
// product. Sticks and rate unit have other forms and other orders of sums, too.
// Must pass at the numeric level.
#include <cmath>

#include <Eigen/Geometry>

#include "tests/ports/cascade_port.hpp"

namespace {

using namespace attest::cascade;
using Vector = Vector3<float>;
using Q = Quaternion<float>;
using Rotation = Eigen::Quaternionf;

Rotation rotation(const Q& q) { return {q[0], q[1], q[2], q[3]}; }

struct SwingTwist : AttitudeStages<float> {
  // {cos, sin about x, sin about y} of half the tilt, and {cos, sin} of half the torsion.
  struct Parts {
    Vector tilt_B;
    Eigen::Vector2f torsion;
  };

  // The law's case of opposite thrust axes, whose length is the squared norm of the attitude.
  static bool is_half_turn(const Q& e, float squared_norm) {
    constexpr float least_sine = 1e-5f;
    const float swing = std::sqrt(e[1] * e[1] + e[2] * e[2]);
    const float twist = std::sqrt(e[0] * e[0] + e[3] * e[3]);
    return twist < swing && squared_norm * (2 * swing * twist) < least_sine;
  }

  // Of the error e, of norm 1: e is the swing times the twist.
  static Parts parts(const Q& e, const Q& q_WB) {
    if (is_half_turn(e, squared_norm(q_WB))) {
      const Vector z_W = z_axis(q_WB);
      const Vector axis_W = cross(z_W, farthest_axis(z_W)).normalized();
      const Vector a = rotation(q_WB).normalized().conjugate() * axis_W;
      return {{0, a[0], a[1]}, {a[0] * e[1] + a[1] * e[2], a[1] * e[1] - a[0] * e[2]}};
    }
    const float cosine = std::sqrt(e[0] * e[0] + e[3] * e[3]);
    const float w = e[0] / cosine, z = e[3] / cosine;
    return {{cosine, w * e[1] - z * e[2], w * e[2] + z * e[1]}, {w, z}};
  }

  // The law asks for the axis in the world. Below 179 deg of tilt no component is near enough to 1.
  static bool is_opposite(const Vector& tilt_B, const Q& q_WB) {
    if (tilt_B[0] > 0.0087f) return false;
    const Vector axis_W = rotation(q_WB).normalized() * Vector(tilt_B[1], tilt_B[2], 0);
    return AttitudeStages<float>::is_opposite({tilt_B[0], axis_W[0], axis_W[1], axis_W[2]});
  }

  // The part of the torsion that is corrected, as `torsion`. The attitude need not be of norm 1:
  // the law divides by its norm before acos and asin.
  static Eigen::Vector2f weighted(const Eigen::Vector2f& torsion, float norm, float weight) {
    const Q m = canonical(Q{torsion[0] / norm, 0, 0, torsion[1] / norm});
    const Q yaw = weighted_yaw(in_domain(m[0]), in_domain(m[3]), weight);
    return {yaw[0], yaw[3]};
  }

  // The swing times the part of the twist.
  static Q error(const Vector& tilt_B, const Eigen::Vector2f& yaw) {
    return canonical(Q{tilt_B[0] * yaw[0], tilt_B[1] * yaw[0] + tilt_B[2] * yaw[1],
                       tilt_B[2] * yaw[0] - tilt_B[1] * yaw[1], tilt_B[0] * yaw[1]});
  }

  // The world's z axis is the last row of the rotation matrix.
  static Vector feed_forward(const Vector& rates, const Q& q, float yaw_rate) {
    if (!is_finite(yaw_rate)) return rates;
    const float n = squared_norm(q), factor = yaw_rate / (n * n);
    return rates + Vector(2 * (q[1] * q[3] - q[0] * q[2]), 2 * (q[2] * q[3] + q[0] * q[1]),
                          (q[0] * q[0] + q[3] * q[3]) - (q[1] * q[1] + q[2] * q[2])) *
                       factor;
  }
};

// With matrices and unit vectors, and the share of the error that is gone instead of what is left.
struct Model : ReferenceModelStages<float> {
  static Vector world_z(const Q& q_WR) {
    return rotation(q_WR).normalized().toRotationMatrix().row(2).transpose();
  }

  static Vector error(const Q& q_WR, const Q& q_WD) {
    const Rotation e = rotation(q_WR).conjugate() * rotation(q_WD);
    return 2 * imaginary_part(canonical(Q(e.w(), e.x(), e.y(), e.z())));
  }

  static ModelDecay<float> decay(float elapsed_s, const Gains& gains) {
    const float k = gains.natural_rad_s * elapsed_s, E = std::exp(-k);
    return {E + k * E, elapsed_s * E, gains.natural_rad_s * (k * E), E - k * E};
  }

  static Vector without_yaw(const Vector& rate, const Vector& z_R, float yaw_rate) {
    if (!is_finite(yaw_rate) || !(std::abs(yaw_rate) > epsilon)) return rate;
    return z_R.cross(rate).cross(z_R);
  }

  static Q turned(const Q& q_WR, const Vector& turn) {
    const float angle = turn.norm();
    const float sinc = angle < 1e-6f ? 0.5f : std::sin(0.5f * angle) / angle;
    const Rotation whole = rotation(q_WR) * Rotation(std::cos(0.5f * angle), turn[0] * sinc,
                                                     turn[1] * sinc, turn[2] * sinc);
    return unit(Q(whole.w(), whole.x(), whole.y(), whole.z()));
  }

  static Vector in_body(const Q& q_WB, const Q& q_WR, const Vector& rate) {
    return rotation(q_WB).normalized().conjugate() * (rotation(q_WR) * rate);
  }
};

}  // namespace

// The law's composition of stages passes quaternions in world axes. This port has none.
template <>
Quaternion<float> attest::cascade::AttitudeLaw<float, SwingTwist, Model>::error(
    const Q& q_WB) const {
  const float norm = std::sqrt(squared_norm(q_WB));
  const Rotation from_body = rotation(q_WB).conjugate() * rotation(q_WD_);
  const Q whole{from_body.w(), from_body.x(), from_body.y(), from_body.z()};
  const SwingTwist::Parts parts = SwingTwist::parts(whole / norm, q_WB);
  if (SwingTwist::is_opposite(parts.tilt_B, q_WB)) return canonical(Q(whole / (norm * norm)));
  const auto yaw = SwingTwist::weighted(parts.torsion, norm, gains_.yaw_weight);
  return SwingTwist::error(parts.tilt_B, yaw);
}

namespace {

struct ClosedSticks : StickStages<float> {
  // At a pole by the sine of pitch, without asin. A sine above 1 is no angle, and so not at a pole.
  static float heading(const Q& q, const ProfileTraits& law) {
    constexpr float near_pole = 0.9999995f;  // cos 0.001
    const float sine = 2 * (q[0] * q[2] - q[1] * q[3]);
    if (std::abs(sine) > near_pole && std::abs(sine) <= 1) {
      const float R12 = 2 * (q[2] * q[3] - q[0] * q[1]), R02 = 2 * (q[1] * q[3] + q[0] * q[2]);
      return sine > 0 ? std::atan2(R12, R02) : std::atan2(-R12, -R02);
    }
    const float R00 = law.squares_heading
                          ? (q[0] - q[3]) * (q[0] + q[3]) + (q[1] - q[2]) * (q[1] + q[2])
                          : 0.5f + ((0.5f - 2 * q[2] * q[2]) - 2 * q[3] * q[3]);
    return std::atan2(2 * q[1] * q[2] + 2 * q[0] * q[3], R00);
  }

  static Q tilt(const Vector& rotation) {
    const float angle = std::hypot(rotation[0], rotation[1]);
    if (angle < 1e-10f) return identity<float>();
    const float sinc = std::sin(0.5f * angle) / angle;
    return {std::cos(0.5f * angle), rotation[0] * sinc, rotation[1] * sinc, 0};
  }

  // yaw is about z, so half of the products are zero.
  static Q desired_attitude(const Q& yaw, const Q& tilt) {
    const float c = yaw[0], s = yaw[3];
    return {c * tilt[0] - s * tilt[3], c * tilt[1] - s * tilt[2], c * tilt[2] + s * tilt[1],
            c * tilt[3] + s * tilt[0]};
  }

  // The direction of the desired thrust, turned about z by the yaw error. The present yaw is the
  // twist of the attitude. An inverted vehicle has none; then the law's own choice counts.
  static Q tilt_for_yaw_error(const Q& tilt, const Q& yaw, const Q& q_WB) {
    const float twist = std::hypot(q_WB[0], q_WB[3]), swing = std::hypot(q_WB[1], q_WB[2]);
    if (!(twist > 1e-3f * swing)) {
      return StickStages<float>::tilt_for_yaw_error(tilt, yaw, q_WB);
    }
    const float w = (yaw[0] * q_WB[0] + yaw[3] * q_WB[3]) / twist;
    const float z = (yaw[0] * q_WB[3] - yaw[3] * q_WB[0]) / twist;
    const float c = (w - z) * (w + z), s = 2 * w * z;
    const Vector thrust = z_axis(tilt);
    const float x = c * thrust[0] - s * thrust[1], y = s * thrust[0] + c * thrust[1];
    return rotation_from_up({x, y, thrust[2]});
  }

  static Q rotation_from_up(const Vector& direction) {
    const float w = direction[2] + direction.norm();
    const float factor = 1 / std::hypot(w, std::hypot(direction[0], direction[1]));
    return {w * factor, -direction[1] * factor, direction[0] * factor, 0};
  }
};

// Other orders of sums and products.
struct Rate : RateStages<float> {
  static Vector torque(const Vector& p, const Vector& integral, const Vector& d, const Vector& ff) {
    return (p - d) + (ff + integral);
  }
  static float i_factor(float error) {
    const float share = error * (1 / 6.98131704f);
    return max(0.0f, (1 - share) * (1 + share));
  }
  static float integrated(float integral, float factor, float gain, float error, float dt_s) {
    return integral + (gain * dt_s) * (factor * error);
  }
};

struct AttitudePolicies {
  AttitudeStepStages<float> step;
  ClosedSticks sticks;
  SwingTwist attitude;
  Model model;
};
struct RatePolicies {
  RateStepStages<float> step;
  Rate rate;
};

}  // namespace

ATTEST_CASCADE_PORT(
    "quaternion swing and twist",
    (cascade_extension<AttitudeUnit<float, AttitudePolicies>, RateUnit<float, RatePolicies>>))
