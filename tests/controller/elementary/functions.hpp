// The functions of attest_math.h, each with the functions that prove it.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include <mpfr.h>

namespace attest::elementary {

enum class Symmetry { none, even, odd };

// f(y, x). A function of one argument takes y.
using Float2 = float (*)(float y, float x);
using Double2 = double (*)(double y, double x);
using LongDouble2 = long double (*)(long double y, long double x);

struct Function {
  std::string_view name;
  bool two_arguments;
  Symmetry symmetry;  // of a function of one argument: f(-y) is f(y) or -f(y)
  Float2 fast;        // attest_math.h
  Float2 exact;       // exact.hpp. REQUIRES: the result of `fast` is finite and not 0
  Double2 in_double;  // of the C library, same for the next
  LongDouble2 in_long_double;
  int (*mpfr)(mpfr_t result, const mpfr_t y, const mpfr_t x);
};

const std::vector<Function>& functions();

// Null if there is none of that name.
const Function* function_named(std::string_view name);

// The correctly rounded result by MPFR, rounded once, in the range of exponents of binary32.
float by_mpfr(const Function& f, float y, float x);

// The correctly rounded result. The C library's double function is trusted to 2^-44, relative, its
// long double function to 2^-52. If both ends of this interval round to the same float, so does the
// exact value, because rounding to nearest never falls. Where the double function cannot decide,
// the long double function does, and where that cannot (`by_mpfr`), MPFR. The trust is large: 256
// units in the last place of double and 2048 of long double, while errors() measures one or two.
// The functions that are proven here use neither.
struct Truth {
  float value;
  bool by_mpfr;
};
Truth truth(const Function& f, float y, float x);

// The relative errors of the C library's functions, by MPFR with 128 bits. 0 for results below
// 2^-160: the least float is 2^-149, so these round to 0 with any error.
struct Errors {
  double of_double, of_long_double;
};
Errors errors(const Function& f, float y, float x);

// How far the exact value is from a number of 25 bits, relative. Midpoints of two normal floats are
// such numbers.
double distance_from_midpoint(const Function& f, float y, float x);

// Whether two results agree: the same bits, or both NaN.
bool agree(float a, float b);

}  // namespace attest::elementary
