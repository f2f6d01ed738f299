// Rotations, with the expressions of the law.
//
// Quaternions are Hamilton, scalar first, and rotate body FRD into world NED: v_W = R(q_WB) v_B.
// No function normalises: a quaternion whose norm is not 1 gives a scaled matrix. The result of the
// law for such an input is defined by exactly these expressions (PX4 v1.5.5 math library).
//
// Pure functions; any thread.
#pragma once

#include <Eigen/Geometry>

#include "controller/mc_att_control/inline.hpp"
#include "controller/mc_att_control/ordered.hpp"

namespace attest::mc_att_control {

// Unaligned, so that structs that contain one need no aligned allocation.
template <typename Scalar>
using Quaternion = Eigen::Quaternion<Scalar, Eigen::DontAlign>;

// Degrees to rad, in the order of operations of PX4's math::radians().
template <typename Scalar>
ATTEST_INLINE constexpr Scalar radians(Scalar degrees) {
  return (degrees / Scalar(180)) * Scalar(3.14159265358979323846f);
}

template <typename Scalar>
ATTEST_INLINE Quaternion<Scalar> quaternion_from(const float (&wxyz)[4]) {
  return {Scalar(wxyz[0]), Scalar(wxyz[1]), Scalar(wxyz[2]), Scalar(wxyz[3])};
}

// R(q) for a quaternion of any norm; the result is |q|^2 times a rotation.
template <typename Scalar>
ATTEST_INLINE Matrix3<Scalar> rotation_matrix(const Quaternion<Scalar>& q) {
  const Scalar a = q.w(), b = q.x(), c = q.y(), d = q.z();
  const Scalar aa = a * a, bb = b * b, cc = c * c, dd = d * d;
  const Scalar two = 2;
  Matrix3<Scalar> R;
  R(0, 0) = aa + bb - cc - dd;
  R(0, 1) = two * (b * c - a * d);
  R(0, 2) = two * (a * c + b * d);
  R(1, 0) = two * (b * c + a * d);
  R(1, 1) = aa - bb + cc - dd;
  R(1, 2) = two * (c * d - a * b);
  R(2, 0) = two * (b * d - a * c);
  R(2, 1) = two * (a * b + c * d);
  R(2, 2) = aa - bb - cc + dd;
  return R;
}

// The quaternion of a rotation matrix whose trace is not positive. It starts from the largest
// diagonal element, so that the square root stays away from zero.
template <typename Scalar>
Quaternion<Scalar> quaternion_of_half_turn(const Matrix3<Scalar>& D) {
  int i = 0;
  if (D(1, 1) > D(i, i)) i = 1;
  if (D(2, 2) > D(i, i)) i = 2;
  const int j = (i + 1) % 3;
  const int k = (i + 2) % 3;
  using std::sqrt;
  Scalar s = sqrt((D(i, i) - D(j, j) - D(k, k)) + Scalar(1));
  Scalar imaginary[3];
  imaginary[i] = s * Scalar(0.5f);
  s = Scalar(0.5f) / s;
  imaginary[j] = (D(i, j) + D(j, i)) * s;
  imaginary[k] = (D(k, i) + D(i, k)) * s;
  return {(D(k, j) - D(j, k)) * s, imaginary[0], imaginary[1], imaginary[2]};
}

// The quaternion of a rotation matrix: q or -q, which are the same rotation.
template <typename Scalar>
Quaternion<Scalar> quaternion_of(const Matrix3<Scalar>& D) {
  const Scalar trace = D(0, 0) + D(1, 1) + D(2, 2);
  if (!(trace > Scalar(0))) return quaternion_of_half_turn(D);
  using std::sqrt;
  Scalar s = sqrt(trace + Scalar(1));
  const Scalar w = s * Scalar(0.5f);
  s = Scalar(0.5f) / s;
  return {w, (D(2, 1) - D(1, 2)) * s, (D(0, 2) - D(2, 0)) * s, (D(1, 0) - D(0, 1)) * s};
}

template <typename Scalar>
ATTEST_INLINE Quaternion<Scalar> conjugate(const Quaternion<Scalar>& q) {
  return {q.w(), -q.x(), -q.y(), -q.z()};
}

// p * q: first q, then p.
template <typename Scalar>
ATTEST_INLINE Quaternion<Scalar> product(const Quaternion<Scalar>& p, const Quaternion<Scalar>& q) {
  return {p.w() * q.w() - p.x() * q.x() - p.y() * q.y() - p.z() * q.z(),
          p.w() * q.x() + p.x() * q.w() + p.y() * q.z() - p.z() * q.y(),
          p.w() * q.y() - p.x() * q.z() + p.y() * q.w() + p.z() * q.x(),
          p.w() * q.z() + p.x() * q.y() - p.y() * q.x() + p.z() * q.w()};
}

template <typename Scalar>
ATTEST_INLINE Vector3<Scalar> imaginary_part(const Quaternion<Scalar>& q) {
  return {q.x(), q.y(), q.z()};
}

// The matrix K with K v = axis x v.
template <typename Scalar>
ATTEST_INLINE Matrix3<Scalar> cross_product_matrix(const Vector3<Scalar>& axis) {
  Matrix3<Scalar> K;
  K << Scalar(0), -axis[2], axis[1],  //
      axis[2], Scalar(0), -axis[0],   //
      -axis[1], axis[0], Scalar(0);
  return K;
}

// The law's clamp. NaN passes unchanged: both comparisons are false.
template <typename Scalar>
ATTEST_INLINE constexpr Scalar clamp(Scalar value, Scalar low, Scalar high) {
  return value < low ? low : (value > high ? high : value);
}

template <typename Scalar>
ATTEST_INLINE Vector3<Scalar> clamp_each(const Vector3<Scalar>& v, const Vector3<Scalar>& bound) {
  return {clamp(v[0], -bound[0], bound[0]), clamp(v[1], -bound[1], bound[1]),
          clamp(v[2], -bound[2], bound[2])};
}

}  // namespace attest::mc_att_control
