// Writes samples of a sweep as a suite of their own, which `attest sim` can fly again.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/sweep/flight_sampler.hpp"

namespace attest {

// Replaces `folder` by a suite with a case and a vehicle for each sample. The names for sample 42
// are those of the sweep's case and vehicle with `_sample_42` at the end. The files of `models`,
// the models of the sweep's suite, are copied. Without samples the folder is removed.
Result<void> keep_flights(const FlightSampler& sampler, const std::vector<std::uint64_t>& samples,
                          const std::filesystem::path& models, const std::filesystem::path& folder);

// "tilt_step_30_sample_42".
std::string kept_name(const std::string& name, std::uint64_t sample);

}  // namespace attest
