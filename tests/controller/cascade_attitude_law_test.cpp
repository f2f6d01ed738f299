#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "controller/cascade/attitude_law.hpp"
#include "tests/controller/generators.hpp"

namespace attest::cascade {
namespace {

using test::mostly_ordinary_float;
using test::uniform;

template <typename Scalar>
Quaternion<Scalar> cascade_quaternion(const test::Quaterniond& q) {
  return {Scalar(q.w()), Scalar(q.x()), Scalar(q.y()), Scalar(q.z())};
}

Quaternion<float> any_attitude() { return cascade_quaternion<float>(*test::any_attitude()); }

template <typename Scalar>
Quaternion<Scalar> horizontal_turn(Scalar x, Scalar y) {
  return rotation_about(Vector3<Scalar>(x, y, Scalar(0)));
}

Parameters default_attitude_parameters() {
  return default_parameters(attitude_parameters(), Profile::px4_v1_16_0);
}

// The rates of the law in one step.
template <typename Scalar>
Vector3<Scalar> rates_of(const Quaternion<Scalar>& q_WB, const Quaternion<Scalar>& q_WD,
                         Scalar yaw_rate = Scalar(0),
                         const Parameters& parameters = default_attitude_parameters()) {
  AttitudeLaw<Scalar> law;
  law.set_gains(attitude_unit_gains<Scalar>(parameters));
  law.set_setpoint(q_WD, yaw_rate, 0, 0);
  return law.update(q_WB);
}

RC_GTEST_PROP(CascadeAttitudeLaw, BothSignsOfAQuaternionGiveTheSameRates, ()) {
  const Quaternion<float> q_WB = any_attitude();
  const Quaternion<float> q_WD = any_attitude();
  const Vector3<float> rates = rates_of<float>(q_WB, q_WD);
  RC_ASSERT(rates_of<float>(-q_WB, q_WD) == rates);
  RC_ASSERT(rates_of<float>(q_WB, -q_WD) == rates);
}

// Without the clamp ahead of acos and asin, rounding now and then gives NaN here.
RC_GTEST_PROP(CascadeAttitudeLaw, NoErrorGivesNoRates, ()) {
  const Quaternion<float> q = any_attitude();
  const Vector3<float> rates = rates_of<float>(q, q);
  RC_ASSERT(length(rates) < 0.02f);
}

RC_GTEST_PROP(CascadeAttitudeLaw, LimitsHoldAfterTheFeedForward, ()) {
  Parameters parameters = default_attitude_parameters();
  parameters.mc_yawrate_max = 40.0f;
  const Vector3<float> rates = rates_of<float>(any_attitude(), any_attitude(),
                                               static_cast<float>(*uniform(-20, 20)), parameters);
  const Vector3<float> max = attitude_unit_gains<float>(parameters).attitude.rate_max_rad_s;
  for (int i = 0; i < 3; ++i) RC_ASSERT(std::abs(rates[i]) <= max[i]);
}

// Up to a tilt of 179 deg and a remaining yaw of 179 deg.
RC_GTEST_PROP(CascadeAttitudeLaw, AgreesWithDoubleAwayFromHalfTurns, ()) {
  const test::Quaterniond q = *test::any_attitude();
  const test::Quaterniond tilt =
      test::tilt_quaternion(*uniform(-M_PI, M_PI), *uniform(0, 179) * M_PI / 180);
  const test::Quaterniond yaw = test::yaw_quaternion(*uniform(-179, 179) * M_PI / 180);
  const test::Quaterniond q_d = mc_att_control::product(mc_att_control::product(q, tilt), yaw);
  Parameters parameters = default_attitude_parameters();
  parameters.mc_rollrate_max = parameters.mc_pitchrate_max = parameters.mc_yawrate_max = 1800;
  const Vector3<float> in_float = rates_of<float>(cascade_quaternion<float>(q),
                                                  cascade_quaternion<float>(q_d), 0.0f, parameters);
  const Vector3<double> in_double = rates_of<double>(
      cascade_quaternion<double>(q), cascade_quaternion<double>(q_d), 0.0, parameters);
  RC_ASSERT((in_float.cast<double>() - in_double).norm() < 1e-3);
}

// The yaw gain is divided by the weight, so a small yaw error always gives MC_YAW_P times itself.
RC_GTEST_PROP(CascadeAttitudeLaw, YawWeightKeepsTheGainOfSmallYawErrors, ()) {
  Parameters parameters = default_attitude_parameters();
  parameters.mc_yaw_weight = static_cast<float>(*uniform(0.1, 1.0));
  const double error = 0.01;
  const Vector3<double> rates =
      rates_of<double>(identity<double>(), yaw_rotation(error), 0.0, parameters);
  RC_ASSERT(std::abs(rates[2] - 2.8 * error) < 1e-6);
}

TEST(CascadeAttitudeLaw, AWeightNearZeroLeavesTheGain) {
  Parameters parameters = default_attitude_parameters();
  parameters.mc_yaw_weight = 1e-4f;
  EXPECT_EQ(attitude_unit_gains<float>(parameters).attitude.proportional_1_s[2], 2.8f);
}

// Large yaw errors are corrected in part: the sine of the weighted half angle.
TEST(CascadeAttitudeLaw, LargeYawErrorsAreWeighted) {
  const Vector3<double> rates = rates_of<double>(identity<double>(), yaw_rotation(1.0));
  EXPECT_NEAR(rates[2], 2.8 / 0.4 * 2 * std::sin(0.4 * 1.0 / 2), 1e-5);
}

TEST(CascadeAttitudeLaw, TiltErrorsAreCorrectedInFull) {
  const Vector3<double> rates = rates_of<double>(identity<double>(), horizontal_turn(0.3, -0.4));
  EXPECT_NEAR(rates[0], 6.5 * 2 * 0.6 * std::sin(0.25), 1e-6);
  EXPECT_NEAR(rates[1], 6.5 * 2 * -0.8 * std::sin(0.25), 1e-6);
  EXPECT_NEAR(rates[2], 0.0, 1e-9);
}

// Opposite thrust: every direction of turning is as short, and the law turns to the setpoint.
TEST(CascadeAttitudeLaw, OppositeThrustTakesTheWholeRotation) {
  Parameters parameters = default_attitude_parameters();
  parameters.mc_rollrate_max = parameters.mc_pitchrate_max = 1800;
  const Quaternion<float> upside_down{0.0f, 0.6f, 0.8f, 0.0f};
  const Vector3<float> rates = rates_of<float>(identity<float>(), upside_down, 0.0f, parameters);
  EXPECT_NEAR(rates[0], 6.5f * 2 * 0.6f, 1e-5f);
  EXPECT_NEAR(rates[1], 6.5f * 2 * 0.8f, 1e-5f);
  EXPECT_EQ(rates[2], 0.0f);
  // Elsewhere the error has this sign without its canonical form.
  EXPECT_EQ(rates_of<float>(identity<float>(), -upside_down, 0.0f, parameters), rates);
}

TEST(CascadeAttitudeLaw, YawRateIsAboutTheWorldsZAxis) {
  const Quaternion<double> rolled = horizontal_turn(0.5, 0.0);
  const Vector3<double> rates = rates_of<double>(rolled, rolled, 0.7);
  EXPECT_NEAR(rates[1], 0.7 * std::sin(0.5), 1e-6);
  EXPECT_NEAR(rates[2], 0.7 * std::cos(0.5), 1e-6);
}

TEST(CascadeAttitudeLaw, AYawRateThatIsNotFiniteIsNoCommand) {
  const Quaternion<float> q = horizontal_turn(0.5f, 0.0f);
  const Vector3<float> without = rates_of<float>(q, identity<float>(), 0.0f);
  EXPECT_EQ(rates_of<float>(q, identity<float>(), NAN), without);
  EXPECT_EQ(rates_of<float>(q, identity<float>(), INFINITY), without);
}

// An estimator reset turns the attitude; the adapted setpoint keeps the rates.
RC_GTEST_PROP(CascadeAttitudeLaw, AdaptedSetpointKeepsTheRates, ()) {
  const Quaternion<double> q = cascade_quaternion<double>(*test::any_attitude());
  const Quaternion<double> q_d = product(q, horizontal_turn(*uniform(-1, 1), *uniform(-1, 1)));
  const Quaternion<double> delta = cascade_quaternion<double>(*test::any_attitude());
  AttitudeLaw<double> law;
  law.set_gains(attitude_unit_gains<double>(default_attitude_parameters()));
  law.set_setpoint(q_d, 0.0, 0, 0);
  const Vector3<double> before = law.update(q);
  law.adapt_setpoint(delta);
  RC_ASSERT((law.update(product(delta, q)) - before).norm() < 1e-6);
}

TEST(CascadeRotation, TheFarthestAxisIsThatOfTheSmallestComponent) {
  using Vector = Vector3<float>;
  EXPECT_EQ(farthest_axis<float>({0.1f, -0.6f, 0.8f}), Vector::UnitX());
  EXPECT_EQ(farthest_axis<float>({-0.6f, 0.1f, 0.8f}), Vector::UnitY());
  EXPECT_EQ(farthest_axis<float>({0.6f, -0.8f, 0.1f}), Vector::UnitZ());
  EXPECT_EQ(farthest_axis<float>({0.0f, 0.0f, 1.0f}), Vector::UnitY()) << "a tie";
}

TEST(CascadeRotation, ShortestRotationOfOppositeVectorsIsAHalfTurn) {
  const Vector3<float> v(0.6f, 0.0f, 0.8f);
  const Quaternion<float> q = shortest_rotation<float>(v, -v);
  EXPECT_EQ(q[0], 0.0f);
  EXPECT_NEAR(dot(imaginary_part(q), v), 0.0f, 1e-6f);
  EXPECT_NEAR(squared_norm(q), 1.0f, 1e-6f);
}

// At half turns the first component is 0, and the next one decides.
TEST(CascadeRotation, CanonicalFormIsThatOfTheFirstComponentThatIsNotZero) {
  const Quaternion<float> q{1e-8f, -0.6f, 0.8f, 0.0f};
  EXPECT_EQ(canonical(q), Quaternion<float>(-q));
  EXPECT_EQ(canonical<float>(-q), Quaternion<float>(-q));
}

RC_GTEST_PROP(CascadeRotation, HeadingIsTheYawThatWasTurned, (bool squares)) {
  ProfileTraits law = traits_of(Profile::px4_v1_16_0);
  law.squares_heading = squares;
  const double yaw = *uniform(-3.1, 3.1);
  const Quaternion<double> q =
      product(yaw_rotation(yaw), horizontal_turn(0.0, *uniform(-1.5, 1.5)));
  RC_ASSERT(std::abs(heading(q, law) - yaw) < 1e-6);
}

// Beyond a norm of 1 the two forms of the heading differ: that of v1.14.4 keeps the angle.
TEST(CascadeRotation, HeadingOfALongQuaternionDiffersInV1_14_4) {
  const Quaternion<double> twice = yaw_rotation(1.0) * 2.0;
  EXPECT_NEAR(heading(twice, traits_of(Profile::px4_v1_14_4)), 1.0, 1e-9);
  EXPECT_GT(heading(twice, traits_of(Profile::px4_v1_15_4)), 1.5);
}

TEST(CascadeRotation, HeadingNearThePoles) {
  for (const double pitch : {M_PI / 2, -M_PI / 2}) {
    const Quaternion<double> q = product(yaw_rotation(0.7), horizontal_turn(0.0, pitch));
    EXPECT_NEAR(heading(q, traits_of(Profile::px4_v1_16_0)), 0.7, 1e-6) << pitch;
  }
}

}  // namespace
}  // namespace attest::cascade
