// Seeded random numbers with the same values on every platform. The C++ standard fixes the output
// of the engine, but not that of its distributions; so they are not used.
#pragma once

#include <cstdint>
#include <random>

namespace attest {

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  // Uniform in [0, 1), a multiple of 2^-53.
  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

  // Uniform in [low, high); rounding may give `high`.
  double uniform(double low, double high) { return low + (high - low) * uniform(); }

 private:
  std::mt19937_64 engine_;
};

}  // namespace attest
