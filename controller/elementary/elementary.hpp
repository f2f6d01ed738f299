// The elementary functions as the law calls them: `using elementary::sin; sin(x)`.
//
// float, the law's type, has the correctly rounded functions of attest_math.h. double, in which the
// harness measures margins, has those of the C library. Another scalar type provides its own.
#pragma once

#include <cmath>

#include "controller/attest_math.h"

namespace attest::elementary {

inline float sin(float x) { return attest_sinf(x); }
inline float cos(float x) { return attest_cosf(x); }
inline float tan(float x) { return attest_tanf(x); }
inline float asin(float x) { return attest_asinf(x); }
inline float acos(float x) { return attest_acosf(x); }
inline float exp(float x) { return attest_expf(x); }
inline float atan2(float y, float x) { return attest_atan2f(y, x); }

inline double sin(double x) { return std::sin(x); }
inline double cos(double x) { return std::cos(x); }
inline double tan(double x) { return std::tan(x); }
inline double asin(double x) { return std::asin(x); }
inline double acos(double x) { return std::acos(x); }
inline double exp(double x) { return std::exp(x); }
inline double atan2(double y, double x) { return std::atan2(y, x); }

}  // namespace attest::elementary
