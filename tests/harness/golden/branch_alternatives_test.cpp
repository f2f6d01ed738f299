#include "harness/golden/branch_alternatives.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/casefile/stimulus.hpp"
#include "harness/compare/compare.hpp"
#include "harness/loop/open_loop.hpp"
#include "harness/port/builtin.hpp"
#include "tests/harness/casefile/case_files.hpp"

namespace attest {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Key;

const Rate rate = Rate::hz(250);

// Yaw is off by 180 deg, from tick 5 on by less.
const std::string turned =
    "either_branch = [\"yaw_wrap\"]\n"
    "[control_state]\nq.yaw_deg = { signal = \"step\", from = 180, to = 100, at_ticks = 5 }\n"
    "[vehicle_attitude_setpoint]\nthrust = ";

Trace answers(const Case& the_case, Port& port) {
  Trace trace = stimulate(the_case, rate);
  EXPECT_FALSE(drive(port, subject_of(the_case), trace));
  return trace;
}

float yaw_at(const Trace& trace, std::size_t tick) {
  return trace.samples[tick].out.vehicle_rates_setpoint.yaw;
}

TEST(OtherSide, TurnsTheOtherWayWhereTheLawIsFree) {
  const Case the_case = case_of(turned + "0.15\n");
  const Trace law = answers(the_case, *open_builtin());
  const auto others = branch_alternatives(the_case, law);
  ASSERT_TRUE(others) << others.error().to_string();
  ASSERT_THAT(*others, ElementsAre(Key("yaw_wrap")));
  const Trace& other = others->at("yaw_wrap");
  EXPECT_NEAR(yaw_at(other, 2), -yaw_at(law, 2), 1e-6);
  EXPECT_EQ(yaw_at(other, 7), yaw_at(law, 7));
}

TEST(OtherSide, IsAllowedAtEachTickByItself) {
  const Case the_case = case_of(turned + "0.15\n");
  const Trace law = answers(the_case, *open_builtin());
  const BranchAlternatives others = branch_alternatives(the_case, law).value();
  Trace got = law;
  got.samples[1] = others.at("yaw_wrap").samples[1];
  got.samples[3] = others.at("yaw_wrap").samples[3];
  const Tolerances tolerances;
  EXPECT_FALSE(compare(got, law, tolerances).agrees());
  EXPECT_TRUE(compare(got, on_the_branch_of(got, law, others, tolerances), tolerances).agrees());

  // On neither branch: first one branch's direction with another size; then a turn at a tick
  // without a tie.
  got.samples[3].out.vehicle_rates_setpoint.yaw *= 0.9f;
  EXPECT_FALSE(compare(got, on_the_branch_of(got, law, others, tolerances), tolerances).agrees());
  // The deviation is measured from the nearest branch.
  EXPECT_EQ(yaw_at(on_the_branch_of(got, law, others, tolerances), 3),
            yaw_at(others.at("yaw_wrap"), 3));
  got = law;
  got.samples[7].out.vehicle_rates_setpoint.yaw *= -1;
  EXPECT_FALSE(compare(got, on_the_branch_of(got, law, others, tolerances), tolerances).agrees());
}

TEST(OtherSide, OfTwoDecisionsThereAreThree) {
  const Case the_case = case_of(
      "either_branch = [\"yaw_wrap\", \"shorter_rotation\"]\n"
      "[control_state]\nq = { tilt_deg = 120, azimuth_deg = 40, yaw_deg = 180 }\n"
      "[vehicle_attitude_setpoint]\nthrust = 0.15\n"
      // No limit hides which way it turns.
      "[parameters]\nMC_ROLLRATE_MAX = 1800\nMC_PITCHRATE_MAX = 1800\n");
  const auto others = branch_alternatives(the_case, answers(the_case, *open_builtin()));
  ASSERT_TRUE(others) << others.error().to_string();
  EXPECT_THAT(*others, ElementsAre(Key("shorter_rotation"), Key("yaw_wrap"),
                                   Key("yaw_wrap+shorter_rotation")));
}

TEST(OtherSide, ACaseThatDoesNotStandThereIsAnError) {
  const Case level = case_of("either_branch = [\"yaw_wrap\"]\n");
  const auto none = branch_alternatives(level, answers(level, *open_builtin()));
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message, HasSubstr("no tick stands on such a threshold"));
}

TEST(OtherSide, IntegralsThatMoveAreAnError) {
  const Case moving = case_of(turned + "0.6\n[parameters]\nMC_YAWRATE_P = 0.01\n");
  const auto parted = branch_alternatives(moving, answers(moving, *open_builtin()));
  ASSERT_FALSE(parted);
  EXPECT_THAT(parted.error().message, HasSubstr("the integrals are not those of the other branch"));
}

}  // namespace
}  // namespace attest
