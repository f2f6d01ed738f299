// Joins the tables of a sweep's shards. The result has the bytes of a sweep without shards.
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

inline constexpr const char* sample_file = "samples.csv";

// The samples of a shard are consecutive. The sizes of the shards differ by at most one sample.
SampleRange range_of(const Shard& shard, std::uint64_t samples);

// "3,17-20", as Slurm writes the indices of a job array.
// REQUIRES: ascending.
std::string ranges_of(const std::vector<std::size_t>& indices);

// Makes the folder `out` from the folders of all shards, which are given in any order. A folder
// that contains folders of shards stands for all of them. `out` may have the result of an earlier
// merge of this sweep. One shard at a time is in memory. Errors: a folder is of another sweep, with
// the difference; a folder is of another division into shards; a shard is given twice; shards are
// missing or incomplete (the message names them all).
Result<void> merge_shards(const std::vector<std::filesystem::path>& folders,
                          const SweepIdentity& whole, const SampleColumns& columns,
                          std::uint64_t samples, const std::filesystem::path& out);

}  // namespace attest
