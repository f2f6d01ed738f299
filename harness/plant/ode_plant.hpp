// The reference plant: the same vehicle as an ordinary differential equation, integrated by
// SUNDIALS ARKODE (ERKStep) at tight tolerance, and restarted after each change of an input.
//
// States: position, velocity, attitude quaternion, body rate, rotor speeds, hover seconds used.
#pragma once

#include <memory>

#include "harness/plant/plant.hpp"

namespace attest {

struct OdeOptions {
  // Order 5 is Cash-Karp. Order 6 is broken in SUNDIALS 6.4.1. `ci/truth` takes order 8 at a fixed
  // step as exact; the error of order 8 was observed to fall with the 7th power of the step.
  int order = 5;
  double relative_tolerance = 1e-9;
  double absolute_tolerance = 1e-10;
  double fixed_step_s = 0;  // 0 for adaptive steps
};

class OdePlant : public Plant {
 public:
  // The norm of the integrated attitude. Its distance from 1 is a measure of the integrator's
  // error. state() has the attitude scaled to norm 1.
  virtual double quaternion_norm() const = 0;
};

// The vehicle must outlive the plant.
std::unique_ptr<OdePlant> make_ode_plant(const Vehicle& vehicle, const OdeOptions& options);

}  // namespace attest
