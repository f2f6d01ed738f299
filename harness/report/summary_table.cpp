#include "harness/report/summary_table.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "harness/report/text.hpp"

namespace attest {
namespace {

struct Cell {
  std::size_t passed = 0;
  std::size_t failed = 0;
  std::size_t apart = 0;  // unsupported, skip, xfail

  void add(Verdict verdict) {
    if (verdict == Verdict::pass)
      ++passed;
    else if (fails_a_run(verdict))
      ++failed;
    else
      ++apart;
  }

  std::string text() const {
    if (passed + failed + apart == 0) return "-";
    std::string out = fmt::to_string(passed);
    if (failed > 0) out += fmt::format("/{}", passed + failed);
    if (apart > 0) out += fmt::format("+{}", apart);
    return out;
  }

  Colour colour() const {
    if (failed > 0) return Colour::red;
    if (apart > 0) return Colour::yellow;
    return passed > 0 ? Colour::green : Colour::none;
  }
};

struct Row {
  std::string label;
  std::vector<Cell> cells;  // one per rate, then the total
};

struct Table {
  std::vector<std::string> header;  // one per rate, then "total"
  std::vector<Row> rows;
};

std::vector<Rate> selected_rates(const RunResult& run) {
  std::vector<Rate> rates = run.rates;
  for (const CaseResult& result : run.results) rates.push_back(result.rate);
  std::sort(rates.begin(), rates.end());
  rates.erase(std::unique(rates.begin(), rates.end()), rates.end());
  return rates;
}

bool several_profiles(const RunResult& run) {
  return std::any_of(run.results.begin(), run.results.end(), [&run](const CaseResult& result) {
    return result.profile != run.results.front().profile;
  });
}

Row& row_labelled(std::vector<Row>& rows, const std::string& label, std::size_t columns) {
  const auto found = std::find_if(rows.begin(), rows.end(),
                                  [&label](const Row& row) { return row.label == label; });
  if (found != rows.end()) return *found;
  return rows.emplace_back(Row{label, std::vector<Cell>(columns)});
}

Table table_of(const RunResult& run) {
  Table table;
  const std::vector<Rate> rates = selected_rates(run);
  for (const Rate& rate : rates) table.header.push_back(rate.to_string());
  table.header.push_back("total");

  const bool prefixed = several_profiles(run);
  Row sum{"total", std::vector<Cell>(table.header.size())};
  for (const CaseResult& result : run.results) {
    const std::string label =
        one_line(prefixed ? result.profile + "/" + result.group : result.group);
    const auto rate = std::lower_bound(rates.begin(), rates.end(), result.rate);
    const auto column = static_cast<std::size_t>(rate - rates.begin());
    Row& row = row_labelled(table.rows, label, table.header.size());
    for (Row* each : {&row, &sum}) {
      each->cells[column].add(result.verdict);
      each->cells.back().add(result.verdict);
    }
  }
  if (table.rows.size() > 1) table.rows.push_back(std::move(sum));
  return table;
}

std::size_t column_width(const Table& table, std::size_t column) {
  std::size_t width = table.header[column].size();
  for (const Row& row : table.rows) width = std::max(width, row.cells[column].text().size());
  return width + 2;
}

// The columns [begin, result) fit next to the labels; always at least one.
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
      const std::string text = row.cells[column].text();
      // Padded outside the colour: a padded field would count the escape codes.
      out += std::string(column_width(table, column) - text.size(), ' ');
      out += painted(text, row.cells[column].colour(), style);
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
