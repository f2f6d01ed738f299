#include "harness/core/own_arena.hpp"

#include <cstddef>

#include <gtest/gtest.h>
#include <pthread.h>

namespace attest {
namespace {

std::size_t stack_of_this_thread() {
  pthread_attr_t attributes;
  std::size_t bytes = 0;
  if (::pthread_getattr_np(::pthread_self(), &attributes) != 0) return 0;
  ::pthread_attr_getstacksize(&attributes, &bytes);
  ::pthread_attr_destroy(&attributes);
  return bytes;
}

// A port's process has this stack, so it must not depend on `ulimit -s`.
TEST(InOwnArena, TheStackHas8MiB) {
  std::size_t bytes = 0;
  in_own_arena([&] { bytes = stack_of_this_thread(); });
  EXPECT_EQ(bytes, std::size_t{8} << 20);
}

}  // namespace
}  // namespace attest
