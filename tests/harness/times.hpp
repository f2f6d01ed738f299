// Short names for times in tests.
#pragma once

#include <chrono>
#include <cstdint>

#include "harness/core/time.hpp"

namespace attest {

constexpr Nanoseconds ns(std::int64_t count) { return Nanoseconds(count); }
constexpr Nanoseconds us(std::int64_t count) { return std::chrono::microseconds(count); }
constexpr Nanoseconds ms(std::int64_t count) { return std::chrono::milliseconds(count); }

}  // namespace attest
