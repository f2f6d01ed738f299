// How often a thread has asked for memory: in a real-time loop, never.
#pragma once

#include <cstdint>

namespace attest {

// Calls of malloc and its kin by the calling thread so far, by whatever library; always 0 in a
// build with a sanitizer, which has a malloc of its own.
std::uint64_t thread_allocations();

}  // namespace attest
