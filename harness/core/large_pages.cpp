#include "harness/core/large_pages.hpp"

#include <cstdint>

#include <sys/mman.h>

namespace attest {

void advise_large_pages(void* begin, std::size_t bytes) {
  constexpr std::uintptr_t large = std::uintptr_t{2} << 20;
  const auto address = reinterpret_cast<std::uintptr_t>(begin);
  const std::uintptr_t first = (address + large - 1) / large * large;
  const std::uintptr_t last = (address + bytes) / large * large;
  if (first < last) ::madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE);
}

}  // namespace attest
