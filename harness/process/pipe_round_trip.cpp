#include "harness/process/pipe_round_trip.hpp"

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include "harness/process/piped_program.hpp"

namespace attest {

Result<Nanoseconds> pipe_round_trip(std::size_t bytes) {
  constexpr std::size_t exchanges = 1001;  // takes milliseconds
  auto echo = PipedProgram::start({"cat"});
  if (!echo) return tl::unexpected(echo.error());
  std::string frame(bytes, 'x');
  std::vector<Nanoseconds> times;
  for (std::size_t i = 0; i < exchanges; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    if (!echo->write(frame) || !echo->read(frame.data(), frame.size())) {
      return fail("`cat` does not answer");
    }
    times.push_back(std::chrono::steady_clock::now() - begin);
  }
  const auto middle = times.begin() + exchanges / 2;
  std::nth_element(times.begin(), middle, times.end());
  return *middle;
}

}  // namespace attest
