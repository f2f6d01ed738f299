// Compares two floats by their bits.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

namespace attest {

// -0 differs from 0; every NaN equals every NaN.
inline bool same_bits(float a, float b) {
  if (std::isnan(a) || std::isnan(b)) return std::isnan(a) && std::isnan(b);
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}

}  // namespace attest
