// Both plants compared with exact solutions, and with each other. Measured here, judged by
// truth_test.cpp and printed by truth_main.cpp of tests/harness/loop.
#pragma once

#include <string>
#include <vector>

namespace attest::test {

struct Truth {
  std::string what;     // "torque-free asymmetric top, 5 s"
  std::string against;  // "Jacobi elliptic functions"
  std::string plant;    // "mujoco, 1 kHz"
  std::string unit;     // "rad/s"
  double measured = 0;
  double min = 0, max = 0;  // bounds on `measured`
};

std::vector<Truth> truths();

}  // namespace attest::test
