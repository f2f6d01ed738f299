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
  std::optional<Verdict> worst;    // the gravest verdict (matrix.cpp); empty: no result
  std::optional<double> headroom;  // the smallest; empty: no passed vector differs in bits

  std::size_t all() const { return passed + failed + apart; }
  MatrixCell& operator+=(const MatrixCell& other);
};

// "12": all 12 passed; "10/12": two of 12 failed; "5+1": five passed and one was counted apart;
// "-": no result.
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

// The sum of all rows, or of those of one profile. The group of the sum is "total".
MatrixRow total_of(const Matrix& matrix, const std::optional<std::string>& profile = {});

}  // namespace attest
