// Diagnoses of handmade similarities: vectors of 10 ticks, the failing ones first.
#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/diagnosis/diagnose.hpp"

namespace attest {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr std::size_t ticks = 10;

// Faults of three stages, in the order of the catalogue.
const char* const tilt_fault = "tilt-in-world";
const char* const yaw_fault = "yaw-weight-dropped";
const char* const tpa_fault = "tpa-missing";

std::size_t index_of(const char* id) {
  const auto all = faults::catalogue();
  const auto found = std::find(all.begin(), all.end(), faults::find_fault(id));
  EXPECT_NE(found, all.end()) << id;
  return static_cast<std::size_t>(found - all.begin());
}

class HandMade {
 public:
  // At first no fault matches any tick.
  HandMade(std::size_t failing, std::size_t passing) {
    VectorSimilarity vector;
    vector.ticks = ticks;
    vector.similarities.resize(faults::catalogue().size());
    vector.deviates = true;
    vectors_.assign(failing, vector);
    vector.deviates = false;
    vectors_.insert(vectors_.end(), passing, vector);
  }

  Similarity& of(const char* id, std::size_t vector) {
    return vectors_.at(vector).similarities[index_of(id)];
  }
  // The fault matches `matched` ticks in each of the vectors from `first` to before `end`.
  HandMade& matches(const char* id, std::size_t first, std::size_t end,
                    std::size_t matched = ticks) {
    for (std::size_t vector = first; vector < end; ++vector) of(id, vector).matched = matched;
    return *this;
  }
  // Numbers of values of a vector that deviate: in both port and fault, or in either.
  HandMade& deviates(const char* id, std::size_t vector, std::size_t both, std::size_t either) {
    of(id, vector).intersection = both;
    of(id, vector).union_size = either;
    return *this;
  }

  operator const std::vector<VectorSimilarity>&() const { return vectors_; }

 private:
  std::vector<VectorSimilarity> vectors_;
};

std::vector<std::string_view> ids_of(const std::vector<const faults::Fault*>& faults) {
  std::vector<std::string_view> ids;
  for (const faults::Fault* fault : faults) ids.push_back(fault->id);
  return ids;
}

std::vector<std::string_view> suspected(const Diagnosis& diagnosis) {
  std::vector<const faults::Fault*> faults;
  for (const Suspect& suspect : diagnosis.suspects) faults.push_back(suspect.fault);
  return ids_of(faults);
}

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
  vectors.matches(equivalent, 0, 3).deviates(equivalent, 0, 5, 5).deviates(tpa_fault, 0, 1, 5);
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

// ---- two mistakes -------------------------------------------------------------------------------

// The suspects explain three of five vectors; the yaw fault explains the first two.
HandMade alone() {
  HandMade vectors(5, 20);
  vectors.matches(yaw_fault, 0, 2).matches(tilt_fault, 2, 3);
  for (const char* const id : {yaw_fault, tilt_fault}) vectors.matches(id, 5, 25);
  return vectors;
}

// tpa_fault together with the first suspect: it explains `explained` failing vectors, and agrees
// with `passes` passing ones.
HandMade together(std::size_t explained, std::size_t passes) {
  return HandMade(5, 20).matches(tpa_fault, 0, explained).matches(tpa_fault, 5, 5 + passes);
}

TEST(Partner, IsWantedWhereSuspectsLeaveAVector) {
  Diagnosis found = diagnose(alone()).value();
  ASSERT_THAT(suspected(found), ElementsAre(yaw_fault, tilt_fault));
  EXPECT_EQ(found.unexplained, 2u);
  EXPECT_TRUE(wants_partner(found));
  found.unexplained = 1;
  EXPECT_TRUE(wants_partner(found));
  found.unexplained = 0;
  EXPECT_FALSE(wants_partner(found));
}

TEST(Partner, IsNotWantedWithoutASuspect) {
  EXPECT_FALSE(wants_partner(diagnose(HandMade(2, 1)).value()));
}

TEST(Partner, IsNamedWhereTheTwoExplainMoreThanAllSuspectsAlone) {
  Diagnosis found = diagnose(alone()).value();
  add_partner(together(4, 19), found);
  ASSERT_THAT(suspected(found), ElementsAre(yaw_fault, tpa_fault));
  const Suspect& second = found.suspects.back();
  EXPECT_EQ(second.with->id, yaw_fault);
  EXPECT_EQ(second.explained, 4u);
  EXPECT_EQ(second.failing, 5u);
  EXPECT_EQ(found.suspects.front().with, nullptr);
  EXPECT_EQ(found.unexplained, 1u);
  EXPECT_EQ(found.stage, faults::Stage::yaw);
}

TEST(Partner, ThatAddsNothingIsNotNamed) {
  for (const std::size_t explained : {0u, 2u, 3u}) {
    Diagnosis found = diagnose(alone()).value();
    add_partner(together(explained, 20), found);
    ASSERT_THAT(suspected(found), ElementsAre(yaw_fault, tilt_fault)) << explained;
    EXPECT_EQ(found.unexplained, 2u);
  }
}

TEST(Partner, ThatDeviatesWhereThePortDoesNotIsNotNamed) {
  Diagnosis found = diagnose(alone()).value();
  add_partner(together(5, 18), found);
  ASSERT_THAT(suspected(found), ElementsAre(yaw_fault, tilt_fault));
  EXPECT_EQ(found.unexplained, 2u);
}

TEST(Partner, IsTheOneThatExplainsMost) {
  HandMade vectors = together(4, 20);
  vectors.matches(tilt_fault, 0, 5).matches(tilt_fault, 5, 24);
  Diagnosis found = diagnose(alone()).value();
  add_partner(vectors, found);
  ASSERT_THAT(suspected(found), ElementsAre(yaw_fault, tilt_fault));
  EXPECT_EQ(found.suspects.back().with->id, yaw_fault);
  EXPECT_EQ(found.unexplained, 0u);
}

TEST(Partner, HasAGroupOfThoseThatMatchAsWellTogetherWithTheFirst) {
  HandMade vectors = together(5, 20);
  vectors.matches(tilt_fault, 0, 5).matches(tilt_fault, 5, 25);
  Diagnosis found = diagnose(alone()).value();
  add_partner(vectors, found);
  ASSERT_THAT(suspected(found), ElementsAre(yaw_fault, tilt_fault));
  EXPECT_THAT(ids_of(found.suspects.back().ambiguity_group), ElementsAre(tpa_fault));
}

}  // namespace
}  // namespace attest
