// The results of a run by group and rate. The terminal and the HTML page show it as a table.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "harness/verify/run_result.hpp"

namespace attest {

// The results of a group at a rate.
struct MatrixCell {
  std::size_t passed = 0;
  std::size_t failed = 0;
  std::size_t apart = 0;           // unsupported, skip, xfail
  std::optional<Verdict> worst;    // of those that were judged, if any; empty: no result
  std::optional<double> headroom;  // the smallest of those that passed; empty: equal bits

  std::size_t all() const { return passed + failed + apart; }
  MatrixCell& operator+=(const MatrixCell& other);
};

// "12" when all passed; "10/12" when two of twelve failed; "5+1" with one that was counted apart;
// "-" without a result.
std::string text_of(const MatrixCell& cell);

struct MatrixRow {
  std::string profile, group;
  std::vector<MatrixCell> cells;  // one per rate
  MatrixCell total;
};

struct Matrix {
  std::vector<LoopRate> rates;  // ascending
  std::vector<MatrixRow> rows;  // in the order of the results
};

Matrix matrix_of(const RunResult& run);

// The sum of the rows, of all or of one profile. Its group is "total".
MatrixRow total_of(const Matrix& matrix, const std::optional<std::string>& profile = {});

}  // namespace attest
