// Numbers of a processor without floating point: 64 bits, of which FRACTION_BITS (by default 32)
// are fraction bits. Results are rounded and saturated; products have 128 bits.
#pragma once

#include <algorithm>
#include <cmath>
#include <compare>
#include <cstdint>
#include <limits>

#include <Eigen/Core>

#ifndef FRACTION_BITS
#define FRACTION_BITS 32
#endif

class Fixed {
 public:
  __extension__ using Wide = __int128;
  static constexpr int fraction_bits = FRACTION_BITS;

  constexpr Fixed() = default;
  constexpr Fixed(int value) : Fixed(of_raw(Wide{value} << fraction_bits)) {}  // NOLINT
  // Floats are converted only here: sensors, parameters and outputs.
  explicit constexpr Fixed(float value) : Fixed(double{value}) {}
  explicit constexpr Fixed(double value) : Fixed(of_raw(rounded(value))) {}
  explicit operator float() const {
    return static_cast<float>(std::ldexp(static_cast<double>(raw_), -fraction_bits));
  }

  static constexpr Fixed of_raw(Wide raw) {
    constexpr Wide most = std::numeric_limits<std::int64_t>::max();
    Fixed result;
    result.raw_ = static_cast<std::int64_t>(std::clamp<Wide>(raw, -most, most));
    return result;
  }
  constexpr Wide raw() const { return raw_; }

  constexpr Fixed operator-() const { return of_raw(-raw()); }
  friend constexpr Fixed operator+(Fixed a, Fixed b) { return of_raw(a.raw() + b.raw()); }
  friend constexpr Fixed operator-(Fixed a, Fixed b) { return of_raw(a.raw() - b.raw()); }
  friend constexpr Fixed operator*(Fixed a, Fixed b) {
    constexpr Wide half = Wide{1} << (fraction_bits - 1);
    return of_raw((a.raw() * b.raw() + half) >> fraction_bits);
  }
  friend constexpr Fixed operator/(Fixed a, Fixed b) {
    constexpr Wide infinite = Wide{1} << 64;
    if (b.raw() == 0) return of_raw(a.raw() < 0 ? -infinite : infinite);
    return of_raw(a.raw() * (Wide{1} << fraction_bits) / b.raw());
  }
  Fixed& operator+=(Fixed b) { return *this = *this + b; }
  Fixed& operator-=(Fixed b) { return *this = *this - b; }
  Fixed& operator*=(Fixed b) { return *this = *this * b; }
  Fixed& operator/=(Fixed b) { return *this = *this / b; }
  friend constexpr auto operator<=>(Fixed a, Fixed b) = default;

 private:
  // Saturated. NaN, which fixed point cannot represent, becomes the lowest value.
  static constexpr Wide rounded(double value) {
    constexpr double most = 9.2e18;
    const double scaled = value * static_cast<double>(Wide{1} << fraction_bits);
    if (!(scaled > -most && scaled < most)) return scaled > 0 ? Wide{1} << 64 : -(Wide{1} << 64);
    return static_cast<std::int64_t>(scaled + (scaled < 0 ? -0.5 : 0.5));
  }

  std::int64_t raw_ = 0;
};

inline Fixed abs(Fixed value) { return value.raw() < 0 ? -value : value; }

inline Fixed fmin(Fixed a, Fixed b) { return std::min(a, b); }

// Division by zero gives the largest number, which therefore counts as not finite.
inline bool isfinite(Fixed value) {
  return abs(value).raw() != std::numeric_limits<std::int64_t>::max();
}

// Bit by bit.
inline Fixed sqrt(Fixed value) {
  Fixed::Wide rest = std::max<Fixed::Wide>(value.raw(), 0) << Fixed::fraction_bits;
  Fixed::Wide root = 0;
  for (Fixed::Wide bit = Fixed::Wide{1} << (62 + Fixed::fraction_bits); bit != 0; bit >>= 2) {
    const bool fits = rest >= root + bit;
    if (fits) rest -= root + bit;
    root = (root >> 1) + (fits ? bit : 0);
  }
  return Fixed::of_raw(root);
}

// CORDIC: the vector is turned onto the x axis by angles whose tangents are powers of two.
inline Fixed atan2(Fixed sine, Fixed cosine) {
  constexpr int guard_bits = 12, steps = 42;
  constexpr double pi = 3.14159265358979323846;
  const auto angle_of = [](double radians) {
    return std::llround(std::ldexp(radians, Fixed::fraction_bits + guard_bits));
  };
  Fixed::Wide x = cosine.raw() * (1 << guard_bits), y = sine.raw() * (1 << guard_bits), angle = 0;
  if (x == 0 && y == 0) return {};
  if (x < 0) {
    angle = y >= 0 ? angle_of(pi) : -angle_of(pi);
    x = -x;
    y = -y;
  }
  for (int i = 0; i < steps; ++i) {
    const int turned = y > 0 ? 1 : -1;
    const Fixed::Wide dx = turned * (y >> i), dy = turned * (x >> i);
    x += dx;
    y -= dy;
    angle += turned * angle_of(std::atan(std::ldexp(1.0, -i)));
  }
  return Fixed::of_raw((angle + (1 << (guard_bits - 1))) >> guard_bits);
}

template <>
struct Eigen::NumTraits<Fixed> : Eigen::GenericNumTraits<Fixed> {
  using Real = Fixed;
  using NonInteger = Fixed;
  using Nested = Fixed;
  using Literal = Fixed;
  enum { IsComplex = 0, IsInteger = 0, IsSigned = 1, RequireInitialization = 1 };
  enum { ReadCost = 1, AddCost = 1, MulCost = 2 };
};
