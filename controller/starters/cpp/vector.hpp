/* SPDX-License-Identifier: BSD-3-Clause */
// vector.hpp - the vectors, matrices and quaternions of the law: small values in binary32.
//
// World is NED, body is FRD. Quaternions are Hamilton, {w, x, y, z}, and rotate body into world.
// The order of every sum is part of the law: products are added in index order. In a dot product
// and in a product of two matrices the sum starts at 0. In matrix times vector it starts at the
// first product. The difference shows: 0 + (-0) is +0, so only matrix times vector gives -0.
#ifndef ATTEST_STARTER_CPP_VECTOR_HPP
#define ATTEST_STARTER_CPP_VECTOR_HPP

#include <array>
#include <cmath>
#include <cstddef>

namespace starter {

inline constexpr float pi = 3.14159265358979323846f;

constexpr float rad(float degrees) noexcept { return (degrees / 180.0f) * pi; }

// Passes NaN through. Unlike std::clamp, it is defined for low > high too.
constexpr float clamp(float v, float low, float high) noexcept {
  return v < low ? low : (v > high ? high : v);
}

struct Vec3 {
  std::array<float, 3> v{};

  constexpr float& operator[](std::size_t i) noexcept { return v[i]; }
  constexpr float operator[](std::size_t i) const noexcept { return v[i]; }
};

// The vector of f(0), f(1), f(2).
template <typename Function>
constexpr Vec3 each_axis(Function f) noexcept {
  return {{f(0), f(1), f(2)}};
}

constexpr Vec3 operator-(const Vec3& a, const Vec3& b) noexcept {
  return {{a[0] - b[0], a[1] - b[1], a[2] - b[2]}};
}

constexpr Vec3 operator*(const Vec3& a, float k) noexcept {
  return {{a[0] * k, a[1] * k, a[2] * k}};
}

constexpr Vec3 operator/(const Vec3& a, float k) noexcept {
  return {{a[0] / k, a[1] / k, a[2] / k}};
}

constexpr float dot(const Vec3& a, const Vec3& b) noexcept {
  return 0.0f + a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

constexpr Vec3 cross(const Vec3& a, const Vec3& b) noexcept {
  return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
}

inline float length(const Vec3& a) noexcept { return std::sqrt(dot(a, a)); }

struct Mat3 {
  std::array<Vec3, 3> rows{};

  constexpr float operator()(std::size_t i, std::size_t j) const noexcept { return rows[i][j]; }

  constexpr Vec3 column(std::size_t j) const noexcept {
    return {{rows[0][j], rows[1][j], rows[2][j]}};
  }

  constexpr Mat3 transposed() const noexcept { return {{column(0), column(1), column(2)}}; }
};

// The matrix of f(row, column).
template <typename Function>
constexpr Mat3 each_element(Function f) noexcept {
  const auto row = [&f](std::size_t i) {
    return each_axis([&f, i](std::size_t j) { return f(i, j); });
  };
  return {{row(0), row(1), row(2)}};
}

constexpr Vec3 operator*(const Mat3& a, const Vec3& x) noexcept {
  return each_axis([&](std::size_t i) { return a(i, 0) * x[0] + a(i, 1) * x[1] + a(i, 2) * x[2]; });
}

constexpr Mat3 operator*(const Mat3& a, const Mat3& b) noexcept {
  return each_element([&](std::size_t i, std::size_t j) { return dot(a.rows[i], b.column(j)); });
}

struct Quat {
  float w = 0.0f;
  Vec3 im{};  // the imaginary part: x, y, z
};

constexpr Quat conjugate(const Quat& q) noexcept { return {q.w, {{-q.im[0], -q.im[1], -q.im[2]}}}; }

constexpr Quat operator*(const Quat& p, const Quat& q) noexcept {
  const auto& [pw, pim] = p;
  const auto& [qw, qim] = q;
  return {pw * qw - pim[0] * qim[0] - pim[1] * qim[1] - pim[2] * qim[2],
          {{pw * qim[0] + pim[0] * qw + pim[1] * qim[2] - pim[2] * qim[1],
            pw * qim[1] - pim[0] * qim[2] + pim[1] * qw + pim[2] * qim[0],
            pw * qim[2] + pim[0] * qim[1] - pim[1] * qim[0] + pim[2] * qw}}};
}

// Body to world. The quaternion is not normalised first: an all-zero one gives an all-zero matrix.
constexpr Mat3 rotation_matrix(const Quat& q) noexcept {
  const float a = q.w, b = q.im[0], c = q.im[1], d = q.im[2];
  const float aa = a * a, bb = b * b, cc = c * c, dd = d * d;
  return {{{{{aa + bb - cc - dd, 2.0f * (b * c - a * d), 2.0f * (a * c + b * d)}},
            {{2.0f * (b * c + a * d), aa - bb + cc - dd, 2.0f * (c * d - a * b)}},
            {{2.0f * (b * d - a * c), 2.0f * (a * b + c * d), aa - bb - cc + dd}}}}};
}

// The quaternion of a rotation matrix.
inline Quat quaternion_of(const Mat3& D) noexcept {
  Quat q;
  const float trace = D(0, 0) + D(1, 1) + D(2, 2);
  if (trace > 0.0f) {
    const float root = std::sqrt(trace + 1.0f);
    const float s = 0.5f / root;
    q.w = root * 0.5f;
    q.im = {{(D(2, 1) - D(1, 2)) * s, (D(0, 2) - D(2, 0)) * s, (D(1, 0) - D(0, 1)) * s}};
    return q;
  }
  std::size_t i = 0;  // the largest diagonal element, the first if several are
  if (D(1, 1) > D(0, 0)) i = 1;
  if (D(2, 2) > D(i, i)) i = 2;
  const std::size_t j = (i + 1) % 3;
  const std::size_t k = (i + 2) % 3;
  const float root = std::sqrt((D(i, i) - D(j, j) - D(k, k)) + 1.0f);
  const float s = 0.5f / root;
  q.im[i] = root * 0.5f;
  q.im[j] = (D(i, j) + D(j, i)) * s;
  q.im[k] = (D(k, i) + D(i, k)) * s;
  q.w = (D(k, j) - D(j, k)) * s;
  return q;
}

}  // namespace starter

#endif  // ATTEST_STARTER_CPP_VECTOR_HPP
