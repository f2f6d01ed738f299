// Levels and tolerances for the comparison of outputs.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>

#include "harness/core/result.hpp"
#include "harness/trace/channels.hpp"

namespace attest {

enum class Level {
  exact,    // equal bits of float32; any NaN equals any NaN
  numeric,  // |got - want| <= max(absolute, relative * |want|)
  events,   // the same events within a tick (events.hpp), values of about the same size (gross.hpp)
};

std::string_view name_of(Level level);
Result<Level> parse_level(std::string_view text);

struct Tolerance {
  double absolute = 0;  // in the channel's unit
  double relative = 0;

  double at(double want) const { return std::max(absolute, relative * std::abs(want)); }
};

// The tolerance of every channel. Near a half turn AllowedDeviation (allowed_deviation.hpp) adds
// widening() to that of the rates setpoint.
class Tolerances {
 public:
  // Defaults of rate, control and integral. Measured over 10 s of open loop: correct builds (other
  // optimisation, FMA, double, another atan2, a quaternion form) deviate by at most 5e-6 rad/s,
  // 8e-7 and 5e-7; wrong controllers deviate by more than 1e-3 at some tick. The defaults are
  // between.
  static constexpr Tolerance rate{2e-4, 1e-5};
  static constexpr Tolerance control{1e-4, 1e-5};
  static constexpr Tolerance integral{2e-5, 1e-5};
  static constexpr Tolerance passed_through{1e-6, 1e-6};  // thrust: copied, at most scaled
  // 1e-5 in a quaternion is 2e-5 rad in the attitude, and at the default gain 1.3e-4 rad/s in the
  // rates setpoint.
  static constexpr Tolerance quaternion{1e-5, 0};
  // For mixer and battery estimate: correct builds deviate by at most 1.2e-6 and 2.4e-7.
  static constexpr Tolerance motor{2e-5, 0};
  static constexpr Tolerance scale{2e-5, 0};

  explicit Tolerances(Level level = Level::numeric);

  Level level() const { return level_; }
  Tolerance of(std::size_t channel) const { return of_channel_[channel]; }

  // Replaces the tolerance of every float output whose name begins with `prefix` (without "out/"):
  // "vehicle_rates_setpoint" or "actuator_controls_0.control[2]". Has an effect only at the numeric
  // level. Returns false if there is no such output.
  bool set(std::string_view prefix, Tolerance tolerance);

  // Widens the tolerances for a port in fixed point with this number of fraction bits; only at the
  // numeric level. Each tolerance becomes at least the number of LSBs (last bits) below. These
  // exceed the errors of correct ports that round, measured at 16 to 24 bits:
  // - rates setpoints: up to 740 LSB, near a half turn
  // - controls: 750 LSB. A control that consists mostly of its D part has an error in proportion to
  //   its size, because 1 / dt is up to 500 and dt has an error of half an LSB.
  // - integrals: 60 LSB
  // - motors: 13 LSB, where the mixer fits roll and pitch into the motor range
  // - battery estimate: its filter adds up a hundred roundings, each up to one LSB if a port
  //   truncates.
  //
  // Integrals and controls get one more LSB for each of `ticks`: where an integral moves slowly,
  // its step may be less than an LSB, so that all roundings go in the same direction. Measured at
  // 22 bits: 255 LSB after 4,000 ticks of a flight.
  static constexpr double rate_lsb = 2560, control_lsb = 2560, integral_lsb = 256;
  static constexpr double motor_lsb = 64, scale_lsb = 512, quaternion_lsb = 64;
  static constexpr double control_relative_lsb = 1024;
  void allow_lsb(int fraction_bits, std::size_t ticks = 0);

  // All tolerances and widening() times `factor`.
  Tolerances scaled(double factor) const;

  // The addition to the tolerance of the rates setpoint [rad/s], at this tilt error or, in the
  // cascade, attitude error. The direction of the rotation becomes undefined at 180 deg, and float
  // noise in it grows as 1/(pi - error). `gain` is the attitude gain [1/s], 6.5 by default in the
  // law of v1.5.5.
  double widening(double error_rad, double gain) const;

 private:
  Level level_;
  double scale_ = 1;
  std::array<Tolerance, max_channels> of_channel_{};
};

}  // namespace attest
