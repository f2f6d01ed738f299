// The frequency response of the gyro's filters: as measured, and in closed form. A response is the
// complex gain of an oscillation.
#pragma once

#include <cmath>
#include <complex>
#include <cstdint>
#include <numbers>

#include "harness/loop/gyro_filter.hpp"

namespace attest::test {

using Response = std::complex<double>;

struct GyroResponse {
  Response rate, acceleration;  // of the acceleration divided by that of an exact derivative
};

// Measured over one second, after two for the filters to settle.
inline GyroResponse measured_response(const Rate& sampling, GyroFilter filter,
                                      double frequency_hz) {
  constexpr Response i{0, 1};
  const double angular = 2 * std::numbers::pi * frequency_hz;
  const auto samples = static_cast<std::int64_t>(sampling.hertz());
  GyroResponse response{};
  for (std::int64_t k = 0; k < 3 * samples; ++k) {
    const double phase = angular * static_cast<double>(k) / sampling.hertz();
    filter.sample(sampling.tick(k), {0, std::sin(phase), 0});
    if (k < 2 * samples) continue;
    response.rate += filter.rate_rad_s()[1] * std::polar(1.0, -phase);
    response.acceleration += filter.acceleration_rad_s2()[1] * std::polar(1.0, -phase);
  }
  const Response scale = 2.0 * i / static_cast<double>(samples);
  return {scale * response.rate, scale * response.acceleration / (i * angular)};
}

// z^-1 at this frequency: the delay by one sample.
inline Response one_sample(double frequency_hz, double sampling_hz) {
  return std::polar(1.0, -2 * std::numbers::pi * frequency_hz / sampling_hz);
}

// A second-order Butterworth low-pass, 1 / (s^2 + sqrt(2) s + 1), after the bilinear transform.
inline Response butterworth(double frequency_hz, double cutoff_hz, double sampling_hz) {
  const double ratio = std::tan(std::numbers::pi * frequency_hz / sampling_hz) /
                       std::tan(std::numbers::pi * cutoff_hz / sampling_hz);
  return 1.0 / Response{1 - ratio * ratio, std::numbers::sqrt2 * ratio};
}

// y[n] = y[n-1] + w (x[n] - y[n-1]), with w = period / (period + 1 / (2 pi cutoff)).
inline Response first_order(double frequency_hz, double cutoff_hz, double sampling_hz) {
  const double weight = 1 / (1 + sampling_hz / (2 * std::numbers::pi * cutoff_hz));
  return weight / (1.0 - (1 - weight) * one_sample(frequency_hz, sampling_hz));
}

// The difference over one period, divided by that of an exact derivative.
inline Response difference(double frequency_hz, double sampling_hz) {
  const Response change = 1.0 - one_sample(frequency_hz, sampling_hz);
  return change * sampling_hz / Response{0, 2 * std::numbers::pi * frequency_hz};
}

}  // namespace attest::test
