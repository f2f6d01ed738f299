#include "harness/core/random.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

namespace attest {
namespace {

// Goldens depend on these numbers, so they may never change.
TEST(Random, HasTheValuesOfTheStandardsEngine) {
  Random random(5489);  // whose 10000th output the C++ standard gives: 9981545732273789042
  for (int i = 0; i < 9999; ++i) random.uniform();
  EXPECT_EQ(random.uniform(), static_cast<double>(9981545732273789042u >> 11) * 0x1p-53);
}

RC_GTEST_PROP(Random, StaysInItsRange, (std::uint64_t seed, int low, unsigned width)) {
  const double begin = low;
  const double end = begin + 1 + width;
  Random random(seed);
  for (int i = 0; i < 100; ++i) {
    const double value = random.uniform(begin, end);
    RC_ASSERT(value >= begin);
    RC_ASSERT(value < end);
  }
}

TEST(Random, SeedsDiffer) { EXPECT_NE(Random(1).uniform(), Random(2).uniform()); }

}  // namespace
}  // namespace attest
