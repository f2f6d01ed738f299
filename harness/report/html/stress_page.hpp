// The page of `attest stress --html`.
#pragma once

#include <string>

#include "harness/report/stress_text.hpp"

namespace attest {

// For each rate and unit: verdict and reason, the distributions of the times, with the wake-up
// latency of the idle machine, and a timeline of the flight.
std::string stress_page(const StressRun& run);

}  // namespace attest
