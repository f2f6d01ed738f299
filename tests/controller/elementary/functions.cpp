#include "tests/controller/elementary/functions.hpp"

#include <bit>
#include <cfloat>
#include <cmath>

#include "controller/attest_math.h"
#include "controller/elementary/exact.hpp"

namespace attest::elementary {
namespace {

static_assert(LDBL_MANT_DIG >= 64, "the proof needs a long double that is wider than double");

// The names of the functions are the same everywhere, except for the suffix or prefix.
#define ATTEST_ONE(NAME, SYMMETRY)                                         \
  Function {                                                               \
#NAME, false, Symmetry::SYMMETRY,                                        \
        [](float y, float) { return attest_##NAME##f(y); },                  \
        [](float y, float) { return exact::NAME(y); },                       \
        [](double y, double) { return std::NAME(y); },                       \
        [](long double y, long double) { return std::NAME(y); },             \
        [](mpfr_t result, const mpfr_t y, const mpfr_t) {                    \
          return mpfr_##NAME(result, y, MPFR_RNDN);                          \
        } \
  }

struct Number {
  explicit Number(mpfr_prec_t bits) { mpfr_init2(value, bits); }
  ~Number() { mpfr_clear(value); }
  Number(const Number&) = delete;
  Number& operator=(const Number&) = delete;
  mpfr_t value;
};

int evaluate(const Function& f, float y, float x, mpfr_t result) {
  Number up(24), along(24);
  mpfr_set_flt(up.value, y, MPFR_RNDN);
  mpfr_set_flt(along.value, x, MPFR_RNDN);
  return f.mpfr(result, up.value, along.value);
}

// |a - b| / |b|
double difference(const Number& a, const Number& b) {
  Number result(256);
  mpfr_sub(result.value, a.value, b.value, MPFR_RNDN);
  mpfr_div(result.value, result.value, b.value, MPFR_RNDN);
  return std::abs(mpfr_get_d(result.value, MPFR_RNDN));
}

// Whether all numbers within `trust` of `value`, relative, round to one float.
template <typename Wide>
bool decides(Wide value, Wide trust, float& rounded) {
  rounded = static_cast<float>(value);
  if (!std::isfinite(value)) return true;
  const Wide error = value * trust;
  return agree(static_cast<float>(value - error), static_cast<float>(value + error));
}

}  // namespace

const std::vector<Function>& functions() {
  static const std::vector<Function> all = {
      ATTEST_ONE(sin, odd),
      ATTEST_ONE(cos, even),
      ATTEST_ONE(tan, odd),
      ATTEST_ONE(asin, odd),
      ATTEST_ONE(acos, none),
      ATTEST_ONE(exp, none),
      {"atan2", true, Symmetry::none, attest_atan2f, exact::atan2,
       [](double y, double x) { return std::atan2(y, x); },
       [](long double y, long double x) { return std::atan2(y, x); },
       [](mpfr_t result, const mpfr_t y, const mpfr_t x) {
         return mpfr_atan2(result, y, x, MPFR_RNDN);
       }},
  };
  return all;
}

const Function* function_named(std::string_view name) {
  for (const Function& f : functions()) {
    if (f.name == name) return &f;
  }
  return nullptr;
}

float by_mpfr(const Function& f, float y, float x) {
  // The significand of MPFR is from 1/2 to 1, so its exponents are one more than usual. The least
  // is that of the least subnormal float, 2^-149.
  const mpfr_exp_t least = mpfr_get_emin(), largest = mpfr_get_emax();
  mpfr_set_emin(-148);
  mpfr_set_emax(128);
  Number result(24);
  const int rounding = evaluate(f, y, x, result.value);
  mpfr_subnormalize(result.value, rounding, MPFR_RNDN);
  const float value = mpfr_get_flt(result.value, MPFR_RNDN);
  mpfr_set_emin(least);
  mpfr_set_emax(largest);
  return value;
}

Truth truth(const Function& f, float y, float x) {
  float value;
  if (decides(f.in_double(y, x), 0x1p-44, value)) return {value, false};
  if (decides(f.in_long_double(y, x), 0x1p-52L, value)) return {value, false};
  return {by_mpfr(f, y, x), true};
}

Errors errors(const Function& f, float y, float x) {
  Number exact(128);
  evaluate(f, y, x, exact.value);
  const auto error = [&exact](long double value) -> double {
    if (!std::isfinite(value) || std::abs(value) < 0x1p-160L) return 0;
    Number approximate(64);
    mpfr_set_ld(approximate.value, value, MPFR_RNDN);
    return difference(approximate, exact);
  };
  return {error(f.in_double(y, x)), error(f.in_long_double(y, x))};
}

double distance_from_midpoint(const Function& f, float y, float x) {
  Number exact(256), midpoint(25);
  evaluate(f, y, x, exact.value);
  mpfr_set(midpoint.value, exact.value, MPFR_RNDN);
  return difference(midpoint, exact);
}

bool agree(float a, float b) {
  if (std::isnan(a) && std::isnan(b)) return true;
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}

}  // namespace attest::elementary
