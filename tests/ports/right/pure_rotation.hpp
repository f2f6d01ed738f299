// Vectors and quaternions of pure_laws.cpp. A quaternion may have any norm. If it is 0, unit() and
// inverse() give NaN, as in the law.
#pragma once

#include <cmath>

#include <Eigen/Dense>
#ifdef FRACTION_BITS
#include "tests/ports/right/rounded.hpp"
#endif

namespace pure {
#ifdef FRACTION_BITS
using Number = Rounded;
#else
using Number = double;
using std::abs, std::acos, std::asin, std::atan2, std::cos, std::exp, std::fmax, std::fmin,
    std::isfinite, std::sin, std::sqrt;
#endif

using Vector = Eigen::Matrix<Number, 3, 1>;
using Matrix = Eigen::Matrix<Number, 3, 3>;

const Number epsilon = 1.1920929e-7;  // FLT_EPSILON

// Passes NaN.
inline Number clamp(Number value, Number low, Number high) {
  return value < low ? low : (value > high ? high : value);
}

inline Vector clamp(const Vector& value, const Vector& limit) {
  Vector result;
  for (int i = 0; i < 3; ++i) result[i] = clamp(value[i], -limit[i], limit[i]);
  return result;
}

inline Vector vector_of(const float (&values)[3]) { return {values[0], values[1], values[2]}; }

struct Quaternion {
  Number w = 1.0;
  Vector v = Vector::Zero();

  static Quaternion of(const float (&q)[4]) { return {q[0], {q[1], q[2], q[3]}}; }
};

inline Number norm_squared(const Quaternion& q) { return q.w * q.w + q.v.squaredNorm(); }

inline Quaternion operator*(const Quaternion& q, Number factor) {
  return {q.w * factor, q.v * factor};
}

inline Quaternion operator*(const Quaternion& q, const Quaternion& p) {
  return {q.w * p.w - q.v.dot(p.v), q.w * p.v + p.w * q.v + q.v.cross(p.v)};
}

// Of norm 0: NaN, in both.
inline Quaternion unit(const Quaternion& q) { return q * (1.0 / sqrt(norm_squared(q))); }
inline Quaternion inverse(const Quaternion& q) {
  return Quaternion{q.w, -q.v} * (1.0 / norm_squared(q));
}

// The first component other than 0 is positive.
inline Quaternion canonical(const Quaternion& q) {
  for (const Number& component : {q.w, q.v[0], q.v[1], q.v[2]}) {
    if (abs(component) > epsilon) return q * (component > 0.0 ? 1.0 : -1.0);
  }
  return q;
}

// R(q). Of another norm than 1, it also scales.
inline Matrix matrix(const Quaternion& q) {
  const Number a = q.w, b = q.v[0], c = q.v[1], d = q.v[2];
  Matrix m;
  m << a * a + b * b - c * c - d * d, 2 * (b * c - a * d), 2 * (a * c + b * d),  //
      2 * (b * c + a * d), a * a - b * b + c * c - d * d, 2 * (c * d - a * b),   //
      2 * (b * d - a * c), 2 * (a * b + c * d), a * a - b * b - c * c + d * d;
  return m;
}

inline Vector z_axis(const Quaternion& q) { return matrix(q).col(2); }

// v in the frame into which q rotates.
inline Vector turn(const Quaternion& q, const Vector& v) {
  return (q * Quaternion{0.0, v} * inverse(q)).v;
}

inline Quaternion rotation(const Vector& v) {
  const Number angle = v.norm();
  if (angle <= Number(1e-10)) return {};  // which may be rounded to 0
  return {cos(angle / 2), v / angle * sin(angle / 2)};
}

// The shortest rotation that turns a into b.
inline Quaternion between(const Vector& a, const Vector& b) {
  const Vector c = a.cross(b);
  if (!(c.norm() < 1e-5 && a.dot(b) < 0.0)) {
    return unit({a.dot(b) + sqrt(a.squaredNorm() * b.squaredNorm()), c});
  }
  const Vector m = a.cwiseAbs();
  int axis = 2;
  if (m[0] < m[1] && m[0] < m[2]) axis = 0;
  if (!(m[0] < m[1]) && m[1] < m[2]) axis = 1;
  return unit({0.0, a.cross(Vector::Unit(axis))});
}

}  // namespace pure
