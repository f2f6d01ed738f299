// The formats of files of traces, logs and tables: which of them attest can read and write, and
// how.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "harness/compare/timed_signals.hpp"
#include "harness/core/file.hpp"
#include "harness/core/result.hpp"
#include "harness/host/table.hpp"
#include "harness/trace/trace_parts.hpp"
#include "harness/ulog/flight_log.hpp"

namespace attest {

// A function that is null: attest cannot do this with files of the format.
struct FileFormat {
  using Path = std::filesystem::path;

  std::string_view name;                         // "ulg", also the ending of its files
  std::string_view other_ending;                 // "ulog"
  std::string_view title;                        // for messages: "ULog"
  bool (*begins)(std::string_view first_bytes);  // of a file; null: a text of any kind

  // A trace, part by part: see open_csv(). Without this, files are compared by time.
  Result<std::unique_ptr<TraceParts>> (*open)(const Path&, TraceNeed);
  // The log of a flight, in which the steps of the units must be found: see read_flight_log().
  Result<FlightLog> (*read_log)(const Path&, const std::vector<std::string>& assumed, bool whole);
  Result<TimedSignals> (*read_signals)(const Path&);  // see timed_signals.hpp
  // The first rows, at most `most_rows`, of the columns of numbers. A format may read all rows.
  Result<Table> (*read_table)(const Path&, std::size_t most_rows);
  // Writes the trace with all its columns, and commits the file.
  Result<void> (*write)(AtomicFile, const Trace&);
};

// The first one is CSV.
std::span<const FileFormat> file_formats();

// The format by which a file of that name is written: that of the ending, in any case, or else CSV.
const FileFormat& format_for(const std::filesystem::path& path);
// The format of a file to read: that of its first bytes. If no format begins so, and for a pipe,
// whose bytes can be read only once: same as format_for().
const FileFormat& format_of(const std::filesystem::path& path);

// For help: ".ulg, .mat", the endings of the formats other than CSV in which attest writes traces.
std::string written_endings();

// Errors: the format of this name does not have tables, or is unknown.
Result<const FileFormat*> parse_table_format(std::string_view name);

// An error that names the formats that can do what `can` says.
tl::unexpected<Error> wrong_format(const std::filesystem::path& path, const FileFormat& format,
                                   bool (*can)(const FileFormat& format));

// Errors: the file is a library or a program; it is the pointer that Git has in place of a large
// file.
Result<void> check_is_data(const std::filesystem::path& path);

// Calls a function of the file's format: read_as<&FileFormat::open>(path, TraceNeed::outputs).
// Errors: those of the function; the format does not have it; those of check_is_data().
template <auto function, typename... Arguments>
auto read_as(const std::filesystem::path& path, const Arguments&... arguments)
    -> std::invoke_result_t<decltype(FileFormat{}.*function), decltype(path), const Arguments&...> {
  if (auto checked = check_is_data(path); !checked) return tl::unexpected(checked.error());
  const FileFormat& format = format_of(path);
  if (format.*function != nullptr) return (format.*function)(path, arguments...);
  return wrong_format(path, format, [](const FileFormat& one) { return one.*function != nullptr; });
}

// Writes the file in the format of its name. Errors: those of FileFormat::write; the format has no
// such function.
Result<void> write_trace(AtomicFile file, const Trace& trace);

}  // namespace attest
