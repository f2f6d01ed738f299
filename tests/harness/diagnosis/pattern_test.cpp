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
                         std::vector<Where> where = {}) {
  ObservedVector vector{group, {}, FirstStage{stage, stage}};
  Observed& observed = vector.observation[{stage, axis}];
  observed.all = {10, 10};
  observed.where = std::move(where);
  observed.relations.values = 10;
  return vector;
}

ObservedVector agreeing(const std::string& group, Stage stage, int axis, std::size_t values,
                        std::vector<Where> where = {}) {
  ObservedVector vector = deviating(group, stage, axis, std::move(where));
  vector.first.reset();
  vector.observation.begin()->second.all = {0, values};
  vector.observation.begin()->second.relations = {};
  return vector;
}

TEST(Patterns, OfVectorsThatAgreeThereAreNone) {
  EXPECT_THAT(patterns_of({}), IsEmpty());
  EXPECT_THAT(patterns_of({agreeing("modes", Stage::sticks, 0, 9)}), IsEmpty());
}

// Not in the stage that comes first in the law: the deviation may begin in a later one.
TEST(Patterns, AVectorCountsInTheStageOfItsFirstDeviation) {
  ObservedVector both = deviating("modes", Stage::attitude_law, 0);
  both.observation[{Stage::rate_law, 1}].all = {9, 1};
  both.first = FirstStage{Stage::rate_law, Stage::rate_law};
  const auto found = patterns_of({both});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].stage, Stage::rate_law);
  EXPECT_EQ(found[0].axes, "pitch");
}

// In acro the sticks write the rates setpoint of the controller.
TEST(Patterns, TheStageIsTheOneThatReportsCount) {
  ObservedVector acro = deviating("modes", Stage::attitude_law, 1);
  acro.first = FirstStage{Stage::sticks, Stage::attitude_law};
  acro.observation.begin()->second.relations.reversed = 10;
  const auto found = patterns_of({acro});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].stage, Stage::sticks);
  EXPECT_EQ(found[0].axes, "pitch");
  EXPECT_EQ(found[0].relation, "have the other sign");
}

TEST(Patterns, EachStageHasItsOwn) {
  const auto found = patterns_of(
      {deviating("modes", Stage::attitude_law, 2), deviating("rates", Stage::rate_law, 1)});
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

TEST(Patterns, AConditionThatHoldsNearlyAlwaysSeparatesNothing) {
  ObservedVector one = deviating("a", Stage::attitude_law, 0, {{tilted, {90, 8}}});
  one.observation.begin()->second.all = {90, 10};
  EXPECT_EQ(patterns_of({one, one}).at(0).condition, "");
  one.observation.begin()->second.all = {90, 40};
  EXPECT_EQ(patterns_of({one, one}).at(0).condition, tilted);
}

// An input that often has a value may have it by chance where values deviate.
TEST(Patterns, AnInputMustSeparateMoreClearlyThanAStateOfTheLaw) {
  const auto found = [](const char* text, ConditionKind kind, std::size_t agreeing) {
    ObservedVector one = deviating("a", Stage::attitude_law, 0, {{text, {10, agreeing}, kind}});
    one.observation.begin()->second.all = {10, 100};
    return patterns_of({one, one}).at(0).condition;
  };
  EXPECT_EQ(found(tilted, ConditionKind::law, 20), tilted);
  EXPECT_EQ(found(tilted, ConditionKind::law, 45), "");
  EXPECT_EQ(found(landed, ConditionKind::input, 20), "");
  EXPECT_EQ(found(landed, ConditionKind::input, 10), landed);
}

// A parameter is the same in a whole vector.
TEST(Patterns, AParameterIsNamedOnlyIfThereIsNothingElse) {
  constexpr const char* parameter = "MC_ROLL_P is not 6.5";
  const Where of_parameter{parameter, {10, 0}, ConditionKind::parameter};
  const auto found = [&](std::vector<Where> where, std::size_t vectors, std::size_t late) {
    ObservedVector one = deviating("a", Stage::attitude_law, 0, std::move(where));
    one.observation.begin()->second.relations.late = late;
    return patterns_of(std::vector<ObservedVector>(vectors, one)).at(0);
  };
  EXPECT_EQ(found({of_parameter}, 3, 0).condition, parameter);
  EXPECT_EQ(found({of_parameter}, 3, 0).kind, ConditionKind::parameter);
  EXPECT_EQ(found({of_parameter}, 2, 0).condition, "");
  EXPECT_EQ(found({of_parameter}, 3, 10).condition, "") << "the relation says more";
  EXPECT_EQ(found({of_parameter, {landed, {10, 1}}}, 3, 0).condition, landed);
  EXPECT_EQ(found({{parameter, {10, 2}, ConditionKind::parameter}}, 3, 0).condition, "")
      << "it does not separate";
}

TEST(Patterns, ThoseThatSayMoreComeFirst) {
  const auto many = deviating("a", Stage::sticks, 0);
  const auto by_parameter = deviating(
      "b", Stage::attitude_law, 0, {{"MC_ROLL_P is not 6.5", {10, 0}, ConditionKind::parameter}});
  ObservedVector late = deviating("c", Stage::rate_law, 0);
  late.observation.begin()->second.relations.late = 10;
  const auto found = patterns_of({by_parameter, by_parameter, by_parameter, many, many, late});
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[0].stage, Stage::rate_law);
  EXPECT_EQ(found[1].stage, Stage::sticks);
  EXPECT_EQ(found[2].stage, Stage::attitude_law);
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
