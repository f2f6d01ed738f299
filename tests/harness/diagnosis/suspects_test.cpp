// Diagnoses of handmade similarities.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/harness/diagnosis/handmade.hpp"

namespace attest {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::StartsWith;

TEST(Suspects, WhereNothingFailsThereIsNoDiagnosis) {
  EXPECT_FALSE(diagnose({}));
  EXPECT_FALSE(diagnose(HandMade(0, 3).matches(yaw_fault, 0, 3)));
}

TEST(Suspects, AFaultThatExplainsFourOfFiveAndPassesJust95PercentIsNamed) {
  const auto found = diagnose(HandMade(5, 20).matches(yaw_fault, 0, 4).matches(yaw_fault, 5, 24));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->vectors, 25u);
  EXPECT_EQ(found->failing, 5u);
  EXPECT_EQ(found->unexplained, 1u);
  ASSERT_THAT(suspected(*found), ElementsAre(yaw_fault));
  const Suspect& first = found->suspects.front();
  EXPECT_EQ(first.explained, 4u);
  EXPECT_EQ(first.failing, 5u);
  EXPECT_EQ(first.matched, 40u);
  EXPECT_EQ(first.ticks, 50u);
  EXPECT_EQ(first.with, nullptr);
  EXPECT_EQ(found->stage, faults::Stage::yaw);
}

TEST(Suspects, AFaultThatDeviatesInMoreThan5PercentOfWhatPassesIsOut) {
  const auto found = diagnose(HandMade(5, 20).matches(yaw_fault, 0, 5).matches(yaw_fault, 5, 23));
  ASSERT_TRUE(found);
  EXPECT_THAT(found->suspects, IsEmpty());
  EXPECT_EQ(found->unexplained, 5u);
}

TEST(Suspects, WhereNoVectorPassesNothingIsOut) {
  const auto found = diagnose(HandMade(2, 0).matches(yaw_fault, 0, 2));
  ASSERT_TRUE(found);
  ASSERT_THAT(suspected(*found), ElementsAre(yaw_fault));
  EXPECT_EQ(found->unexplained, 0u);
}

TEST(Suspects, AVectorIsExplainedByAllOfItsTicks) {
  const auto found =
      diagnose(HandMade(2, 1).matches(yaw_fault, 0, 2, ticks - 1).matches(yaw_fault, 2, 3));
  ASSERT_TRUE(found);
  EXPECT_THAT(found->suspects, IsEmpty());
  EXPECT_EQ(found->unexplained, 2u);
}

TEST(Suspects, APassingVectorIsPassedByAllOfItsTicks) {
  const auto found =
      diagnose(HandMade(1, 1).matches(yaw_fault, 0, 1).matches(yaw_fault, 1, 2, ticks - 1));
  ASSERT_TRUE(found);
  EXPECT_THAT(found->suspects, IsEmpty());
}

TEST(Suspects, WhatExplainsMoreIsFirstThoughAnotherPassesMore) {
  for (const auto& [best, other] : {std::pair{tilt_fault, tpa_fault}, {tpa_fault, tilt_fault}}) {
    HandMade vectors(3, 20);
    vectors.matches(best, 0, 3).matches(best, 3, 22);
    vectors.matches(other, 1, 3).matches(other, 3, 23);
    const auto found = diagnose(vectors);
    ASSERT_TRUE(found);
    ASSERT_THAT(suspected(*found), ElementsAre(best));
    EXPECT_THAT(found->suspects.front().ambiguity_group, IsEmpty());
  }
}

TEST(Suspects, OfTwoThatExplainAsMuchTheOneThatPassesMoreIsFirst) {
  for (const auto& [best, other] : {std::pair{tilt_fault, tpa_fault}, {tpa_fault, tilt_fault}}) {
    HandMade vectors(2, 20);
    vectors.matches(best, 0, 1).matches(best, 2, 22);
    vectors.matches(other, 0, 1).matches(other, 1, 2, ticks - 1).matches(other, 2, 21);
    const auto found = diagnose(vectors);
    ASSERT_TRUE(found);
    ASSERT_THAT(suspected(*found), ElementsAre(best));
    EXPECT_THAT(found->suspects.front().ambiguity_group, IsEmpty());
  }
}

