// Memory for long traces.
#pragma once

#include <cstddef>
#include <vector>

namespace attest {

// Asks the system for large pages. A trace of some megabytes is then mapped in a few steps instead
// of thousands. This is a hint; without large pages it has no effect.
void advise_large_pages(void* begin, std::size_t bytes);

template <typename T>
void reserve_large(std::vector<T>& objects, std::size_t count) {
  objects.reserve(count);
  advise_large_pages(objects.data(), count * sizeof(T));
}

}  // namespace attest
