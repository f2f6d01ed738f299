#include "harness/realtime/allocations.hpp"

#include <cstddef>

// A program may replace malloc ("Replacing malloc" in the manual of the GNU C library). A program
// that links this file does so: the functions here count, and call those of the GNU C library. Its
// free() is not replaced. Libraries that are loaded later, such as ports, use these functions too.

namespace {

// Other TLS models may allocate the variable at its first use, and so call malloc within malloc.
[[gnu::tls_model("initial-exec")]] thread_local std::uint64_t allocations = 0;

}  // namespace

namespace attest {

std::uint64_t thread_allocations() { return allocations; }

}  // namespace attest

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) && defined(__GLIBC__)
#define ATTEST_COUNTS_ALLOCATIONS
#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#undef ATTEST_COUNTS_ALLOCATIONS
#endif
#endif
#endif

#ifdef ATTEST_COUNTS_ALLOCATIONS
extern "C" {

void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}

void* calloc(std::size_t count, std::size_t size) {
  ++allocations;
  return __libc_calloc(count, size);
}

void* realloc(void* memory, std::size_t size) {
  ++allocations;
  return __libc_realloc(memory, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) {
  ++allocations;
  return __libc_memalign(alignment, size);
}

}  // extern "C"
#endif
