#include "harness/report/summary_table.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "harness/report/matrix.hpp"
#include "harness/report/text.hpp"

namespace attest {
namespace {

Colour colour_of(const MatrixCell& cell) {
  if (cell.failed > 0) return Colour::red;
  if (cell.apart > 0) return Colour::yellow;
  return cell.passed > 0 ? Colour::green : Colour::none;
}

struct Row {
  std::string label;
  std::vector<MatrixCell> cells;  // one per rate, then the total
};

struct Table {
  std::vector<std::string> header;  // one per rate, then "total"
  std::vector<Row> rows;
};

Row labelled(std::string label, MatrixRow row) {
  row.cells.push_back(row.total);
  return {std::move(label), std::move(row.cells)};
}

Table table_of(const RunResult& run) {
  const Matrix matrix = matrix_of(run);
  Table table;
  for (const LoopRate& rate : matrix.rates) table.header.push_back(rate.to_string());
  table.header.push_back("total");
  const bool prefixed =
      std::any_of(matrix.rows.begin(), matrix.rows.end(),
                  [&](const MatrixRow& row) { return row.profile != matrix.rows.front().profile; });
  for (const MatrixRow& row : matrix.rows) {
    const std::string label = prefixed ? row.profile + "/" + row.group : row.group;
    table.rows.push_back(labelled(one_line(label), row));
  }
  if (table.rows.size() > 1) table.rows.push_back(labelled("total", total_of(matrix)));
  return table;
}

std::size_t column_width(const Table& table, std::size_t column) {
  std::size_t width = table.header[column].size();
  for (const Row& row : table.rows) width = std::max(width, text_of(row.cells[column]).size());
  return width + 2;
}

// Returns `end`: the columns [begin, end) fit next to the labels. At least one column is taken.
std::size_t last_that_fits(const Table& table, std::size_t begin, std::size_t labels, int limit) {
  std::size_t used = labels + column_width(table, begin);
  std::size_t end = begin + 1;
  while (end < table.header.size()) {
    used += column_width(table, end);
    if (limit > 0 && used > static_cast<std::size_t>(limit)) break;
    ++end;
  }
  return end;
}

std::string block(const Table& table, std::size_t begin, std::size_t end, std::size_t labels,
                  TerminalStyle style) {
  std::string header = fmt::format("{:<{}}", "group \\ Hz", labels);
  for (std::size_t column = begin; column < end; ++column) {
    header += fmt::format("{:>{}}", table.header[column], column_width(table, column));
  }
  std::string out = painted(header, Colour::bold, style) + "\n";
  for (const Row& row : table.rows) {
    out += fmt::format("{:<{}}", row.label, labels);
    for (std::size_t column = begin; column < end; ++column) {
      const std::string text = text_of(row.cells[column]);
      // The padding is added apart from the coloured text, because a field width would count the
      // escape codes.
      out += std::string(column_width(table, column) - text.size(), ' ');
      out += painted(text, colour_of(row.cells[column]), style);
    }
    out += "\n";
  }
  return out;
}

constexpr const char* legend = "n/m: n of m vectors passed; +k: k counted apart\n";

bool needs_legend(const Table& table) {
  return std::any_of(table.rows.begin(), table.rows.end(), [](const Row& row) {
    return row.cells.back().failed > 0 || row.cells.back().apart > 0;
  });
}

}  // namespace

std::string render_table(const RunResult& run, TerminalStyle style) {
  if (run.results.empty()) return {};
  const Table table = table_of(run);
  std::size_t labels = std::string_view("group \\ Hz").size();
  for (const Row& row : table.rows) labels = std::max(labels, row.label.size());
  std::string out;
  for (std::size_t begin = 0; begin < table.header.size();) {
    const std::size_t end = last_that_fits(table, begin, labels, style.width);
    if (begin > 0) out += "\n";
    out += block(table, begin, end, labels, style);
    begin = end;
  }
  return needs_legend(table) ? out + legend : out;
}

}  // namespace attest
