// Passes the last value that one thread wrote to one other thread, like a topic of queue length 1.
// Wait-free: neither thread ever waits for the other, takes a lock or allocates.
//
// There are three slots: the writer fills one, the reader looks at one, and the third is handed
// over by an atomic exchange of its index.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace attest {

template <typename T>
class TripleBuffer {
 public:
  // Writer only.
  void write(const T& value) {
    slots_[writing_].value = value;
    const std::uint8_t handed =
        shared_.exchange(static_cast<std::uint8_t>(writing_ | fresh), std::memory_order_acq_rel);
    writing_ = handed & index;
  }

  // Reader only: the last value written; null if no value was written since the last call. Valid
  // until the next call.
  const T* read() {
    if ((shared_.load(std::memory_order_relaxed) & fresh) == 0) return nullptr;
    const std::uint8_t handed = shared_.exchange(reading_, std::memory_order_acq_rel);
    reading_ = handed & index;
    return &slots_[reading_].value;
  }

 private:
  static constexpr std::uint8_t index = 3, fresh = 4;
  static constexpr std::size_t line_bytes = 64;  // a cache line; two threads never write to one

  struct alignas(line_bytes) Slot {
    T value{};
  };
  std::array<Slot, 3> slots_{};
  alignas(line_bytes) std::atomic<std::uint8_t> shared_{0};
  alignas(line_bytes) std::uint8_t writing_ = 1;
  alignas(line_bytes) std::uint8_t reading_ = 2;
};

static_assert(std::atomic<std::uint8_t>::is_always_lock_free);

}  // namespace attest