TEST(Suspects, ThenTheOneThatMatchesMoreOfTheFailingTicksIsFirst) {
  for (const auto& [best, other] : {std::pair{tilt_fault, tpa_fault}, {tpa_fault, tilt_fault}}) {
    HandMade vectors(2, 1);
    vectors.matches(best, 0, 1).matches(best, 1, 2, 6).matches(best, 2, 3);
    vectors.matches(other, 0, 1).matches(other, 1, 2, 5).matches(other, 2, 3);
    const auto found = diagnose(vectors);
    ASSERT_TRUE(found);
    ASSERT_THAT(suspected(*found), ElementsAre(best));
    EXPECT_EQ(found->suspects.front().matched, 16u);
    EXPECT_THAT(found->suspects.front().ambiguity_group, IsEmpty());
  }
}

TEST(Suspects, LastTheOneThatMatchesMoreOfThePassingTicksIsFirst) {
  for (const auto& [best, other] : {std::pair{tilt_fault, tpa_fault}, {tpa_fault, tilt_fault}}) {
    HandMade vectors(1, 20);
    vectors.matches(best, 0, 20).matches(best, 20, 21, 6);
    vectors.matches(other, 0, 20).matches(other, 20, 21, 5);
    const auto found = diagnose(vectors);
    ASSERT_TRUE(found);
    ASSERT_THAT(suspected(*found), ElementsAre(best));
    EXPECT_THAT(found->suspects.front().ambiguity_group, IsEmpty());
  }
}

TEST(Suspects, FaultsThatMatchAsWellAreNamedWithTheFirst) {
  HandMade vectors(2, 1);
  for (const char* const id : {tilt_fault, yaw_fault}) vectors.matches(id, 0, 3);
  vectors.matches(tpa_fault, 1, 3);
  const auto found = diagnose(vectors);
  ASSERT_TRUE(found);
  ASSERT_THAT(suspected(*found), ElementsAre(tilt_fault));
  EXPECT_THAT(ids_of(found->suspects.front().ambiguity_group), ElementsAre(yaw_fault));
}

// The vectors distinguish the two.
TEST(Suspects, AFaultThatExplainsAsManyOthersIsNotNamedWithTheFirst) {
  HandMade vectors(4, 1);
  vectors.matches(tilt_fault, 0, 2).matches(yaw_fault, 2, 4);
  for (const char* const id : {tilt_fault, yaw_fault}) vectors.matches(id, 4, 5);
  const auto found = diagnose(vectors);
  ASSERT_TRUE(found);
  ASSERT_THAT(suspected(*found), ElementsAre(tilt_fault, yaw_fault));
  EXPECT_THAT(found->suspects.front().ambiguity_group, IsEmpty());
}

TEST(Suspects, TheSecondExplainsWhatTheFirstDoesNot) {
  HandMade vectors(6, 1);
  vectors.matches(yaw_fault, 0, 3).matches(tilt_fault, 1, 3).matches(tpa_fault, 2, 5);
  for (const char* const id : {tilt_fault, yaw_fault, tpa_fault}) vectors.matches(id, 6, 7);
  vectors.matches(yaw_fault, 5, 6, 1);  // decides between two that explain three
  const auto found = diagnose(vectors);
  ASSERT_TRUE(found);
  ASSERT_THAT(suspected(*found), ElementsAre(yaw_fault, tpa_fault));
  EXPECT_EQ(found->suspects.back().explained, 3u);
  EXPECT_EQ(found->unexplained, 1u);
  EXPECT_EQ(found->stage, faults::Stage::yaw);
}

TEST(Suspects, AFaultThatNoInputTellsFromTheLawIsNeverNamed) {
  const char* const equivalent = "limits-exchanged";
  HandMade vectors(2, 1);
  vectors.matches(equivalent, 0, 3).deviates(equivalent, 0, 5, 5).deviates(tpa_fault, 0, 4, 5);
  const auto found = diagnose(vectors);
  ASSERT_TRUE(found);
  EXPECT_THAT(found->suspects, IsEmpty());
  EXPECT_EQ(found->nearest->id, tpa_fault);
}

