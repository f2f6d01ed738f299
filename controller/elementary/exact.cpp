// A result is computed with an absolute error below 2^-180 (tan: 2^-150 of itself), cut off, and
// rounded by the bit after the last. This is correct if no result lies so near to a midpoint of two
// floats that the error decides.
//
// - A result is not equal to a midpoint: except at 0 and at acos(1), a function of an algebraic
//   number is transcendental here (Lindemann 1882).
// - One argument: all 2^32 were compared with MPFR (tests/controller/elementary).
// - atan2: a result of at least 2^-42 has an error below 2^-138 of itself. There are fewer than
//   2^48 ratios of two significands, in 80 exponents. If the results lie as if at random, the
//   smallest distance from a midpoint is near 2^-80 of the result. The nearest pair that a search
//   found is 2^-89 away (hard_cases.txt): t = y / x misses the midpoint by almost exactly t^3 / 3,
//   so t^5 / 5 decides. A ratio misses a midpoint by at least 2^-49 of itself. So this occurs only
//   for t above 2^-24, and t^4 / 5 is above 2^-99 there. This does not prove it for every pair.
//   Smaller results are quotients, see quotient().
//
// Methods: J.-M. Muller et al., Handbook of Floating-Point Arithmetic, chapters 10 and 11.
#include "controller/elementary/exact.hpp"

#include <algorithm>

#include "controller/elementary/binary32.hpp"
#include "controller/elementary/constants.hpp"
#include "controller/elementary/fixed.hpp"

