#include "controller/mc_att_control/attitude_control.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/controller/generators.hpp"

namespace attest::mc_att_control {
namespace {

using test::any_attitude;
using test::mostly_ordinary_float;
using test::Quaterniond;
using test::tilt_quaternion;
using test::uniform;
using test::yaw_quaternion;

using Vector = Vector3<double>;

// Limits that no rate reaches, so that the error itself can be seen.
AttitudeGains<double> unlimited_gains() {
  AttitudeGains<double> gains = compute_gains<double>(default_parameters()).attitude;
  gains.rate_max_rad_s.setConstant(1e9);
  return gains;
}

Vector rates(const Quaterniond& q, const Quaterniond& q_d) {
  AttitudeControl<double> control(Profile::px4_v1_5_5);
  control.set_gains(unlimited_gains());
  return control.update({q, q_d, 0.0, false, false});
}

Quaternion<float> draw_quaternion() {
  return {*mostly_ordinary_float(), *mostly_ordinary_float(), *mostly_ordinary_float(),
          *mostly_ordinary_float()};
}

TEST(AttitudeControl, LevelAndLevelSetpointGiveZero) {
  const Quaterniond level(1, 0, 0, 0);
  EXPECT_EQ(rates(level, level), Vector::Zero());
}

TEST(AttitudeControl, AllZeroSetpointGivesZero) {
  EXPECT_EQ(rates(Quaterniond(1, 0, 0, 0), Quaterniond(0, 0, 0, 0)), Vector::Zero());
}

RC_GTEST_PROP(AttitudeControl, SetpointReachedGivesZero, ()) {
  const Quaterniond q = *any_attitude();
  RC_ASSERT(rates(q, q).cwiseAbs().maxCoeff() < 1e-6);
}

// The setpoint is the body, tilted and then turned about the new thrust axis. The error that the
// rates undo is exactly that tilt and, weighted, that turn.
RC_GTEST_PROP(AttitudeControl, RecoversTheRotationOfTheSetpoint, ()) {
  const Quaterniond q = *any_attitude();
  const double direction = *uniform(-M_PI, M_PI);
  const double angle = *uniform(0.001, 1.57);
  const double turn = *uniform(-3.1, 3.1);
  const Quaterniond tilted = product(q, tilt_quaternion(direction, angle));
  const Quaterniond q_d = product(tilted, yaw_quaternion(turn));
  const double weight = AttitudeStages<double>::yaw_weight(rotation_matrix(q_d));
  const Vector error(std::cos(direction) * angle, std::sin(direction) * angle, turn * weight);
  const Vector expected = unlimited_gains().proportional_1_s.cwiseProduct(error);
  RC_ASSERT((rates(q, q_d) - expected).cwiseAbs().maxCoeff() < 1e-9);
}

// The rates do not depend on where north is.
RC_GTEST_PROP(AttitudeControl, HeadingOfTheWorldDoesNotMatter, ()) {
  const Quaterniond q = *any_attitude();
  const Quaterniond tilted = product(q, tilt_quaternion(*uniform(-M_PI, M_PI), *uniform(0, 3)));
  const Quaterniond q_d = product(tilted, yaw_quaternion(*uniform(-2.5, 2.5)));
  const Quaterniond heading = yaw_quaternion(*uniform(-M_PI, M_PI));
  const Vector turned = rates(product(heading, q), product(heading, q_d));
  RC_ASSERT((turned - rates(q, q_d)).cwiseAbs().maxCoeff() < 1e-6);
}

// q and -q are one attitude: R(q) is made of products of two components, so not a bit may change.
RC_GTEST_PROP(AttitudeControl, SignOfAQuaternionDoesNotMatter, ()) {
  AttitudeControl<float> control(Profile::px4_v1_5_5);
  control.set_gains(compute_gains<float>(default_parameters()).attitude);
  const Quaternion<float> q = draw_quaternion();
  const Quaternion<float> q_d = draw_quaternion();
  const auto negative = [](const Quaternion<float>& p) {
    return Quaternion<float>(-p.w(), -p.x(), -p.y(), -p.z());
  };
  const Vector3<float> expected = control.update({q, q_d, 0.1f, false, false});
  const Vector3<float> actual = control.update({negative(q), negative(q_d), 0.1f, false, false});
  for (int i = 0; i < 3; ++i) {
    RC_ASSERT(actual[i] == expected[i] || (std::isnan(actual[i]) && std::isnan(expected[i])));
  }
}

// NaN is the only value that the clamp does not limit.
RC_GTEST_PROP(AttitudeControl, RateLimitsHold, (bool autonomous)) {
  const AttitudeGains<float> gains = compute_gains<float>(default_parameters()).attitude;
  AttitudeControl<float> control(Profile::px4_v1_5_5);
  control.set_gains(gains);
  const Vector3<float>& bound = autonomous ? gains.auto_rate_max_rad_s : gains.rate_max_rad_s;
  const Vector3<float> actual =
      control.update({draw_quaternion(), draw_quaternion(), 0.0f, autonomous, false});
  for (int i = 0; i < 3; ++i) {
    RC_ASSERT(std::abs(actual[i]) <= bound[i] || std::isnan(actual[i]));
  }
}

RC_GTEST_PROP(AttitudeControl, WeathervaneBoundsYawWithItsFeedForward, ()) {
  const AttitudeGains<float> gains = compute_gains<float>(default_parameters()).attitude;
  AttitudeControl<float> control(Profile::px4_v1_5_5);
  control.set_gains(gains);
  const float bound = gains.auto_rate_max_rad_s[2] * gains.weathervane_scale;
  const float yaw = control.update(
      {draw_quaternion(), draw_quaternion(), *mostly_ordinary_float(), true, true})[2];
  RC_ASSERT(std::abs(yaw) <= bound || std::isnan(yaw));
}

TEST(AttitudeControl, FeedForwardIsAddedAfterTheLimit) {
  const AttitudeGains<double> gains = compute_gains<double>(default_parameters()).attitude;
  AttitudeControl<double> control(Profile::px4_v1_5_5);
  control.set_gains(gains);
  const Vector actual =
      control.update({yaw_quaternion(0.0), yaw_quaternion(2.0), 3.0, true, false});
  EXPECT_NEAR(actual[2], gains.auto_rate_max_rad_s[2] + 3.0 * 0.5, 1e-12);
}

TEST(AttitudeControl, OlderLawWeathervanesBeforeTheFeedForwardToo) {
  const AttitudeGains<double> gains = compute_gains<double>(default_parameters()).attitude;
  const double bound = gains.auto_rate_max_rad_s[2] * gains.weathervane_scale;
  const AttitudeInput<double> in{yaw_quaternion(2.0), yaw_quaternion(0.0), bound, true, true};
  AttitudeControl<double> newer(Profile::px4_v1_5_5);
  newer.set_gains(gains);
  EXPECT_NEAR(newer.update(in)[2], -bound, 1e-12);
  AttitudeControl<double> older(Profile::px4_v1_3_4);
  older.set_gains(gains);
  EXPECT_NEAR(older.update(in)[2], -bound + bound * 0.5, 1e-12);
}

TEST(AttitudeControl, DirectRotationTakesOverWhenUpsideDown) {
  const Vector actual = rates(Quaterniond(1, 0, 0, 0), Quaterniond(0, 1, 0, 0));
  EXPECT_NEAR(actual[0], 6.5 * 2.0, 1e-9);
  EXPECT_NEAR(actual[1], 0.0, 1e-9);
}

}  // namespace
}  // namespace attest::mc_att_control