TEST(Suspects, WithoutOneTheStageIsThatOfTheFaultThatDeviatesInTheSamePlaces) {
  HandMade vectors(2, 1);
  vectors.deviates(tilt_fault, 0, 4, 8).deviates(tilt_fault, 1, 4, 8);
  vectors.deviates(yaw_fault, 0, 9, 10).deviates(yaw_fault, 1, 6, 10);  // 15 of 20
  vectors.deviates(tpa_fault, 0, 10, 10)
      .deviates(tpa_fault, 1, 10, 10)
      .deviates(tpa_fault, 2, 0, 20);
  const auto found = diagnose(vectors);
  ASSERT_TRUE(found);
  EXPECT_THAT(found->suspects, IsEmpty());
  EXPECT_EQ(found->nearest->id, yaw_fault);
  EXPECT_DOUBLE_EQ(found->jaccard_index, 0.75);
  EXPECT_EQ(found->stage, faults::Stage::yaw);
}

TEST(Suspects, WithLessThanHalfOfTheValuesInCommonNoFaultIsNamed) {
  for (const std::size_t in_common : {9u, 10u}) {
    const auto found = diagnose(HandMade(1, 1).deviates(yaw_fault, 0, in_common, 20));
    ASSERT_TRUE(found);
    EXPECT_EQ(found->nearest != nullptr, in_common == 10);
    EXPECT_EQ(found->stage.has_value(), in_common == 10);
  }
}

TEST(Suspects, TheStagesAreThoseOfMostFailingVectors) {
  HandMade vectors(4, 2);
  const StageSet rates = only(Stage::rate_law) | only(Stage::integrator);
  vectors.deviates_first(0, only(Stage::sticks)).deviates_first(1, rates).deviates_first(2, rates);
  vectors.deviates_first(3, only(Stage::rate_law));
  const auto found = diagnose(vectors);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->first_stages, rates);
  EXPECT_EQ(found->in_first_stages, 2u);
}

TEST(Suspects, TheSpecificCaseIsTheFailingOneInWhichTheFewestFaultsDeviate) {
  HandMade vectors(3, 1);
  for (const std::size_t vector : {0u, 1u, 2u}) vectors.of(yaw_fault, vector).deviates = true;
  vectors.of(tilt_fault, 0).deviates = true;
  const auto found = diagnose(vectors);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->specific_case, "case 1");  // the first of two, and case 3 passes
  EXPECT_EQ(found->shown_by_it, 1u);
}

TEST(Suspects, TheFirstDecidesTheStageThoughAnotherIsNearer) {
  const auto found = diagnose(HandMade(2, 1)
                                  .matches(tpa_fault, 0, 1)
                                  .matches(tpa_fault, 2, 3)
                                  .deviates(tpa_fault, 0, 1, 2)
                                  .deviates(yaw_fault, 0, 2, 2));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->stage, faults::Stage::tpa);
  EXPECT_EQ(found->nearest->id, yaw_fault);
  EXPECT_EQ(found->jaccard_index, 1);
}

// ---- functions of the C library -----------------------------------------------------------------

constexpr LibraryCalls asinf = 1 << 2, acosf = 1 << 3, atan2f = 1 << 5;

TEST(LibraryCalls, TheSmallestSetThatExplainsAllVectorsIsTheOnlySuspect) {
  const auto found = diagnose(HandMade(2, 1)
                                  .matches(yaw_fault, 0, 3)
                                  .deviates_first(0, only(Stage::sticks))
                                  .deviates_first(1, only(Stage::sticks))
                                  .explained_by(0, {asinf, asinf | acosf, asinf | atan2f, 63})
                                  .explained_by(1, {atan2f, asinf | atan2f, acosf | atan2f, 63})
                                  .explained_by(2, {0, asinf, atan2f, asinf | atan2f, 63}));
  ASSERT_TRUE(found);
  ASSERT_THAT(suspected(*found), ElementsAre("libm-asinf-atan2f"));
  const Suspect& first = found->suspects.front();
  EXPECT_EQ(first.explained, 2u);
  EXPECT_EQ(first.failing, 2u);
  EXPECT_EQ(first.matched, 2 * ticks);
  EXPECT_EQ(first.ticks, 2 * ticks);
  EXPECT_THAT(first.ambiguity_group, IsEmpty());
  EXPECT_EQ(found->vectors, 3u);
  EXPECT_EQ(found->failing, 2u);
  EXPECT_EQ(found->unexplained, 0u);
  EXPECT_EQ(found->first_stages, only(Stage::sticks));
}

