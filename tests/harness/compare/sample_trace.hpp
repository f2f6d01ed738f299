// Traces made by hand for the tests.
#pragma once

#include <cstddef>
#include <limits>
#include <string_view>

#include "harness/trace/trace.hpp"

namespace attest {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// Ticks 4 ms apart, level, in an attitude mode, every output published with a value of its own.
Trace sample_trace(std::size_t ticks);

// Index of a channel that exists.
std::size_t channel(std::string_view name);

void set(Trace& trace, std::size_t tick, std::string_view name, double value);

}  // namespace attest
