#include "harness/core/own_arena.hpp"

#include <cstddef>

#include <pthread.h>

namespace attest {
namespace {

// The usual stack of a main thread. The default for other threads depends on `ulimit -s`. A large
// limit gives a large stack, which counts in the limit of a port's memory. Without a limit the
// default is only 2 MiB.
constexpr std::size_t stack_bytes = std::size_t{8} << 20;

void* call(void* work) {
  (*static_cast<const std::function<void()>*>(work))();
  return nullptr;
}

}  // namespace

void in_own_arena(const std::function<void()>& work) {
  pthread_attr_t attributes;
  ::pthread_attr_init(&attributes);
  ::pthread_attr_setstacksize(&attributes, stack_bytes);
  pthread_t thread{};
  void* const argument = const_cast<std::function<void()>*>(&work);
  const bool has_thread = ::pthread_create(&thread, &attributes, call, argument) == 0;
  ::pthread_attr_destroy(&attributes);
  if (has_thread) {
    ::pthread_join(thread, nullptr);
  } else {
    work();
  }
}

}  // namespace attest
