#include "harness/sweep/statistics.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace attest {
namespace {

TEST(ClopperPearson, HasTheClosedFormAtItsEnds) {
  // No failure of n: the lower bound is (alpha / 2)^(1 / n).
  EXPECT_NEAR(clopper_pearson(100, 100, 0.95).low, std::pow(0.025, 0.01), 1e-12);
  EXPECT_EQ(clopper_pearson(100, 100, 0.95).high, 1);
  EXPECT_EQ(clopper_pearson(0, 100, 0.95).low, 0);
  EXPECT_NEAR(clopper_pearson(0, 100, 0.95).high, 1 - std::pow(0.025, 0.01), 1e-12);
}

TEST(ClopperPearson, HasThePublishedInterval) {
  // 81 of 263: 0.2527 to 0.3676 (Newcombe, Statistics in Medicine 17, 1998, table I).
  const Interval interval = clopper_pearson(81, 263, 0.95);
  EXPECT_NEAR(interval.low, 0.2527, 5e-5);
  EXPECT_NEAR(interval.high, 0.3676, 5e-5);
}

TEST(ClopperPearson, KnowsNothingWithoutASample) {
  EXPECT_EQ(clopper_pearson(0, 0, 0.95).low, 0);
  EXPECT_EQ(clopper_pearson(0, 0, 0.95).high, 1);
}

TEST(EmpiricalQuantile, IsAnObservedValue) {
  const std::vector<double> values{1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
  EXPECT_EQ(empirical_quantile(values, 0), 1);
  EXPECT_EQ(empirical_quantile(values, 0.5), 5);
  EXPECT_EQ(empirical_quantile(values, 0.51), 6);
  EXPECT_EQ(empirical_quantile(values, 1), 10);
}

TEST(RankCorrelation, IsThatOfTheRanks) {
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_NEAR(rank_correlation({1, 2, 3, 4}, {1, 8, 27, infinity}), 1, 1e-12);
  EXPECT_NEAR(rank_correlation({1, 2, 3, 4}, {9, 7, 5, -3}), -1, 1e-12);
  // By hand: ranks 1, 2.5, 2.5, 4 and 1, 3, 2, 4: 4.5 / sqrt(4.5 * 5).
  EXPECT_NEAR(rank_correlation({1, 2, 2, 3}, {1, 3, 2, 4}), 4.5 / std::sqrt(4.5 * 5), 1e-12);
}

TEST(RankCorrelation, LeavesOutFlightsWithoutAValue) {
  const double nan = std::nan("");
  EXPECT_NEAR(rank_correlation({1, 9, 2, 3}, {1, nan, 2, 3}), 1, 1e-12);
  EXPECT_TRUE(std::isnan(rank_correlation({1, 2, 3}, {5, 5, 5})));
  EXPECT_TRUE(std::isnan(rank_correlation({1, 2}, {5, 6})));
}

TEST(SignTest, IsExact) {
  EXPECT_EQ(sign_test(0, 0), 1);
  EXPECT_EQ(sign_test(5, 5), 1);
  EXPECT_NEAR(sign_test(10, 0), 2 * std::pow(0.5, 10), 1e-15);
  EXPECT_NEAR(sign_test(1, 9), 2 * 11 * std::pow(0.5, 10), 1e-15);  // 1 + 10 of 1024, twice
}

}  // namespace
}  // namespace attest
