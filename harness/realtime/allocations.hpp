// Counts the allocations of a thread. A real-time loop must not allocate.
#pragma once

#include <cstdint>

namespace attest {

// Calls of malloc, calloc, realloc and aligned_alloc by the calling thread so far, from any
// library. Always 0 in a build with a sanitizer, which has its own malloc, and without the GNU C
// library.
std::uint64_t thread_allocations();

}  // namespace attest
