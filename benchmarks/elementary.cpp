// The elementary functions of a float, against those of the C library. Each call uses the result of
// the call before, as the law's calls do. The arguments are those of a law: up to a turn.
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include <benchmark/benchmark.h>

#include "controller/attest_math.h"

namespace attest::bench {
namespace {

// 1024 numbers from -1 to 1, by a linear congruential generator.
const std::array<float, 1024>& arguments() {
  static const std::array<float, 1024> numbers = [] {
    std::array<float, 1024> made{};
    std::uint32_t state = 1;
    for (float& number : made) {
      state = state * 1664525 + 1013904223;
      number = static_cast<float>(static_cast<std::int32_t>(state)) * 0x1p-31f;
    }
    return made;
  }();
  return numbers;
}

template <typename Function>
void call(benchmark::State& state, float scale, Function function) {
  const auto& numbers = arguments();
  float result = 0;
  std::size_t i = 0;
  for (auto _ : state) {
    // The earlier result changes no bit of the argument, which the compiler does not know.
    const float none = result * 0x1p-140f * 0x1p-140f;
    result = function(numbers[i % 1024] * scale + none, numbers[(i + 1) % 1024]);
    ++i;
  }
  benchmark::DoNotOptimize(result);
}

void register_function(const char* name, float scale, float (*own)(float, float),
                       float (*host)(float, float)) {
  const std::string prefix = std::string("elementary/") + name;
  benchmark::RegisterBenchmark((prefix + "_own").c_str(), call<decltype(own)>, scale, own);
  benchmark::RegisterBenchmark((prefix + "_host").c_str(), call<decltype(host)>, scale, host);
}

#define ATTEST_FUNCTION(NAME, SCALE)                                    \
  register_function(                                                    \
      #NAME, SCALE, [](float x, float) { return attest_##NAME##f(x); }, \
      [](float x, float) { return std::NAME(x); })

const bool registered = [] {
  constexpr float half_turn = 3.14159274f;
  ATTEST_FUNCTION(sin, half_turn);
  ATTEST_FUNCTION(cos, half_turn);
  ATTEST_FUNCTION(tan, half_turn);
  ATTEST_FUNCTION(asin, 1);
  ATTEST_FUNCTION(acos, 1);
  ATTEST_FUNCTION(exp, 4);
  register_function("atan2", 1, attest_atan2f, [](float y, float x) { return std::atan2(y, x); });
  return true;
}();

}  // namespace
}  // namespace attest::bench
