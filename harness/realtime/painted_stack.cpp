#include "harness/realtime/painted_stack.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <utility>

#include <fmt/format.h>
#include <sys/mman.h>
#include <ucontext.h>

namespace attest {
namespace {

constexpr std::size_t stack_bytes = PaintedStack::size, page_bytes = 4096;
constexpr unsigned char paint = 0xa5;

struct Call {
  void (*function)(void*);
  void* argument;
};

// makecontext() passes ints only, so the address of the Call arrives in two halves.
void enter(unsigned high, unsigned low) {
  const auto address = (static_cast<std::uintptr_t>(high) << 32) | low;
  const Call& call = *reinterpret_cast<const Call*>(address);
  call.function(call.argument);
}

}  // namespace

Result<PaintedStack> PaintedStack::make() {
  void* const memory = ::mmap(nullptr, page_bytes + stack_bytes, PROT_READ | PROT_WRITE,
                              MAP_PRIVATE | MAP_ANONYMOUS | MAP_STACK, -1, 0);
  if (memory == MAP_FAILED) {
    return fail(fmt::format("no memory for a stack: {}", std::strerror(errno)));
  }
  ::mprotect(memory, page_bytes, PROT_NONE);
  PaintedStack stack(static_cast<unsigned char*>(memory));
  std::memset(stack.memory_ + page_bytes, paint, stack_bytes);
  stack.run([] {});
  stack.own_ = stack.used();
  stack.repaint();
  return stack;
}

PaintedStack::PaintedStack(PaintedStack&& other) noexcept
    : memory_(std::exchange(other.memory_, nullptr)), own_(other.own_) {}

PaintedStack::~PaintedStack() {
  if (memory_ != nullptr) ::munmap(memory_, page_bytes + stack_bytes);
}

void PaintedStack::call(void (*function)(void*), void* argument) {
  const Call call{function, argument};
  const auto address = reinterpret_cast<std::uintptr_t>(&call);
  ucontext_t here, there;
  ::getcontext(&there);
  there.uc_stack.ss_sp = memory_ + page_bytes;
  there.uc_stack.ss_size = stack_bytes;
  there.uc_link = &here;
  ::makecontext(&there, reinterpret_cast<void (*)()>(enter), 2,
                static_cast<unsigned>(address >> 32), static_cast<unsigned>(address));
  ::swapcontext(&here, &there);
}

std::size_t PaintedStack::lowest_change() const {
  static const auto painted = [] {
    std::array<unsigned char, page_bytes> page;
    page.fill(paint);
    return page;
  }();
  const unsigned char* const stack = memory_ + page_bytes;
  std::size_t page = 0;
  while (page < stack_bytes && std::memcmp(stack + page, painted.data(), page_bytes) == 0) {
    page += page_bytes;
  }
  return static_cast<std::size_t>(
      std::find_if(stack + page, stack + stack_bytes, [](auto byte) { return byte != paint; }) -
      stack);
}

std::size_t PaintedStack::used() const {
  const std::size_t all = stack_bytes - lowest_change();
  return all - std::min(all, own_);
}

void PaintedStack::repaint() {
  const std::size_t lowest = lowest_change();
  std::memset(memory_ + page_bytes + lowest, paint, stack_bytes - lowest);
}

}  // namespace attest
