// A scalar type for the law: a float with other elementary functions than those of this folder.
//
// Functions has them as static functions of float: sin, cos, asin, acos, exp and atan2. The law
// finds them because a FloatWith<Functions> is declared here. The rest of its arithmetic is that of
// float, so outputs differ from those of the law with float only because of the functions.
//
// If Functions has a string_view `caller`, it is set before each call: to the name of the function
// of the law that makes the call, such as "tilt_error".
//
// A plain value; any thread.
#pragma once

#include <cmath>
#include <compare>
#include <string_view>
#include <type_traits>

#include <Eigen/Core>

namespace attest::elementary {

template <typename Functions>
class FloatWith {
 public:
  constexpr FloatWith() = default;
  template <typename T>
  requires std::is_arithmetic_v<T>
  constexpr FloatWith(T value) : value_(static_cast<float>(value)) {}  // NOLINT
  explicit constexpr operator float() const { return value_; }

  constexpr FloatWith operator-() const { return -value_; }
  friend constexpr FloatWith operator+(FloatWith a, FloatWith b) { return a.value_ + b.value_; }
  friend constexpr FloatWith operator-(FloatWith a, FloatWith b) { return a.value_ - b.value_; }
  friend constexpr FloatWith operator*(FloatWith a, FloatWith b) { return a.value_ * b.value_; }
  friend constexpr FloatWith operator/(FloatWith a, FloatWith b) { return a.value_ / b.value_; }
  FloatWith& operator+=(FloatWith b) { return *this = *this + b; }
  FloatWith& operator-=(FloatWith b) { return *this = *this - b; }
  FloatWith& operator*=(FloatWith b) { return *this = *this * b; }
  friend constexpr auto operator<=>(FloatWith a, FloatWith b) = default;

  friend FloatWith sin(FloatWith x, const char* caller = __builtin_FUNCTION()) {
    set_caller(caller);
    return Functions::sin(x.value_);
  }
  friend FloatWith cos(FloatWith x, const char* caller = __builtin_FUNCTION()) {
    set_caller(caller);
    return Functions::cos(x.value_);
  }
  friend FloatWith asin(FloatWith x, const char* caller = __builtin_FUNCTION()) {
    set_caller(caller);
    return Functions::asin(x.value_);
  }
  friend FloatWith acos(FloatWith x, const char* caller = __builtin_FUNCTION()) {
    set_caller(caller);
    return Functions::acos(x.value_);
  }
  friend FloatWith exp(FloatWith x, const char* caller = __builtin_FUNCTION()) {
    set_caller(caller);
    return Functions::exp(x.value_);
  }
  friend FloatWith atan2(FloatWith y, FloatWith x, const char* caller = __builtin_FUNCTION()) {
    set_caller(caller);
    return Functions::atan2(y.value_, x.value_);
  }

  friend FloatWith sqrt(FloatWith x) { return std::sqrt(x.value_); }
  friend FloatWith abs(FloatWith x) { return std::abs(x.value_); }
  friend FloatWith floor(FloatWith x) { return std::floor(x.value_); }
  friend bool isfinite(FloatWith x) { return std::isfinite(x.value_); }

 private:
  static void set_caller([[maybe_unused]] std::string_view name) {
    // gcc appends the arguments of a template.
    if constexpr (requires { Functions::caller = name; }) {
      Functions::caller = name.substr(0, name.find('<'));
    }
  }

  float value_ = 0;
};

}  // namespace attest::elementary

template <typename Functions>
struct Eigen::NumTraits<attest::elementary::FloatWith<Functions>> : Eigen::NumTraits<float> {
  using Real = attest::elementary::FloatWith<Functions>;
  using NonInteger = Real;
  using Nested = Real;
  using Literal = Real;
};
