#include "controller/mc_att_control/tailsitter_recovery.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/controller/generators.hpp"

namespace attest::mc_att_control {
namespace {

using test::any_attitude;
using test::Quaterniond;
using test::tilt_quaternion;
using test::uniform;
using test::yaw_quaternion;

AttitudeGains<double> gains() { return compute_gains<double>(default_parameters()).attitude; }

TEST(TailsitterRecovery, LatchesWithHysteresis) {
  using Stages = RecoveryStages<double>;
  const double between = radians(15.0);
  EXPECT_TRUE(Stages::latch(false, radians(30.1)));
  EXPECT_TRUE(Stages::latch(true, between));
  EXPECT_FALSE(Stages::latch(false, between));
  EXPECT_FALSE(Stages::latch(true, radians(4.9)));
}

TEST(TailsitterRecovery, SmallErrorsAreAnsweredAgainstThem) {
  TailsitterRecovery<double> recovery;
  recovery.set_gains(gains());
  const auto rates = recovery.update(tilt_quaternion(0.0, 0.1), yaw_quaternion(0.0), 0.0);
  EXPECT_NEAR(rates[0], -6.5 * 2.0 * std::sin(0.05), 1e-6);
  EXPECT_NEAR(rates[1], 0.0, 1e-12);
}

RC_GTEST_PROP(TailsitterRecovery, SetpointReachedGivesZero, ()) {
  TailsitterRecovery<double> recovery;
  recovery.set_gains(gains());
  const Quaterniond q = *any_attitude();
  RC_ASSERT(recovery.update(q, q, 0.0).cwiseAbs().maxCoeff() < 1e-6);
}

RC_GTEST_PROP(TailsitterRecovery, RateLimitsHoldWithTheFeedForward, ()) {
  TailsitterRecovery<double> recovery;
  recovery.set_gains(gains());
  for (int step = 0; step < 20; ++step) {
    const auto rates = recovery.update(*any_attitude(), *any_attitude(), *uniform(-20.0, 20.0));
    for (int i = 0; i < 3; ++i) RC_ASSERT(std::abs(rates[i]) <= gains().rate_max_rad_s[i]);
  }
}

RC_GTEST_PROP(TailsitterRecovery, DirectionIsFoldedIntoTheFirstQuadrant, ()) {
  const auto tilt = RecoveryStages<double>::tilt(*any_attitude(), *any_attitude());
  RC_ASSERT(tilt.direction_rad >= 0.0);
  RC_ASSERT(tilt.direction_rad <= M_PI / 2 + 1e-6);
}

RC_GTEST_PROP(TailsitterRecovery, TiltFromALevelSetpointIsFound, ()) {
  const Quaterniond q_d = yaw_quaternion(*uniform(-M_PI, M_PI));
  const double angle = *uniform(0.01, 3.1);
  const Quaterniond q = product(q_d, tilt_quaternion(*uniform(-M_PI, M_PI), angle));
  RC_ASSERT(std::abs(RecoveryStages<double>::tilt(q, q_d).angle_rad - angle) < 1e-9);
}

}  // namespace
}  // namespace attest::mc_att_control
