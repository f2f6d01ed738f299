// The scalar functions of the law: angles, limits, filters and stick curves.
//
// Each keeps the law's order of operations, on which the last bit depends. Scalar is float in the
// law; another type computes the same expressions with the same binary32 constants. The results for
// NaN are part of the law: they depend on the order of the arguments of a comparison.
//
// Pure functions, and a filter and a line that are plain values; any thread.
#pragma once

#include <cmath>

#include "controller/cascade/profile.hpp"
#include "controller/mc_att_control/inline.hpp"

namespace attest::cascade {

inline constexpr float epsilon = 1.1920929e-7f;  // FLT_EPSILON

// Degrees to rad. One multiplication; the law of v1.5.5 divides by 180 first.
template <typename Scalar>
ATTEST_INLINE constexpr Scalar radians(Scalar degrees) {
  return degrees * Scalar(0.0174532924f);
}

// NaN passes: both comparisons are false.
template <typename Scalar>
ATTEST_INLINE constexpr Scalar clamp(Scalar value, Scalar low, Scalar high) {
  return value < low ? low : (value > high ? high : value);
}

// min() and max() return b if an argument is NaN.
template <typename Scalar>
ATTEST_INLINE constexpr Scalar min(Scalar a, Scalar b) {
  return a < b ? a : b;
}
template <typename Scalar>
ATTEST_INLINE constexpr Scalar max(Scalar a, Scalar b) {
  return a > b ? a : b;
}

template <typename Scalar>
ATTEST_INLINE bool is_finite(Scalar value) {
  using std::isfinite;  // a user-defined scalar type provides its own overload
  return isfinite(value);
}

// An angle [rad] in -pi .. pi, pi excluded.
template <typename Scalar>
ATTEST_INLINE Scalar wrap(Scalar angle) {
  constexpr float pi = 3.14159274f, turn = 6.28318548f, turns_each_rad = 0.159154937f;
  const Scalar low = Scalar(-pi);
  if (low <= angle && angle < Scalar(pi)) return angle;
  using std::floor;
  return angle - Scalar(turn) * floor((angle - low) * Scalar(turns_each_rad));
}

// First-order low-pass. The weight keeps its value if tau_s + dt_s is at most epsilon.
template <typename Scalar>
struct LowPass {
  Scalar state = Scalar(0);
  Scalar weight = Scalar(0);

  ATTEST_INLINE Scalar update(Scalar tau_s, Scalar dt_s, Scalar input, const ProfileTraits& law) {
    const Scalar span_s = tau_s + dt_s;
    if (span_s > Scalar(epsilon)) weight = dt_s / span_s;
    state = law.weighs_low_pass ? (Scalar(1) - weight) * state + weight * input
                                : state + weight * (input - state);
    return state;
  }
};

// The next value of a quantity that follows `target` by at most `rate` in each second.
template <typename Scalar>
ATTEST_INLINE Scalar slewed(Scalar value, Scalar rate, Scalar dt_s, Scalar target) {
  const Scalar step = rate * dt_s;
  return value + clamp(target - value, -step, step);
}

// The straight line from (x0, y0) to (x1, y1): y0 before x0, and y1 after x1.
template <typename Scalar>
struct Line {
  Scalar x0, x1, y0, y1;

  ATTEST_INLINE Scalar at(Scalar x) const {
    if (x <= x0) return y0;
    if (x > x1) return y1;
    const Scalar slope = (y1 - y0) / (x1 - x0);
    return (slope * x) + (y0 - (slope * x0));
  }
};

// A share of the stick is cubed, for finer control around the centre.
template <typename Scalar>
ATTEST_INLINE Scalar expo(Scalar stick, Scalar share) {
  const Scalar x = clamp(stick, Scalar(-1), Scalar(1));
  const Scalar cubic = clamp(share, Scalar(0), Scalar(1));
  return (Scalar(1) - cubic) * x + cubic * x * x * x;
}

// expo() that is steeper near the ends.
template <typename Scalar>
ATTEST_INLINE Scalar superexpo(Scalar stick, Scalar share, Scalar steepness) {
  using std::abs;
  const Scalar x = clamp(stick, Scalar(-1), Scalar(1));
  const Scalar steeper = clamp(steepness, Scalar(0), Scalar(0.99f));
  return (expo(x, share) * (Scalar(1) - steeper)) / (Scalar(1) - abs(x) * steeper);
}

// 0 within `zone` of the centre, and from there a straight line to +-1 at the ends.
template <typename Scalar>
ATTEST_INLINE Scalar deadzone(Scalar stick, Scalar zone) {
  using std::abs;
  const Scalar x = clamp(stick, Scalar(-1), Scalar(1));
  const Scalar width = clamp(zone, Scalar(0), Scalar(0.99f));
  const Scalar sign = Scalar(int(Scalar(0) < x) - int(x < Scalar(0)));
  return ((x - sign * width) / (Scalar(1) - width)) * Scalar(abs(x) > width ? 1 : 0);
}

}  // namespace attest::cascade
