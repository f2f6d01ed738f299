// Pairs whose atan2 is near a midpoint of two floats.
#pragma once

#include <cstdint>
#include <vector>

#include "tests/controller/elementary/sweep.hpp"

namespace attest::elementary {

// From `count` midpoints m at random, from 2^-31 to pi/2. The convergents of the continued fraction
// of tan(m) are the ratios of small integers nearest to it. The last with 24 bits is y / x. It
// misses m by about 2^-48, relative. Returns the 64 pairs that miss it least.
std::vector<Arguments> hard_pairs(std::uint64_t count);

}  // namespace attest::elementary
