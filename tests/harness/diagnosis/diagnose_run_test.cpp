#include "harness/diagnosis/diagnose_run.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace attest {
namespace {

// Of a vector that passed with this headroom.
VectorResult passed(double headroom) {
  VectorResult result;
  result.compared = Level::numeric;
  result.tightest = Headroom{headroom};
  return result;
}

std::vector<VectorResult> passed_each(std::initializer_list<double> headrooms) {
  std::vector<VectorResult> results;
  for (const double headroom : headrooms) results.push_back(passed(headroom));
  return results;
}

TEST(ShareOfTolerances, APortWithoutRoundingMustBeWithinATenth) {
  VectorResult same_bits = passed(1);
  same_bits.tightest.reset();
  EXPECT_EQ(share_of_tolerances({same_bits}, Level::numeric), 0.1);
  const double sign_of_0 = std::numeric_limits<double>::infinity();
  EXPECT_EQ(share_of_tolerances(passed_each({sign_of_0}), Level::numeric), 0.1);
}

TEST(ShareOfTolerances, IsTenTimesTheRounding) {
  const auto results = passed_each({90, 80, 70, 60, 50, 300, 300, 300, 300, 4000});
  EXPECT_DOUBLE_EQ(share_of_tolerances(results, Level::numeric), 0.2);
  EXPECT_EQ(share_of_tolerances(passed_each({3}), Level::numeric), 1) << "a port in fixed point";
}

// A small mistake hides in a few of the vectors that passed.
TEST(ShareOfTolerances, ATenthOfTheVectorsMayBeNearToFailing) {
  auto results = passed_each({1.01});
  for (int i = 0; i < 19; ++i) results.push_back(passed(1e6));
  EXPECT_EQ(share_of_tolerances(results, Level::numeric), 0.1);
}

TEST(ShareOfTolerances, IsAllOfThemIfNothingIsKnownOfTheRounding) {
  EXPECT_EQ(share_of_tolerances({}, Level::numeric), 1);
  VectorResult failed = passed(100);
  failed.verdict = Verdict::fail;
  VectorResult not_compared = passed(100);
  not_compared.compared.reset();
  EXPECT_EQ(share_of_tolerances({failed, not_compared}, Level::numeric), 1);
  // Vectors that pass at the level exact have no rounding, and those with rounding fail.
  EXPECT_EQ(share_of_tolerances(passed_each({1e6}), Level::exact), 1);
  EXPECT_EQ(share_of_tolerances(passed_each({1e6}), Level::events), 1);
}

}  // namespace
}  // namespace attest
