// The results of a sweep as a CSV file: a row for each sample, in the order of the samples'
// indices.
//
// Rows are appended to an unfinished table, which has another name:
// "samples.csv.part-node7-1f0c9a7e". When it is complete, it is renamed. So `samples.csv` is
// complete or missing, and has the same bytes whether the sweep was interrupted or not. After a
// kill the last line of the unfinished table may be incomplete; it is dropped when the table is
// continued.
//
// Several machines may make the same table at the same time in a shared folder, for example if a
// cluster starts a shard again while its lost node still works. Each machine has an unfinished
// table of its own, named after the machine, and begins with the rows of the longest one. All
// finish with the same bytes, so it does not matter which table is renamed last. This needs no lock
// between machines: many shared file systems have none, or do not release that of a dead machine.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "harness/core/result.hpp"

namespace attest {

// How a flight ended: "done", "diverged" (the vehicle was lost), or the verdict on a port that had
// a fault or non-finite outputs, such as "crash".
inline constexpr const char* outcome_done = "done";
inline constexpr const char* outcome_diverged = "diverged";

struct FlightResult {
  std::string outcome = outcome_done;
  std::vector<double> metrics;  // empty unless done; in a SampleRow: NaN unless done
};

struct SampleColumns {
  std::vector<std::string> dispersions, metrics;
  bool with_port = false;

  // "sample,mass,reference.outcome,reference.settles,port.outcome,port.settles\n".
  std::string header() const;
  // With its line break. `flights`: of the reference, then of the port if there is one.
  std::string line(std::uint64_t index, const std::vector<double>& drawn,
                   const std::vector<FlightResult>& flights) const;
  // The index of the metric with this name. REQUIRES: there is one.
  std::size_t place_of(const std::string& metric) const;
};

// The content of a line. The metrics of a flight whose outcome is not "done" are NaN.
struct SampleRow {
  std::vector<double> drawn;
  std::vector<FlightResult> flights;  // of the reference, then of the port if there is one
};

using OnRow = std::function<void(const SampleRow&)>;

// Reads a line without its line break. False: it is not the row of the sample `index`.
bool read_row(std::string_view line, const SampleColumns& columns, std::uint64_t index,
              SampleRow& row);

// The samples of a shard, [begin, end).
struct SampleRange {
  std::uint64_t begin = 0, end = 0;
  std::uint64_t size() const { return end - begin; }
};

class SampleTable {
 public:
  // Makes the unfinished table of this machine, or continues the longest one. If `file` has all
  // rows of `range`, none is left to append. `on_row` gets the rows that are there. Empty: another
  // process of this machine is making the table, or some process has just finished it; try again.
  // Errors: a finished table has a line that is not one of its rows (with the line's number); the
  // table cannot be written.
  static Result<std::optional<SampleTable>> open(
      const std::filesystem::path& file, const SampleColumns& columns, const SampleRange& range,
      const OnRow& on_row = [](const SampleRow&) {});
  // The same, with this name of the machine.
  static Result<std::optional<SampleTable>> open_on(
      const std::string& machine, const std::filesystem::path& file, const SampleColumns& columns,
      const SampleRange& range, const OnRow& on_row = [](const SampleRow&) {});
  SampleTable(SampleTable&& other) noexcept;
  SampleTable& operator=(SampleTable&&) = delete;
  ~SampleTable();  // without finish(): the table stays unfinished

  std::uint64_t next() const { return next_; }  // the first sample that has no row

  // Appends the row of sample next(), with its line break. Errors: it cannot be written.
  Result<void> append(std::string_view line);
  // Flushes the table to disk, gives it its name, and removes all unfinished ones. REQUIRES: the
  // table has all rows that it is to have.
  Result<void> finish();

 private:
  SampleTable(std::filesystem::path file, std::filesystem::path part, int descriptor,
              std::uint64_t next)
      : file_(std::move(file)), part_(std::move(part)), descriptor_(descriptor), next_(next) {}

  std::filesystem::path file_, part_;
  int descriptor_;
  std::uint64_t next_;
  bool is_complete_ = false;  // finish() has nothing to do
};

// The flights of one pilot: the reference or the port.
struct PilotData {
  std::vector<std::string> outcomes;         // of each sample
  std::vector<std::vector<double>> metrics;  // [metric][sample]; NaN unless done
};

struct SampleData {
  std::vector<std::vector<double>> drawn;  // [dispersion][sample]
  std::vector<PilotData> pilots;           // reference, then port

  std::size_t samples() const { return pilots.front().outcomes.size(); }
};

// Reads all rows into memory, because quantiles, ranks and indices need all values of a column.
// They take 8 bytes for each number, and the text of each outcome. Errors: a line that is not of
// this table, an incomplete last line, fewer rows than `range` has.
Result<SampleData> read_samples(const std::filesystem::path& file, const SampleColumns& columns,
                                const SampleRange& range);

}  // namespace attest
