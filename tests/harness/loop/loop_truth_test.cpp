#include "tests/harness/loop/loop_truth.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace attest::test {
namespace {

// The simpler models miss every bound: so the bounds tell a wrong model from a right one.
TEST(LoopTruth, TheModelsAreWithinTheirBoundsAndSimplerOnesAreNot) {
  for (const LoopTruth& truth : loop_truths(500)) {
    EXPECT_LE(truth.difference, truth.bound) << truth.of << ", " << truth.what;
    if (!truth.simple) continue;
    EXPECT_GT(std::abs(*truth.simple - truth.exact), truth.bound) << truth.of << ", " << truth.what;
  }
}

}  // namespace
}  // namespace attest::test
