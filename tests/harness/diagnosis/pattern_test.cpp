#include "harness/diagnosis/pattern.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace attest {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr const char* tilted = "the tilt error exceeds 90 deg";
constexpr const char* landed = "vehicle_land_detected.landed is set";

// A vector in which 10 values of a stage deviate and 10 agree.
ObservedVector deviating(const std::string& group, Stage stage, int axis,
                         std::vector<std::pair<std::string, Tally>> where = {}) {
  ObservedVector vector{group, {}};
  Observed& observed = vector.observation[{stage, axis}];
  observed.all = {10, 10};
  observed.where = std::move(where);
  observed.relations.values = 10;
  return vector;
}

ObservedVector agreeing(const std::string& group, Stage stage, int axis, std::size_t values,
                        std::vector<std::pair<std::string, Tally>> where = {}) {
  ObservedVector vector = deviating(group, stage, axis, std::move(where));
  vector.observation.begin()->second.all = {0, values};
  vector.observation.begin()->second.relations = {};
  return vector;
}

TEST(Patterns, OfVectorsThatAgreeThereAreNone) {
  EXPECT_THAT(patterns_of({}), IsEmpty());
  EXPECT_THAT(patterns_of({agreeing("modes", Stage::sticks, 0, 9)}), IsEmpty());
}

TEST(Patterns, AVectorCountsInItsFirstStage) {
  ObservedVector both = deviating("modes", Stage::rate_law, 0);
  both.observation[{Stage::attitude_law, 2}].all = {1, 9};
  const auto found = patterns_of({both, deviating("rates", Stage::rate_law, 1)});
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].stage, Stage::attitude_law);
  EXPECT_EQ(found[0].axes, "yaw");
  EXPECT_EQ(found[1].stage, Stage::rate_law);
  EXPECT_EQ(found[1].axes, "pitch");
  EXPECT_THAT(found[1].groups, ElementsAre("rates"));
}

TEST(Patterns, TheConditionThatHoldsAtTheFewestAgreeingValuesIsNamed) {
  const auto found =
      patterns_of({deviating("a", Stage::attitude_law, 0, {{landed, {10, 3}}, {tilted, {10, 1}}}),
                   deviating("b", Stage::attitude_law, 1, {{landed, {10, 3}}, {tilted, {10, 0}}})});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].condition, tilted);
  EXPECT_EQ(found[0].axes, "roll and pitch");
  EXPECT_EQ(found[0].vectors, 2u);
}

TEST(Patterns, AConditionMustHoldAtNearlyAllDeviatingValues) {
  const auto one = deviating("a", Stage::attitude_law, 0, {{tilted, {9, 0}}, {landed, {10, 9}}});
  const auto found = patterns_of({one, one});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].condition, "") << "and must not hold at nearly all others";
}

// What holds in all vectors of a group, and in few of the others, says nothing.
TEST(Patterns, VectorsOfOtherGroupsDoNotCount) {
  const auto one = deviating("a", Stage::attitude_law, 0, {{landed, {10, 10}}});
  const auto with = [&](const char* group) {
    return patterns_of({one, one, agreeing(group, Stage::attitude_law, 0, 1000)}).at(0).condition;
  };
  EXPECT_EQ(with("b"), "");
  EXPECT_EQ(with("a"), landed);
}

TEST(Patterns, OneVectorHasNoCondition) {
  const auto one = deviating("a", Stage::attitude_law, 0, {{landed, {10, 0}}});
  EXPECT_EQ(patterns_of({one}).at(0).condition, "");
  EXPECT_EQ(patterns_of({one, one}).at(0).condition, landed);
}

TEST(Patterns, WithoutACommonConditionEachGroupHasItsOwn) {
  const auto a = deviating("a", Stage::attitude_law, 0, {{tilted, {10, 0}}});
  const auto b = deviating("b", Stage::attitude_law, 0, {{landed, {10, 0}}});
  const auto c = deviating("c", Stage::attitude_law, 1, {{landed, {10, 0}}});
  const auto found = patterns_of({a, a, b, b, c, c});
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].condition, landed);
  EXPECT_THAT(found[0].groups, ElementsAre("b", "c"));
  EXPECT_EQ(found[1].condition, tilted);
}

Pattern with(void (*set)(Relations&), Stage stage = Stage::rate_law) {
  ObservedVector vector = deviating("a", stage, 0);
  set(vector.observation.begin()->second.relations);
  return patterns_of({vector}).at(0);
}

TEST(Patterns, NameTheRelationOfTheValues) {
  EXPECT_THAT(with([](Relations& r) { r.late = 10; }).relation, HasSubstr("of the step before"));
  EXPECT_THAT(with([](Relations& r) { r.late = 9; }).relation, "");
  EXPECT_THAT(with([](Relations& r) { r.cleared = r.zero = 10; }).relation, HasSubstr("clears"));
  EXPECT_THAT(with([](Relations& r) { r.zero = 10; }).relation, "are 0");
  EXPECT_THAT(with([](Relations& r) { r.reversed = 10; }).relation, "have the other sign");
  const auto limited = [](Relations& r) {
    r.smaller = 10;
    r.smaller_from = 0.9999;
    r.smaller_to = 1;
  };
  EXPECT_THAT(with(limited).relation, "are limited to 1");
  const auto quarter = [](Relations& r) {
    r.quotients = 10;
    r.quotient_from = r.quotient_to = 0.25;
  };
  EXPECT_THAT(with(quarter).relation, HasSubstr("are 0.25 times those expected"));
  EXPECT_THAT(with(quarter, Stage::integrator).relation, HasSubstr("a wrong dt or gain"));
  const auto near = [](Relations& r) {
    r.quotients = 10;
    r.quotient_from = 0.995;
    r.quotient_to = 1.01;
  };
  EXPECT_THAT(with(near).relation, HasSubstr("at most 1%"));
}

TEST(Patterns, AFewValuesHaveNoRelation) {
  EXPECT_EQ(with([](Relations& r) { r.values = r.late = 4; }).relation, "");
}

TEST(Patterns, OneRelationInSeveralGroupsIsOne) {
  ObservedVector a = deviating("a", Stage::integrator, 0, {{tilted, {10, 0}}});
  ObservedVector b = deviating("b", Stage::integrator, 0, {{landed, {10, 0}}});
  ObservedVector c = deviating("c", Stage::integrator, 0);
  for (ObservedVector* one : {&a, &b}) one->observation.begin()->second.relations.late = 10;
  const auto found = patterns_of({a, b, c});
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].vectors, 2u);
  EXPECT_EQ(found[0].condition, "");
  EXPECT_THAT(found[0].groups, ElementsAre("a", "b"));
}

}  // namespace
}  // namespace attest
