// The random numbers of a sweep: functions of seed, purpose and two counters. No number depends on
// another one, so each machine can make those of any sample.
//
// They are SHA-256 in counter mode, so the bits are the same on every platform.
#pragma once

#include <cstdint>
#include <string>
#include <utility>

namespace attest {

class SampleStream {
 public:
  // `seed`: any text, for example a SHA-256 in hexadecimal digits.
  explicit SampleStream(std::string seed) : seed_(std::move(seed)) {}

  enum class Purpose : std::uint8_t { point, permutation, shift, seed };

  // 64 uniform bits.
  std::uint64_t bits(Purpose purpose, std::uint64_t sample, std::uint64_t item) const;

 private:
  std::string seed_;
};

// Uniform in (0, 1), never 0 or 1: an odd multiple of 2^-53.
double open_uniform(std::uint64_t bits);

}  // namespace attest
