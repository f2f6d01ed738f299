// The allowed |got - want| of each value of a trace, which depends on the tick: the tolerance of
// the rates setpoint is wider near a tilt error of 180 deg in the controller, and near an attitude
// error of 180 deg in the attitude unit (Tolerances::widening).
#pragma once

#include <cstddef>
#include <span>

#include "harness/compare/followed_setpoint.hpp"
#include "harness/compare/tolerance.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

class AllowedDeviation {
 public:
  // REQUIRES: the tolerances outlive this.
  AllowedDeviation(const Tolerances& tolerances, Module module)
      : tolerances_(tolerances), module_(module), setpoint_(module), gain_(module) {}

  // Takes the next tick of the expected trace, with the parameters that it sets.
  void next(const Sample& want, std::span<const ParameterChange> changes);

  // The allowed deviation at that tick. The widening takes time to compute. It is left out if the
  // tolerance without it is at least ample_headroom times the deviation of `got`. So a headroom
  // (tolerance / deviation) below ample_headroom is exact, and a larger one is a lower bound.
  static constexpr double ample_headroom = 16;
  double of(std::size_t channel, const Sample& tick, float got, float want) const;

 private:
  bool widens(std::size_t channel, const Sample& tick) const;
  double widening(const Sample& tick) const;

  const Tolerances& tolerances_;
  Module module_;
  FollowedSetpoint setpoint_;
  AttitudeGain gain_;
};

// Returns a trace with the times of `want` and, in place of each float32 output, its allowed
// deviation. Flags, and outputs that are not finite, have 0.
Trace allowed_deviations(const Trace& want, const Tolerances& tolerances);

}  // namespace attest
