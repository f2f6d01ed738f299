// The other side of the memory is a thread here, and a real program in tests/cli/programs.bats.
#include "harness/process/shared_frames.hpp"

#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <unistd.h>

namespace attest {
namespace {

std::atomic_ref<std::uint32_t> counter(const SharedFrames& frames, std::size_t at) {
  return std::atomic_ref(*reinterpret_cast<std::uint32_t*>(frames.bytes() + at));
}

bool never() { return false; }

TEST(SharedFrames, EachRequestHasItsAnswer) {
  constexpr std::uint32_t requests = 1000;
  SharedFrames frames = *SharedFrames::make();
  std::jthread other([&] {
    for (std::uint32_t i = 1; i <= requests; ++i) {
      while (counter(frames, SharedLayout::requests) != i) std::this_thread::yield();
      std::uint32_t asked = 0;
      std::memcpy(&asked, frames.bytes() + SharedLayout::request, sizeof asked);
      const std::uint32_t answer[] = {asked + 1, asked + 2};
      std::memcpy(frames.bytes() + SharedLayout::answer, answer, sizeof answer);
      counter(frames, SharedLayout::answers) = i;
    }
  });
  for (std::uint32_t i = 1; i <= requests; ++i) {
    const std::uint32_t request = 7 * i;
    ASSERT_TRUE(frames.write({reinterpret_cast<const char*>(&request), sizeof request}));
    std::uint32_t first = 0, second = 0;  // an answer may be read in parts
    ASSERT_TRUE(frames.read(&first, sizeof first, never));
    ASSERT_TRUE(frames.read(&second, sizeof second, never));
    ASSERT_EQ(first, request + 1);
    ASSERT_EQ(second, request + 2);
  }
}

TEST(SharedFrames, TheEndOfTheOtherSideEndsTheWait) {
  SharedFrames frames = *SharedFrames::make();
  ASSERT_TRUE(frames.write("request"));
  char answer = 0;
  EXPECT_FALSE(frames.read(&answer, 1, [] { return true; }));
}

TEST(SharedFrames, ACounterThatRunsAheadIsNoAnswer) {
  SharedFrames frames = *SharedFrames::make();
  counter(frames, SharedLayout::answers) = 2;
  ASSERT_TRUE(frames.write("request"));
  char answer = 0;
  EXPECT_FALSE(frames.read(&answer, 1, [] { return true; }));
}

TEST(SharedFrames, AFrameHasItsLimit) {
  SharedFrames frames = *SharedFrames::make();
  EXPECT_FALSE(frames.write(std::string(SharedLayout::most + 1, 'x')));
  ASSERT_TRUE(frames.write(std::string(SharedLayout::most, 'x')));
  counter(frames, SharedLayout::answers) = 1;
  std::string answer(SharedLayout::most, '\0');
  EXPECT_TRUE(frames.read(answer.data(), SharedLayout::most, never));
  EXPECT_FALSE(frames.read(answer.data(), 1, never));
}

TEST(SharedFrames, TheOtherSideCannotChangeTheSize) {
  const SharedFrames frames = *SharedFrames::make();
  EXPECT_EQ(::ftruncate(frames.file(), 0), -1);
  EXPECT_EQ(errno, EPERM);
}

}  // namespace
}  // namespace attest
