// Diagnoses of handmade ports.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/harness/diagnosis/handmade.hpp"

namespace attest {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

TEST(Suspects, WhereNothingFailsThereIsNoDiagnosis) {
  EXPECT_FALSE(HandMade(0, 0).diagnosed());
  EXPECT_FALSE(HandMade(0, 3).acts(yaw_fault, 0, 3, 0, 5).diagnosed());
}

TEST(Suspects, AVectorThatDoesNotDeviateAloneIsNotDiagnosed) {
  EXPECT_FALSE(HandMade(2, 1).acts(yaw_fault, 0, 1, 0, 5).diagnosed());
}

TEST(Suspects, TheFaultThatHasThePortsValuesIsNamed) {
  const auto found = HandMade(5, 3)
                         .acts(yaw_fault, 0, 5, 0, 7)
                         .acts(tilt_fault, 0, 5, 0, 6)
                         .has(yaw_fault)
                         .diagnosed();
  ASSERT_TRUE(found);
  ASSERT_THAT(suspected(*found), ElementsAre(yaw_fault));
  EXPECT_EQ(found->vectors, 8u);
  EXPECT_EQ(found->failing, 5u);
  EXPECT_EQ(found->unexplained, 0u);
  EXPECT_EQ(found->suspects.front().explained, 5u);
  EXPECT_EQ(found->suspects.front().failing, 5u);
  EXPECT_THAT(found->suspects.front().ambiguity_group, IsEmpty());
  EXPECT_EQ(found->stage, faults::Stage::yaw);
}

// A fault that deviates in the same places with other values is no suspect, however many they are.
TEST(Suspects, AFaultWithOtherValuesIsNotNamed) {
  const auto found =
      HandMade(20, 0).acts(yaw_fault, 0, 20, 0, 7).differs(0, 20, 0, 6.5).diagnosed();
  ASSERT_TRUE(found);
  EXPECT_THAT(found->suspects, IsEmpty());
  EXPECT_EQ(found->unexplained, 20u);
  EXPECT_FALSE(found->stage);
}

TEST(Suspects, AFaultThatDeviatesWhereThePortIsRightIsOut) {
  for (const std::size_t passing : {1u, 2u}) {
    const auto found = HandMade(19, passing)
                           .acts(yaw_fault, 0, 19 + passing, 0, 7)
                           .differs(0, 19, 0, 7)
                           .diagnosed();
    ASSERT_TRUE(found);
    EXPECT_EQ(found->suspects.size(), passing == 1 ? 1u : 0u) << "5% may hide a mistake";
  }
}

// At the level events vectors pass in which the port deviates.
TEST(Suspects, AVectorThatPassesDoesNotRefuteWhereThePortDeviatesToo) {
  const auto found = HandMade(5, 3).acts(yaw_fault, 0, 8, 0, 7).differs(0, 8, 0, 7).diagnosed();
  ASSERT_TRUE(found);
  EXPECT_THAT(suspected(*found), ElementsAre(yaw_fault));
}

TEST(Suspects, FaultsWithTheSameValuesAreNamedWithTheFirst) {
  const auto found = HandMade(2, 1)
                         .acts(tilt_fault, 0, 2, 0, 3)
                         .acts(yaw_fault, 0, 2, 0, 3)
                         .has(tilt_fault)
                         .diagnosed();
  ASSERT_TRUE(found);
  ASSERT_THAT(suspected(*found), ElementsAre(tilt_fault));
  EXPECT_THAT(ids_of(found->suspects.front().ambiguity_group), ElementsAre(yaw_fault));
  EXPECT_EQ(found->suspects.front().others, 1u);
}

TEST(Suspects, AFaultThatNoInputTellsFromTheLawIsNeverNamed) {
  const auto found =
      HandMade(2, 0).acts("limits-exchanged", 0, 2, 0, 3).has("limits-exchanged").diagnosed();
  ASSERT_TRUE(found);
  EXPECT_THAT(found->suspects, IsEmpty());
}

// The narrower fault explains all places where it acts; the wider one is nearer to the port.
TEST(Suspects, OfTwoFaultsThatExplainTheSameTheOneNearerToThePortIsNamed) {
  const auto found = HandMade(6, 0)
                         .acts(tilt_fault, 0, 6, 0, 3)
                         .acts(yaw_fault, 0, 6, 0, 3)
                         .acts(yaw_fault, 0, 6, 1, 100)
                         .has(yaw_fault)
                         .differs(3, 6, 1, 1)
                         .diagnosed();
  ASSERT_TRUE(found);
  ASSERT_THAT(suspected(*found), ElementsAre(yaw_fault));
  EXPECT_EQ(found->unexplained, 3u);
}

TEST(Suspects, TheSpecificCaseIsTheFailingOneInWhichTheFewestFaultsDeviate) {
  HandMade port(3, 0);
  port.acts(yaw_fault, 0, 3, 0, 4).acts(tilt_fault, 0, 1, 1, 4).has(yaw_fault);
  const auto found = port.diagnosed();
  ASSERT_TRUE(found);
  EXPECT_EQ(found->specific_case, "case 1");  // the first of two
  EXPECT_EQ(found->shown_by_it, 1u);
}

TEST(Suspects, TheFirstStageIsThatOfMostFailingVectors) {
  HandMade port(4, 2);
  port.differs(0, 4, 0, 1).deviates_first(0, Stage::sticks).deviates_first(1, Stage::integrator);
  port.deviates_first(2, Stage::integrator).deviates_first(3, Stage::rate_law);
  const auto found = port.diagnosed();
  ASSERT_TRUE(found);
  EXPECT_EQ(found->first_stage, Stage::integrator);
  EXPECT_EQ(found->in_first_stage, 2u);
}

TEST(Suspects, WhatNoSuspectExplainsIsObserved) {
  HandMade port(4, 1);
  port.acts(yaw_fault, 0, 3, 0, 4).has(yaw_fault).differs(3, 4, 0, 9);
  Evidence evidence = port.evidence();
  std::vector<std::size_t> vectors;
  Hypothesis expected;
  evidence.observe = [&](const auto& asked, const Hypothesis& hypothesis) {
    vectors = asked;
    expected = hypothesis;
    ObservedVector one{"modes", {}, FirstStage{Stage::sticks, Stage::sticks}};
    one.observation[{Stage::sticks, 0}].all = {3, 0};
    return std::vector<ObservedVector>{one};
  };
  const auto found = diagnose(evidence);
  ASSERT_TRUE(found);
  EXPECT_THAT(vectors, ElementsAre(0, 1, 2, 3, 4));
  EXPECT_THAT(ids_of(expected), ElementsAre(yaw_fault));
  ASSERT_EQ(found->patterns.size(), 1u);
  EXPECT_EQ(found->patterns.front().stage, Stage::sticks);
}

TEST(Suspects, HaveTheCasesThatTheyExplain) {
  const auto found = HandMade(4, 1)
                         .acts(yaw_fault, 0, 2, 0, 4)
                         .acts(tilt_fault, 1, 3, 1, 4)
                         .has(yaw_fault)
                         .has(tilt_fault)
                         .differs(3, 4, 0, 9)
                         .diagnosed();
  ASSERT_TRUE(found);
  ASSERT_THAT(suspected(*found), UnorderedElementsAre(yaw_fault, tilt_fault));
  for (const Suspect& suspect : found->suspects) {
    const bool is_yaw = suspect.fault->id == yaw_fault;
    EXPECT_THAT(suspect.cases,
                ElementsAre(is_yaw ? "case 0" : "case 1", is_yaw ? "case 1" : "case 2"));
  }
  EXPECT_THAT(found->unexplained_cases, ElementsAre("case 3"));
}

// ---- several mistakes ---------------------------------------------------------------------------

TEST(Several, MistakesInVectorsOfTheirOwnAreAllNamed) {
  const auto found = HandMade(9, 2)
                         .acts(yaw_fault, 0, 4, 0, 4)
                         .acts(tilt_fault, 4, 7, 1, 4)
                         .acts(tpa_fault, 7, 9, 2, 4)
                         .has(yaw_fault)
                         .has(tilt_fault)
                         .has(tpa_fault)
                         .diagnosed();
  ASSERT_TRUE(found);
  EXPECT_THAT(suspected(*found), ElementsAre(yaw_fault, tilt_fault, tpa_fault));
  EXPECT_EQ(found->unexplained, 0u);
}

TEST(Several, AVectorInWhichTwoActIsExplainedByBoth) {
  const auto found = HandMade(6, 0)
                         .acts(yaw_fault, 0, 5, 0, 4)
                         .acts(tilt_fault, 3, 6, 0, 8)
                         .has(yaw_fault)
                         .has(tilt_fault)
                         .diagnosed();
  ASSERT_TRUE(found);
  EXPECT_THAT(suspected(*found), ElementsAre(yaw_fault, tilt_fault));
  EXPECT_EQ(found->unexplained, 0u);
}

TEST(Several, TwoThatActEverywhereAreFoundTogether) {
  const auto found = HandMade(6, 0)
                         .acts(yaw_fault, 0, 6, 0, 40)
                         .acts(tilt_fault, 0, 6, 0, 8)
                         .acts(tpa_fault, 0, 6, 0, 1)
                         .has(yaw_fault)
                         .has(tilt_fault)
                         .diagnosed();
  ASSERT_TRUE(found);
  EXPECT_THAT(suspected(*found), UnorderedElementsAre(yaw_fault, tilt_fault));
  EXPECT_EQ(found->unexplained, 0u);
}

TEST(Several, ThreeThatActEverywhereAreFoundTogether) {
  const auto found = HandMade(6, 0)
                         .acts(yaw_fault, 0, 6, 0, 400)
                         .acts(tilt_fault, 0, 6, 0, 40)
                         .acts(tpa_fault, 0, 6, 0, 5)
                         .has(yaw_fault)
                         .has(tilt_fault)
                         .has(tpa_fault)
                         .diagnosed();
  ASSERT_TRUE(found);
  EXPECT_THAT(suspected(*found), UnorderedElementsAre(yaw_fault, tilt_fault, tpa_fault));
}

TEST(Several, AMistakeThatIsNoFaultLeavesItsVectorsUnexplained) {
  const auto found =
      HandMade(6, 0).acts(yaw_fault, 0, 4, 0, 4).has(yaw_fault).differs(4, 6, 1, 3).diagnosed();
  ASSERT_TRUE(found);
  EXPECT_THAT(suspected(*found), ElementsAre(yaw_fault));
  EXPECT_EQ(found->unexplained, 2u);
}

// A mistake that has the fault's values in one of ten vectors where the fault acts.
TEST(Several, AFaultThatIsLikeAMistakeUnderFewConditionsIsNotNamed) {
  const auto found = HandMade(10, 0)
                         .acts(yaw_fault, 0, 10, 0, 4)
                         .differs(0, 1, 0, 4)
                         .differs(1, 10, 0, 5)
                         .deviates_before(1, 10)
                         .diagnosed();
  ASSERT_TRUE(found);
  EXPECT_THAT(found->suspects, IsEmpty());
  EXPECT_EQ(found->unexplained, 10u);
}

// As the bound of one side in place of no bound: it explains a vector more, and spoils all others.
TEST(Several, AFaultThatTakesThePlaceOfABetterOneIsDropped) {
  const auto found = HandMade(9, 0)
                         .acts(yaw_fault, 0, 9, 0, 4)
                         .acts(tilt_fault, 8, 9, 1, 30)
                         .replaces(tilt_fault, yaw_fault)
                         .has(yaw_fault)
                         .differs(8, 9, 1, 30)
                         .diagnosed();
  ASSERT_TRUE(found);
  EXPECT_THAT(suspected(*found), ElementsAre(yaw_fault));
}

// It explains an output in all vectors. But another output, in which it acts as well, has other
// values from the first tick on.
TEST(Several, AFaultThatIsMostlyWrongWhereItFirstActsIsNotNamed) {
  const auto port = [](std::size_t wrong) {
    HandMade made(20, 0);
    made.acts(yaw_fault, 0, 20, 0, 4).acts(yaw_fault, 0, 20, 1, 4).has(yaw_fault);
    return made.differs(0, wrong, 1, 2);
  };
  EXPECT_THAT(suspected(*port(15).diagnosed()), ElementsAre(yaw_fault));
  EXPECT_THAT(suspected(*port(16).diagnosed()), IsEmpty());
  EXPECT_THAT(suspected(*port(16).deviates_before(0, 16).diagnosed()), ElementsAre(yaw_fault))
      << "another mistake may be the cause";
}

// In most of its vectors a second mistake changes the same output, one tick later.
TEST(Several, AFaultThatIsRightWhereItFirstActsIsNamed) {
  HandMade port(5, 0);
  port.acts(yaw_fault, 0, 5, 0, 4).has(yaw_fault).differs(2, 5, 0, 3);
  EXPECT_THAT(suspected(*port.diagnosed()), IsEmpty());
  EXPECT_THAT(suspected(*port.deviates_after(2, 5).diagnosed()), ElementsAre(yaw_fault));
}

// Without the pair, this fault has the port's values in one vector by chance.
TEST(Several, AFaultThatTheOthersMakeSuperfluousIsDropped) {
  const auto found = HandMade(8, 0)
                         .acts(yaw_fault, 0, 8, 0, 4)
                         .acts(tilt_fault, 0, 1, 1, 8)
                         .acts(tpa_fault, 0, 1, 1, 8)
                         .acts(tpa_fault, 1, 8, 1, 2)
                         .has(yaw_fault)
                         .has(tpa_fault)
                         .diagnosed();
  ASSERT_TRUE(found);
  EXPECT_THAT(suspected(*found), ElementsAre(yaw_fault, tpa_fault));
}

}  // namespace
}  // namespace attest
