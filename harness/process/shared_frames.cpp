#include "harness/process/shared_frames.hpp"

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sched.h>
#include <sys/mman.h>
#include <unistd.h>

namespace attest {
namespace {

// Waiting has three phases. It reads the counter looks_alone times with pause() between the reads
// (about 100 us), then looks_between_others times with sched_yield() (about 1 ms). Then it sleeps
// between the reads.
constexpr unsigned looks_alone = 4096, looks_between_others = 1024;
constexpr auto nap = std::chrono::microseconds(50);
constexpr unsigned naps_until_asked = 20;  // naps between two calls of has_ended()

std::atomic_ref<std::uint32_t> counter(std::byte* memory, std::size_t at) {
  return std::atomic_ref(*reinterpret_cast<std::uint32_t*>(memory + at));
}

void pause() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#endif
}

}  // namespace

Result<SharedFrames> SharedFrames::make() {
  const int file = ::memfd_create("attest", MFD_CLOEXEC | MFD_ALLOW_SEALING);
  // The seals fix the size: if a program shortened the memory, a read would kill attest (SIGBUS).
  const bool is_ready = file >= 0 && ::ftruncate(file, SharedLayout::size) == 0 &&
                        ::fcntl(file, F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW) == 0;
  void* const memory =
      is_ready ? ::mmap(nullptr, SharedLayout::size, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0)
               : MAP_FAILED;
  if (memory != MAP_FAILED) return SharedFrames(file, static_cast<std::byte*>(memory));
  const int reason = errno;
  if (file >= 0) ::close(file);
  return fail(fmt::format("cannot share memory with the program: {}", std::strerror(reason)));
}

SharedFrames::SharedFrames(SharedFrames&& other) noexcept { *this = std::move(other); }

SharedFrames& SharedFrames::operator=(SharedFrames&& other) noexcept {
  std::swap(file_, other.file_);
  std::swap(bytes_, other.bytes_);
  std::swap(sent_, other.sent_);
  std::swap(read_, other.read_);
  return *this;
}

SharedFrames::~SharedFrames() {
  if (file_ < 0) return;
  ::munmap(bytes_, SharedLayout::size);
  ::close(file_);
}

bool SharedFrames::write(std::string_view request) {
  if (request.size() > SharedLayout::most) return false;
  std::memcpy(bytes_ + SharedLayout::request, request.data(), request.size());
  read_ = 0;
  counter(bytes_, SharedLayout::requests).store(++sent_, std::memory_order_release);
  return true;
}

bool SharedFrames::wait(const std::function<bool()>& has_ended) const {
  const auto answers = counter(bytes_, SharedLayout::answers);
  const auto is_answered = [&] { return answers.load(std::memory_order_acquire) == sent_; };
  for (unsigned look = 0; look < looks_alone; ++look) {
    if (is_answered()) return true;
    pause();
  }
  for (unsigned look = 0; look < looks_between_others; ++look) {
    if (is_answered()) return true;
    ::sched_yield();
  }
  // sched_yield() gives no turn to a process of lower priority on the same CPU; a nap does.
  for (unsigned look = 1; !is_answered(); ++look) {
    std::this_thread::sleep_for(nap);
    if (look % naps_until_asked == 0 && has_ended()) return is_answered();
  }
  return true;
}

bool SharedFrames::read(void* place, std::size_t size, const std::function<bool()>& has_ended) {
  if (size > SharedLayout::most - read_ || !wait(has_ended)) return false;
  std::memcpy(place, bytes_ + SharedLayout::answer + read_, size);
  read_ += size;
  return true;
}

}  // namespace attest
