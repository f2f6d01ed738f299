/* SPDX-License-Identifier: BSD-3-Clause */
// tailsitter.hpp - the outer loop of a tailsitter that may have to recover from a large tilt.
#ifndef ATTEST_STARTER_CPP_TAILSITTER_HPP
#define ATTEST_STARTER_CPP_TAILSITTER_HPP

#include "attitude.hpp"

namespace starter {

// Replaces attitude_law() if VT_TYPE is 0 and VT_OPT_RECOV_EN is not 0 at the first step. Its rates
// return the vehicle from a large tilt as fast as possible. They are fitted to the solutions of an
// optimisation. A port for multicopters only can leave this class out and return ATTEST_UNSUPPORTED
// instead.
class TailsitterLoop {
 public:
  Vec3 update(const Gains& gains, const AttitudeTask& task) noexcept;

 private:
  bool recovering_ = false;
};

}  // namespace starter

#endif  // ATTEST_STARTER_CPP_TAILSITTER_HPP
