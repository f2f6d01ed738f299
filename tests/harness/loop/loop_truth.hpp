// The models around the units of the cascade, compared with exact values: control allocator, gyro
// filters and land detector. The simpler models that attest had first are measured, too. Measured
// here, judged by loop_truth_test.cpp and printed by truth_main.cpp.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace attest::test {

struct LoopTruth {
  std::string what;              // "gain of the rates at 40 Hz"
  std::string of;                // "gyro at 1 kHz"
  std::string unit;              // "s"; empty for ratios
  std::optional<double> simple;  // of the simpler model, if it has this value
  double measured = 0;
  double exact = 0;
  double difference = 0;  // of `measured` from `exact`; of gains, with their phase
  double bound = 0;       // on `difference`
};

// `setpoints`: of the allocator, for each vehicle.
std::vector<LoopTruth> loop_truths(int setpoints);

}  // namespace attest::test
