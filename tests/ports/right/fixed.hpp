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

inline Fixed floor(Fixed value) {
  return Fixed::of_raw(value.raw() >> Fixed::fraction_bits << Fixed::fraction_bits);
}

// The whole square root, bit by bit.
inline Fixed::Wide root_of(Fixed::Wide value) {
  Fixed::Wide rest = std::max<Fixed::Wide>(value, 0);
  Fixed::Wide root = 0;
  for (Fixed::Wide bit = Fixed::Wide{1} << (62 + Fixed::fraction_bits); bit != 0; bit >>= 2) {
    const bool fits = rest >= root + bit;
    if (fits) rest -= root + bit;
    root = (root >> 1) + (fits ? bit : 0);
  }
  return root;
}

inline Fixed sqrt(Fixed value) {
  return Fixed::of_raw(root_of(value.raw() * (Fixed::Wide{1} << Fixed::fraction_bits)));
}

// CORDIC: a vector is turned by angles whose tangents are powers of two. Each turn makes it longer.
struct Cordic {
  using Wide = Fixed::Wide;
  static constexpr int guard_bits = 12, steps = 42;
  static constexpr double pi = 3.14159265358979323846;

  Wide x, y;
  Wide angle;  // by which the vector has been turned clockwise

  static Wide wide(Fixed value) { return value.raw() * (1 << guard_bits); }
  static Wide wide(double value) {
    return std::llround(std::ldexp(value, Fixed::fraction_bits + guard_bits));
  }
  static Fixed rounded(Wide value) {
    return Fixed::of_raw((value + (1 << (guard_bits - 1))) >> guard_bits);
  }

  void turn(int step, int clockwise) {
    const Wide dx = clockwise * (y >> step), dy = clockwise * (x >> step);
    x += dx;
    y -= dy;
    angle += clockwise * wide(std::atan(std::ldexp(1.0, -step)));
  }
};

// The vector is turned onto the x axis.
inline Fixed atan2(Fixed sine, Fixed cosine) {
  Cordic vector{Cordic::wide(cosine), Cordic::wide(sine), 0};
  if (vector.x == 0 && vector.y == 0) return {};
  if (vector.x < 0) {
    vector.angle = vector.y >= 0 ? Cordic::wide(Cordic::pi) : -Cordic::wide(Cordic::pi);
    vector.x = -vector.x;
    vector.y = -vector.y;
  }
  for (int i = 0; i < Cordic::steps; ++i) vector.turn(i, vector.y > 0 ? 1 : -1);
  return Cordic::rounded(vector.angle);
}

// {cos, sin}. A vector on the x axis is turned until the angle is used up. It begins as short as
// the turns make it longer. CORDIC reaches 99 deg; the nearest multiple of 180 deg changes the
// sign.
struct Direction {
  Fixed cosine, sine;
};
inline Direction direction_of(Fixed angle) {
  static const double shortness = [] {
    double product = 1;
    for (int i = 0; i < Cordic::steps; ++i) product /= std::sqrt(1 + std::ldexp(1.0, -2 * i));
    return product;
  }();
  const Fixed::Wide half_turn = Cordic::wide(Cordic::pi), turn = 2 * half_turn;
  const Fixed::Wide shifted = 2 * Cordic::wide(angle) + half_turn;
  const Fixed::Wide half_turns = shifted / turn - (shifted % turn < 0 ? 1 : 0);
  Cordic vector{Cordic::wide(shortness), 0, Cordic::wide(angle) - half_turns * half_turn};
  for (int i = 0; i < Cordic::steps; ++i) vector.turn(i, vector.angle > 0 ? -1 : 1);
  const Direction direction{Cordic::rounded(vector.x), Cordic::rounded(vector.y)};
  return (half_turns & 1) != 0 ? Direction{-direction.cosine, -direction.sine} : direction;
}
inline Fixed cos(Fixed angle) { return direction_of(angle).cosine; }
inline Fixed sin(Fixed angle) { return direction_of(angle).sine; }

// Of x / 256 by its series, and then squared eight times. Twenty more bits keep it right to the
// last.
inline Fixed exp(Fixed x) {
  using Wide = Fixed::Wide;
  constexpr int guard_bits = 20, squarings = 8, most = 40;
  constexpr int bits = Fixed::fraction_bits + guard_bits;
  constexpr Wide one = Wide{1} << bits;
  if (x < Fixed(-most)) return {};
  const Wide r =
      (std::min(x, Fixed(0)).raw() * (1 << guard_bits)) >> squarings;  // the law's is <= 0
  Wide sum = one, term = one;
  for (int i = 1; i <= 10; ++i) sum += term = (term * r >> bits) / i;
  for (int i = 0; i < squarings; ++i) sum = sum * sum >> bits;
  return Fixed::of_raw((sum + (Wide{1} << (guard_bits - 1))) >> guard_bits);
}

// sqrt(1 - x^2), from all bits of the square. A number above 1 has none, and gives 0.
inline Fixed other_leg(Fixed x) {
  return Fixed::of_raw(root_of((Fixed::Wide{1} << (2 * Fixed::fraction_bits)) - x.raw() * x.raw()));
}
inline Fixed asin(Fixed x) { return atan2(x, other_leg(x)); }
inline Fixed acos(Fixed x) { return atan2(other_leg(x), x); }

template <>
struct Eigen::NumTraits<Fixed> : Eigen::GenericNumTraits<Fixed> {
  using Real = Fixed;
  using NonInteger = Fixed;
  using Nested = Fixed;
  using Literal = Fixed;
  enum { IsComplex = 0, IsInteger = 0, IsSigned = 1, RequireInitialization = 1 };
  enum { ReadCost = 1, AddCost = 1, MulCost = 2 };
};
