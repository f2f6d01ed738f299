#include "harness/host/file_format.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/core/suggestion.hpp"
#include "harness/host/mat_file.hpp"
#include "harness/port/profiles.hpp"
#include "harness/trace/csv.hpp"
#include "harness/trace/csv_rows.hpp"
#include "harness/ulog/format.hpp"
#include "harness/ulog/trace_log.hpp"

namespace attest {
namespace {

Result<Table> read_csv_table(const std::filesystem::path& path, std::size_t most_rows) {
  // A column may have no name.
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

// The trace of a case is named by the id of the case, which begins with the profile.
Result<void> write_csv_trace(AtomicFile file, const Trace& trace) {
  CsvColumns columns = all_columns(trace);
  columns.plant = !trace.plant.empty();
  const std::string profile = trace.source.substr(0, trace.source.find('/'));
  if (find_profile(profile)) columns.profile = profile;
  return write_csv(std::move(file), trace, columns);
}

// To add a format: a file with its functions, and its row here.
constexpr std::array formats{
    FileFormat{"csv", "", "CSV", nullptr, open_csv, nullptr, signals_of_csv, read_csv_table,
               write_csv_trace},
    FileFormat{"ulg", "ulog", "ULog",
               [](std::string_view bytes) { return bytes.starts_with(ulog::file_magic); }, nullptr,
               read_flight_log, signals_of_log, nullptr, write_log},
    FileFormat{"mat", "", "MAT",
               [](std::string_view bytes) { return bytes.starts_with("MATLAB "); }, nullptr,
               nullptr, nullptr, read_mat, write_mat},
};

// Empty for a pipe.
std::string first_bytes_of(const std::filesystem::path& path) {
  std::error_code unknown;
  if (!std::filesystem::is_regular_file(path, unknown)) return "";
  std::array<char, 64> begin{};
  std::ifstream file(path, std::ios::binary);
  file.read(begin.data(), begin.size());
  return {begin.data(), static_cast<std::size_t>(file.gcount())};
}

std::vector<std::string> names_of_all(bool (*can)(const FileFormat& format)) {
  std::vector<std::string> names;
  for (const FileFormat& format : formats) {
    if (can(format)) names.emplace_back(format.name);
  }
  return names;
}

bool has_tables(const FileFormat& format) { return format.read_table != nullptr; }
bool is_written(const FileFormat& format) { return format.write != nullptr; }

}  // namespace

std::span<const FileFormat> file_formats() { return formats; }

const FileFormat& format_for(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  for (char& c : ending) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  const auto found = std::find_if(formats.begin(), formats.end(), [&](const FileFormat& format) {
    return ending.size() > 1 &&
           (ending.substr(1) == format.name || ending.substr(1) == format.other_ending);
  });
  return found == formats.end() ? formats.front() : *found;
}

const FileFormat& format_of(const std::filesystem::path& path) {
  const std::string bytes = first_bytes_of(path);
  const auto found = std::find_if(formats.begin(), formats.end(), [&](const FileFormat& format) {
    return format.begins != nullptr && format.begins(bytes);
  });
  return found == formats.end() ? format_for(path) : *found;
}

Result<void> check_is_data(const std::filesystem::path& path) {
  const std::string bytes = first_bytes_of(path);
  if (bytes.starts_with("\x7f"
                        "ELF")) {
    return fail_at(path.string(),
                   "is a library or program, not a trace; `attest run` runs a port, and `attest "
                   "record` writes its trace");
  }
  if (!bytes.starts_with("version https://git-lfs.github.com/spec/v1")) return {};
  return fail_at(path.string(),
                 "is a pointer of Git LFS, not the file itself; fetch it with `git lfs pull`");
}

std::string written_endings() {
  const auto names = names_of_all(is_written);
  return fmt::format(".{}", fmt::join(names.begin() + 1, names.end(), ", ."));
}

Result<const FileFormat*> parse_table_format(std::string_view name) {
  for (const FileFormat& format : formats) {
    if (format.name == name && has_tables(format)) return &format;
  }
  const auto names = names_of_all(has_tables);
  return fail(fmt::format("no format `{}`{}; there are {}", name, suggestion(name, names),
                          fmt::join(names, ", ")));
}

tl::unexpected<Error> wrong_format(const std::filesystem::path& path, const FileFormat& format,
                                   bool (*can)(const FileFormat& format)) {
  return fail_at(path.string(), fmt::format("is a {} file; this needs one of the format {}",
                                            format.title, fmt::join(names_of_all(can), " or ")));
}

Result<void> write_trace(AtomicFile file, const Trace& trace) {
  const FileFormat& format = format_for(file.path());
  if (is_written(format)) return format.write(std::move(file), trace);
  return wrong_format(file.path(), format, is_written);
}

}  // namespace attest