TEST(LibraryCalls, SetsOfTheSameSizeAreEquallyGood) {
  const auto found = diagnose(HandMade(1, 0).explained_by(0, {atan2f, asinf, asinf | atan2f}));
  ASSERT_TRUE(found);
  ASSERT_THAT(suspected(*found), ElementsAre("libm-asinf"));
  EXPECT_THAT(ids_of(found->suspects.front().ambiguity_group), ElementsAre("libm-atan2f"));
}

TEST(LibraryCalls, APassingVectorThatTheCallsWouldFailRefutesThem) {
  const auto found = diagnose(HandMade(1, 1).explained_by(0, {asinf}).explained_by(1, {0, atan2f}));
  ASSERT_TRUE(found);
  EXPECT_THAT(found->suspects, IsEmpty());
}

TEST(LibraryCalls, ADeviationBeyondRoundingThatTheyDoNotExplainRefutesThem) {
  const auto found = diagnose(HandMade(3, 0)
                                  .explained_by(0, {asinf})
                                  .explained_by(1, {asinf})
                                  .matches_with(2, asinf, ticks - 1));
  ASSERT_TRUE(found);
  EXPECT_THAT(found->suspects, IsEmpty());
}

// Vectors that pass at the level numeric.
TEST(LibraryCalls, TheyNeedToExplainHalfOfTheDeviationsByRounding) {
  HandMade half(0, 2);
  half.explained_by(0, {asinf}).matches_with(1, asinf, 4);
  const auto found = diagnose(half);
  ASSERT_TRUE(found);
  ASSERT_THAT(suspected(*found), ElementsAre("libm-asinf"));
  EXPECT_EQ(found->suspects.front().explained, 1u);
  EXPECT_EQ(found->suspects.front().failing, 2u);
  EXPECT_EQ(found->suspects.front().matched, ticks + 4);
  EXPECT_EQ(found->unexplained, 1u);
  HandMade third(0, 3);
  third.explained_by(0, {asinf}).matches_with(1, asinf, 4).matches_with(2, asinf, 4);
  EXPECT_FALSE(diagnose(third));
}

constexpr const char* in_tilt = "atan2f@tilt_error";
constexpr const char* in_yaw = "atan2f@yaw_error";

TEST(LibraryCalls, ASingleCallIsNamedIfItExplainsMoreThanAllCallsOfItsFunction) {
  const auto found = diagnose(HandMade(2, 1)
                                  .explained_by(0, {atan2f})
                                  .matches_with(0, in_tilt, ticks)
                                  .matches_with(1, atan2f, ticks - 1)
                                  .matches_with(1, in_tilt, ticks)
                                  .matches_with(1, in_yaw, 2)
                                  .explained_by(2, {0, atan2f}));
  ASSERT_TRUE(found);
  ASSERT_THAT(suspected(*found), ElementsAre("libm-atan2f@tilt_error"));
  EXPECT_EQ(found->suspects.front().explained, 2u);
  EXPECT_THAT(found->suspects.front().ambiguity_group, IsEmpty());
  EXPECT_THAT(std::string(found->suspects.front().fault->what),
              StartsWith("calls atan2f of the C library where the law has `tilt_error`"));
}

TEST(LibraryCalls, AllCallsAreNamedIfASingleOneExplainsNoMore) {
  const auto found = diagnose(HandMade(1, 1)
                                  .explained_by(0, {atan2f})
                                  .matches_with(0, in_tilt, ticks)
                                  .explained_by(1, {0, atan2f}));
  ASSERT_TRUE(found);
  ASSERT_THAT(suspected(*found), ElementsAre("libm-atan2f"));
  EXPECT_THAT(found->suspects.front().ambiguity_group, IsEmpty());
}

TEST(LibraryCalls, WhereASingleCallDoesNotMatterTheLawPasses) {
  HandMade refuted(1, 1);
  refuted.matches_with(0, atan2f, 1).matches_with(0, in_tilt, ticks).explained_by(1, {0});
  EXPECT_THAT(suspected(*diagnose(refuted)), ElementsAre("libm-atan2f@tilt_error"));
  refuted.matches_with(1, in_tilt, ticks - 1);
  EXPECT_THAT(diagnose(refuted)->suspects, IsEmpty());
}

TEST(LibraryCalls, APortThatPassesIsNotDiagnosed) {
  EXPECT_FALSE(diagnose(HandMade(0, 2).explained_by(0, {0, asinf}).explained_by(1, {0, asinf})));
}

}  // namespace
}  // namespace attest
