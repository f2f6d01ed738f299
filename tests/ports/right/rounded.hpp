// Numbers with FRACTION_BITS bits behind the point. Each result is rounded to the nearest one. They
// are kept in a double, so NaN and infinity are as in floating point.
#pragma once

#include <cmath>

#include <Eigen/Core>

class Rounded {
 public:
  Rounded() = default;
  Rounded(double value) : value_(std::ldexp(std::nearbyint(scaled(value)), -FRACTION_BITS)) {}
  explicit operator double() const { return value_; }
  explicit operator float() const { return static_cast<float>(value_); }

  Rounded operator-() const { return -value_; }
  friend Rounded operator+(Rounded a, Rounded b) { return a.value_ + b.value_; }
  friend Rounded operator-(Rounded a, Rounded b) { return a.value_ - b.value_; }
  friend Rounded operator*(Rounded a, Rounded b) { return a.value_ * b.value_; }
  friend Rounded operator/(Rounded a, Rounded b) { return a.value_ / b.value_; }
  Rounded& operator+=(Rounded b) { return *this = *this + b; }
  Rounded& operator-=(Rounded b) { return *this = *this - b; }
  Rounded& operator*=(Rounded b) { return *this = *this * b; }
  Rounded& operator/=(Rounded b) { return *this = *this / b; }
  friend auto operator<=>(Rounded a, Rounded b) = default;

 private:
  static double scaled(double value) { return std::ldexp(value, FRACTION_BITS); }

  double value_ = 0;
};

inline bool isfinite(Rounded x) { return std::isfinite(double(x)); }
inline Rounded abs(Rounded x) { return std::abs(double(x)); }
inline Rounded sqrt(Rounded x) { return std::sqrt(double(x)); }
inline Rounded exp(Rounded x) { return std::exp(double(x)); }
inline Rounded sin(Rounded x) { return std::sin(double(x)); }
inline Rounded cos(Rounded x) { return std::cos(double(x)); }
inline Rounded asin(Rounded x) { return std::asin(double(x)); }
inline Rounded acos(Rounded x) { return std::acos(double(x)); }
inline Rounded atan2(Rounded y, Rounded x) { return std::atan2(double(y), double(x)); }
inline Rounded fmin(Rounded x, Rounded y) { return std::fmin(double(x), double(y)); }
inline Rounded fmax(Rounded x, Rounded y) { return std::fmax(double(x), double(y)); }

template <>
struct Eigen::NumTraits<Rounded> : Eigen::GenericNumTraits<Rounded> {
  using Real = Rounded;
  using NonInteger = Rounded;
  using Nested = Rounded;
  using Literal = Rounded;
  enum { IsComplex = 0, IsInteger = 0, IsSigned = 1, RequireInitialization = 1 };
  enum { ReadCost = 1, AddCost = 1, MulCost = 2 };
};
