// Requests and answers in memory that attest shares with a program (PROTOCOL.md, "Shared memory").
// Each side watches a counter of the other one. Waiting takes no system call if the answer comes
// within about 100 us.
#pragma once

#include <cstddef>
#include <functional>
#include <string_view>

#include "harness/core/result.hpp"

namespace attest {

// The layout of the memory: offsets and sizes in bytes. All of it is zero at the start.
struct SharedLayout {
  static constexpr std::size_t requests = 0;  // u32 that counts requests
  static constexpr std::size_t answers = 64;  // u32 that counts answers, in its own cache line
  static constexpr std::size_t request = 4096;
  static constexpr std::size_t most = 262144;  // largest size of a request, and of an answer
  static constexpr std::size_t answer = request + most;
  static constexpr std::size_t size = answer + most;
};

// attest's side. One thread at a time. The program may write into the memory at any time, so each
// byte is copied once and judged from the copy.
class SharedFrames {
 public:
  // Errors: the system has no memory for it.
  static Result<SharedFrames> make();

  SharedFrames(SharedFrames&& other) noexcept;
  SharedFrames& operator=(SharedFrames&& other) noexcept;
  ~SharedFrames();

  // A descriptor of the memory, for another process, which cannot change the size of the memory.
  int file() const { return file_; }

  // Writes the next request. False: the request has more than SharedLayout::most bytes.
  bool write(std::string_view request);

  // Waits for the answer to the last request, and copies its next `size` bytes. Calls `has_ended`
  // about every millisecond. False: `has_ended` returned true and no answer came, or the memory has
  // no room for an answer of that size.
  bool read(void* place, std::size_t size, const std::function<bool()>& has_ended);

  // The memory itself, for tests and measurements in which the other side is in this process.
  std::byte* bytes() const { return bytes_; }

 private:
  SharedFrames(int file, std::byte* bytes) : file_(file), bytes_(bytes) {}

  bool wait(const std::function<bool()>& has_ended) const;

  int file_ = -1;
  std::byte* bytes_ = nullptr;
  unsigned sent_ = 0;     // requests
  std::size_t read_ = 0;  // bytes of the answer to the last request
};

}  // namespace attest
