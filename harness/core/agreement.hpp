// Whether two values agree: one rule for NaN, infinity and the sign of zero, for every comparison.
#pragma once

#include <cmath>
#include <concepts>
#include <limits>

namespace attest {

// -0 differs from 0; every NaN equals every NaN.
template <std::floating_point Value>
bool same_bits(Value a, Value b) {
  if (std::isnan(a) || std::isnan(b)) return std::isnan(a) && std::isnan(b);
  return a == b && std::signbit(a) == std::signbit(b);
}

// 0 for equal values, such as -0 and 0, and for two NaNs. Infinite if only one value is NaN or
// infinite.
inline double distance(double a, double b) {
  if (a == b || (std::isnan(a) && std::isnan(b))) return 0;
  const double difference = std::abs(a - b);
  return std::isnan(difference) ? std::numeric_limits<double>::infinity() : difference;
}

// Whether the distance is at most `allowed`. A number never agrees with infinity or NaN, not even
// if `allowed` is infinite.
inline bool agree(double a, double b, double allowed) {
  const double apart = distance(a, b);
  return apart == 0 || (std::isfinite(apart) && apart <= allowed);
}

}  // namespace attest
