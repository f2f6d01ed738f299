#include "harness/sweep/sobol_indices.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "harness/sweep/design.hpp"

namespace attest {
namespace {

using std::numbers::pi;

// The function of Ishigami and Homma (1990), with a = 7 and b = 0.1. Its indices are known.
double ishigami(const std::vector<double>& u) {
  const double x = 2 * pi * u[0] - pi, y = 2 * pi * u[1] - pi, z = 2 * pi * u[2] - pi;
  return std::sin(x) + 7 * std::sin(y) * std::sin(y) + 0.1 * std::pow(z, 4) * std::sin(x);
}

struct Known {
  double first, total;
};

std::vector<Known> known_indices() {
  constexpr double a = 7, b = 0.1;
  const double pi4 = std::pow(pi, 4), pi8 = pi4 * pi4;
  const double all = a * a / 8 + b * pi4 / 5 + b * b * pi8 / 18 + 0.5;
  const double x = 0.5 * std::pow(1 + b * pi4 / 5, 2), y = a * a / 8;
  const double xz = b * b * pi8 * 8 / 225;
  return {{x / all, (x + xz) / all}, {y / all, y / all}, {0, xz / all}};
}

std::vector<double> flown(std::uint64_t blocks, const std::string& seed) {
  const Design design{DesignKind::saltelli, 5 * blocks, 3, {}, {}};
  const DesignPoints points(design, SampleStream(seed));
  std::vector<double> values;
  for (std::uint64_t i = 0; i < design.samples; ++i) values.push_back(ishigami(points.at(i)));
  return values;
}

TEST(SobolIndices, AreThoseOfTheIshigamiFunction) {
  const SobolIndices found = sobol_indices(flown(4096, "1"), 3, 0.95);
  ASSERT_EQ(found.dimensions.size(), 3u);
  EXPECT_EQ(found.blocks, 4096u);
  const auto known = known_indices();
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(found.dimensions[i].first, known[i].first, 0.03) << i;
    EXPECT_NEAR(found.dimensions[i].total, known[i].total, 0.03) << i;
  }
}

TEST(SobolIndices, TheIntervalsContainThem) {
  constexpr int sweeps = 50;
  int inside = 0, all = 0;
  double widest = 0;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    const auto found = sobol_indices(flown(256, std::to_string(sweep)), 3, 0.95);
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& [first, total, of_first, of_total] = found.dimensions[i];
      const auto [known_first, known_total] = known_indices()[i];
      inside += of_first.low <= known_first && known_first <= of_first.high ? 1 : 0;
      inside += of_total.low <= known_total && known_total <= of_total.high ? 1 : 0;
      all += 2;
      widest = std::max({widest, of_first.high - of_first.low, of_total.high - of_total.low});
    }
  }
  EXPECT_GE(inside, 0.92 * all);
  EXPECT_LT(widest, 0.6);
}

// The points of a Sobol sequence in 22 dimensions gave 0 with an interval from 0 to 0 here.
TEST(SobolIndices, FewBlocksFindTheOnlyCause) {
  const Design design{DesignKind::saltelli, 16 * 13, 11, {}, {}};
  for (int sweep = 0; sweep < 20; ++sweep) {
    const DesignPoints points(design, SampleStream(std::to_string(sweep)));
    std::vector<double> values;
    for (std::uint64_t i = 0; i < design.samples; ++i) {
      values.push_back(points.at(i)[3] < 0.5 ? 0 : 1);
    }
    const auto found = sobol_indices(values, 11, 0.95);
    ASSERT_EQ(found.dimensions.size(), 11u) << sweep;
    EXPECT_GT(found.dimensions[3].total, 0.3) << sweep;
    EXPECT_GT(found.dimensions[3].total_interval.high, 0.9) << sweep;
    EXPECT_EQ(found.dimensions[4].total, 0) << sweep;
  }
}

TEST(SobolIndices, ABlockWithALostFlightIsLeftOut) {
  auto values = flown(200, "1");
  const SobolIndices whole = sobol_indices({values.begin() + 10, values.end()}, 3, 0.95);
  values[3] = std::nan("");
  values[9] = std::numeric_limits<double>::infinity();
  const SobolIndices found = sobol_indices(values, 3, 0.95);
  EXPECT_EQ(found.blocks, 198u);
  EXPECT_EQ(found.left_out, 2u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(found.dimensions[i].first, whole.dimensions[i].first);
    EXPECT_EQ(found.dimensions[i].total, whole.dimensions[i].total);
  }
}

TEST(SobolIndices, TooFewBlocksOrAConstantHaveNone) {
  EXPECT_TRUE(sobol_indices(flown(9, "1"), 3, 0.95).dimensions.empty());
  EXPECT_TRUE(sobol_indices(std::vector<double>(500, 1.5), 3, 0.95).dimensions.empty());
}

}  // namespace
}  // namespace attest
