// The results of a sweep as columns in an HDF5 file.
//
// Each column of samples.csv is a dataset with the same name: `sample` (uint64), dispersions
// (float64), metrics (float64, NaN where a flight was not done), outcomes (an enumeration). A
// dispersion has two attributes: `keys`, the names of the numbers that it changes, and `as`, which
// is "value", "factor" or "offset". A metric has the attribute `measure`. The names of numbers and
// measures have their units. Attributes of the file: those of identity.json, and `case`, `rate`,
// `vehicle`, `plant`, `design`.
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
