// Values of inputs and parameters for trials: the ranges of the law, and what lies at and next to
// its thresholds.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "harness/compare/tolerance.hpp"
#include "harness/core/random.hpp"
#include "harness/port/profiles.hpp"
#include "harness/trace/channels.hpp"

namespace attest {

// Random numbers of one trial.
class HuntRandom {
 public:
  HuntRandom(std::uint64_t seed, std::uint64_t trial);

  bool chance(double probability) { return random_.uniform() < probability; }
  double uniform(double low, double high) { return random_.uniform(low, high); }
  // From 0 to `count` - 1. REQUIRES: count > 0.
  std::size_t below(std::size_t count);
  // Small values are more likely: about as many below 10 as from 10 to 100.
  std::size_t skewed(std::size_t least, std::size_t most);
  template <typename Values>
  auto one_of(const Values& values) {
    return values[below(std::size(values))];
  }

 private:
  Random random_;
};

// A value of a float input that is no component of a quaternion.
double hunt_value(const Channel& channel, Level level, HuntRandom& random);

// NaN, infinities, the largest and the smallest floats: for the level exact.
double extreme_value(HuntRandom& random);

// A value of a flag or byte, other than a reset counter.
double hunt_byte(const Channel& channel, HuntRandom& random);

// A relative time [us].
std::int64_t hunt_time_us(const Channel& channel, double period_s, HuntRandom& random);

float hunt_parameter(const Parameter& parameter, Level level, HuntRandom& random);

using HuntRotation = std::array<double, 4>;  // w, x, y, z
// The whole sphere, level, small, near half turns, near the poles of the heading; either sign.
HuntRotation hunt_rotation(HuntRandom& random);
HuntRotation product(const HuntRotation& a, const HuntRotation& b);
HuntRotation rotation(const std::array<double, 3>& axis, double angle_rad);

}  // namespace attest
