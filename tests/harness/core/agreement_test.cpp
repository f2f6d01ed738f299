#include "harness/core/agreement.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace attest {
namespace {

constexpr double endless = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

TEST(Agreement, EveryNaNIsTheSameAndTheSignOfZeroIsABit) {
  EXPECT_TRUE(same_bits(not_a_number, -not_a_number));
  EXPECT_TRUE(same_bits(-0.0f, -0.0f));
  EXPECT_FALSE(same_bits(-0.0f, 0.0f));
  EXPECT_FALSE(same_bits(not_a_number, 1.0));
  EXPECT_FALSE(same_bits(1.0f, std::nextafter(1.0f, 2.0f)));
}

TEST(Agreement, EqualValuesHaveNoDistanceAndNaNIsFarFromNumbers) {
  for (const double value : {0.0, -3.5, endless, -endless, not_a_number})
    EXPECT_EQ(distance(value, value), 0);
  EXPECT_EQ(distance(-0.0, 0.0), 0);
  EXPECT_EQ(distance(-1.5, 2), 3.5);
  for (const double other : {0.0, endless, -endless})
    EXPECT_EQ(distance(not_a_number, other), endless);
  EXPECT_EQ(distance(endless, -endless), endless);
}

TEST(Agreement, ANumberNeverAgreesWithInfinityOrNaN) {
  EXPECT_TRUE(agree(1, 1.5, 0.5));
  EXPECT_FALSE(agree(1, 1.5, 0.49));
  for (const double allowed : {0.0, 1.0, endless}) {
    EXPECT_TRUE(agree(not_a_number, not_a_number, allowed));
    EXPECT_TRUE(agree(endless, endless, allowed));
    EXPECT_FALSE(agree(1, endless, allowed));
    EXPECT_FALSE(agree(endless, -endless, allowed));
    EXPECT_FALSE(agree(not_a_number, 1, allowed));
  }
}

}  // namespace
}  // namespace attest
