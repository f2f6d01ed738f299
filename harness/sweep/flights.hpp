// Flies the samples of a sweep in worker processes.
#pragma once

#include <functional>
#include <string>

#include "harness/host/port_process.hpp"
#include "harness/sweep/flight_sampler.hpp"
#include "harness/sweep/sample_table.hpp"

namespace attest {

struct FlightsOptions {
  int processes = 1;
  bool with_port = false;  // also fly the port; the reference always flies
  HostOptions host;        // of the port
  std::function<bool()> stop = [] { return false; };  // true: end soon, rows may be missing
};

SampleColumns columns_of(const FlightSampler& sampler, bool with_port);

// Flies the samples of the range, and calls `on_row` in this process with the row of each, in the
// order of the samples. A lost vehicle or a fault of the port is a result, not an error. Errors:
// case or vehicle refuses a sample's numbers, a flight cannot be set up, the port does not support
// the case; that of `on_row`. After an error or a stop, later samples have no rows.
//
// The port has a process for each of its flights, because it may keep state from one flight to the
// next. Results must not depend on shards, jobs and kills.
Result<void> fly_samples(const FlightSampler& sampler, const SampleRange& range,
                         const FlightsOptions& options,
                         const std::function<Result<void>(const std::string& row)>& on_row);

}  // namespace attest
