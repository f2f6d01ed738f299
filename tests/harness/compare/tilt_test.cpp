#include "harness/compare/tilt.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include "tests/harness/compare/sample_trace.hpp"

namespace attest {
namespace {

// `angle` [rad] about the axis {x, y, z}, of length `norm`.
AttitudeQuaternion at(double angle, double x, double y, double z, double norm = 1) {
  const double s = norm * std::sin(angle / 2);
  return {norm * std::cos(angle / 2), s * x, s * y, s * z};
}

TEST(TiltError, IsTheAngleBetweenTheThrustAxes) {
  const AttitudeQuaternion level = at(0, 1, 0, 0);
  for (const double degrees : {0.0, 1e-3, 30.0, 90.0, 179.9, 180.0}) {
    const double angle = degrees * std::numbers::pi / 180;
    EXPECT_NEAR(tilt_error(at(angle, 1, 0, 0), level), angle, 1e-6);
    EXPECT_NEAR(tilt_error(level, at(angle, 0.6, 0.8, 0)), angle, 1e-6);
  }
}

TEST(TiltError, HeadingSignAndLengthDoNotMatter) {
  const AttitudeQuaternion level = at(0, 1, 0, 0);
  EXPECT_NEAR(tilt_error(at(2, 0, 0, 1), level), 0, 1e-6);
  EXPECT_NEAR(tilt_error(at(1, 1, 0, 0, -1), level), 1, 1e-6);
  EXPECT_NEAR(tilt_error(at(1, 1, 0, 0, 1e-3), level), 1, 1e-6);
}

TEST(TiltError, IsNoNumberWithoutAnAttitude) {
  AttitudeQuaternion broken = at(0, 1, 0, 0);
  broken[2] = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(std::isnan(tilt_error(broken, at(0, 1, 0, 0))));
  EXPECT_TRUE(std::isnan(tilt_error(AttitudeQuaternion{}, at(0, 1, 0, 0))));
}

RC_GTEST_PROP(TiltError, IsSymmetric, (double a, double b)) {
  const AttitudeQuaternion one = at(a, 1, 0, 0), other = at(b, 0, 1, 0);
  RC_ASSERT(std::abs(tilt_error(one, other) - tilt_error(other, one)) < 1e-9);
}

TEST(AttitudeGain, IsTheLargerInForce) {
  AttitudeGain gain(Module::mc_att_control);
  EXPECT_DOUBLE_EQ(gain.value(), 6.5);
  gain.set({1, "MC_ROLL_P", 8});
  EXPECT_DOUBLE_EQ(gain.value(), 8);
  gain.set({2, "MC_PITCH_TC", 0.1f});
  EXPECT_NEAR(gain.value(), 13, 1e-6);
  gain.set({4, "MC_YAW_P", 99});
  EXPECT_NEAR(gain.value(), 13, 1e-6);
}

TEST(AttitudeError, IsNearAHalfTurnIfTiltOrYawIs) {
  const double pi = std::numbers::pi;
  const AttitudeQuaternion level = at(0, 1, 0, 0);
  for (const double angle : {0.0, 1e-3, 1.0, pi - 1e-3, pi}) {
    EXPECT_NEAR(attitude_error(at(angle, 1, 0, 0), level), angle, 1e-9);
    EXPECT_NEAR(attitude_error(level, at(angle, 0, 0, 1, -0.5)), angle, 1e-9);
  }
  EXPECT_TRUE(std::isnan(attitude_error(AttitudeQuaternion{}, level)));
}

TEST(AttitudeGain, OfTheCascadeIsThatOfYawTooByItsWeight) {
  AttitudeGain gain(Module::attitude_unit);
  EXPECT_NEAR(gain.value(), 7, 1e-6);  // 2.8 / 0.4
  gain.set({0, "MC_YAW_WEIGHT", 0.1f});
  EXPECT_NEAR(gain.value(), 28, 1e-5);
  gain.set({0, "MC_YAW_WEIGHT", 0});
  EXPECT_NEAR(gain.value(), 6.5, 1e-6);
}

TEST(AttitudeGain, HasNoSign) {
  AttitudeGain gain(Module::mc_att_control);
  gain.set({0, "MC_ROLL_P", -8});
  gain.set({0, "MC_PITCH_P", -7});
  EXPECT_DOUBLE_EQ(gain.value(), 8);
}

}  // namespace
}  // namespace attest
