#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "controller/cascade/rate_law.hpp"
#include "tests/controller/generators.hpp"

namespace attest::cascade {
namespace {

using test::mostly_ordinary_float;

using Vector = Vector3<float>;

Parameters default_rate_parameters() {
  return default_parameters(rate_parameters(), Profile::px4_v1_16_0);
}

RateLaw<float> make_law(const Parameters& parameters = default_rate_parameters()) {
  RateLaw<float> law;
  law.set_gains(rate_unit_gains<float>(parameters).rate);
  return law;
}

// In flight, without rotation.
RateInput<float> flying(const Vector& rates_sp) {
  return {.rates_B = Vector::Zero(),
          .rates_sp_B = rates_sp,
          .acceleration_B = Vector::Zero(),
          .dt_s = 0.004f,
          .maybe_landed = false,
          .landed = false};
}

Vector draw_vector() {
  return {*mostly_ordinary_float(), *mostly_ordinary_float(), *mostly_ordinary_float()};
}

RateLaw<float>::Allocation draw_allocation() {
  RateLaw<float>::Allocation status{};
  for (float& torque : status.unallocated_torque) torque = *mostly_ordinary_float();
  return status;
}

TEST(CascadeRateLaw, TheIntegralActsFromTheNextStepOn) {
  RateLaw<float> law = make_law();
  const RateInput<float> in = flying({0.1f, -0.2f, 0.3f});
  const Vector first = law.update(in);
  EXPECT_NEAR(first[0], 0.15f * 0.1f, 1e-7f);
  EXPECT_NEAR(first[2], 0.2f * 0.3f, 1e-7f);
  EXPECT_NEAR(law.integral()[0], 0.2f * 0.1f * 0.004f, 1e-7f);
  EXPECT_NEAR(law.update(in)[0] - first[0], 0.2f * 0.1f * 0.004f, 1e-7f);
}

TEST(CascadeRateLaw, DerivativeActsAgainstTheAcceleration) {
  RateLaw<float> law = make_law();
  RateInput<float> in = flying(Vector::Zero());
  in.acceleration_B = {10.0f, 0.0f, 0.0f};
  EXPECT_NEAR(law.update(in)[0], -0.003f * 10.0f, 1e-7f);
}

TEST(CascadeRateLaw, FactorScalesAllButTheFeedForward) {
  Parameters parameters = default_rate_parameters();
  parameters.mc_rollrate_ff = 0.01f;
  parameters.mc_rollrate_k = 2.0f;
  RateLaw<float> law = make_law(parameters);
  RateInput<float> in = flying({0.5f, 0.0f, 0.0f});
  in.acceleration_B = {1.0f, 0.0f, 0.0f};
  EXPECT_NEAR(law.update(in)[0], 2 * (0.15f * 0.5f - 0.003f) + 0.01f * 0.5f, 1e-6f);
  EXPECT_NEAR(law.integral()[0], 2 * 0.2f * 0.5f * 0.004f, 1e-5f);
}

// In the saturated direction the integral does not grow, and the torque does not see the flags.
RC_GTEST_PROP(CascadeRateLaw, SaturatedAxesDoNotIntegrateFurther, ()) {
  RateLaw<float> law = make_law();
  RateLaw<float> unsaturated = make_law();
  const RateLaw<float>::Allocation status = draw_allocation();
  law.set_saturation(status);
  const RateInput<float> in = flying(draw_vector());
  const Vector torque = law.update(in);
  const Vector other = unsaturated.update(in);
  for (int i = 0; i < 3; ++i) {
    RC_ASSERT(torque[i] == other[i] || std::isnan(torque[i]));
    if (status.unallocated_torque[i] > epsilon) RC_ASSERT(law.integral()[i] <= 0.0f);
    if (status.unallocated_torque[i] < -epsilon) RC_ASSERT(law.integral()[i] >= 0.0f);
    if (std::abs(status.unallocated_torque[i]) <= epsilon) {
      RC_ASSERT(law.integral()[i] == unsaturated.integral()[i]);
    }
  }
}

TEST(CascadeRateLaw, AchievedTorqueClearsEveryFlag) {
  RateLaw<float> law = make_law();
  law.set_saturation({.unallocated_torque = {1.0f, 1.0f, 1.0f}, .torque_setpoint_achieved = 0});
  law.set_saturation({.unallocated_torque = {1.0f, 1.0f, 1.0f}, .torque_setpoint_achieved = 1});
  law.update(flying({0.1f, 0.1f, 0.1f}));
  EXPECT_GT(law.integral().minCoeff(), 0.0f);
}

RC_GTEST_PROP(CascadeRateLaw, IntegralNeverLeavesItsLimit, ()) {
  Parameters parameters = default_rate_parameters();
  parameters.mc_rollrate_i = parameters.mc_pitchrate_i = parameters.mc_yawrate_i = 100.0f;
  RateLaw<float> law = make_law(parameters);
  for (int step = 0; step < 50; ++step) {
    RateInput<float> in = flying(draw_vector());
    in.rates_B = draw_vector();
    law.set_saturation(draw_allocation());
    law.update(in);
    for (int i = 0; i < 3; ++i) RC_ASSERT(std::abs(law.integral()[i]) <= 0.3f);
  }
}

TEST(CascadeRateLaw, MoreErrorIntegratesLess) {
  EXPECT_EQ(RateStages<float>::i_factor(0.0f), 1.0f);
  EXPECT_NEAR(RateStages<float>::i_factor(-radians(200.0f)), 0.75f, 1e-6f);
  EXPECT_NEAR(RateStages<float>::i_factor(radians(400.0f)), 0.0f, 1e-6f);
  EXPECT_EQ(RateStages<float>::i_factor(radians(500.0f)), 0.0f);
}

TEST(CascadeRateLaw, TheGroundFreezesTheIntegral) {
  RateLaw<float> law = make_law();
  law.update(flying({0.1f, -0.2f, 0.3f}));
  const Vector before = law.integral();
  RateInput<float> in = flying({0.1f, -0.2f, 0.3f});
  in.maybe_landed = true;
  law.update(in);
  EXPECT_EQ(law.integral(), before);
  in.maybe_landed = false;
  in.landed = true;
  law.update(in);
  EXPECT_EQ(law.integral(), before);
}

TEST(CascadeRateLaw, AnIntegralThatIsNotFiniteIsDropped) {
  RateLaw<float> law = make_law();
  law.update(flying({0.1f, -0.2f, 0.3f}));
  const Vector before = law.integral();
  law.update(flying({NAN, INFINITY, 0.0f}));
  EXPECT_EQ(law.integral(), before);
}

TEST(CascadeRateLaw, NewGainsKeepTheIntegral) {
  RateLaw<float> law = make_law();
  law.update(flying({0.1f, -0.2f, 0.3f}));
  const Vector before = law.integral();
  law.set_gains(rate_unit_gains<float>(default_rate_parameters()).rate);
  EXPECT_EQ(law.integral(), before);
}

}  // namespace
}  // namespace attest::cascade
