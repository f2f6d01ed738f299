// Reads the sweep that a command line names, and prepares its flights.
#pragma once

#include <string>

#include "harness/casefile/select.hpp"
#include "harness/cli/globals.hpp"
#include "harness/cli/suite_folder.hpp"
#include "harness/sweep/flight_sampler.hpp"
#include "harness/sweep/flights.hpp"
#include "harness/sweep/identity.hpp"

namespace attest::cli {

struct SweepOptions {
  std::string file;
  std::string vehicle, plant;  // empty: those of the file
  HostOptions host;            // with the port `builtin` only the reference flies
  int jobs = 1;
  std::uint64_t samples = 0;  // 0: those of the file
  std::string shard = "1/1";
  std::string out;                 // folder
  std::string html;                // file; empty: not written
  int keep_worst = 0;              // number of flights, of each requirement
  std::vector<std::string> merge;  // folders of shards to join; empty: fly
  std::string plan;                // the program that flies the shards; empty: fly here
  std::size_t shards = 0;          // their number, for `plan`
};

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
