// Diagnoses at the level exact: functions of the C library.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/harness/diagnosis/handmade.hpp"

namespace attest {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::StartsWith;

constexpr std::size_t ticks = 10;

// Vectors of 10 ticks, of which the first ones deviate at the level numeric, too. No fault explains
// them.
class Exact {
 public:
  Exact(std::size_t deviating, std::size_t others) : values_(deviating, others) {
    values_.differs(0, deviating, 0, 1);
    for (std::size_t i = 0; i < deviating + others; ++i) {
      vectors_.push_back({ticks, i < deviating, {}});
    }
  }
  Exact& deviates_first(std::size_t vector, Stage stage) {
    vectors_.at(vector).stage = stage;
    return *this;
  }
  // These sets of calls of the C library give the port's outputs.
  Exact& explained_by(std::size_t vector, std::initializer_list<LibraryCalls> sets) {
    for (const LibraryCalls calls : sets) matches_with(vector, calls, ticks);
    return *this;
  }
  // With these calls, the reference has the port's outputs at `matched` ticks.
  Exact& matches_with(std::size_t vector, LibraryCalls calls, std::size_t matched) {
    vectors_.at(vector).library.with_set.resize(library_call_sets);
    vectors_.at(vector).library.with_set[calls] = matched;
    return *this;
  }
  Exact& matches_with(std::size_t vector, const LibraryCall& single, std::size_t matched) {
    vectors_.at(vector).library.with_single[single] = matched;
    return *this;
  }
  std::optional<Diagnosis> diagnosed() const {
    Evidence evidence = values_.evidence();
    evidence.exact = vectors_;
    return diagnose(evidence);
  }

 private:
  HandMade values_;
  std::vector<ExactVector> vectors_;
};

constexpr LibraryCalls asinf = 1 << 2, acosf = 1 << 3, atan2f = 1 << 5;

TEST(LibraryCalls, TheSmallestSetThatExplainsAllVectorsIsTheOnlySuspect) {
  const auto found = Exact(2, 1)
                         .deviates_first(0, Stage::sticks)
                         .deviates_first(1, Stage::sticks)
                         .explained_by(0, {asinf, asinf | acosf, asinf | atan2f, 63})
                         .explained_by(1, {atan2f, asinf | atan2f, acosf | atan2f, 63})
                         .explained_by(2, {0, asinf, atan2f, asinf | atan2f, 63})
                         .diagnosed();
  ASSERT_TRUE(found);
  ASSERT_THAT(suspected(*found), ElementsAre("libm-asinf-atan2f"));
  const Suspect& first = found->suspects.front();
  EXPECT_EQ(first.explained, 2u);
  EXPECT_EQ(first.failing, 2u);
  EXPECT_THAT(first.ambiguity_group, IsEmpty());
  EXPECT_EQ(found->vectors, 3u);
  EXPECT_EQ(found->failing, 2u);
  EXPECT_EQ(found->unexplained, 0u);
  EXPECT_EQ(found->first_stage, Stage::sticks);
}

TEST(LibraryCalls, SetsOfTheSameSizeAreEquallyGood) {
  const auto found = Exact(1, 0).explained_by(0, {atan2f, asinf, asinf | atan2f}).diagnosed();
  ASSERT_TRUE(found);
  ASSERT_THAT(suspected(*found), ElementsAre("libm-asinf"));
  EXPECT_THAT(ids_of(found->suspects.front().ambiguity_group), ElementsAre("libm-atan2f"));
}

TEST(LibraryCalls, APassingVectorThatTheCallsWouldFailRefutesThem) {
  const auto found = Exact(1, 1).explained_by(0, {asinf}).explained_by(1, {0, atan2f}).diagnosed();
  ASSERT_TRUE(found);
  EXPECT_THAT(found->suspects, IsEmpty());
}

TEST(LibraryCalls, ADeviationBeyondRoundingThatTheyDoNotExplainRefutesThem) {
  const auto found = Exact(3, 0)
                         .explained_by(0, {asinf})
                         .explained_by(1, {asinf})
                         .matches_with(2, asinf, ticks - 1)
                         .diagnosed();
  ASSERT_TRUE(found);
  EXPECT_THAT(found->suspects, IsEmpty());
}

// Vectors that pass at the level numeric.
TEST(LibraryCalls, TheyNeedToExplainHalfOfTheDeviationsByRounding) {
  Exact half(0, 2);
  half.explained_by(0, {asinf}).matches_with(1, asinf, 4);
  const auto found = half.diagnosed();
  ASSERT_TRUE(found);
  ASSERT_THAT(suspected(*found), ElementsAre("libm-asinf"));
  EXPECT_EQ(found->suspects.front().explained, 1u);
  EXPECT_EQ(found->suspects.front().failing, 2u);
  EXPECT_EQ(found->unexplained, 1u);
  Exact third(0, 3);
  third.explained_by(0, {asinf}).matches_with(1, asinf, 4).matches_with(2, asinf, 4);
  EXPECT_FALSE(third.diagnosed());
}

constexpr const char* in_tilt = "atan2f@tilt_error";
constexpr const char* in_yaw = "atan2f@yaw_error";

TEST(LibraryCalls, ASingleCallIsNamedIfItExplainsMoreThanAllCallsOfItsFunction) {
  const auto found = Exact(2, 1)
                         .explained_by(0, {atan2f})
                         .matches_with(0, in_tilt, ticks)
                         .matches_with(1, atan2f, ticks - 1)
                         .matches_with(1, in_tilt, ticks)
                         .matches_with(1, in_yaw, 2)
                         .explained_by(2, {0, atan2f})
                         .diagnosed();
  ASSERT_TRUE(found);
  ASSERT_THAT(suspected(*found), ElementsAre("libm-atan2f@tilt_error"));
  EXPECT_EQ(found->suspects.front().explained, 2u);
  EXPECT_THAT(found->suspects.front().ambiguity_group, IsEmpty());
  EXPECT_THAT(std::string(found->suspects.front().fault->what),
              StartsWith("calls atan2f of the C library where the law has `tilt_error`"));
}

TEST(LibraryCalls, AllCallsAreNamedIfASingleOneExplainsNoMore) {
  const auto found = Exact(1, 1)
                         .explained_by(0, {atan2f})
                         .matches_with(0, in_tilt, ticks)
                         .explained_by(1, {0, atan2f})
                         .diagnosed();
  ASSERT_TRUE(found);
  ASSERT_THAT(suspected(*found), ElementsAre("libm-atan2f"));
  EXPECT_THAT(found->suspects.front().ambiguity_group, IsEmpty());
}

TEST(LibraryCalls, WhereASingleCallDoesNotMatterTheLawPasses) {
  Exact refuted(1, 1);
  refuted.matches_with(0, atan2f, 1).matches_with(0, in_tilt, ticks).explained_by(1, {0});
  EXPECT_THAT(suspected(*refuted.diagnosed()), ElementsAre("libm-atan2f@tilt_error"));
  refuted.matches_with(1, in_tilt, ticks - 1);
  EXPECT_THAT(refuted.diagnosed()->suspects, IsEmpty());
}

TEST(LibraryCalls, APortThatPassesIsNotDiagnosed) {
  EXPECT_FALSE(Exact(0, 2).explained_by(0, {0, asinf}).explained_by(1, {0, asinf}).diagnosed());
}

}  // namespace
}  // namespace attest
