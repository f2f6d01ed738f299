#include "harness/loop/estimator.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace attest {
namespace {

PlantState tumbling() {
  PlantState state;
  state.attitude = {0.5, -0.5, 0.5, 0.5};
  state.rate_rad_s = {1, -2, 3};
  return state;
}

TEST(Estimator, WithoutNoiseTellsTheTruth) {
  const ControlState estimate = NoisyEstimator({}).sample(tumbling());
  EXPECT_EQ(estimate.q[0], 0.5f);
  EXPECT_EQ(estimate.q[1], -0.5f);
  EXPECT_EQ(estimate.q[3], 0.5f);
  EXPECT_EQ(estimate.roll_rate, 1);
  EXPECT_EQ(estimate.pitch_rate, -2);
  EXPECT_EQ(estimate.yaw_rate, 3);
}

TEST(Estimator, NoiseHasTheDeviationAskedFor) {
  Estimator options;
  options.attitude_noise_deg = 0.5;
  options.rate_noise_rad_s = 0.1;
  NoisyEstimator estimator(options);
  const PlantState state = tumbling();
  constexpr int samples = 20000;
  double rate_sum = 0, rate_squares = 0, angle_squares = 0;
  for (int i = 0; i < samples; ++i) {
    const ControlState estimate = estimator.sample(state);
    const double error = static_cast<double>(estimate.roll_rate) - 1;
    rate_sum += error;
    rate_squares += error * error;
    double along = 0, norm = 0;
    const double truth[] = {0.5, -0.5, 0.5, 0.5};
    for (int k = 0; k < 4; ++k) {
      along += truth[k] * static_cast<double>(estimate.q[k]);
      norm += static_cast<double>(estimate.q[k]) * static_cast<double>(estimate.q[k]);
    }
    EXPECT_NEAR(norm, 1, 1e-6);
    const double angle_deg = 2 * std::acos(std::min(1.0, along)) * 57.29577951308232;
    angle_squares += angle_deg * angle_deg;
  }
  EXPECT_NEAR(rate_sum / samples, 0, 0.003);
  EXPECT_NEAR(std::sqrt(rate_squares / samples), 0.1, 0.002);
  EXPECT_NEAR(std::sqrt(angle_squares / samples), 0.5 * std::sqrt(3), 0.02);  // of three axes
}

TEST(Estimator, NoiseIsOfItsSeed) {
  Estimator options;
  options.rate_noise_rad_s = 0.1;
  const auto roll_rate = [&](std::uint64_t seed) {
    options.seed = seed;
    return NoisyEstimator(options).sample(tumbling()).roll_rate;
  };
  EXPECT_EQ(roll_rate(3), roll_rate(3));
  EXPECT_NE(roll_rate(3), roll_rate(4));
}

TEST(Estimator, EachAxisHasNoiseOfItsOwn) {
  Estimator options;
  options.rate_noise_rad_s = 0.1;
  NoisyEstimator estimator(options);
  const ControlState estimate = estimator.sample(PlantState{});
  EXPECT_NE(estimate.roll_rate, estimate.pitch_rate);
  EXPECT_NE(estimate.pitch_rate, estimate.yaw_rate);
  EXPECT_NE(estimate.roll_rate, estimate.yaw_rate);
}

// The rate unit gets filtered rates: of a step of 1 rad/s, 0.0133592 at first and then 0.0620863
// (gyro_filter_test.cpp has the computation). The other units get the rates as they are.
TEST(Estimator, FiltersTheGyroOfTheRateUnitOnly) {
  const auto after_step = [](Module module) {
    Case flight;
    flight.module = module;
    flight.flight.emplace();
    UnitEstimator estimator(flight, Rate::hz(1000), Rate::hz(1000));
    estimator.sample(Nanoseconds(0), {});
    PlantState turning;
    turning.rate_rad_s[1] = 1;
    estimator.sample(Nanoseconds(1'000'000), turning);
    return estimator.sample(Nanoseconds(2'000'000), turning);
  };
  EXPECT_NEAR(after_step(Module::rate_unit).state.pitch_rate, 0.0620863, 1e-6);
  EXPECT_NEAR(after_step(Module::rate_unit).acceleration_rad_s2[1], 9.51087, 1e-4);
  EXPECT_EQ(after_step(Module::mc_att_control).state.pitch_rate, 1);
}

}  // namespace
}  // namespace attest
