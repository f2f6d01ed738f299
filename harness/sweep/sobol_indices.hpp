// Sobol indices: how much of a metric's variance each dispersion causes. They need a sweep with the
// design `saltelli`.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "harness/sweep/statistics.hpp"

namespace attest {

// Shares of the variance: `first` of the dispersion alone, `total` with all its interactions.
struct SobolIndex {
  double first = 0, total = 0;
  Interval first_interval, total_interval;
};

struct SobolIndices {
  std::uint64_t blocks = 0;            // blocks that were used
  std::uint64_t left_out = 0;          // blocks in which a value is infinite or missing
  std::vector<SobolIndex> dimensions;  // empty: fewer than 10 blocks, or the metric does not vary
};

// `values`: the metric of each sample, NaN if it is missing. An incomplete last block is ignored.
//
// First-order indices by Saltelli et al., total ones by Jansen (1999): formulas (b) and (f) of
// table 2 in Saltelli et al., Variance based sensitivity analysis of model output, 2010. The
// intervals are normal ones with the standard error of the delta method, for independent blocks.
SobolIndices sobol_indices(const std::vector<double>& values, std::size_t dimensions,
                           double confidence);

}  // namespace attest
