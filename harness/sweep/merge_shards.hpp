// Joins the shards of a sweep: the result is that of one machine, byte for byte.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "harness/casefile/select.hpp"
#include "harness/core/result.hpp"
#include "harness/sweep/identity.hpp"
#include "harness/sweep/sample_table.hpp"

namespace attest {

// The table in the folder of a sweep.
inline constexpr const char* sample_file = "samples.csv";

// The samples of a shard are consecutive. The sizes of the shards differ by at most one sample.
SampleRange range_of(const Shard& shard, std::uint64_t samples);

// "3,17-20": as ranges, the way that Slurm writes the indices of a job array.
// REQUIRES: ascending.
std::string ranges_of(const std::vector<std::size_t>& indices);

// Makes the folder `out` from the folders of all shards, in any order. A folder of such folders
// stands for all of them. May be repeated. Memory: one shard. Errors, with the folder: a shard of
// another sweep, with the difference; another division into shards; a shard that is given twice;
// all shards that are missing or incomplete.
Result<void> merge_shards(const std::vector<std::filesystem::path>& folders,
                          const SweepIdentity& whole, const SampleColumns& columns,
                          std::uint64_t samples, const std::filesystem::path& out);

}  // namespace attest
