// The fast path: each function in double, and a test whether its error can matter.
//
// The float nearest to an approximation is also the float nearest to the exact value, unless a
// midpoint of two floats lies between the two. Where a midpoint is that near, exact.cpp decides
// (A. Ziv, Fast evaluation of elementary mathematical functions with correctly rounded last bit,
// 1991). So the approximations may round in any mode, with or without fused multiply-adds.
//
// The approximations have an error below 2^-46, relative; the test assumes 2^-44. They are
// polynomials of small arguments (constants.py). Of the C library they use only sqrt(), whose
// result IEEE 754 defines. No double here is subnormal.
#include "controller/elementary/elementary.hpp"

#include "controller/elementary/binary32.hpp"
#include "controller/elementary/constants.hpp"
#include "controller/elementary/exact.hpp"

namespace attest::elementary {
namespace {

constexpr double half_turn = 3.14159265358979323846;
constexpr double quarter_turn = half_turn / 2;

constexpr std::uint64_t one = 1;
constexpr std::uint64_t lead = one << 52;  // of the significand of a double
constexpr std::uint64_t error = 512;       // 2^-44 of a significand, rounded up
static_assert(sizeof(double) == 8, "the fast path needs binary64");

struct Rounded {
  float value;
  bool is_sure;
};

// The cases of nearest() whose result is subnormal, 0 or infinite.
Rounded nearest_at_limits(std::uint64_t size, bool negative) {
  const int exponent = static_cast<int>(size >> 52) - 1023;
  if (exponent > 127) return {float_of(negative, exponent, 0), true};
  // Below 2^-150, which is half the least float.
  if (exponent < -151) return {float_of(negative, least_exponent, 0), true};
  const std::uint64_t significand = (size & (lead - 1)) | lead;
  const int cut = 29 + least_exponent - exponent;
  const std::uint64_t half = one << (cut - 1), rest = significand & (2 * half - 1);
  const auto kept = static_cast<std::uint32_t>((significand + half) >> cut);
  return {float_of(negative, least_exponent, kept), rest < half - error || rest > half + error};
}

// The float nearest to each number within 2^-44 of `value`, relative, or of -value. It is not sure
// if they have more than one. In integers, so the rounding mode does not matter. REQUIRES: value is
// finite.
inline Rounded nearest(double value, bool negate = false) {
  constexpr std::uint64_t half = one << 28, rest_bits = 2 * half - 1;
  const auto bits = std::bit_cast<std::uint64_t>(value);
  const std::uint64_t size = bits & ~(one << 63);
  const std::uint64_t sign = (bits ^ (std::uint64_t{negate} << 63)) >> 32 & 0x80000000;
  constexpr std::uint64_t least_normal = std::uint64_t{1023 - 126} << 52;
  constexpr std::uint64_t least_infinite = std::uint64_t{1023 + 128} << 52;
  if (size - least_normal >= least_infinite - least_normal) [[unlikely]] {
    return nearest_at_limits(size, sign != 0);
  }
  // The exponent's bias changes from 1023 to 127. A carry out of the significand adds 1 to it.
  const std::uint64_t kept = ((size + half) >> 29) - (std::uint64_t{1023 - 127} << 23);
  const std::uint64_t from_half = (size & rest_bits) - (half - error);
  return {std::bit_cast<float>(static_cast<std::uint32_t>(kept | sign)), from_half > 2 * error};
}

std::uint32_t size_bits(float x) { return std::bit_cast<std::uint32_t>(x) & 0x7fffffff; }
bool is_negative(float x) { return std::bit_cast<std::uint32_t>(x) >> 31 != 0; }

constexpr std::uint32_t bits_of(float x) { return std::bit_cast<std::uint32_t>(x); }
constexpr std::uint32_t infinity_bits = 0x7f800000;

// x and |x|, also where the processor reads subnormal floats as 0.
inline double widened(float x) {
  const std::uint32_t size = size_bits(x);
  if (size < bits_of(0x1p-126f)) return (is_negative(x) ? -0x1p-149 : 0x1p-149) * size;
  return static_cast<double>(x);
}

inline double widened_size(float x) { return widened(std::bit_cast<float>(size_bits(x))); }

// ---- sin, cos, tan ------------------------------------------------------------------------------

// x = quarters * pi/2 + angle, modulo 2 pi, |angle| <= pi/4.
struct Reduced {
  double angle_rad;
  std::uint32_t quarters;
  bool is_accurate;
};

// Of any finite x, by 96 bits of 2/pi (Payne and Hanek 1983).
inline Reduced reduced(float x) {
  const std::uint32_t bits = size_bits(x);
  if (bits < bits_of(0.785f)) return {widened(x), 0, true};
  const int exponent = static_cast<int>(bits >> 23) - 127;
  const std::uint64_t significand = (bits & 0x7fffff) | 0x800000;
  // Bit 0 of the product counts 2^-62 quarters. Bits from 4 quarters on are cut off.
  const int first = 32 * 11 - (exponent - 23) - 62 - 32;
  const std::uint32_t* const limbs = two_over_pi + first / 32;
  const int shift = first % 32;
  const auto limb = [limbs, shift](int i) {
    return (std::uint64_t{limbs[i + 1]} << 32 | limbs[i]) >> shift & 0xffffffff;
  };
  const std::uint64_t product =
      (significand * limb(0) >> 32) + significand * limb(1) + (significand * limb(2) << 32);
  const auto quarters = static_cast<std::uint32_t>((product + (std::uint64_t{1} << 61)) >> 62);
  const auto share = static_cast<std::int64_t>(product << 2);  // of a quarter, times 2^64
  const double angle_rad = static_cast<double>(share) * (quarter_turn / 0x1p64);
  // The share has an error of less than 8.
  constexpr std::int64_t least = std::int64_t{1} << 50;
  const bool is_accurate = share > least || share < -least;
  if (is_negative(x)) return {-angle_rad, -quarters, is_accurate};
  return {angle_rad, quarters, is_accurate};
}

// Polynomials in s = a^2. The order of operations lets the processor compute the parts at once.
inline double small_sine(double a) {
  const double* const c = sine_terms;
  const double s = a * a, s2 = s * s, s4 = s2 * s2;
  return a * ((c[0] + c[1] * s) + s2 * (c[2] + c[3] * s) + s4 * (c[4] + c[5] * s));
}

inline double small_cosine(double a) {
  const double* const c = cosine_terms;
  const double s = a * a, s2 = s * s, s4 = s2 * s2;
  return (c[0] + c[1] * s) + s2 * (c[2] + c[3] * s) + s4 * ((c[4] + c[5] * s) + s2 * c[6]);
}

// sin(x + turned * pi/2), not sure if `from` is not.
inline Rounded turned_sine(const Reduced& from, std::uint32_t turned) {
  const std::uint32_t quarters = from.quarters + turned;
  const double size = quarters % 2 == 0 ? small_sine(from.angle_rad) : small_cosine(from.angle_rad);
  const Rounded result = nearest(size, quarters % 4 >= 2);
  return {result.value, result.is_sure && from.is_accurate};
}

// ---- asin, acos, atan2 --------------------------------------------------------------------------

// asin(sqrt(s)) / sqrt(s) for 0 <= s <= 1/4.
inline double arc_sine_factor(double s) {
  const double* const c = arc_sine_terms;
  const double s2 = s * s, s4 = s2 * s2, s8 = s4 * s4;
  const double low = ((c[0] + c[1] * s) + s2 * (c[2] + c[3] * s)) +
                     s4 * ((c[4] + c[5] * s) + s2 * (c[6] + c[7] * s));
  return low + s8 * ((c[8] + c[9] * s) + s2 * (c[10] + c[11] * s));
}

// acos(x) for 1/2 <= x <= 1, from half the angle: its sine is sqrt((1 - x) / 2).
inline double small_arc_cosine(double x) {
  const double s = 0.5 - 0.5 * x;
  // Where the mode rounds down, 0.5 - 0.5 is -0.
  return std::abs(2 * std::sqrt(s) * arc_sine_factor(s));
}

// atan2(y, x) for positive y and x.
double direction_of(double y, double x) {
  const bool steep = y > x;
  const double low = steep ? x : y, high = steep ? y : x;
  const int i = static_cast<int>(low / high * 32 + 1) / 2;
  const double table = i / 16.0;
  const double t = (low - table * high) / (high + table * low);
  const double s = t * t, s2 = s * s;
  const double factor = (1 - s * (1.0 / 3)) + s2 * ((1.0 / 5 - s * (1.0 / 7)) + s2 * (1.0 / 9));
  const double angle = arc_tangents[i] + t * factor;
  return steep ? quarter_turn - angle : angle;
}

// atan2 where an argument is 0 or infinite, as in Annex F of C.
double direction_of_axes(float y, float x) {
  const bool up = size_bits(y) == infinity_bits, along = size_bits(x) == infinity_bits;
  double angle = 0;
  if (up && along) {
    angle = quarter_turn / 2;
  } else if (up || (size_bits(x) == 0 && size_bits(y) != 0)) {
    return quarter_turn;
  }
  return is_negative(x) ? half_turn - angle : angle;
}

}  // namespace

extern "C" {

float attest_sinf(float x) {
  if (size_bits(x) >= infinity_bits) return not_a_number;
  const Rounded result = turned_sine(reduced(x), 0);
  return result.is_sure ? result.value : exact::sin(x);
}

float attest_cosf(float x) {
  if (size_bits(x) >= infinity_bits) return not_a_number;
  const Rounded result = turned_sine(reduced(x), 1);
  return result.is_sure ? result.value : exact::cos(x);
}

float attest_tanf(float x) {
  if (size_bits(x) >= infinity_bits) return not_a_number;
  const Reduced from = reduced(x);
  const double sine = small_sine(from.angle_rad), cosine = small_cosine(from.angle_rad);
  const Rounded result = nearest(from.quarters % 2 == 0 ? sine / cosine : -cosine / sine);
  return result.is_sure && from.is_accurate ? result.value : exact::tan(x);
}

float attest_asinf(float x) {
  const std::uint32_t size = size_bits(x);
  if (size > bits_of(1.0f)) return not_a_number;
  const double sine = widened_size(x);
  const double angle = size < bits_of(0.5f) ? sine * arc_sine_factor(sine * sine)
                                            : quarter_turn - small_arc_cosine(sine);
  const Rounded result = nearest(angle, is_negative(x));
  return result.is_sure ? result.value : exact::asin(x);
}

float attest_acosf(float x) {
  const std::uint32_t size = size_bits(x);
  if (size > bits_of(1.0f)) return not_a_number;
  const double cosine = widened(x);
  double angle;
  if (size < bits_of(0.5f)) {
    angle = quarter_turn - cosine * arc_sine_factor(cosine * cosine);
  } else {
    const double small = small_arc_cosine(widened_size(x));
    angle = is_negative(x) ? half_turn - small : small;
  }
  const Rounded result = nearest(angle);
  return result.is_sure ? result.value : exact::acos(x);
}

float attest_expf(float x) {
  if (size_bits(x) > infinity_bits) return not_a_number;
  if (size_bits(x) > bits_of(104.0f)) {
    return float_of(false, is_negative(x) ? least_exponent : 128, 0);
  }
  const double value = widened(x);
  const int twos = static_cast<int>(value * 1.4426950408889634 + (value < 0 ? -0.5 : 0.5));
  // The first part of ln 2 has 33 bits, so its product is exact.
  const double r = (value - twos * 0x1.62e42feep-1) - twos * 0x1.a39ef35793c76p-33;
  const double r2 = r * r, r4 = r2 * r2;
  const double low = (1 + r) + r2 * (1.0 / 2 + r * (1.0 / 6));
  const double middle = (1.0 / 24 + r * (1.0 / 120)) + r2 * (1.0 / 720 + r * (1.0 / 5040));
  const double high =
      (1.0 / 40320 + r * (1.0 / 362880)) + r2 * (1.0 / 3628800 + r * (1.0 / 39916800));
  const double power = low + r4 * (middle + r4 * (high + r4 * (1.0 / 479001600)));
  const std::uint64_t scale = static_cast<std::uint64_t>(1023 + twos) << 52;
  const Rounded result = nearest(power * std::bit_cast<double>(scale));
  return result.is_sure ? result.value : exact::exp(x);
}

float attest_atan2f(float y, float x) {
  const std::uint32_t up = size_bits(y), along = size_bits(x);
  if (up > infinity_bits || along > infinity_bits) return not_a_number;
  if (up == 0 || along == 0 || up == infinity_bits || along == infinity_bits) {
    return nearest(direction_of_axes(y, x), is_negative(y)).value;
  }
  const double first_quarter = direction_of(widened_size(y), widened_size(x));
  const double angle = is_negative(x) ? half_turn - first_quarter : first_quarter;
  const Rounded result = nearest(angle, is_negative(y));
  return result.is_sure ? result.value : exact::atan2(y, x);
}

}  // extern "C"

}  // namespace attest::elementary
