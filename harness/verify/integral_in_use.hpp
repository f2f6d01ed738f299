// The integral that a single step of a rate unit used, as part of its torque.
#pragma once

#include <cstdint>

#include "harness/trace/module.hpp"

namespace attest {

// The log has the integral after a step, and the torque has the one before. So the integral in use
// is taken to be between the logged one and this one less the increments that it may have had
// since, where the reference's torque is nearest to the logged one. An integral at its limit has no
// increment.
class IntegralInUse {
 public:
  // `period_us`: of the loop; 0: not known. Then the increments are taken to be 0.
  explicit IntegralInUse(double period_us) : period_us_(period_us) {}

  // Removes it from the torque of the next step of a log. `reference`: the reference's outputs; its
  // integral begins each step at 0, so it is the increment after the step.
  void remove_from(Sample& logged, const Sample& reference);

 private:
  double period_us_;
  std::uint64_t last_us_ = 0;
};

}  // namespace attest
