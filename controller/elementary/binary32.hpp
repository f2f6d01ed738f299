// A finite float as integers: sign, exponent and significand.
//
// Floats are put together and taken apart in integers only, because the results of float operations
// depend on the rounding mode. Pure functions; any thread.
#pragma once

#include <bit>
#include <cstdint>

namespace attest::elementary {

inline constexpr int least_exponent = -126;  // of a normal float
inline constexpr float not_a_number = std::bit_cast<float>(0x7fc00000u);

// significand * 2^(exponent - 23). The significand has 24 bits, except that of 0, which is 0.
struct Binary32 {
  bool negative;
  int exponent;
  std::uint32_t significand;
};

// REQUIRES: x is finite.
constexpr Binary32 parts_of(float x) {
  const auto bits = std::bit_cast<std::uint32_t>(x);
  const bool negative = bits >> 31 != 0;
  const int exponent = static_cast<int>(bits >> 23 & 0xff);
  const std::uint32_t fraction = bits & 0x7fffff;
  if (exponent != 0) return {negative, exponent - 127, fraction | 0x800000};
  if (fraction == 0) return {negative, least_exponent, 0};
  const int lead = std::countl_zero(fraction) - 8;
  return {negative, least_exponent - lead, fraction << lead};
}

// significand * 2^(exponent - 23), infinity if that is too large. REQUIRES: exponent >= -126, and
// significand <= 2^24. Only if the exponent is -126 may the significand have less than 24 bits.
constexpr float float_of(bool negative, int exponent, std::uint32_t significand) {
  constexpr std::uint32_t infinity = 0x7f800000;
  // The leading bit of the significand adds 1 to the exponent field, which is 0 if there is none. A
  // significand of 2^24, which was rounded up, gives the next exponent.
  std::uint32_t bits = infinity;
  if (exponent <= 127) bits = (static_cast<std::uint32_t>(exponent + 126) << 23) + significand;
  return std::bit_cast<float>(bits | (negative ? 0x80000000u : 0u));
}

}  // namespace attest::elementary
