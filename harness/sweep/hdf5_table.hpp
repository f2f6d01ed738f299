// The results of a sweep as columns in an HDF5 file.
//
// A dataset for each column of samples.csv, with its name: `sample` (uint64), dispersions and
// metrics (float64, NaN where a flight was not done), outcomes (an enumeration). Attributes of a
// dispersion: `keys`, the numbers that it changes, whose names have their units, and `as`; of a
// metric: `measure`, whose name has its unit. Attributes of the file: those of identity.json, and
// `case`, `rate`, `vehicle`, `plant`, `design`.
#pragma once

#include <filesystem>
#include <string>

#include "harness/sweep/flight_sampler.hpp"
#include "harness/sweep/identity.hpp"
#include "harness/sweep/sample_table.hpp"

namespace attest {

// The bytes of the file: the same for the same table. Needs their size twice in memory. Errors:
// libhdf5 is missing, or cannot make the file.
Result<std::string> hdf5_table(const FlightSampler& sampler, const SweepIdentity& identity,
                               const SampleColumns& columns, const SampleData& data);

}  // namespace attest
