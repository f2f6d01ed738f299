// Samples of a sweep as a suite of their own, which `attest sim` flies again.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/sweep/flight_sampler.hpp"

namespace attest {

// The case and the vehicle of sample 42 are those of the sweep with `_sample_42` at the end of
// their names. `models` are those of the suite of the sweep; they are copied. Replaces the folder.
Result<void> keep_flights(const FlightSampler& sampler, const std::vector<std::uint64_t>& samples,
                          const std::filesystem::path& models, const std::filesystem::path& folder);

// "tilt_step_30_sample_42".
std::string kept_name(const std::string& name, std::uint64_t sample);

}  // namespace attest
