// The summary of a dispersed sweep for people.
#pragma once

#include <filesystem>
#include <string>

#include "harness/sweep/flight_sampler.hpp"
#include "harness/sweep/summary.hpp"

namespace attest {

// "px4-v1.5.5/flight/tilt_step_30@250hz-iris-mujoco: 1000 samples, design sobol".
std::string heading_of(const FlightSampler& sampler, const SweepSummary& summary);
// How a sweep with `stop_when_decided` ended; empty for other sweeps.
std::string ending_of(const SweepFile& sweep, const SweepSummary& summary);
// "998 done, 2 diverged".
std::string outcomes_of(const SweepSummary& summary);
// "at most 1.2".
std::string bounds_of(const Requirement& requirement);
// "probability (0.95)" and "0.9430 to 0.9810"; for a grid "share" and "0.9800".
std::string probability_heading(const SweepFile& sweep);
std::string probability_of(const SweepFile& sweep, const RequirementResult& result);
// "0.31 (0.28 to 0.34)".
std::string index_text(double value, const Interval& interval);
// "Sobol indices of tilts, of 500 blocks (0.95)", and how many blocks are left out.
std::string indices_heading(const SweepFile& sweep, const MetricSummary& metric);
// "The port differs from the reference: settles."
std::string difference_text(const PortDifference& port);
// The command that flies a kept sample again. `port` and `kept`: see render_sweep().
std::string sim_command_for(const FlightSampler& sampler, std::uint64_t sample,
                            const std::string& port, const std::filesystem::path& kept);

// `port`: empty if only the reference flew. `kept`: the folder of keep_flights(); empty: no flight
// was kept.
std::string render_sweep(const FlightSampler& sampler, const SampleColumns& columns,
                         const SweepSummary& summary, const std::string& port,
                         const std::filesystem::path& kept);

}  // namespace attest
