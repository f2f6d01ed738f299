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
  bool with_port = false;  // fly the port, too; the reference flies always
  HostOptions host;        // of the port
  std::function<bool()> stop = [] { return false; };  // true: end soon
};

// The columns of the table for these flights.
SampleColumns columns_of(const FlightSampler& sampler, bool with_port);

// Flies the samples of the range, and calls `on_row` with the row of each, in the order of the
// samples, in this process. A vehicle that is lost and a fault of the port are results. Errors, of
// the first sample that has one: a sample that is impossible, a flight that cannot be set up, a
// port that does not fly this case; or that of `on_row`.
//
// The port has a process for each of its flights, because it may keep state from one flight to the
// next. Results must not depend on shards, jobs and kills.
Result<void> fly_samples(const FlightSampler& sampler, const SampleRange& range,
                         const FlightsOptions& options,
                         const std::function<Result<void>(const std::string& row)>& on_row);

}  // namespace attest
