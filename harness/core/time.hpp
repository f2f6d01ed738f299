// Time in the harness: integer nanoseconds, never a floating point clock.
#pragma once

#include <chrono>
#include <cstdint>

namespace attest {

// 64 bits on every platform of attest, enough for +-292 years.
using Nanoseconds = std::chrono::nanoseconds;

// For printing, and for computations in doubles.
constexpr double in_seconds(Nanoseconds time) { return static_cast<double>(time.count()) * 1e-9; }

constexpr double in_microseconds(Nanoseconds time) {
  return static_cast<double>(time.count()) / 1000;
}

// The `timestamp` of a sample: microseconds, rounded down, as the firmware's clock gives them.
// REQUIRES: time >= 0.
constexpr std::uint64_t timestamp_us(Nanoseconds time) {
  return static_cast<std::uint64_t>(time.count() / 1000);
}

}  // namespace attest
