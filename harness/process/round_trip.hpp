// The least time that an exchange with a program takes: that of a program that computes nothing.
#pragma once

#include <cstddef>

#include "harness/core/result.hpp"
#include "harness/core/time.hpp"

namespace attest {

// The median time in which `cat` sends `bytes` bytes back. Errors: a program cannot be started.
Result<Nanoseconds> pipe_round_trip(std::size_t bytes);

// The median time in which a thread answers in shared memory. Errors: there is no memory.
Result<Nanoseconds> memory_round_trip(std::size_t bytes);

}  // namespace attest
