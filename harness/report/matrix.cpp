#include "harness/report/matrix.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace attest {
namespace {

// The gravest verdict has the largest number. The smallest numbers are those of vectors that were
// not judged: they say less about a group than vectors that passed.
int severity(Verdict verdict) {
  switch (verdict) {
    case Verdict::skip:
      return 0;
    case Verdict::unsupported:
      return 1;
    case Verdict::pass:
      return 2;
    case Verdict::xfail:
      return 3;
    case Verdict::xpass:
      return 4;
    case Verdict::fail:
      return 5;
    case Verdict::non_finite:
      return 6;
    case Verdict::protocol:
      return 7;
    case Verdict::timeout:
      return 8;
    case Verdict::crash:
      return 9;
  }
  return 0;
}

MatrixCell cell_of(const VectorResult& result) {
  MatrixCell cell;
  cell.worst = result.verdict;
  if (fails_a_run(result.verdict)) {
    cell.failed = 1;
  } else if (result.verdict != Verdict::pass) {
    cell.apart = 1;
  } else {
    cell.passed = 1;
    const bool differs = result.tightest && std::isfinite(result.tightest->ratio);
    if (differs) cell.headroom = result.tightest->ratio;
  }
  return cell;
}

std::vector<LoopRate> rates_of(const RunResult& run) {
  std::vector<LoopRate> rates = run.rates;
  for (const VectorResult& result : run.results) rates.push_back(result.rate);
  std::sort(rates.begin(), rates.end());
  rates.erase(std::unique(rates.begin(), rates.end()), rates.end());
  return rates;
}

MatrixRow& row_of(const VectorResult& result, Matrix& matrix) {
  const auto found =
      std::find_if(matrix.rows.begin(), matrix.rows.end(), [&](const MatrixRow& row) {
        return row.profile == result.profile && row.group == result.group;
      });
  if (found != matrix.rows.end()) return *found;
  return matrix.rows.emplace_back(
      MatrixRow{result.profile, result.group, std::vector<MatrixCell>(matrix.rates.size()), {}});
}

}  // namespace

MatrixCell& MatrixCell::operator+=(const MatrixCell& other) {
  passed += other.passed;
  failed += other.failed;
  apart += other.apart;
  const bool is_worse = other.worst && (!worst || severity(*other.worst) > severity(*worst));
  if (is_worse) worst = other.worst;
  const bool is_tighter = other.headroom && (!headroom || *other.headroom < *headroom);
  if (is_tighter) headroom = other.headroom;
  return *this;
}

std::string text_of(const MatrixCell& cell) {
  if (cell.all() == 0) return "-";
  std::string out = fmt::to_string(cell.passed);
  if (cell.failed > 0) out += fmt::format("/{}", cell.passed + cell.failed);
  if (cell.apart > 0) out += fmt::format("+{}", cell.apart);
  return out;
}

Matrix matrix_of(const RunResult& run) {
  Matrix matrix;
  matrix.rates = rates_of(run);
  for (const VectorResult& result : run.results) {
    const auto rate = std::lower_bound(matrix.rates.begin(), matrix.rates.end(), result.rate);
    MatrixRow& row = row_of(result, matrix);
    const MatrixCell cell = cell_of(result);
    row.cells[static_cast<std::size_t>(rate - matrix.rates.begin())] += cell;
    row.total += cell;
  }
  return matrix;
}

MatrixRow total_of(const Matrix& matrix, const std::optional<std::string>& profile) {
  MatrixRow sum{profile.value_or(""), "total", std::vector<MatrixCell>(matrix.rates.size()), {}};
  for (const MatrixRow& row : matrix.rows) {
    if (profile && row.profile != *profile) continue;
    for (std::size_t i = 0; i < row.cells.size(); ++i) sum.cells[i] += row.cells[i];
    sum.total += row.total;
  }
  return sum;
}

}  // namespace attest
