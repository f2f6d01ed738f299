#include "harness/loop/gyro_filter.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/harness/loop/gyro_response.hpp"

namespace attest {
namespace {

using test::butterworth;
using test::difference;
using test::first_order;
using test::measured_response;
using test::Response;

constexpr double not_low_passed = 0;

// At 1 kHz. The rate is 0 in the first sample and 1 rad/s from the second one on.
//
//     k = tan(pi 40 / 1000) = 0.1263294     a0 = 1 + 1.4142136 k + k^2 = 1.1946158
//     b = k^2 / a0 = 0.0133592              a1 = 2 (k^2 - 1) / a0 = -1.6474600
//     y1 = b = 0.0133592                    y2 = 3 b - a1 y1 = 0.0400776 + 0.0220087 = 0.0620863
//     w = 0.001 / (0.001 + 1 / (2 pi 30)) = 0.001 / 0.00630516 = 0.1586001
//     d1 = w y1 / 0.001 = 2.11877           d2 = d1 + w (48.7271 - d1) = 9.51087
TEST(GyroFilter, AStepGivesTheNumbersOfTheDefaultCutoffs) {
  GyroFilter filter(Rate::hz(1000));
  filter.sample(Nanoseconds(0), {0, 0, 0});
  filter.sample(Nanoseconds(1'000'000), {0, 0, 1});
  EXPECT_NEAR(filter.rate_rad_s()[2], 0.0133592, 1e-7);
  EXPECT_NEAR(filter.acceleration_rad_s2()[2], 2.11877, 1e-5);
  filter.sample(Nanoseconds(2'000'000), {0, 0, 1});
  EXPECT_NEAR(filter.rate_rad_s()[2], 0.0620863, 1e-7);
  EXPECT_NEAR(filter.acceleration_rad_s2()[2], 9.51087, 1e-5);
  EXPECT_EQ(filter.rate_rad_s()[0], 0);
}

TEST(GyroFilter, RateIsOfSecondOrderAndItsDerivativeOfFirstOrderMore) {
  for (const std::int64_t sampling_hz : {250, 1000, 8000}) {
    const auto sampling = static_cast<double>(sampling_hz);
    for (const double f : {1., 10., 30., 40., 60., 100.}) {
      const Rate at = Rate::hz(sampling_hz);
      const auto [got_rate, got_acceleration] = measured_response(at, GyroFilter(at), f);
      const Response rate = butterworth(f, 40, sampling);
      const Response acceleration = rate * difference(f, sampling) * first_order(f, 30, sampling);
      EXPECT_LE(std::abs(got_rate - rate), 2e-6) << sampling_hz << " " << f;
      EXPECT_LE(std::abs(got_acceleration - acceleration), 2e-6) << sampling_hz << " " << f;
    }
  }
}

TEST(GyroFilter, RateGainIsRootOneHalfAtTheCutoff) {
  const GyroFilter filter(Rate::hz(1000), 80);
  const Response rate = measured_response(Rate::hz(1000), filter, 80).rate;
  EXPECT_NEAR(std::abs(rate), std::sqrt(0.5), 1e-6);
}

// At 80 Hz the rates' cutoff of 40 Hz is half of the sampling rate. At 60 Hz so is the
// derivative's cutoff of 30 Hz.
TEST(GyroFilter, ACutoffThatIsNotBelowHalfTheRateLeavesThatValueUnfiltered) {
  const auto expect_no_filter = [](const Rate& sampling, GyroFilter filter) {
    double last = 0;
    for (std::int64_t k = 0; k < 100; ++k) {
      const double rate = std::sin(static_cast<double>(k));
      filter.sample(sampling.tick(k), {rate, 0, 0});
      EXPECT_NEAR(filter.rate_rad_s()[0], rate, 1e-15) << k;
      const double dt_s = in_seconds(sampling.tick(k) - sampling.tick(k - 1));
      const double derivative = k > 0 ? (rate - last) / dt_s : 0;
      EXPECT_NEAR(filter.acceleration_rad_s2()[0], derivative, 1e-9) << k;
      last = rate;
    }
  };
  expect_no_filter(Rate::hz(60), GyroFilter(Rate::hz(60)));
  expect_no_filter(Rate::hz(1000), GyroFilter(Rate::hz(1000), not_low_passed, not_low_passed));
  expect_no_filter(Rate::hz(1000), GyroFilter(Rate::hz(1000), std::nan(""), std::nan("")));
  const auto [rate, acceleration] = measured_response(Rate::hz(80), GyroFilter(Rate::hz(80)), 10);
  EXPECT_LE(std::abs(rate - 1.0), 1e-6);
  EXPECT_LE(std::abs(acceleration - difference(10, 80) * first_order(10, 30, 80)), 2e-6);
  const Response below_half = measured_response(Rate::hz(84), GyroFilter(Rate::hz(84)), 40).rate;
  EXPECT_NEAR(std::abs(below_half), std::sqrt(0.5), 2e-6);
}

TEST(GyroFilter, ARampGivesItsSlopeAboutEachAxis) {
  GyroFilter filter(Rate::hz(400));
  for (std::int64_t k = 0; k < 400; ++k) {
    const double t = static_cast<double>(k) / 400;
    filter.sample(Rate::hz(400).tick(k), {3 * t, -2 * t, 1 + t / 2});
  }
  EXPECT_NEAR(filter.acceleration_rad_s2()[0], 3, 1e-9);
  EXPECT_NEAR(filter.acceleration_rad_s2()[1], -2, 1e-9);
  EXPECT_NEAR(filter.acceleration_rad_s2()[2], 0.5, 1e-9);
}

TEST(GyroFilter, StartsSettledAtTheFirstSample) {
  GyroFilter filter(Rate::hz(1000));
  for (std::int64_t k = 0; k < 100; ++k) {
    filter.sample(Rate::hz(1000).tick(k), {0.7, -0.1, 5});
    EXPECT_EQ(filter.rate_rad_s(), (Vector3{0.7, -0.1, 5}));
    EXPECT_EQ(filter.acceleration_rad_s2(), (Vector3{0, 0, 0}));
  }
}

TEST(GyroFilter, DividesByTheTrueTimeUpTo20Milliseconds) {
  GyroFilter filter(Rate::hz(1000), not_low_passed, not_low_passed);
  const auto acceleration = [&](std::int64_t us, double rate) {
    filter.sample(Nanoseconds(us * 1000), {rate, 0, 0});
    return filter.acceleration_rad_s2()[0];
  };
  EXPECT_EQ(acceleration(0, 1), 0);
  EXPECT_DOUBLE_EQ(acceleration(500, 1.5), 1000);
  EXPECT_DOUBLE_EQ(acceleration(2'500, 1), -250);
  EXPECT_DOUBLE_EQ(acceleration(502'500, 2), 50);
}

// A sample of the same time, or of an earlier one, changes neither the result nor the next one.
TEST(GyroFilter, ASampleThatIsNotLaterIsIgnored) {
  GyroFilter filter(Rate::hz(1000)), reference(Rate::hz(1000));
  for (GyroFilter* each : {&filter, &reference}) {
    each->sample(Nanoseconds(0), {0, 0, 0});
    each->sample(Nanoseconds(1'000'000), {1, 0, 0});
  }
  filter.sample(Nanoseconds(1'000'000), {5, 0, 0});
  filter.sample(Nanoseconds(900'000), {5, 0, 0});
  for (GyroFilter* each : {&filter, &reference}) each->sample(Nanoseconds(2'000'000), {1, 0, 0});
  EXPECT_EQ(filter.rate_rad_s(), reference.rate_rad_s());
  EXPECT_EQ(filter.acceleration_rad_s2(), reference.acceleration_rad_s2());
}

}  // namespace
}  // namespace attest
