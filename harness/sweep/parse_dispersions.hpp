// Reads the tables [disperse.NAME] and [correlate.NAME] of a sweep file.
#pragma once

#include <vector>

#include "harness/core/toml.hpp"
#include "harness/sweep/sweep_file.hpp"

namespace attest {

// This function and parse_correlation() record their errors in the tables of the file.
std::vector<Dispersion> parse_dispersions(const TomlTable& root, DesignKind design);

// The correlation matrix of all dimensions, row by row; empty if the file has no [correlate.NAME].
// REQUIRES: the dispersions of this file.
std::vector<double> parse_correlation(const TomlTable& root,
                                      const std::vector<Dispersion>& dispersions,
                                      DesignKind design);

// The indices of the dispersions that are dimensions of the design: all except seeds.
std::vector<std::size_t> dimensions_of(const std::vector<Dispersion>& dispersions);

}  // namespace attest
