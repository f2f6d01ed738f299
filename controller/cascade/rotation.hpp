// Vectors and rotations, with the expressions of the law.
//
// Quaternions are Hamilton, {w, x, y, z}, and rotate body FRD into world NED. Only unit() and
// shortest_rotation() normalise. Exactly these expressions define the law's result for a quaternion
// whose norm is not 1, and the sign of a zero.
//
// Pure functions; any thread.
#pragma once

#include <cmath>

#include <Eigen/Core>

#include "controller/cascade/profile.hpp"
#include "controller/cascade/scalar_math.hpp"
#include "controller/elementary/elementary.hpp"
#include "controller/mc_att_control/inline.hpp"
#include "controller/mc_att_control/ordered.hpp"

namespace attest::cascade {

using mc_att_control::Vector3;
using mc_att_control::ordered::dot;
using mc_att_control::ordered::length;

// A vector of four, so that the law's sums can be written by index. Unaligned, so that structs that
// contain one need no aligned allocation.
template <typename Scalar>
using Quaternion = Eigen::Matrix<Scalar, 4, 1, Eigen::DontAlign>;

template <typename Scalar>
ATTEST_INLINE Quaternion<Scalar> quaternion_from(const float (&wxyz)[4]) {
  return {Scalar(wxyz[0]), Scalar(wxyz[1]), Scalar(wxyz[2]), Scalar(wxyz[3])};
}

template <typename Scalar>
ATTEST_INLINE Vector3<Scalar> vector_from(const float (&xyz)[3]) {
  return {Scalar(xyz[0]), Scalar(xyz[1]), Scalar(xyz[2])};
}

template <typename Scalar>
ATTEST_INLINE Quaternion<Scalar> identity() {
  return {Scalar(1), Scalar(0), Scalar(0), Scalar(0)};
}

template <typename Scalar>
ATTEST_INLINE Vector3<Scalar> imaginary_part(const Quaternion<Scalar>& q) {
  return {q[1], q[2], q[3]};
}

template <typename Scalar>
ATTEST_INLINE Scalar squared_norm(const Quaternion<Scalar>& q) {
  return Scalar(0) + q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
}

// Computed by component: Eigen's q * factor takes all four as one vector, so components that were
// just computed pass through memory. With Eigen's product a step of the attitude unit was a tenth
// slower.
template <typename Scalar>
ATTEST_INLINE Quaternion<Scalar> scaled(const Quaternion<Scalar>& q, Scalar factor) {
  return {q[0] * factor, q[1] * factor, q[2] * factor, q[3] * factor};
}

// The quaternion scaled to norm 1. A zero quaternion gives NaN.
template <typename Scalar>
ATTEST_INLINE Quaternion<Scalar> unit(const Quaternion<Scalar>& q) {
  using std::sqrt;
  return scaled(q, Scalar(1) / sqrt(squared_norm(q)));
}

// q p: first p, then q. All sixteen products are computed, also those with a factor that is 0.
template <typename Scalar>
ATTEST_INLINE Quaternion<Scalar> product(const Quaternion<Scalar>& q, const Quaternion<Scalar>& p) {
  return {q[0] * p[0] - q[1] * p[1] - q[2] * p[2] - q[3] * p[3],
          q[1] * p[0] + q[0] * p[1] - q[3] * p[2] + q[2] * p[3],
          q[2] * p[0] + q[3] * p[1] + q[0] * p[2] - q[1] * p[3],
          q[3] * p[0] - q[2] * p[1] + q[1] * p[2] + q[0] * p[3]};
}

template <typename Scalar>
ATTEST_INLINE Quaternion<Scalar> inverse(const Quaternion<Scalar>& q) {
  const Scalar n = squared_norm(q);
  return {q[0] / n, -q[1] / n, -q[2] / n, -q[3] / n};
}

// q or -q, which are the same rotation: the first component beyond +-epsilon becomes positive.
template <typename Scalar>
ATTEST_INLINE Quaternion<Scalar> canonical(const Quaternion<Scalar>& q) {
  using std::abs;
  for (int i = 0; i < 4; ++i) {
    if (abs(q[i]) > Scalar(epsilon)) return scaled(q, Scalar(q[i] > Scalar(0) ? 1 : -1));
  }
  return q;
}

// The body's z axis in the world, times the squared norm.
template <typename Scalar>
ATTEST_INLINE Vector3<Scalar> z_axis(const Quaternion<Scalar>& q) {
  const Scalar two = 2;
  return {two * (q[0] * q[2] + q[1] * q[3]), two * (q[2] * q[3] - q[0] * q[1]),
          q[0] * q[0] - q[1] * q[1] - q[2] * q[2] + q[3] * q[3]};
}

template <typename Scalar>
ATTEST_INLINE Vector3<Scalar> cross(const Vector3<Scalar>& a, const Vector3<Scalar>& b) {
  return {a[1] * b[2] - a[2] * b[1], (-a[0]) * b[2] + a[2] * b[0], a[0] * b[1] - a[1] * b[0]};
}

// The coordinate axis farthest from the direction of v. At a tie, the last of the tied axes.
template <typename Scalar>
ATTEST_INLINE Vector3<Scalar> farthest_axis(const Vector3<Scalar>& v) {
  using std::abs;
  const Scalar x = abs(v[0]), y = abs(v[1]), z = abs(v[2]);
  const int axis = x < y ? (x < z ? 0 : 2) : (y < z ? 1 : 2);
  return {Scalar(axis == 0 ? 1 : 0), Scalar(axis == 1 ? 1 : 0), Scalar(axis == 2 ? 1 : 0)};
}

// The shortest rotation that turns the direction of a into that of b. Opposite directions have many
// such rotations: the result turns about an axis perpendicular to a.
template <typename Scalar>
ATTEST_INLINE Quaternion<Scalar> shortest_rotation(const Vector3<Scalar>& a,
                                                   const Vector3<Scalar>& b) {
  Vector3<Scalar> axis = cross(a, b);
  Scalar w = dot(a, b);
  if (w < Scalar(0) && length(axis) < Scalar(1e-5f)) {
    axis = cross(a, farthest_axis(a));
    w = Scalar(0);
  } else {
    using std::sqrt;
    w = w + sqrt(dot(a, a) * dot(b, b));
  }
  return unit<Scalar>({w, axis[0], axis[1], axis[2]});
}

// A rotation by |v| [rad] about the direction of v.
template <typename Scalar>
ATTEST_INLINE Quaternion<Scalar> rotation_about(const Vector3<Scalar>& v) {
  using elementary::cos;
  using elementary::sin;
  const Scalar angle = length(v);
  if (angle < Scalar(1e-10f)) return identity<Scalar>();
  const Vector3<Scalar> axis = v * (Scalar(1) / angle);
  const Scalar sine = sin(angle / Scalar(2));
  return {cos(angle / Scalar(2)), axis[0] * sine, axis[1] * sine, axis[2] * sine};
}

// A rotation by `yaw` [rad] about z.
template <typename Scalar>
ATTEST_INLINE Quaternion<Scalar> yaw_rotation(Scalar yaw) {
  using elementary::cos;
  using elementary::sin;
  return {cos(yaw / Scalar(2)), Scalar(0), Scalar(0), sin(yaw / Scalar(2))};
}

// 1 if the nose points straight up, -1 if straight down, within 0.001 rad; otherwise 0.
template <typename Scalar>
int pole_at(Scalar R20) {
  constexpr float half_pi = 1.57079637f, near_pole = 0.001f;
  using elementary::asin;
  using std::abs;
  const Scalar pitch = asin(-R20);
  if (abs(pitch - Scalar(half_pi)) < Scalar(near_pole)) return 1;
  return abs(pitch + Scalar(half_pi)) < Scalar(near_pole) ? -1 : 0;
}

// The yaw angle [rad] of the order yaw, pitch, roll. Near the poles yaw and roll are about the same
// axis, and the whole angle counts as yaw.
template <typename Scalar>
Scalar heading(const Quaternion<Scalar>& q, const ProfileTraits& law) {
  using elementary::atan2;
  using std::abs;
  const Scalar two = 2;
  const Scalar R20 = two * (q[1] * q[3] - q[0] * q[2]);
  // asin is expensive, so pole_at() is called only near a pole: asin(0.99) is 0.14 rad short of it.
  // NaN also takes this branch.
  constexpr float surely_far = 0.99f;
  if (!(abs(R20) < Scalar(surely_far))) {
    const Scalar R12 = two * (q[2] * q[3] - q[0] * q[1]);
    const Scalar R02 = two * (q[0] * q[2] + q[1] * q[3]);
    switch (pole_at(R20)) {
      case 1:
        return atan2(R12, R02);
      case -1:
        return atan2(-R12, -R02);
    }
  }
  const Scalar R10 = two * (q[1] * q[2] + q[0] * q[3]);
  const Scalar R00 = law.squares_heading ? q[0] * q[0] + q[1] * q[1] - q[2] * q[2] - q[3] * q[3]
                                         : Scalar(1) - two * (q[2] * q[2] + q[3] * q[3]);
  return atan2(R10, R00);
}

}  // namespace attest::cascade
