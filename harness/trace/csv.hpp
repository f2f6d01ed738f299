// Traces as CSV: one header line with channel names, one row a tick, floats in the shortest decimal
// form that reads back to the same bits. `nan`, `inf` and `-inf` are numbers; CRLF is accepted.
//
// A flown trace may have columns `plant/...`, the truth of the vehicle at each tick, for people and
// their plots: they are written and never read (plant_columns.hpp).
//
// A file that stands beside a provenance.toml leaves out what never changes: the constants there
// are columns too (provenance.hpp).
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// Reads the whole trace, with the constants of the provenance.toml beside it if there is one.
// Parameter columns become changes: all at tick 0, after those of the constants; then, at each tick
// with in/updated.parameter_update, those whose value is not the one last set (by bits, NaN = NaN).
// Errors, each as file:line:column with what to do: unreadable file, no header, unknown or repeated
// column, missing channel, short or long row, a cell that is not a number of its channel's type,
// timestamps that do not increase, no rows.
Result<Trace> read_csv(const std::filesystem::path& path, TraceNeed need);

// The same a tick at a time, in memory that does not grow with the length of the trace.
class TraceReader {
 public:
  static Result<TraceReader> open(const std::filesystem::path& path, TraceNeed need);
  TraceReader(TraceReader&&) noexcept;
  ~TraceReader();

  const std::string& file() const;
  const ChannelSet& present() const;

  // The next tick, with the parameters that change at it in place of what was in `changes`; false
  // after the last.
  Result<bool> next(Sample& sample, std::vector<ParameterChange>& changes);

 private:
  struct Impl;
  explicit TraceReader(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

// Which columns to write. Constant channels are left to the provenance.
struct CsvColumns {
  ChannelSet channels;                  // in the order of channels()
  std::vector<std::string> parameters;  // names, written after the inputs
  bool plant = false;                   // plant/ columns, last. REQUIRES: a flown trace
};

// Everything the trace has, parameters in the order they are first set; without plant/ columns.
CsvColumns all_columns(const Trace& trace);

// Written aside and renamed. Errors: the file cannot be written, and what a column cannot say of a
// parameter: a first value later than tick 0, a change at a tick without
// in/updated.parameter_update.
Result<void> write_csv(const std::filesystem::path& path, const Trace& trace,
                       const CsvColumns& columns);

}  // namespace attest
