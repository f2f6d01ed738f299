#include "harness/core/agreement.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace attest {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

TEST(Agreement, EveryNaNIsTheSameAndTheSignOfZeroIsABit) {
  EXPECT_TRUE(same_bits(nan, -nan));
  EXPECT_TRUE(same_bits(-0.0f, -0.0f));
  EXPECT_FALSE(same_bits(-0.0f, 0.0f));
  EXPECT_FALSE(same_bits(nan, 1.0));
  EXPECT_FALSE(same_bits(1.0f, std::nextafter(1.0f, 2.0f)));
}

TEST(Agreement, EqualValuesHaveNoDistanceAndNaNIsFarFromNumbers) {
  for (const double value : {0.0, -3.5, inf, -inf, nan}) EXPECT_EQ(distance(value, value), 0);
  EXPECT_EQ(distance(-0.0, 0.0), 0);
  EXPECT_EQ(distance(-1.5, 2), 3.5);
  for (const double other : {0.0, inf, -inf}) EXPECT_EQ(distance(nan, other), inf);
  EXPECT_EQ(distance(inf, -inf), inf);
}

TEST(Agreement, ANumberNeverAgreesWithInfinityOrNaN) {
  EXPECT_TRUE(agree(1, 1.5, 0.5));
  EXPECT_FALSE(agree(1, 1.5, 0.49));
  for (const double allowed : {0.0, 1.0, inf}) {
    EXPECT_TRUE(agree(nan, nan, allowed));
    EXPECT_TRUE(agree(inf, inf, allowed));
    EXPECT_FALSE(agree(1, inf, allowed));
    EXPECT_FALSE(agree(inf, -inf, allowed));
    EXPECT_FALSE(agree(nan, 1, allowed));
  }
}

}  // namespace
}  // namespace attest
