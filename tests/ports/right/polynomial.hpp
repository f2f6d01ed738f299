// Elementary functions in polynomials, for a processor without a mathematical library. Before
// rounding they are right to 2e-7; with the rounding of float, to 4.4e-7 (measured on 4 million
// arguments).
//
// NaN and arguments outside of the domain give NaN, as in the C library.
#pragma once

#include <cmath>
#include <limits>
#include <utility>

namespace polynomial {

inline constexpr float pi = 3.14159265358979f;

// The series to x^13, for |x| <= tan(pi/8): the term left out is below 1.3e-7.
inline float atan_small(float x) {
  const float z = x * x;
  return x *
         (1 - z * (1 / 3.0f -
                   z * (1 / 5.0f - z * (1 / 7.0f - z * (1 / 9.0f - z * (1 / 11.0f - z / 13.0f))))));
}

inline float atan2(float y, float x) {
  float big = std::abs(x), small = std::abs(y);
  if (std::isnan(big) || std::isnan(small)) return big + small;
  const bool steep = small > big;
  if (steep) std::swap(big, small);
  if (big == 0) return std::atan2(y, x);
  const float ratio = std::isinf(big) ? (std::isinf(small) ? 1.0f : 0.0f) : small / big;
  // atan r = pi/4 + atan((r - 1) / (r + 1))
  float angle =
      ratio > 0.41421356f ? pi / 4 + atan_small((ratio - 1) / (ratio + 1)) : atan_small(ratio);
  if (steep) angle = pi / 2 - angle;
  if (std::signbit(x)) angle = pi - angle;
  return std::copysign(angle, y);
}

// The series to x^9 and x^8, for |x| <= pi/4: the terms left out are below 2e-9 and 3e-8.
inline float sin_small(float x) {
  const float z = x * x;
  return x * (1 - z / 6 * (1 - z / 20 * (1 - z / 42 * (1 - z / 72))));
}
inline float cos_small(float x) {
  const float z = x * x;
  return 1 - z / 2 * (1 - z / 12 * (1 - z / 30 * (1 - z / 56)));
}

// sin(x + quarters pi/2). pi/2 is subtracted in two parts. The first has 11 bits, so that its
// multiples are exact up to 4096. The law wraps its angles, so larger ones do not occur.
inline float sin_turned(float x, int quarters) {
  constexpr float half_pi_high = 1.5703125f, half_pi_low = 4.8382679e-4f;
  const float turns = std::nearbyint(x / (pi / 2));
  if (!(std::abs(turns) < 4096)) return std::numeric_limits<float>::quiet_NaN();
  const float rest = (x - turns * half_pi_high) - turns * half_pi_low;
  const int quadrant = static_cast<int>(turns) + quarters;
  const float size = (quadrant & 1) != 0 ? cos_small(rest) : sin_small(rest);
  return (quadrant & 2) != 0 ? -size : size;
}
inline float sin(float x) { return sin_turned(x, 0); }
inline float cos(float x) { return sin_turned(x, 1); }

// M. Abramowitz and I. Stegun, Handbook of Mathematical Functions, 4.4.46: right to 2e-8 before
// rounding, for 0 <= x <= 1.
inline float acos_positive(float x) {
  constexpr float coefficients[] = {-0.0012624911f, 0.0066700901f, -0.0170881256f, 0.0308918810f,
                                    -0.0501743046f, 0.0889789874f, -0.2145988016f, 1.5707963050f};
  float sum = 0;
  for (const float coefficient : coefficients) sum = sum * x + coefficient;
  return std::sqrt(1 - x) * sum;
}
inline float acos(float x) { return x < 0 ? pi - acos_positive(-x) : acos_positive(x); }
inline float asin(float x) { return std::copysign(pi / 2 - acos_positive(std::abs(x)), x); }

// 2^n times the series to r^6, for |r| <= ln 2 / 2: the term left out is below 2e-7. ln 2 is
// subtracted in two parts, of which the first has 12 bits.
inline float exp(float x) {
  constexpr float turns_each = 1.44269504f, ln2_high = 0.693115234f, ln2_low = 3.19461833e-5f;
  if (std::isnan(x)) return x;
  if (x < -104) return 0;
  if (x > 89) return std::numeric_limits<float>::infinity();
  const float n = std::nearbyint(x * turns_each);
  const float r = (x - n * ln2_high) - n * ln2_low;
  const float series = 1 + r * (1 + r / 2 * (1 + r / 3 * (1 + r / 4 * (1 + r / 5 * (1 + r / 6)))));
  return std::ldexp(series, static_cast<int>(n));
}

}  // namespace polynomial
