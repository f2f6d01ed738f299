// The cascade with sin, cos, asin, acos and atan2 as polynomials. The law is instantiated with a
// scalar type that has these functions, so that no angle is computed by the C library.
// Must pass at the numeric level.
#include <cmath>
#include <compare>
#include <type_traits>

#include <Eigen/Core>

#include "tests/ports/cascade_port.hpp"
#include "tests/ports/right/polynomial.hpp"

namespace {

class Real {
 public:
  constexpr Real() = default;
  template <typename T>
  requires std::is_arithmetic_v<T>
  constexpr Real(T value) : value_(static_cast<float>(value)) {}  // NOLINT
  explicit constexpr operator float() const { return value_; }

  constexpr Real operator-() const { return -value_; }
  friend constexpr Real operator+(Real a, Real b) { return a.value_ + b.value_; }
  friend constexpr Real operator-(Real a, Real b) { return a.value_ - b.value_; }
  friend constexpr Real operator*(Real a, Real b) { return a.value_ * b.value_; }
  friend constexpr Real operator/(Real a, Real b) { return a.value_ / b.value_; }
  Real& operator+=(Real b) { return *this = *this + b; }
  friend constexpr auto operator<=>(Real a, Real b) = default;

 private:
  float value_ = 0;
};

// Found by the law in place of the functions of the C library, because Real is declared here.
Real sin(Real x) { return polynomial::sin(float(x)); }
Real cos(Real x) { return polynomial::cos(float(x)); }
Real asin(Real x) { return polynomial::asin(float(x)); }
Real acos(Real x) { return polynomial::acos(float(x)); }
Real atan2(Real y, Real x) { return polynomial::atan2(float(y), float(x)); }
Real sqrt(Real x) { return std::sqrt(float(x)); }
Real abs(Real x) { return std::abs(float(x)); }
Real floor(Real x) { return std::floor(float(x)); }
bool isfinite(Real x) { return std::isfinite(float(x)); }

}  // namespace

template <>
struct Eigen::NumTraits<Real> : Eigen::NumTraits<float> {
  using Real = ::Real;
  using NonInteger = ::Real;
  using Nested = ::Real;
  using Literal = ::Real;
};

// No angle occurs in the rate unit.
ATTEST_CASCADE_PORT(
    "polynomial trigonometry",
    (cascade_extension<attest::cascade::AttitudeUnit<Real>, attest::cascade::RateUnit<float>>))
