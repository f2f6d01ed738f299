// Joins the shards of a sweep: the result is that of one machine, byte for byte.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "harness/casefile/select.hpp"
#include "harness/core/result.hpp"
#include "harness/sweep/identity.hpp"
#include "harness/sweep/sample_table.hpp"

namespace attest {

// The table in the folder of a sweep.
inline constexpr const char* sample_file = "samples.csv";

// Consecutive samples; the shards differ by at most one sample.
SampleRange range_of(const Shard& shard, std::uint64_t samples);

// Makes the folder `out` from the folders of all shards, in any order. May be repeated. Errors,
// with the folder: a shard of another sweep, with the difference; another division into shards; a
// shard that is given twice; a shard that is missing or incomplete.
Result<void> merge_shards(const std::vector<std::filesystem::path>& folders,
                          const SweepIdentity& whole, const SampleColumns& columns,
                          std::uint64_t samples, const std::filesystem::path& out);

}  // namespace attest
