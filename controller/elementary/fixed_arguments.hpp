// Fixed arguments of the functions of attest_math.h, and a hash of the correctly rounded results.
//
// A build whose results have another hash was compiled wrongly, or is damaged. `attest doctor`
// compares them. MPFR gave the hashes: tests/controller/elementary computes them again.
//
// Pure functions; any thread.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "controller/attest_math.h"

namespace attest::elementary {

struct Arguments {
  float y, x;
};

// 64 bits at random, for each i: SplitMix64 (Steele, Lea, Flood 2014).
inline std::uint64_t random_bits(std::uint64_t i) {
  std::uint64_t z = (i + 1) * 0x9e3779b97f4a7c15;
  z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9;
  z = (z ^ z >> 27) * 0x94d049bb133111eb;
  return z ^ z >> 31;
}

// A pair at random, for each i. If i is even, all bits are random. If i is odd, the exponents
// differ by at most 32.
inline Arguments random_pair(std::uint64_t i) {
  const std::uint64_t bits = random_bits(i);
  const auto y = static_cast<std::uint32_t>(bits);
  auto x = static_cast<std::uint32_t>(bits >> 32);
  if (i % 2 == 1) {
    const int exponent = static_cast<int>(y >> 23 & 0xff) + static_cast<int>(x >> 23 & 63) - 32;
    x = (x & 0x807fffff) | static_cast<std::uint32_t>(std::clamp(exponent, 0, 254)) << 23;
  }
  return {std::bit_cast<float>(y), std::bit_cast<float>(x)};
}

// A number with the same significand, but with a size from 2^-16 to 2^8. The results of asin, acos,
// exp and atan2 are limits, or almost the argument, for most sizes beyond.
inline float moderate(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const std::uint32_t exponent = 127 - 16 + (bits >> 23 & 0xff) % 24;
  return std::bit_cast<float>((bits & 0x807fffff) | exponent << 23);
}

// FNV-1a, with words in place of bytes.
inline void add_to_hash(std::uint64_t& hash, std::uint64_t word) {
  hash = (hash ^ word) * 0x100000001b3;
}

inline constexpr std::size_t fixed_pairs = 1 << 16;

struct FixedFunction {
  std::string_view name;
  float (*result)(float y, float x);  // a function of one argument takes y
  std::uint64_t hash;                 // hash_of() the correctly rounded results
  // Hard cases need the exact path, which random arguments hardly ever do. They are of
  // hard_cases.txt in tests/controller/elementary, as far as it has four.
  Arguments hard[4];
};

inline constexpr FixedFunction fixed_functions[] = {
    {"sin",
     [](float y, float) { return attest_sinf(y); },
     0xaf73cced3fc8c673,
     {{0x1.e35bc6p+7f, 0}, {-0x1.33333p+13f, 0}, {0x1.524856p+80f, 0}, {0x1.b559b6p+117f, 0}}},
    {"cos",
     [](float y, float) { return attest_cosf(y); },
     0x140b2f5264afb23a,
     {{0x1p-12f, 0}, {0x1.20ffccp-7f, 0}, {0x1.3170fp+63f, 0}, {-0x1.96344ep+117f, 0}}},
    {"tan",
     [](float y, float) { return attest_tanf(y); },
     0x60efee4e89ceb070,
     {{0x1.b0e75cp+59f, 0}, {-0x1.b0e75cp+59f, 0}, {0x1.fa6748p+64f, 0}, {-0x1.fa6748p+64f, 0}}},
    {"asin",
     [](float y, float) { return attest_asinf(y); },
     0x0132a53f34eecac7,
     {{0x1.cbf43cp-4f, 0}, {-0x1.cbf43cp-4f, 0}, {0x1.107434p-1f, 0}, {-0x1.107434p-1f, 0}}},
    {"acos",
     [](float y, float) { return attest_acosf(y); },
     0x3e56ae62c6f70a8d,
     {{0x1.110b46p-26f, 0}, {0x1.04c444p-12f, 0}, {-0x1.80d99ap-7f, 0}, {1, 0}}},
    {"exp",
     [](float y, float) { return attest_expf(y); },
     0xe653d1ed07eab138,
     {{-0x1.d2259ap+3f, 0}, {0, 0}, {0x1p-25f, 0}, {-0x1p-25f, 0}}},
    {"atan2",
     attest_atan2f,
     0xe54b6cdf27cdc5a0,
     {{-0x1.825c24p-108f, -0x1.151346p-104f},
      {0x1.2329e4p+122f, -0x1.30d23ap+127f},
      {0x1.800006p+1f, 0x1.000006p+23f},
      {0x1.dcf9ecp+23f, 0x1.021f16p+23f}}},
};

// The hash of the results of `f`, a function of y and x, for the fixed arguments of `function`.
template <typename F>
std::uint64_t hash_of(const FixedFunction& function, F f) {
  std::uint64_t hash = 0;
  const auto add = [&](float y, float x) {
    add_to_hash(hash, std::bit_cast<std::uint32_t>(f(y, x)));
  };
  for (const auto& [y, x] : function.hard) add(y, x);
  for (std::size_t i = 0; i < fixed_pairs; ++i) {
    auto [y, x] = random_pair(i);
    if (i % 2 == 0) {
      y = moderate(y);
      x = moderate(x);
    }
    add(y, x);
  }
  return hash;
}

inline bool is_correct(const FixedFunction& function) {
  return hash_of(function, function.result) == function.hash;
}

}  // namespace attest::elementary
