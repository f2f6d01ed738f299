// The allowed |got - want| of each value of a trace, which depends on the tick: near a tilt error
// of 180 deg the tolerance of the rates setpoint is wider (Tolerances::widening).
#pragma once

#include <cstddef>
#include <span>

#include "harness/compare/tilt.hpp"
#include "harness/compare/tolerance.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// Follows the setpoint and the gains of a trace, tick by tick.
class AllowedDeviation {
 public:
  // REQUIRES: the tolerances outlive this.
  explicit AllowedDeviation(const Tolerances& tolerances) : tolerances_(tolerances) {}

  // The next tick, with the parameters that it sets.
  void next(const attest_inputs& in, std::span<const ParameterChange> changes);

  // Of that tick, whose inputs are `in`. If `got` is within the tolerance without widening, the
  // result is that tolerance, because the widening takes time to compute.
  double of(std::size_t channel, const attest_inputs& in, float got, float want) const;

 private:
  const Tolerances& tolerances_;
  bool is_first_ = true;
  attest_inputs setpoint_{};  // the inputs with the last new attitude setpoint
  AttitudeGain gain_;
};

// The times of `want`, and at each tick the allowed deviation of each float32 output in place of
// its value. Flags have 0.
Trace allowed_deviations(const Trace& want, const Tolerances& tolerances);

}  // namespace attest
