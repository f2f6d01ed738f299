// The summary of a dispersed sweep for people.
#pragma once

#include <filesystem>
#include <string>

#include "harness/sweep/flight_sampler.hpp"
#include "harness/sweep/summary.hpp"

namespace attest {

// `port`: empty for the reference only. `kept`: the folder of keep_flights(); empty: none are kept.
std::string render_summary(const FlightSampler& sampler, const SampleColumns& columns,
                           const SweepSummary& summary, const std::string& port,
                           const std::filesystem::path& kept);

}  // namespace attest
