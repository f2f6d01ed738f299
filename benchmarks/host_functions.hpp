// The law with the C library's elementary functions, as the floor of the law with attest's own.
#pragma once

#include <cmath>

#include "controller/elementary/float_with.hpp"

namespace attest::bench {

struct HostFunctions {
  static float sin(float x) { return std::sin(x); }
  static float cos(float x) { return std::cos(x); }
  static float asin(float x) { return std::asin(x); }
  static float acos(float x) { return std::acos(x); }
  static float exp(float x) { return std::exp(x); }
  static float atan2(float y, float x) { return std::atan2(y, x); }
};

using HostFloat = elementary::FloatWith<HostFunctions>;

}  // namespace attest::bench
