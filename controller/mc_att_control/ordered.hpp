// Products over small vectors and matrices whose order of operations is part of the law.
//
// PX4 v1.5.5 computes each dot product, matrix product and squared length as a sum that starts at
// 0 and adds the products in index order. Floating point addition is not associative, and
// 0 + (-0) is +0, so both the start and the order change bits of the result. Eigen provides the
// types and the element-wise operations. Its products and norms are not used: they may reorder.
//
// Pure functions, no units; any thread.
#pragma once

#include <cmath>

#include <Eigen/Core>

#include "controller/mc_att_control/inline.hpp"

namespace attest::mc_att_control {

template <typename Scalar>
using Vector3 = Eigen::Matrix<Scalar, 3, 1>;

template <typename Scalar>
using Matrix3 = Eigen::Matrix<Scalar, 3, 3>;

namespace ordered {

// a . b
template <typename Scalar>
ATTEST_INLINE Scalar dot(const Vector3<Scalar>& a, const Vector3<Scalar>& b) {
  return Scalar(0) + a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <typename Scalar>
ATTEST_INLINE Scalar length(const Vector3<Scalar>& v) {
  using std::sqrt;
  return sqrt(dot(v, v));
}

// a x b. Each component is one difference, so there is no sum to order.
template <typename Scalar>
ATTEST_INLINE Vector3<Scalar> cross(const Vector3<Scalar>& a, const Vector3<Scalar>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// A v. Its sums, and those of transpose_times(), start at the first product, not at 0. This shows
// in the sign of a zero rate setpoint, at tilt errors of exactly 0 and 180 deg.
template <typename Scalar>
ATTEST_INLINE Vector3<Scalar> times(const Matrix3<Scalar>& A, const Vector3<Scalar>& v) {
  return {A(0, 0) * v[0] + A(0, 1) * v[1] + A(0, 2) * v[2],
          A(1, 0) * v[0] + A(1, 1) * v[1] + A(1, 2) * v[2],
          A(2, 0) * v[0] + A(2, 1) * v[1] + A(2, 2) * v[2]};
}

// A^T v
template <typename Scalar>
ATTEST_INLINE Vector3<Scalar> transpose_times(const Matrix3<Scalar>& A, const Vector3<Scalar>& v) {
  return {A(0, 0) * v[0] + A(1, 0) * v[1] + A(2, 0) * v[2],
          A(0, 1) * v[0] + A(1, 1) * v[1] + A(2, 1) * v[2],
          A(0, 2) * v[0] + A(1, 2) * v[1] + A(2, 2) * v[2]};
}

// One column of A B, from that column of B.
template <typename Scalar>
ATTEST_INLINE Vector3<Scalar> product_column(const Matrix3<Scalar>& A,
                                             const Vector3<Scalar>& column) {
  const Vector3<Scalar>& b = column;
  return {Scalar(0) + A(0, 0) * b[0] + A(0, 1) * b[1] + A(0, 2) * b[2],
          Scalar(0) + A(1, 0) * b[0] + A(1, 1) * b[1] + A(1, 2) * b[2],
          Scalar(0) + A(2, 0) * b[0] + A(2, 1) * b[1] + A(2, 2) * b[2]};
}

// A^T B
template <typename Scalar>
ATTEST_INLINE Matrix3<Scalar> transpose_product(const Matrix3<Scalar>& A,
                                                const Matrix3<Scalar>& B) {
  const Matrix3<Scalar> A_transposed = A.transpose();
  Matrix3<Scalar> C;
  C.col(0) = product_column<Scalar>(A_transposed, B.col(0));
  C.col(1) = product_column<Scalar>(A_transposed, B.col(1));
  C.col(2) = product_column<Scalar>(A_transposed, B.col(2));
  return C;
}

}  // namespace ordered
}  // namespace attest::mc_att_control
