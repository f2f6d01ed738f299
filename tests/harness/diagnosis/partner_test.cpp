// Two mistakes of a port, and matches by chance.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/harness/diagnosis/handmade.hpp"

namespace attest {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

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

CombinedWith with(const HandMade& vectors) {
  return [vectors](const faults::Fault&) { return vectors; };
}

TEST(Partner, OfTheFirstSuspectIsSearchedWhereSuspectsLeaveAVector) {
  for (const std::size_t end : {4u, 5u}) {
    HandMade vectors = alone();
    vectors.matches(tpa_fault, 3, end).matches(tpa_fault, 5, 25);
    std::vector<std::string_view> searched;
    const auto found = diagnose(vectors, [&](const faults::Fault& first) {
      searched.push_back(first.id);
      return together(0, 20);
    });
    ASSERT_TRUE(found);
    EXPECT_EQ(found->unexplained, 5 - end);
    if (end == 5) {
      EXPECT_THAT(searched, IsEmpty());
    } else {
      EXPECT_THAT(searched, ElementsAre(yaw_fault));
    }
  }
}

TEST(Partner, IsNotSearchedWhereNoFaultExplainsAVector) {
  const auto found = diagnose(HandMade(2, 0), [](const faults::Fault&) {
    ADD_FAILURE();
    return HandMade(2, 0);
  });
  EXPECT_TRUE(found);
}

TEST(Partner, IsNamedWhereTheTwoExplainMoreThanAllSuspectsAlone) {
  const auto found = diagnose(alone(), with(together(4, 19)));
  ASSERT_TRUE(found);
  ASSERT_THAT(suspected(*found), ElementsAre(yaw_fault, tpa_fault));
  const Suspect& second = found->suspects.back();
  EXPECT_EQ(second.with->id, yaw_fault);
  EXPECT_EQ(second.explained, 4u);
  EXPECT_EQ(second.failing, 5u);
  EXPECT_EQ(found->suspects.front().with, nullptr);
  EXPECT_EQ(found->unexplained, 1u);
  EXPECT_EQ(found->stage, faults::Stage::yaw);
}

TEST(Partner, ThatAddsNothingIsNotNamed) {
  for (const std::size_t explained : {0u, 2u, 3u}) {
    const auto found = diagnose(alone(), with(together(explained, 20)));
    ASSERT_TRUE(found);
    EXPECT_THAT(suspected(*found), ElementsAre(yaw_fault, tilt_fault)) << explained;
    EXPECT_EQ(found->unexplained, 2u);
  }
}

TEST(Partner, ThatDeviatesWhereThePortDoesNotIsNotNamed) {
  const auto found = diagnose(alone(), with(together(5, 18)));
  ASSERT_TRUE(found);
  EXPECT_THAT(suspected(*found), ElementsAre(yaw_fault, tilt_fault));
  EXPECT_EQ(found->unexplained, 2u);
}

TEST(Partner, IsNotNamedWhereThePortFailsOtherVectorsTheSecondTime) {
  const auto found =
      diagnose(alone(), with(HandMade(6, 19).matches(tpa_fault, 0, 6).matches(tpa_fault, 6, 25)));
  ASSERT_TRUE(found);
  EXPECT_THAT(suspected(*found), ElementsAre(yaw_fault, tilt_fault));
  EXPECT_EQ(found->unexplained, 2u);
}

TEST(Partner, IsTheOneThatExplainsMost) {
  HandMade vectors = together(4, 20);
  vectors.matches(tilt_fault, 0, 5).matches(tilt_fault, 5, 24);
  const auto found = diagnose(alone(), with(vectors));
  ASSERT_TRUE(found);
  ASSERT_THAT(suspected(*found), ElementsAre(yaw_fault, tilt_fault));
  EXPECT_EQ(found->suspects.back().with->id, yaw_fault);
  EXPECT_EQ(found->unexplained, 0u);
}

TEST(Partner, HasAGroupOfThoseThatMatchAsWellTogetherWithTheFirst) {
  HandMade vectors = together(5, 20);
  vectors.matches(tilt_fault, 0, 5).matches(tilt_fault, 5, 25);
  const auto found = diagnose(alone(), with(vectors));
  ASSERT_TRUE(found);
  ASSERT_THAT(suspected(*found), ElementsAre(yaw_fault, tilt_fault));
  EXPECT_THAT(ids_of(found->suspects.back().ambiguity_group), ElementsAre(tpa_fault));
}

// ---- a match by chance --------------------------------------------------------------------------

TEST(Chance, AFaultThatExplainsHalfOfTheFailingVectorsIsNamed) {
  const auto found = diagnose(HandMade(20, 1).matches(yaw_fault, 0, 10).matches(yaw_fault, 20, 21));
  ASSERT_TRUE(found);
  EXPECT_THAT(suspected(*found), ElementsAre(yaw_fault));
  EXPECT_EQ(found->unexplained, 10u);
}

TEST(Chance, AFaultThatExplainsLessIsNotAndTheStageIsTheNearest) {
  HandMade vectors(21, 1);
  vectors.matches(yaw_fault, 0, 10).matches(yaw_fault, 21, 22).deviates(tpa_fault, 0, 1, 1);
  const auto found = diagnose(vectors);
  ASSERT_TRUE(found);
  EXPECT_THAT(suspected(*found), IsEmpty());
  EXPECT_EQ(found->unexplained, 21u);
  EXPECT_EQ(found->stage, faults::Stage::tpa);
}

TEST(Chance, TwoFaultsThatExplainHalfTogetherAreNamed) {
  HandMade vectors(20, 1);
  vectors.matches(yaw_fault, 0, 6).matches(tilt_fault, 6, 10);
  for (const char* const id : {yaw_fault, tilt_fault}) vectors.matches(id, 20, 21);
  const auto found = diagnose(vectors);
  ASSERT_TRUE(found);
  EXPECT_THAT(suspected(*found), ElementsAre(yaw_fault, tilt_fault));
}

TEST(Chance, TheSecondExplainsATenthOfWhatTheFirstLeaves) {
  for (const std::size_t left : {10u, 11u}) {
    const std::size_t failing = 20 + left;
    HandMade vectors(failing, 1);
    vectors.matches(yaw_fault, 0, 20).matches(tilt_fault, 20, 21);
    for (const char* const id : {yaw_fault, tilt_fault}) vectors.matches(id, failing, failing + 1);
    const auto found = diagnose(vectors);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->suspects.size(), left == 10 ? 2u : 1u);
    EXPECT_EQ(found->unexplained, left == 10 ? 9u : 11u);
  }
}

TEST(Chance, APairIsNamedThoughItsFirstExplainsLittleAlone) {
  HandMade first(21, 1), both(21, 1);
  first.matches(yaw_fault, 0, 2).matches(yaw_fault, 21, 22);
  both.matches(tilt_fault, 0, 20).matches(tilt_fault, 21, 22);
  const auto found = diagnose(first, with(both));
  ASSERT_TRUE(found);
  EXPECT_THAT(suspected(*found), ElementsAre(yaw_fault, tilt_fault));
  EXPECT_EQ(found->unexplained, 1u);
}

TEST(Chance, APairOfWhichTheSecondAddsLittleIsNotNamed) {
  for (const std::size_t explained : {19u, 20u, 21u}) {
    HandMade first(31, 1), both(31, 1);
    first.matches(yaw_fault, 0, 20).matches(yaw_fault, 31, 32);
    both.matches(tilt_fault, 0, explained).matches(tilt_fault, 31, 32);
    const auto found = diagnose(first, with(both));
    ASSERT_TRUE(found);
    EXPECT_THAT(suspected(*found), ElementsAre(yaw_fault)) << explained;
    EXPECT_EQ(found->unexplained, 11u);
  }
}

}  // namespace
}  // namespace attest
