// The number of allocations of a thread; in a real-time loop it stays the same.
#pragma once

#include <cstdint>

namespace attest {

// Calls of malloc and related functions by the calling thread so far, from any library. Always 0 in
// a build with a sanitizer, which has its own malloc.
std::uint64_t thread_allocations();

}  // namespace attest
