#include "harness/realtime/triple_buffer.hpp"

#include <array>
#include <atomic>
#include <thread>

#include <gtest/gtest.h>

namespace attest {
namespace {

TEST(TripleBuffer, IsReadOnce) {
  TripleBuffer<int> value;
  EXPECT_EQ(value.read(), nullptr);
  value.write(1);
  value.write(2);
  ASSERT_NE(value.read(), nullptr);
  EXPECT_EQ(value.read(), nullptr);
  value.write(3);
  EXPECT_EQ(*value.read(), 3);
}

TEST(TripleBuffer, StaysWhileOthersAreWritten) {
  TripleBuffer<int> value;
  value.write(1);
  const int* const read = value.read();
  for (int i = 2; i < 10; ++i) value.write(i);
  EXPECT_EQ(*read, 1);
  EXPECT_EQ(*value.read(), 9);
}

// Two threads at full speed: no value is torn, repeated or out of order. The thread sanitizer finds
// a race that this test misses by luck.
TEST(TripleBuffer, GoesFromThreadToThreadWhole) {
  using Wide = std::array<std::uint64_t, 32>;
  constexpr std::uint64_t last = 200'000;
  TripleBuffer<Wide> value;
  std::thread writer([&] {
    for (std::uint64_t i = 1; i <= last; ++i) {
      Wide wide;
      wide.fill(i);
      value.write(wide);
    }
  });
  std::uint64_t seen = 0, wrong = 0;
  while (seen != last) {
    const Wide* const wide = value.read();
    if (wide == nullptr) continue;
    for (const std::uint64_t element : *wide) wrong += element != wide->front() ? 1 : 0;
    wrong += wide->front() <= seen ? 1 : 0;
    seen = wide->front();
  }
  writer.join();
  EXPECT_EQ(wrong, 0u);
}

}  // namespace
}  // namespace attest
