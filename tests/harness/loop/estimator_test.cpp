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

}  // namespace
}  // namespace attest
