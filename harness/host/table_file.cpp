#include "harness/host/table_file.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/core/suggestion.hpp"
#include "harness/host/mat_file.hpp"
#include "harness/trace/csv.hpp"
#include "harness/trace/csv_rows.hpp"

namespace attest {
namespace {

Result<Table> read_csv_table(const std::filesystem::path& path, std::size_t most_rows) {
  auto rows = CsvRows::open(path, CsvRows::Unnamed::allowed);
  if (!rows) return tl::unexpected(rows.error());
  Table table;
  std::vector<CsvColumn> columns;
  for (const std::string& name : rows->header()) {
    columns.push_back({CellType::f64, sizeof(double) * columns.size()});
    table.push_back({name, {}});
  }
  std::vector<double> row(columns.size());
  rows->set_columns(std::move(columns));
  for (std::size_t count = 0; count < most_rows; ++count) {
    const auto more = rows->next(row.data());
    if (!more) return tl::unexpected(more.error());
    if (!*more) return table;
    for (std::size_t i = 0; i < row.size(); ++i) table[i].values.push_back(row[i]);
  }
  return table;
}

Result<void> check_lengths(const std::filesystem::path& path, const Table& table) {
  if (table.empty()) return fail_at(path.string(), "has no column of numbers");
  for (const Column& column : table) {
    if (column.values.size() == table.front().values.size()) continue;
    return fail_at(path.string(),
                   fmt::format("`{}` has {} values, `{}` has {}; each column needs one for "
                               "each tick",
                               column.name, column.values.size(), table.front().name,
                               table.front().values.size()));
  }
  return {};
}

}  // namespace

std::string_view name_of(TableFormat format) {
  switch (format) {
    case TableFormat::csv:
      return "csv";
    case TableFormat::mat:
      return "mat";
  }
  return "";
}

Result<TableFormat> parse_table_format(std::string_view name) {
  std::vector<std::string> names;
  for (const TableFormat format : table_formats) {
    if (name_of(format) == name) return format;
    names.emplace_back(name_of(format));
  }
  return fail(fmt::format("no format `{}`{}; there are {}", name, suggestion(name, names),
                          fmt::join(names, ", ")));
}

Result<Table> read_table(const std::filesystem::path& path, TableFormat format,
                         std::size_t most_rows) {
  auto table = format == TableFormat::mat ? read_mat(path) : read_csv_table(path, most_rows);
  if (!table) return table;
  if (auto checked = check_lengths(path, *table); !checked) return tl::unexpected(checked.error());
  return table;
}

Result<void> write_inputs(const std::filesystem::path& path, TableFormat format,
                          const Trace& trace) {
  if (format == TableFormat::mat) return write_mat(path, inputs_of(trace));
  Trace inputs = trace;
  for (std::size_t i = 0; i < channels().size(); ++i) {
    if (channels()[i].is_output()) inputs.present.reset(i);
  }
  return write_csv(path, inputs, all_columns(inputs));
}

}  // namespace attest
