#include "harness/core/large_pages.hpp"

#include <cstdint>

#include <sys/mman.h>

namespace attest {
namespace {

// Calls madvise() for the pages of size `page` that lie wholly in the memory.
void advise(void* begin, std::size_t bytes, std::uintptr_t page, int advice) {
  const auto address = reinterpret_cast<std::uintptr_t>(begin);
  const std::uintptr_t first = (address + page - 1) / page * page;
  const std::uintptr_t last = (address + bytes) / page * page;
  if (first < last) ::madvise(reinterpret_cast<void*>(first), last - first, advice);
}

}  // namespace

void map_at_once(void* begin, std::size_t bytes) {
  constexpr std::uintptr_t small = std::uintptr_t{4} << 10, large = std::uintptr_t{2} << 20;
  advise(begin, bytes, large, MADV_HUGEPAGE);
  advise(begin, bytes, small, MADV_POPULATE_WRITE);
}

}  // namespace attest
