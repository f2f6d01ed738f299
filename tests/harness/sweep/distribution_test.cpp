#include "harness/sweep/distribution.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace attest {
namespace {

using Kind = Distribution::Kind;

TEST(Quantile, IsThatOfTheClosedForm) {
  Distribution of{.kind = Kind::uniform, .low = 2, .high = 6, .values = {}};
  EXPECT_EQ(quantile(of, 0.25), 3);
  of = {.kind = Kind::normal, .mean = 10, .deviation = 2, .values = {}};
  EXPECT_EQ(quantile(of, 0.5), 10);
  EXPECT_NEAR(quantile(of, 0.975), 10 + 2 * 1.959963984540054, 1e-13);
  of = {.kind = Kind::log_normal, .median = 3, .spread = 0.1, .values = {}};
  EXPECT_NEAR(quantile(of, 0.5), 3, 1e-15);
  EXPECT_NEAR(quantile(of, normal_probability(1)), 3.3, 1e-13);
  EXPECT_NEAR(quantile(of, normal_probability(-1)), 3 / 1.1, 1e-13);
}

TEST(Quantile, OfATruncatedNormalIsThatOfTheNormalBetweenItsLimits) {
  const Distribution half{.kind = Kind::truncated_normal,
                          .low = 0,
                          .high = 40,
                          .mean = 0,
                          .deviation = 1,
                          .values = {}};
  // Half of a standard normal: its probability below x is 2 Phi(x) - 1.
  EXPECT_NEAR(quantile(half, 2 * normal_probability(1) - 1), 1, 1e-12);
  EXPECT_GE(quantile(half, 0x1p-53), 0);
  const Distribution both{.kind = Kind::truncated_normal,
                          .low = 0.9,
                          .high = 1.1,
                          .mean = 1,
                          .deviation = 0.05,
                          .values = {}};
  EXPECT_NEAR(quantile(both, 0.5), 1, 1e-15);
  EXPECT_NEAR(quantile(both, 0.2), 2 - quantile(both, 0.8), 1e-13);
  EXPECT_NEAR(quantile(both, 0x1p-53), 0.9, 1e-12);
  EXPECT_NEAR(quantile(both, 1 - 0x1p-53), 1.1, 1e-12);
}

TEST(Quantile, OfAChoiceGivesEachValueTheSameProbability) {
  const Distribution of{.kind = Kind::choice, .values = {5, 7, 9}};
  EXPECT_EQ(quantile(of, 0.01), 5);
  EXPECT_EQ(quantile(of, 0.34), 7);
  EXPECT_EQ(quantile(of, 0.67), 9);
  EXPECT_EQ(quantile(of, 1 - 0x1p-53), 9);
}

TEST(Quantile, HasTheseBitsWithEveryCompiler) {
  const Distribution of{.kind = Kind::normal, .mean = 0, .deviation = 1, .values = {}};
  EXPECT_EQ(quantile(of, 0.1), -0x1.4813c36e26d33p+0);
  EXPECT_EQ(quantile(of, 0.999), 0x1.8b8cbb720447p+1);
}

}  // namespace
}  // namespace attest
