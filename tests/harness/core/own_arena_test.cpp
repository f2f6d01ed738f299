#include "harness/core/own_arena.hpp"

#include <array>
#include <cstddef>
#include <fstream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <pthread.h>

#include "harness/core/sanitizers.hpp"

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

// Of the mappings that replace the heap: what a fork copies page by page [kB]. Empty: there is
// none.
std::optional<std::size_t> private_kb() {
  std::ifstream maps("/proc/self/smaps");
  std::optional<std::size_t> sum;
  bool is_of_heap = false;
  for (std::string line; std::getline(maps, line);) {
    std::istringstream words(line);
    std::string first;
    std::size_t kb = 0;
    words >> first;
    if (!first.ends_with(':')) is_of_heap = line.find("attest-heap") != std::string::npos;
    if (is_of_heap && first == "Anonymous:" && words >> kb) sum = sum.value_or(0) + kb;
  }
  return sum;
}

// A command runs jobs several times: the vectors, and then their diagnosis.
TEST(HeapCheapToFork, IsCheapAgainAfterItChanged) {
  if (built_with_sanitizers) GTEST_SKIP() << "a sanitizer has a heap of its own";
  std::vector<std::unique_ptr<std::array<char, 1000>>> objects(20'000);
  for (auto& object : objects) object = std::make_unique<std::array<char, 1000>>();
  make_heap_cheap_to_fork();
  for (auto& object : objects) object->fill('x');
  make_heap_cheap_to_fork();
  const auto kb = private_kb();
  ASSERT_TRUE(kb);
  EXPECT_LT(*kb, 2'000u);
  for (const auto& object : objects) ASSERT_EQ(object->back(), 'x');
}

}  // namespace
}  // namespace attest
