/* SPDX-License-Identifier: BSD-3-Clause */
// linear.hpp - vectors, matrices and quaternions of the law, in binary32.
//
// World is NED, body is FRD. Quaternions are Hamilton, {w, x, y, z}, body to world. The order of
// every sum is part of the law: dot products and matrix products start at 0 and add in index order.
#ifndef ATTEST_TESTS_PORTS_MISTAKES_LINEAR_HPP
#define ATTEST_TESTS_PORTS_MISTAKES_LINEAR_HPP

#include <array>
#include <cmath>
#include <cstddef>

namespace mc {

constexpr float kPi = 3.14159265358979323846f;

constexpr float radians(float degrees) { return (degrees / 180.0f) * kPi; }

// Unlike std::clamp, defined for low above high too: a limit may be negative.
constexpr float clamp(float v, float low, float high) {
  return v < low ? low : (v > high ? high : v);
}

struct Vec3 {
  std::array<float, 3> v{};

  constexpr Vec3() = default;
  constexpr Vec3(float x, float y, float z) : v{x, y, z} {}

  constexpr float& operator[](std::size_t i) { return v[i]; }
  constexpr float operator[](std::size_t i) const { return v[i]; }

  float dot(const Vec3& other) const {
    float sum = 0.0f;
    for (std::size_t i = 0; i < 3; ++i) sum += v[i] * other[i];
    return sum;
  }

  Vec3 cross(const Vec3& b) const {
    return {v[1] * b[2] - v[2] * b[1], v[2] * b[0] - v[0] * b[2], v[0] * b[1] - v[1] * b[0]};
  }

  float norm() const { return std::sqrt(dot(*this)); }

  // Element by element.
  Vec3 emult(const Vec3& b) const { return {v[0] * b[0], v[1] * b[1], v[2] * b[2]}; }

  Vec3 operator-() const { return {-v[0], -v[1], -v[2]}; }
};

inline Vec3 operator+(const Vec3& a, const Vec3& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline Vec3 operator-(const Vec3& a, const Vec3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Vec3 operator*(const Vec3& a, float k) { return {a[0] * k, a[1] * k, a[2] * k}; }
inline Vec3 operator/(const Vec3& a, float k) { return {a[0] / k, a[1] / k, a[2] / k}; }

struct Mat3 {
  std::array<std::array<float, 3>, 3> m{};

  static Mat3 identity() {
    return {{{{1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, {0.0f, 0.0f, 1.0f}}}};
  }

  // The matrix K with K v = a x v.
  static Mat3 skew(const Vec3& a) {
    return {{{{0.0f, -a[2], a[1]}, {a[2], 0.0f, -a[0]}, {-a[1], a[0], 0.0f}}}};
  }

  float& operator()(std::size_t i, std::size_t j) { return m[i][j]; }
  float operator()(std::size_t i, std::size_t j) const { return m[i][j]; }

  Vec3 col(std::size_t j) const { return {m[0][j], m[1][j], m[2][j]}; }

  Mat3 transposed() const {
    Mat3 out;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) out(i, j) = m[j][i];
    }
    return out;
  }

  Vec3 operator*(const Vec3& x) const {
    Vec3 out;
    for (std::size_t i = 0; i < 3; ++i) out[i] = m[i][0] * x[0] + m[i][1] * x[1] + m[i][2] * x[2];
    return out;
  }

  Mat3 operator*(const Mat3& b) const {
    Mat3 out;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        for (std::size_t k = 0; k < 3; ++k) out(i, j) += m[i][k] * b(k, j);
      }
    }
    return out;
  }

  Mat3 operator*(float k) const {
    Mat3 out = *this;
    for (auto& row : out.m) {
      for (float& x : row) x *= k;
    }
    return out;
  }

  Mat3 operator+(const Mat3& b) const {
    Mat3 out;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) out(i, j) = m[i][j] + b(i, j);
    }
    return out;
  }
};

struct Quat {
  float w = 0.0f, x = 0.0f, y = 0.0f, z = 0.0f;

  Quat() = default;
  Quat(float w_, float x_, float y_, float z_) : w(w_), x(x_), y(y_), z(z_) {}
  explicit Quat(const float (&q)[4]) : w(q[0]), x(q[1]), y(q[2]), z(q[3]) {}

  // Of a rotation matrix.
  explicit Quat(const Mat3& D) {
    const float trace = D(0, 0) + D(1, 1) + D(2, 2);
    if (trace > 0.0f) {
      float s = std::sqrt(trace + 1.0f);
      w = s * 0.5f;
      s = 0.5f / s;
      x = (D(2, 1) - D(1, 2)) * s;
      y = (D(0, 2) - D(2, 0)) * s;
      z = (D(1, 0) - D(0, 1)) * s;
      return;
    }
    std::size_t i = 0;
    for (std::size_t n = 1; n < 3; ++n) {
      if (D(n, n) > D(i, i)) i = n;
    }
    const std::size_t j = (i + 1) % 3;
    const std::size_t k = (i + 2) % 3;
    float s = std::sqrt((D(i, i) - D(j, j) - D(k, k)) + 1.0f);
    std::array<float, 3> im{};
    im[i] = s * 0.5f;
    s = 0.5f / s;
    im[j] = (D(i, j) + D(j, i)) * s;
    im[k] = (D(k, i) + D(i, k)) * s;
    w = (D(k, j) - D(j, k)) * s;
    x = im[0];
    y = im[1];
    z = im[2];
  }

  Vec3 imag() const { return {x, y, z}; }
  Quat conjugate() const { return {w, -x, -y, -z}; }

  Quat operator*(const Quat& q) const {
    return {w * q.w - x * q.x - y * q.y - z * q.z, w * q.x + x * q.w + y * q.z - z * q.y,
            w * q.y - x * q.z + y * q.w + z * q.x, w * q.z + x * q.y - y * q.x + z * q.w};
  }

  // Body to world. The norm is used as it is.
  Mat3 to_dcm() const {
    const float a = w * w, b = x * x, c = y * y, d = z * z;
    return {{{{a + b - c - d, 2.0f * (x * y - w * z), 2.0f * (w * y + x * z)},
              {2.0f * (x * y + w * z), a - b + c - d, 2.0f * (y * z - w * x)},
              {2.0f * (x * z - w * y), 2.0f * (w * x + y * z), a - b - c + d}}}};
  }
};

}  // namespace mc

#endif  // ATTEST_TESTS_PORTS_MISTAKES_LINEAR_HPP
