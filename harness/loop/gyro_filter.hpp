// vehicle_angular_velocity, which the rate unit receives, from samples of the gyro: the body rates
// after a second-order Butterworth low-pass, and the derivative of these filtered rates after a
// first-order low-pass. models/README.md has the equations and their source.
//
// Both low-passes assume the nominal period of the samples. The derivative divides by the true time
// between samples.
//
// Body axes FRD. No allocation; one thread at a time.
#pragma once

#include <optional>

#include "harness/core/frames.hpp"
#include "harness/core/rate.hpp"
#include "harness/core/time.hpp"

namespace attest {

class GyroFilter {
 public:
  static constexpr double default_rate_cutoff_hz = 40;          // of IMU_GYRO_CUTOFF
  static constexpr double default_acceleration_cutoff_hz = 30;  // of IMU_DGYRO_CUTOFF

  // A low-pass exists only if 0 < its cutoff < half of the sampling rate.
  explicit GyroFilter(const Rate& sampling, double rate_cutoff_hz = default_rate_cutoff_hz,
                      double acceleration_cutoff_hz = default_acceleration_cutoff_hz);

  // Takes a sample of the gyro. A sample that is not later than the one before is ignored.
  void sample(Nanoseconds now, const Vector3& rate_rad_s);

  // After the last sample. After the first one they are its rate and 0.
  const Vector3& rate_rad_s() const { return rate_rad_s_; }
  const Vector3& acceleration_rad_s2() const { return acceleration_rad_s2_; }

 private:
  // y[k] = b (x[k] + 2 x[k-1] + x[k-2]) - a1 y[k-1] - a2 y[k-2], in the transposed direct form II.
  struct Biquad {
    double b, a1, a2;
  };
  static std::optional<Biquad> biquad(const Rate& sampling, double cutoff_hz);
  double low_passed(std::size_t axis, double rate_rad_s);

  std::optional<Biquad> rate_low_pass_;
  double acceleration_weight_;  // of a new sample in the first-order low-pass
  std::optional<Nanoseconds> last_;
  Vector3 first_rad_s_{};  // The low-pass filters the change since then, so it starts settled.
  Vector3 delay_1_{}, delay_2_{};  // state of the low-pass
  Vector3 rate_rad_s_{}, acceleration_rad_s2_{};
};

}  // namespace attest