namespace attest::elementary::exact {
namespace {

constexpr int fraction_bits = 32 * fraction_limbs;

// The limb that starts at bit `first` of an array of limbs, which zeros surround.
template <typename Limbs>
constexpr std::uint32_t limb_at(const Limbs& limbs, int first) {
  const auto limb = [&limbs](int index) {
    const bool inside = 0 <= index && index < static_cast<int>(std::size(limbs));
    return std::uint64_t{inside ? limbs[static_cast<std::size_t>(index)] : 0};
  };
  const int index = (first + 32 * fixed_limbs) / 32 - fixed_limbs;  // rounded down
  const int shift = first - 32 * index;
  return static_cast<std::uint32_t>((limb(index + 1) << 32 | limb(index)) >> shift);
}

// integer * 2^exponent. REQUIRES: the result is below 2^32. Bits below 2^-192 are cut off.
Fixed scaled(std::uint32_t integer, int exponent) {
  const std::uint32_t limbs[] = {integer};
  Fixed result;
  for (int i = 0; i < fixed_limbs; ++i) {
    result.limbs[static_cast<std::size_t>(i)] = limb_at(limbs, 32 * i - fraction_bits - exponent);
  }
  return result;
}

// The float nearest to value * 2^exponent. REQUIRES: value is 0, or at least 2^-168.
float rounded(bool negative, const Fixed& value, int exponent = 0) {
  int top = 32 * fixed_limbs - 1;
  while (top > 0 && (value.limbs[static_cast<std::size_t>(top / 32)] >> top % 32 & 1) == 0) --top;
  const int lead = std::max(top - fraction_bits + exponent, least_exponent);
  const int last = lead - 23 + fraction_bits - exponent;  // the last bit that is kept
  if (last > top + 1) return float_of(negative, least_exponent, 0);
  // Bit `last - 1` rounds: a tie does not occur.
  const std::uint32_t kept = limb_at(value.limbs, last) & 0xffffff;
  return float_of(negative, lead, kept + (limb_at(value.limbs, last - 1) & 1));
}

Fixed root(const Fixed& x) {
  return largest([](const Fixed& y) { return y * y; }, x);
}

Fixed operator/(const Fixed& a, const Fixed& b) {
  return largest([&b](const Fixed& quotient) { return quotient * b; }, a);
}

// ---- sin, cos, tan ------------------------------------------------------------------------------

// |x| = quarters * pi/2 + angle, or - angle if `behind`. 0 <= angle <= pi/4. `quarters` is
// modulo 4.
struct Reduced {
  std::uint32_t quarters;
  bool behind;
  Fixed angle_rad;
};

// The product with 2/pi in integers (Payne and Hanek 1983). Its whole quarters are cut off, so
// large arguments lose no bits.
Reduced reduced(const Binary32& x) {
  constexpr std::size_t size = std::size(two_over_pi);
  std::array<std::uint32_t, size> product{};
  std::uint64_t carry = 0;
  for (std::size_t i = 0; i < size; ++i) {
    carry += std::uint64_t{x.significand} * two_over_pi[i];
    product[i] = static_cast<std::uint32_t>(carry);
    carry >>= 32;
  }

  const int first = static_cast<int>(32 * (size - 1)) - (x.exponent - 23) - fraction_bits;
  Fixed share;  // of pi/2
  for (int i = 0; i < fixed_limbs; ++i) {
    share.limbs[static_cast<std::size_t>(i)] = limb_at(product, first + 32 * i);
  }
  std::uint32_t quarters = share.limbs[fraction_limbs];
  share.limbs[fraction_limbs] = 0;
  const bool behind = share.limbs[fraction_limbs - 1] >> 31 != 0;
  if (behind) {
    share = Fixed(1) - share;
    ++quarters;
  }
  return {quarters & 3, behind, share * Fixed(half_pi)};
}

struct SineCosine {
  Fixed sine, cosine;
};

// Of an angle from 0 to pi/4, by Taylor's series.
SineCosine sine_cosine(const Fixed& angle_rad) {
  SineCosine sums{angle_rad, Fixed(1)};
  Fixed term = angle_rad;
  for (std::uint32_t n = 2; !term.is_zero(); ++n) {
    term = term * angle_rad / n;
    Fixed& sum = n % 2 == 0 ? sums.cosine : sums.sine;
    sum = n % 4 < 2 ? sum + term : sum - term;
  }
  return sums;
}

// sin(|x| + quarters * pi/2)
float turned_sine(const Binary32& x, std::uint32_t quarters, bool negative) {
  const Reduced from = reduced(x);
  const SineCosine angle = sine_cosine(from.angle_rad);
  const std::uint32_t turned = from.quarters + quarters;
  const bool is_sine = turned % 2 == 0;
  negative ^= turned % 4 >= 2;
  negative ^= is_sine && from.behind;
  return rounded(negative, is_sine ? angle.sine : angle.cosine);
}

// ---- asin, acos, atan2 --------------------------------------------------------------------------

// The angle [rad] of the direction (cosine, sine), from sine * cosine and sine^2 <= 1/2. Euler's
// series, all of whose terms are positive:
//   angle = sine cosine (1 + 2/3 sine^2 + (2 4)/(3 5) sine^4 + ...)
Fixed angle_of(const Fixed& sine_cosine, const Fixed& sine_squared) {
  Fixed sum, term = sine_cosine;
  for (std::uint32_t n = 1; !term.is_zero(); ++n) {
    sum = sum + term;
    term = term * sine_squared * (2 * n) / (2 * n + 1);
  }
  return sum;
}

// asin(|x|) [rad]
Fixed arc_sine(const Binary32& x) {
  const Fixed sine = scaled(x.significand, x.exponent - 23);
  const Fixed sine_squared = sine * sine;
  const Fixed cosine_squared = Fixed(1) - sine_squared;
  const Fixed product = sine * root(cosine_squared);
  if (sine_squared < cosine_squared) return angle_of(product, sine_squared);
  return Fixed(half_pi) - angle_of(product, cosine_squared);
}

// A tiny y / x > 0, minus less than 2^-81 of it. REQUIRES: y / x < 2^-40.
//
// atan(t) is t - t^3/3 + ..., so it is below t by less than 2^-81 of t. y / x may be a float or a
// midpoint of two subnormal floats; atan2 is then just below. The quotient has 40 or 41 bits here.
// If it has a rest, the rest is at least 2^-24 of its last bit. The deviation is less than 2^-40 of
// that bit, so it does not change the bits. If it has no rest, the deviation takes one from the
// last bit.
float quotient(bool negative, const Binary32& y, const Binary32& x) {
  const std::uint64_t dividend = std::uint64_t{y.significand} << 40;
  const std::uint64_t bits = dividend / x.significand - (dividend % x.significand == 0 ? 1 : 0);
  Fixed value;
  value.limbs[0] = static_cast<std::uint32_t>(bits);
  value.limbs[1] = static_cast<std::uint32_t>(bits >> 32);
  return rounded(negative, value, y.exponent - x.exponent - 40 + fraction_bits);
}

// atan(small / large) [rad]. A ratio below 2^-40 counts as 0, because the caller adds the angle to
// a multiple of pi/2, and these are farther than 2^-28 from the midpoints of floats.
Fixed arc_tangent(const Binary32& small, const Binary32& large) {
  if (small.exponent < large.exponent - 41) return Fixed();
  const Fixed sine = scaled(small.significand, small.exponent - large.exponent - 24);
  const Fixed cosine = scaled(large.significand, -24);
  const Fixed squared = sine * sine + cosine * cosine;
  return angle_of(sine * cosine / squared, sine * sine / squared);
}

}  // namespace

float sin(float x) {
  const Binary32 parts = parts_of(x);
  return turned_sine(parts, 0, parts.negative);
}

float cos(float x) { return turned_sine(parts_of(x), 1, false); }

float tan(float x) {
  const Binary32 parts = parts_of(x);
  const Reduced from = reduced(parts);
  const SineCosine angle = sine_cosine(from.angle_rad);
  const bool odd = from.quarters % 2 != 0;
  return rounded(parts.negative ^ from.behind ^ odd,
                 odd ? angle.cosine / angle.sine : angle.sine / angle.cosine);
}

float asin(float x) {
  const Binary32 parts = parts_of(x);
  return rounded(parts.negative, arc_sine(parts));
}

float acos(float x) {
  const Binary32 parts = parts_of(x);
  const Fixed angle_rad = arc_sine(parts);
  return rounded(false, parts.negative ? Fixed(half_pi) + angle_rad : Fixed(half_pi) - angle_rad);
}

// 2^twos exp(rest), with rest = x - twos ln 2 from 0 to 3, by Taylor's series.
float exp(float x) {
  const Binary32 parts = parts_of(x);
  if (parts.exponent >= 7) return float_of(false, parts.negative ? least_exponent : 128, 0);
  // Rounding changes this by at most 1, so `rest` is positive.
  const int twos = static_cast<int>(x * 1.4427f) - 2;
  const Fixed size = scaled(parts.significand, parts.exponent - 23);
  const Fixed whole = Fixed(ln2) * static_cast<std::uint32_t>(twos < 0 ? -twos : twos);
  const Fixed rest = (parts.negative ? -size : size) + (twos < 0 ? whole : -whole);
  Fixed sum, term = Fixed(1);
  for (std::uint32_t n = 1; !term.is_zero(); ++n) {
    sum = sum + term;
    term = term * rest / n;
  }
  return rounded(false, sum, twos);
}

float atan2(float y, float x) {
  const Binary32 up = parts_of(y), along = parts_of(x);
  if (!along.negative && up.exponent < along.exponent - 41) return quotient(up.negative, up, along);
  const bool steep = up.exponent > along.exponent ||
                     (up.exponent == along.exponent && up.significand > along.significand);
  const Fixed angle = steep ? arc_tangent(along, up) : arc_tangent(up, along);  // from an axis
  Fixed total = steep ? Fixed(half_pi) - angle : angle;
  if (along.negative) total = Fixed(half_pi) + Fixed(half_pi) - total;
  return rounded(up.negative, total);
}

}  // namespace attest::elementary::exact
