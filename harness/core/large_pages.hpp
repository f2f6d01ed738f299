// Memory for long traces.
#pragma once

#include <cstddef>
#include <vector>

namespace attest {

// Asks the system to map memory that will be written, in a few steps and with large pages. Without
// it, each 4 KiB of a trace costs an interrupt, together 2% of the time of a flight at 1 kHz. A
// system that cannot do this maps the memory when it is written.
void map_at_once(void* begin, std::size_t bytes);

template <typename T>
void reserve_large(std::vector<T>& objects, std::size_t count) {
  objects.reserve(count);
  map_at_once(objects.data(), count * sizeof(T));
}

}  // namespace attest
