// Many arguments of a function, compared with their correctly rounded results.
#pragma once

#include <cstdint>
#include <vector>

#include "tests/controller/elementary/functions.hpp"

namespace attest::elementary {

struct Arguments {
  float y, x;
};

struct Swept {
  std::uint64_t arguments = 0;
  std::uint64_t differences = 0;
  std::uint64_t hash = 0;          // of the bits of all results in order, each NaN the same
  std::vector<Arguments> wrong{};  // the first few
  std::vector<Arguments> hard{};   // those that MPFR had to decide
  double seconds = 0;
};

// Every `every`-th of the 2^32 arguments of a function of one argument: in the order of the bits of
// their size, each with both signs.
Swept sweep_arguments(const Function& f, std::uint64_t every, unsigned threads);

// `count` pairs at random, each with both signs of x. In half of the pairs all bits are random. In
// the other half the exponents differ by at most 32.
Swept sweep_pairs(const Function& f, std::uint64_t count, unsigned threads);

// The i-th pair of sweep_pairs(), with the sign of x as it came.
Arguments random_pair(std::uint64_t i);

// 64 bits at random, for each i.
std::uint64_t random_bits(std::uint64_t i);

}  // namespace attest::elementary
