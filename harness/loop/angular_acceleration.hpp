// The angular acceleration that the rate unit receives, from samples of the gyro: the difference of
// two samples divided by the time between them, then a second-order Butterworth low-pass.
//
// The low-pass is a biquad for samples at the nominal rate, by the bilinear transform with its
// cutoff prewarped: its gain is sqrt(1/2) at the cutoff. The difference always uses the true time
// between samples. The low-pass assumes the nominal period, even if samples come at other times.
//
// Body axes FRD. No allocation; one thread at a time.
#pragma once

#include <optional>

#include "harness/core/frames.hpp"
#include "harness/core/rate.hpp"
#include "harness/core/time.hpp"

namespace attest {

class AngularAcceleration {
 public:
  static constexpr double default_cutoff_hz = 30;  // the default of IMU_DGYRO_CUTOFF

  // There is a low-pass only if 0 < cutoff_hz < half of the sampling rate.
  explicit AngularAcceleration(const Rate& sampling, double cutoff_hz = default_cutoff_hz);

  // Returns the angular acceleration [rad/s^2] at `now`, which is 0 at the first sample. A sample
  // that is not later than the one before is ignored, and the last result is returned again.
  const Vector3& sample(Nanoseconds now, const Vector3& rate_rad_s);

 private:
  // y[k] = b (x[k] + 2 x[k-1] + x[k-2]) - a1 y[k-1] - a2 y[k-2], in the transposed direct form II.
  struct Biquad {
    double b, a1, a2;
  };
  static std::optional<Biquad> biquad(const Rate& sampling, double cutoff_hz);
  double filtered(std::size_t axis, double difference_rad_s2);

  std::optional<Biquad> low_pass_;
  std::optional<Nanoseconds> last_;
  Vector3 last_rate_rad_s_{};
  Vector3 delay_1_{}, delay_2_{};  // state of the low-pass
  Vector3 acceleration_rad_s2_{};
};

}  // namespace attest
