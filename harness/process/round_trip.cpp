#include "harness/process/round_trip.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "harness/process/piped_program.hpp"
#include "harness/process/shared_frames.hpp"

namespace attest {
namespace {

// Empty: an exchange failed.
std::optional<Nanoseconds> median_of(const std::function<bool()>& exchange) {
  constexpr std::size_t exchanges = 1001;  // takes milliseconds
  std::vector<Nanoseconds> times;
  for (std::size_t i = 0; i < exchanges; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    if (!exchange()) return std::nullopt;
    times.push_back(std::chrono::steady_clock::now() - begin);
  }
  const auto middle = times.begin() + exchanges / 2;
  std::nth_element(times.begin(), middle, times.end());
  return *middle;
}

void answer_all(std::byte* memory, std::stop_token stop) {
  const auto counter = [&](std::size_t at) {
    return std::atomic_ref(*reinterpret_cast<std::uint32_t*>(memory + at));
  };
  while (!stop.stop_requested()) {
    counter(SharedLayout::answers).store(counter(SharedLayout::requests));
    std::this_thread::yield();
  }
}

}  // namespace

Result<Nanoseconds> pipe_round_trip(std::size_t bytes) {
  auto echo = PipedProgram::start({"cat"});
  if (!echo) return tl::unexpected(echo.error());
  std::string frame(bytes, 'x');
  const auto time =
      median_of([&] { return echo->write(frame) && echo->read(frame.data(), frame.size()); });
  if (!time) return fail("`cat` does not answer");
  return *time;
}

Result<Nanoseconds> memory_round_trip(std::size_t bytes) {
  auto frames = SharedFrames::make();
  if (!frames) return tl::unexpected(frames.error());
  std::string frame(bytes, 'x');
  std::jthread other([&](std::stop_token stop) { answer_all(frames->bytes(), stop); });
  const auto time = median_of([&] {
    return frames->write(frame) && frames->read(frame.data(), frame.size(), [] { return false; });
  });
  if (!time) return fail("the frame is too long");
  return *time;
}

}  // namespace attest
