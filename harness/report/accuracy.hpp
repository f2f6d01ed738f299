// How accurate a port is, whether its vectors pass or fail.
#pragma once

#include <optional>

#include "harness/report/document.hpp"
#include "harness/verify/run_result.hpp"

namespace attest {

// The largest deviation of each signal, and the groups in which it deviates most:
//
//     accuracy: the largest deviation of each signal, and the groups where it is largest
//       signal                           unit   largest  groups
//       out/vehicle_rates_setpoint.yaw   rad/s  0.0021   large_angle 0.0021, attitude 3.1e-06
//
// Empty if no vector was compared, or all bits are equal.
std::optional<DocumentTable> accuracy_of(const RunResult& run);

}  // namespace attest
