#include "harness/sweep/design.hpp"

#include <cmath>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/sweep/distribution.hpp"
#include "harness/sweep/statistics.hpp"

namespace attest {
namespace {

using testing::HasSubstr;

Design design_of(DesignKind kind, std::uint64_t samples, std::size_t dimensions) {
  return {kind, samples, dimensions, {}, {}};
}

std::vector<std::vector<double>> all_points(const Design& design, const std::string& seed = "1") {
  const DesignPoints points(design, SampleStream(seed));
  std::vector<std::vector<double>> all;
  for (std::uint64_t i = 0; i < design.samples; ++i) all.push_back(points.at(i));
  return all;
}

TEST(Saltelli, ABlockIsTwoPointsAndTheirMixtures) {
  const Design design = design_of(DesignKind::saltelli, 50, 3);
  const auto all = all_points(design);
  for (std::size_t begin = 0; begin < all.size(); begin += 5) {
    const auto &a = all[begin], &b = all[begin + 1];
    for (std::size_t i = 0; i < 3; ++i) {
      auto mixed = a;
      mixed[i] = b[i];
      EXPECT_NE(a[i], b[i]);
      EXPECT_EQ(all[begin + 2 + i], mixed);
      EXPECT_EQ(design.with_seeds(begin + 2 + i), begin);
      EXPECT_FALSE(design.is_judged(begin + 2 + i));
    }
    EXPECT_EQ(design.with_seeds(begin + 1), begin + 1);
    EXPECT_TRUE(design.is_judged(begin) && design.is_judged(begin + 1));
  }
}

class EveryDesign : public testing::TestWithParam<DesignKind> {
 protected:
  static Design design() {
    Design one = design_of(GetParam(), 60, 3);
    if (GetParam() == DesignKind::grid) one.levels = {3, 4, 5};
    return one;
  }
};

INSTANTIATE_TEST_SUITE_P(Kinds, EveryDesign,
                         testing::Values(DesignKind::monte_carlo, DesignKind::latin_hypercube,
                                         DesignKind::sobol, DesignKind::grid, DesignKind::saltelli),
                         [](const auto& kind) { return std::string(name_of(kind.param)); });

TEST_P(EveryDesign, APointDependsOnItsIndexOnly) {
  const auto all = all_points(design());
  const DesignPoints again(design(), SampleStream("1"));
  for (std::uint64_t i = design().samples; i-- > 0;) EXPECT_EQ(again.at(i), all[i]) << i;
}

TEST_P(EveryDesign, PointsAreInsideOfTheUnitCube) {
  for (const auto& point : all_points(design())) {
    EXPECT_EQ(point.size(), 3u);
    for (const double u : point) EXPECT_TRUE(u > 0 && u < 1) << u;
  }
}

TEST_P(EveryDesign, PointsOfAnotherSeedDiffer) {
  const bool is_equal = all_points(design(), "1") == all_points(design(), "2");
  EXPECT_EQ(is_equal, GetParam() == DesignKind::grid);
}

TEST(LatinHypercube, HasOneSampleInEachStratum) {
  for (const std::uint64_t samples : {1ull, 2ull, 7ull, 100ull, 101ull}) {
    const auto all = all_points(design_of(DesignKind::latin_hypercube, samples, 4));
    for (std::size_t dimension = 0; dimension < 4; ++dimension) {
      std::set<std::uint64_t> strata;
      for (const auto& point : all) {
        strata.insert(static_cast<std::uint64_t>(point[dimension] * static_cast<double>(samples)));
      }
      EXPECT_EQ(strata.size(), samples) << dimension;
    }
  }
}

TEST(LatinHypercube, DimensionsHaveDifferentOrders) {
  const auto all = all_points(design_of(DesignKind::latin_hypercube, 500, 2));
  std::vector<double> x, y;
  for (const auto& point : all) x.push_back(point[0]), y.push_back(point[1]);
  EXPECT_LT(std::abs(rank_correlation(x, y)), 0.15);
}

// Joe and Kuo's first points of three dimensions, in the order of the Gray code.
TEST(Sobol, IsThePublishedSequenceWithADigitalShift) {
  const std::vector<std::vector<double>> published = {{0, 0, 0},
                                                      {0.5, 0.5, 0.5},
                                                      {0.75, 0.25, 0.25},
                                                      {0.25, 0.75, 0.75},
                                                      {0.375, 0.375, 0.625},
                                                      {0.875, 0.875, 0.125},
                                                      {0.625, 0.125, 0.875},
                                                      {0.125, 0.625, 0.375}};
  const auto all = all_points(design_of(DesignKind::sobol, 8, 3));
  const auto eighth = [](double u) { return static_cast<int>(u * 8); };
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t dimension = 0; dimension < 3; ++dimension) {
      const int shift = eighth(all[0][dimension]);  // the first point is 0
      EXPECT_EQ(eighth(all[i][dimension]), eighth(published[i][dimension]) ^ shift)
          << "point " << i << ", dimension " << dimension;
    }
  }
}

TEST(Grid, HasAllCombinationsOfTheMiddlesOfItsLevels) {
  Design grid = design_of(DesignKind::grid, 6, 2);
  grid.levels = {2, 3};
  std::set<std::vector<double>> points;
  for (const auto& point : all_points(grid)) points.insert(point);
  EXPECT_EQ(points.size(), 6u);
  EXPECT_TRUE(points.contains({0.25, 0.5 / 3}));
  EXPECT_TRUE(points.contains({0.75, 2.5 / 3}));
}

TEST(Permutation, HasEachNumberOnce) {
  const SampleStream stream("seed");
  for (const std::uint64_t count : {1ull, 2ull, 3ull, 10ull, 97ull, 1000ull}) {
    std::set<std::uint64_t> all;
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::uint64_t place = permuted(i, count, 3, stream);
      EXPECT_LT(place, count);
      all.insert(place);
    }
    EXPECT_EQ(all.size(), count);
  }
}

TEST(Correlation, IsThatOfTheNormalScores) {
  Design design = design_of(DesignKind::latin_hypercube, 4000, 2);
  design.correlation = {1, -0.8, -0.8, 1};
  ASSERT_TRUE(check_correlation(design));
  double xx = 0, xy = 0, yy = 0;
  for (const auto& point : all_points(design)) {
    const double x = normal_quantile(point[0]), y = normal_quantile(point[1]);
    xx += x * x, xy += x * y, yy += y * y;
  }
  EXPECT_NEAR(xy / std::sqrt(xx * yy), -0.8, 0.02);
  EXPECT_NEAR(yy / 4000, 1, 0.03);
}

TEST(Correlation, ThatIsNotPositiveDefiniteIsRefused) {
  Design design = design_of(DesignKind::monte_carlo, 10, 3);
  design.correlation = {1, 0.9, -0.9, 0.9, 1, 0.9, -0.9, 0.9, 1};
  EXPECT_THAT(check_correlation(design).error().message, HasSubstr("not positive definite"));
}

}  // namespace
}  // namespace attest
