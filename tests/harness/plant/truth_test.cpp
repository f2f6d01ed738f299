#include "tests/harness/plant/truth.hpp"

#include <gtest/gtest.h>

namespace attest::test {
namespace {

TEST(Truth, BothPlantsAreWithinTheirBounds) {
  for (const Truth& truth : truths()) {
    EXPECT_GE(truth.measured, truth.min) << truth.what << ", " << truth.plant;
    EXPECT_LE(truth.measured, truth.max) << truth.what << ", " << truth.plant;
  }
}

}  // namespace
}  // namespace attest::test
