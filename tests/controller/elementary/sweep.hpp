// Many arguments of a function, compared with their correctly rounded results.
#pragma once

#include <cstdint>
#include <vector>

#include "controller/elementary/fixed_arguments.hpp"
#include "tests/controller/elementary/functions.hpp"

namespace attest::elementary {

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

// `count` pairs of random_pair(), each also with the other sign of x.
Swept sweep_pairs(const Function& f, std::uint64_t count, unsigned threads);

}  // namespace attest::elementary
