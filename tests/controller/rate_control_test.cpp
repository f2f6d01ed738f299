#include "controller/mc_att_control/rate_control.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/controller/generators.hpp"

namespace attest::mc_att_control {
namespace {

using test::any_float;
using test::mostly_ordinary_float;

using Vector = Vector3<float>;

// No rates and a small setpoint: inside every gate of the integral.
RateInput<float> gentle_input() {
  RateInput<float> in;
  in.rates_B.setZero();
  in.rates_sp_B = Vector(0.1f, -0.2f, 0.3f);
  in.thrust_sp = 0.5f;
  in.published_thrust_sp = 0.5f;
  in.dt_s = 0.004f;
  in.limits = {};
  in.flying = true;
  return in;
}

RateControl<float> make_control(Profile profile = Profile::px4_v1_5_5) {
  RateControl<float> control(profile);
  control.set_gains(compute_gains<float>(default_parameters()).rate);
  return control;
}

Vector integral_after_one_step(const RateInput<float>& in, Profile profile = Profile::px4_v1_5_5) {
  RateControl<float> control = make_control(profile);
  control.update(in);
  return control.integral();
}

Vector draw_vector() {
  return {*mostly_ordinary_float(), *mostly_ordinary_float(), *mostly_ordinary_float()};
}

TEST(RateControl, ProportionalThenIntegral) {
  RateControl<float> control = make_control();
  const RateInput<float> in = gentle_input();
  const Vector first = control.update(in);
  EXPECT_NEAR(first[0], 0.15f * 0.1f, 1e-7f);
  EXPECT_NEAR(first[2], 0.2f * 0.3f, 1e-7f);
  EXPECT_NEAR(control.integral()[0], 0.05f * 0.1f * 0.004f, 1e-9f);
  const Vector second = control.update(in);
  EXPECT_NEAR(second[0] - first[0], 0.05f * 0.1f * 0.004f, 1e-8f);
}

TEST(RateControl, DerivativeActsOnTheMeasurementOnly) {
  RateControl<float> control = make_control();
  RateInput<float> in = gentle_input();
  in.rates_B = in.rates_sp_B = Vector(0.4f, 0.0f, 0.0f);
  EXPECT_NEAR(control.update(in)[0], -0.003f * 0.4f / 0.004f, 1e-6f);
  EXPECT_NEAR(control.update(in)[0], 0.0f, 1e-9f);
}

TEST(RateControl, EachGateStopsTheIntegral) {
  EXPECT_NE(integral_after_one_step(gentle_input()), Vector::Zero());
  RateInput<float> in = gentle_input();
  in.thrust_sp = takeoff_thrust;
  EXPECT_EQ(integral_after_one_step(in), Vector::Zero());
  in = gentle_input();
  in.limits.lower = true;
  EXPECT_EQ(integral_after_one_step(in), Vector::Zero());
  in = gentle_input();
  in.limits.upper = true;
  EXPECT_EQ(integral_after_one_step(in), Vector::Zero());
  in = gentle_input();
  in.rates_sp_B = Vector(2.1f, -2.1f, 1.6f);
  EXPECT_EQ(integral_after_one_step(in), Vector::Zero()) << "controls beyond 0.3";
}

TEST(RateControl, YawLimitFreezesYawInTheNewerLawOnly) {
  RateInput<float> in = gentle_input();
  in.limits.yaw = true;
  EXPECT_EQ(integral_after_one_step(in)[2], 0.0f);
  EXPECT_NE(integral_after_one_step(in)[0], 0.0f);
  EXPECT_NE(integral_after_one_step(in, Profile::px4_v1_3_4)[2], 0.0f);
}

TEST(RateControl, ThrottleAttenuationInTheNewerLawOnly) {
  RateGains<float> gains = compute_gains<float>(default_parameters()).rate;
  gains.tpa_break = 0.25f;
  gains.tpa_slope = 2.0f;
  RateInput<float> in = gentle_input();
  RateControl<float> newer = make_control(Profile::px4_v1_5_5);
  newer.set_gains(gains);
  EXPECT_NEAR(newer.update(in)[0], 0.5f * 0.15f * 0.1f, 1e-7f);
  RateControl<float> older = make_control(Profile::px4_v1_3_4);
  older.set_gains(gains);
  EXPECT_NEAR(older.update(in)[0], 0.15f * 0.1f, 1e-7f);
}

TEST(RateControl, FeedForwardOfTheOlderLawIsTheChangeOfTheSetpoint) {
  RateGains<float> gains = compute_gains<float>(default_parameters()).rate;
  gains.feed_forward.setConstant(0.01f);
  RateInput<float> in = gentle_input();
  in.rates_B = in.rates_sp_B = Vector(0.4f, 0.0f, 0.0f);
  gains.derivative.setZero();
  RateControl<float> newer = make_control(Profile::px4_v1_5_5);
  newer.set_gains(gains);
  EXPECT_NEAR(newer.update(in)[0], 0.01f * 0.4f, 1e-7f);
  EXPECT_NEAR(newer.update(in)[0], 0.01f * 0.4f, 1e-7f);
  RateControl<float> older = make_control(Profile::px4_v1_3_4);
  older.set_gains(gains);
  EXPECT_NEAR(older.update(in)[0], 0.01f * 0.4f / 0.004f, 1e-5f);
  EXPECT_NEAR(older.update(in)[0], 0.0f, 1e-7f);
}

RC_GTEST_PROP(RateControl, AttenuationIsAFactorForAnyThrust, ()) {
  RateGains<float> gains = compute_gains<float>(default_parameters()).rate;
  gains.tpa_break = *any_float();
  gains.tpa_slope = *any_float();
  const float factor = RateStages<float>::throttle_attenuation(*any_float(), gains);
  RC_ASSERT(factor >= 0.0f);
  RC_ASSERT(factor <= 1.0f);
}

// For any inputs, the integral stays finite and inside its bound.
RC_GTEST_PROP(RateControl, IntegralNeverLeavesItsBound, (bool newer)) {
  RateControl<float> control = make_control(newer ? Profile::px4_v1_5_5 : Profile::px4_v1_3_4);
  RateGains<float> gains = compute_gains<float>(default_parameters()).rate;
  gains.integral *= 500.0f;
  control.set_gains(gains);
  for (int step = 0; step < 50; ++step) {
    RateInput<float> in = gentle_input();
    in.rates_B = draw_vector();
    in.rates_sp_B = draw_vector();
    in.thrust_sp = *mostly_ordinary_float();
    in.published_thrust_sp = *mostly_ordinary_float();
    control.update(in);
    for (int i = 0; i < 3; ++i) RC_ASSERT(std::abs(control.integral()[i]) < integral_limit);
  }
}

// On the ground each step starts the integral from zero, but adds the same as in flight.
RC_GTEST_PROP(RateControl, IntegralStartsFromZeroUnlessFlying, ()) {
  RateControl<float> control = make_control();
  control.update(gentle_input());
  RateInput<float> in = gentle_input();
  in.flying = false;
  control.update(in);
  const Vector once = control.integral();
  control.update(in);
  RC_ASSERT(control.integral() == once);
}

}  // namespace
}  // namespace attest::mc_att_control
