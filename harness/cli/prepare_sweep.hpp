// Reads the sweep that a command line names, and prepares its flights.
#pragma once

#include <string>

#include "harness/casefile/select.hpp"
#include "harness/cli/command.hpp"
#include "harness/cli/suite_folder.hpp"
#include "harness/sweep/flight_sampler.hpp"
#include "harness/sweep/flights.hpp"
#include "harness/sweep/identity.hpp"

namespace attest::cli {

struct PreparedSweep {
  FlightSampler sampler;
  FlightsOptions flights;
  Shard shard;
  SweepIdentity identity;

  SampleColumns columns() const { return columns_of(sampler, flights.with_port); }
  std::uint64_t samples() const { return sampler.sweep().design.samples; }
};

// Errors: those of the sweep file, its case and its vehicle; a --shard that is no shard, or of more
// shards than samples; the port cannot be opened.
Result<PreparedSweep> prepare_sweep(const SweepOptions& options, const SuiteFolder& suite);

}  // namespace attest::cli
