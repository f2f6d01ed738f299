/* SPDX-License-Identifier: BSD-3-Clause */
// The elementary functions of the law, rounded to the nearest float.
//
// The float functions of many C libraries are often off by the last bit, so a port that calls them
// does not conform at the level exact. The double functions, rounded to float, give the nearest
// float for nearly every argument. For every argument define ATTEST_MATH, and link the functions of
// attest_math.h.
#pragma once

#ifdef ATTEST_MATH
#include <attest_math.h>
#else
#include <cmath>
#endif

namespace starter {

#ifdef ATTEST_MATH
inline float acos(float x) noexcept { return attest_acosf(x); }
inline float atan2(float y, float x) noexcept { return attest_atan2f(y, x); }
inline float exp(float x) noexcept { return attest_expf(x); }
#else
inline float acos(float x) noexcept { return static_cast<float>(std::acos(double{x})); }
inline float atan2(float y, float x) noexcept {
  return static_cast<float>(std::atan2(double{y}, double{x}));
}
inline float exp(float x) noexcept { return static_cast<float>(std::exp(double{x})); }
#endif

}  // namespace starter
