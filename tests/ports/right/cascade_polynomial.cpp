// The cascade with sin, cos, asin, acos, exp and atan2 as polynomials. The law is instantiated with
// a scalar type that has these functions. Must pass at the numeric level.
#include "controller/elementary/float_with.hpp"
#include "tests/ports/cascade_port.hpp"
#include "tests/ports/right/polynomial.hpp"

namespace {

struct Polynomials {
  static float sin(float x) { return polynomial::sin(x); }
  static float cos(float x) { return polynomial::cos(x); }
  static float asin(float x) { return polynomial::asin(x); }
  static float acos(float x) { return polynomial::acos(x); }
  static float exp(float x) { return polynomial::exp(x); }
  static float atan2(float y, float x) { return polynomial::atan2(y, x); }
};
using Real = attest::elementary::FloatWith<Polynomials>;

}  // namespace

// No angle occurs in the rate unit.
ATTEST_CASCADE_PORT(
    "polynomial trigonometry",
    (cascade_extension<attest::cascade::AttitudeUnit<Real>, attest::cascade::RateUnit<float>>))
