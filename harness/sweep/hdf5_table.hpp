// The results of a sweep as columns in an HDF5 file.
//
// Each column of samples.csv is a dataset with the same name: `sample` (uint64), dispersions
// (float64), metrics (float64, NaN where the outcome is not "done"), outcomes (an enumeration). A
// dispersion has two attributes: `keys`, the names of the numbers that it changes, and `as`, which
// is "value", "factor" or "offset". A metric has the attribute `measure`. The names of numbers and
// measures contain their units. The file has the attributes `attest`, `sweep_sha256`, `port`,
// `port_sha256`, `case`, `rate`, `vehicle`, `plant` and `design`. Empty ones are left out.
#pragma once

#include <filesystem>
#include <string>

#include "harness/sweep/flight_sampler.hpp"
#include "harness/sweep/identity.hpp"
#include "harness/sweep/sample_table.hpp"

namespace attest {

// The bytes of the file, which are the same for the same table. Needs memory for twice their size.
// Errors: libhdf5 is missing, or cannot make the file.
Result<std::string> hdf5_table(const FlightSampler& sampler, const SweepIdentity& identity,
                               const SampleColumns& columns, const SampleData& data);

}  // namespace attest
