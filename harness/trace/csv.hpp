// Traces as CSV: one header line with channel names, one row per tick, floats in the shortest
// decimal form that reads back to the same bits. `nan`, `inf` and `-inf` are numbers; CRLF is
// accepted.
//
// A column `profile/px4-v1.18` says of which version of the law the trace is; its cells are 1. The
// trace of a simulated flight may have columns `plant/...` with the true state of the vehicle
// at each tick, for people and their plots (plant_columns.hpp). They are written, but not read, so
// their cells may have any text.
//
// Other programs may write a trace to be replayed (TraceNeed::inputs_and_outputs). Its unknown
// columns are ignored, too, with one exception: a name that begins with in/ or out/, or resembles a
// channel's name, is an error. PX4's out/actuator_controls_status.* is ignored.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "harness/core/file.hpp"
#include "harness/core/result.hpp"
#include "harness/trace/trace.hpp"
#include "harness/trace/trace_parts.hpp"

namespace attest {

// Reads the whole trace, from a pipe too. A file with a column of mixer traces (mixer_csv.hpp) has
// all channels in its columns, so `need` does not apply; its timestamps count the rows from 0.
// Parameter columns become changes. At tick 0 all are changes. Later, at each tick with
// in/updated.parameter_update, a value that differs from the one last set is a change (by bits,
// NaN = NaN). Errors, each as file:line:column with what to do: unreadable file, no header, unknown
// or repeated column, missing channel, short or long row, a cell that is not a number of its
// channel's type, timestamps that do not increase, no rows; a golden, which is no trace; those of
// RereadableFile::open().
Result<Trace> read_csv(const std::filesystem::path& path, TraceNeed need);

// Reads a trace part by part, in memory that does not grow with the length of the trace. But the
// content of a pipe is kept in memory. Errors: those of read_csv(), also in next_part().
Result<std::unique_ptr<TraceParts>> open_csv(const std::filesystem::path& path, TraceNeed need);

inline constexpr std::string_view profile_prefix = "profile/";

// The columns to write.
struct CsvColumns {
  ChannelSet channels;                  // in the order of channels()
  std::vector<std::string> parameters;  // names, written after the inputs
  std::string profile = {};             // "px4-v1.18", after the outputs; empty: no such column
  bool plant = false;                   // plant/ columns, last. REQUIRES: the trace has `plant`
};

// All channels and parameters of the trace, parameters in the order in which they are first set.
// Without profile and plant/ columns.
CsvColumns all_columns(const Trace& trace);

// Writes the file, and commits it. Errors: the file cannot be written; a parameter that a column
// cannot represent, because it has no value at tick 0, or because it changes at a tick without
// in/updated.parameter_update.
Result<void> write_csv(AtomicFile file, const Trace& trace, const CsvColumns& columns);
// The same for the path of a file.
Result<void> write_csv(const std::filesystem::path& path, const Trace& trace,
                       const CsvColumns& columns);

}  // namespace attest
