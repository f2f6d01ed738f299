#include "harness/loop/angular_acceleration.hpp"

#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

namespace attest {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double not_low_passed = 0;

// The gain from the rate of an oscillation to the result, divided by 2 pi f: 1 is exact. Measured
// over one second, after two for the filter to settle.
double gain(const Rate& sampling, double cutoff_hz, double frequency_hz) {
  AngularAcceleration acceleration(sampling, cutoff_hz);
  const auto samples = static_cast<std::int64_t>(sampling.hertz());
  std::complex<double> sum = 0;
  for (std::int64_t k = 0; k < 3 * samples; ++k) {
    const double phase = 2 * pi * frequency_hz * static_cast<double>(k) / sampling.hertz();
    const double result = acceleration.sample(sampling.tick(k), {0, std::sin(phase), 0})[1];
    if (k >= 2 * samples) sum += result * std::polar(1.0, -phase);
  }
  return 2 * std::abs(sum) / static_cast<double>(samples) / (2 * pi * frequency_hz);
}

// Of the difference over one period, divided by 2 pi f.
double difference_gain(double frequency_hz, double sampling_hz) {
  const double x = pi * frequency_hz / sampling_hz;
  return std::sin(x) / x;
}

// Of a second-order Butterworth low-pass after the bilinear transform.
double butterworth_gain(double frequency_hz, double cutoff_hz, double sampling_hz) {
  const double ratio =
      std::tan(pi * frequency_hz / sampling_hz) / std::tan(pi * cutoff_hz / sampling_hz);
  return 1 / std::sqrt(1 + std::pow(ratio, 4));
}

TEST(AngularAcceleration, HasTheFrequencyResponseOfButterworth) {
  for (const std::int64_t sampling_hz : {250, 1000, 8000}) {
    const auto sampling = static_cast<double>(sampling_hz);
    for (const double f : {1., 10., 30., 60., 100.}) {
      const double expected = difference_gain(f, sampling) * butterworth_gain(f, 30, sampling);
      EXPECT_NEAR(gain(Rate::hz(sampling_hz), 30, f), expected, 2e-6) << sampling_hz << " " << f;
    }
  }
}

TEST(AngularAcceleration, GainIsRootOneHalfAtTheCutoff) {
  EXPECT_NEAR(gain(Rate::hz(1000), 80, 80) / difference_gain(80, 1000), std::sqrt(0.5), 1e-6);
}

TEST(AngularAcceleration, CutoffIs30HzUnlessItIsGiven) {
  AngularAcceleration by_default(Rate::hz(1000)), given(Rate::hz(1000), 30);
  for (std::int64_t k = 0; k < 10; ++k) {
    const Vector3 rate{std::sin(static_cast<double>(k)), 0, 0};
    EXPECT_EQ(by_default.sample(Rate::hz(1000).tick(k), rate),
              given.sample(Rate::hz(1000).tick(k), rate));
  }
}

// At 50 Hz a cutoff of 30 Hz is above half of the sampling rate. At 60 Hz it is equal.
TEST(AngularAcceleration, ACutoffThatSamplesCannotHaveLeavesTheDifference) {
  const auto expect_difference = [](const Rate& sampling, double cutoff_hz) {
    AngularAcceleration acceleration(sampling, cutoff_hz);
    Vector3 last{};
    for (std::int64_t k = 0; k < 100; ++k) {
      const Vector3 rate{std::sin(static_cast<double>(k)), 0, 0};
      const double dt_s = in_seconds(sampling.tick(k) - sampling.tick(k - 1));
      const double difference = k > 0 ? (rate[0] - last[0]) / dt_s : 0;
      EXPECT_EQ(acceleration.sample(sampling.tick(k), rate)[0], difference) << k;
      last = rate;
    }
  };
  expect_difference(Rate::hz(50), 30);
  expect_difference(Rate::hz(60), 30);
  expect_difference(Rate::hz(1000), not_low_passed);
  expect_difference(Rate::hz(1000), std::nan(""));
  EXPECT_NEAR(gain(Rate::hz(64), 30, 30), difference_gain(30, 64) * std::sqrt(0.5), 2e-6);
}

TEST(AngularAcceleration, ARampGivesItsSlopeAboutEachAxis) {
  AngularAcceleration acceleration(Rate::hz(400));
  Vector3 result{};
  for (std::int64_t k = 0; k < 400; ++k) {
    const double t = static_cast<double>(k) / 400;
    result = acceleration.sample(Rate::hz(400).tick(k), {3 * t, -2 * t, 1 + t / 2});
  }
  EXPECT_NEAR(result[0], 3, 1e-9);
  EXPECT_NEAR(result[1], -2, 1e-9);
  EXPECT_NEAR(result[2], 0.5, 1e-9);
}

TEST(AngularAcceleration, AConstantRateGivesExactlyZero) {
  AngularAcceleration acceleration(Rate::hz(1000));
  for (std::int64_t k = 0; k < 100; ++k) {
    EXPECT_EQ(acceleration.sample(Rate::hz(1000).tick(k), {0.7, -0.1, 5}), (Vector3{0, 0, 0}));
  }
}

TEST(AngularAcceleration, DividesByTheTrueTime) {
  AngularAcceleration acceleration(Rate::hz(1000), not_low_passed);
  EXPECT_EQ(acceleration.sample(Nanoseconds(0), {1, 0, 0})[0], 0);
  EXPECT_DOUBLE_EQ(acceleration.sample(Nanoseconds(500'000), {1.5, 0, 0})[0], 1000);
  EXPECT_DOUBLE_EQ(acceleration.sample(Nanoseconds(2'500'000), {1, 0, 0})[0], -250);
}

// A sample of the same time, or of an earlier one, changes neither the result nor the next one.
TEST(AngularAcceleration, ASampleThatIsNotLaterIsIgnored) {
  AngularAcceleration acceleration(Rate::hz(1000), 100), reference(Rate::hz(1000), 100);
  for (AngularAcceleration* each : {&acceleration, &reference}) {
    each->sample(Nanoseconds(0), {0, 0, 0});
  }
  const Vector3 before = acceleration.sample(Nanoseconds(1'000'000), {1, 0, 0});
  EXPECT_EQ(acceleration.sample(Nanoseconds(1'000'000), {5, 0, 0}), before);
  EXPECT_EQ(acceleration.sample(Nanoseconds(900'000), {5, 0, 0}), before);
  reference.sample(Nanoseconds(1'000'000), {1, 0, 0});
  EXPECT_EQ(acceleration.sample(Nanoseconds(2'000'000), {1, 0, 0}),
            reference.sample(Nanoseconds(2'000'000), {1, 0, 0}));
}

}  // namespace
}  // namespace attest
