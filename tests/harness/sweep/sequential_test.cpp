#include "harness/sweep/sequential.hpp"

#include <cmath>
#include <functional>
#include <random>

#include <gtest/gtest.h>

namespace attest {
namespace {

TEST(Sequential, TheMixtureIsThatOfTheFormula) {
  // B(3, 2) / (0.5^2 * 0.5) = (2! 1! / 4!) * 8
  EXPECT_NEAR(std::exp(log_mixture_ratio(2, 3, 0.5)), 2.0 / 24 * 8, 1e-14);
  // Only successes: 1 / (n + 1) / p^n.
  EXPECT_NEAR(std::exp(log_mixture_ratio(10, 10, 0.9)), 1 / (11 * std::pow(0.9, 10)), 1e-12);
}

TEST(Sequential, AnIntervalEndsWhereProbabilitiesAreExcluded) {
  const auto [low, high] = sequential_interval(180, 200, 0.95);
  EXPECT_FALSE(excludes(180, 200, low + 1e-9, 0.95));
  EXPECT_TRUE(excludes(180, 200, low - 1e-9, 0.95));
  EXPECT_FALSE(excludes(180, 200, high - 1e-9, 0.95));
  EXPECT_TRUE(excludes(180, 200, high + 1e-9, 0.95));
  EXPECT_EQ(sequential_interval(0, 0, 0.95).high, 1);
  EXPECT_EQ(sequential_interval(0, 5, 0.95).low, 0);
  EXPECT_EQ(sequential_interval(5, 5, 0.95).high, 1);
}

TEST(Sequential, ItIsWiderThanTheIntervalForAFixedNumber) {
  const Interval fixed = clopper_pearson(180, 200, 0.95);
  const Interval sequential = sequential_interval(180, 200, 0.95);
  EXPECT_LT(sequential.low, fixed.low);
  EXPECT_GT(sequential.high, fixed.high);
}

// The share of sweeps in which the true probability is ever excluded.
double ever_excluded(double probability, int samples,
                     const std::function<bool(std::uint64_t, std::uint64_t)>& is_excluded) {
  constexpr int sweeps = 1000;
  std::mt19937_64 random(20261);
  int wrong = 0;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    std::uint64_t held = 0;
    for (int count = 1; count <= samples; ++count) {
      if (static_cast<double>(random() >> 11) * 0x1p-53 < probability) ++held;
      if (!is_excluded(held, static_cast<std::uint64_t>(count))) continue;
      ++wrong;
      break;
    }
  }
  return static_cast<double>(wrong) / sweeps;
}

TEST(Sequential, LookingAfterEverySampleKeepsTheConfidence) {
  constexpr double confidence = 0.9;
  for (const double probability : {0.5, 0.9, 0.99}) {
    const double wrong = ever_excluded(probability, 3000, [&](auto held, auto count) {
      return excludes(held, count, probability, confidence);
    });
    EXPECT_LE(wrong, 1 - confidence) << probability;
    EXPECT_GT(wrong, 0.005) << probability;  // the simulation can find errors
  }
}

// Why the interval of Clopper and Pearson must not be looked at again and again.
TEST(Sequential, TheIntervalForAFixedNumberWouldLoseIt) {
  const double wrong = ever_excluded(0.9, 300, [](auto held, auto count) {
    const Interval interval = clopper_pearson(held, count, 0.9);
    return interval.low > 0.9 || interval.high < 0.9;
  });
  EXPECT_GT(wrong, 0.2);
}

TEST(Sequential, ASignTestIsSmallForManyEqualSigns) {
  EXPECT_EQ(sequential_sign_test(0, 0), 1);
  EXPECT_EQ(sequential_sign_test(5, 5), 1);
  EXPECT_NEAR(sequential_sign_test(20, 0), 21 * std::pow(0.5, 20), 1e-12);
  EXPECT_EQ(sequential_sign_test(20, 0), sequential_sign_test(0, 20));
}

}  // namespace
}  // namespace attest
