// Memory for long traces.
#pragma once

#include <cstddef>
#include <vector>

namespace attest {

// Asks the kernel to map this memory now, with large pages where possible. Otherwise each page
// costs a page fault when it is first written, together 2% of the time of a flight at 1 kHz. A
// kernel that cannot do this maps the pages at their first write.
void map_at_once(void* begin, std::size_t bytes);

template <typename T>
void reserve_large(std::vector<T>& objects, std::size_t count) {
  objects.reserve(count);
  map_at_once(objects.data(), count * sizeof(T));
}

}  // namespace attest
