// The least time that an exchange with a program takes: that of a program that computes nothing.
#pragma once

#include <cstddef>

#include "harness/core/result.hpp"
#include "harness/core/time.hpp"

namespace attest {

// The median time in which `cat` sends `bytes` bytes back. Errors: `cat` cannot be started, or does
// not answer.
Result<Nanoseconds> pipe_round_trip(std::size_t bytes);

// The median time in which a thread answers a frame of `bytes` bytes in shared memory. Errors:
// there is no shared memory, or the frame does not fit into it.
Result<Nanoseconds> memory_round_trip(std::size_t bytes);

}  // namespace attest
