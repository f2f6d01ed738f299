// The results of a sweep as a CSV file: a row for each sample, in the order of their indices.
//
// Rows are appended. After a kill the last line may be incomplete; it is dropped when the file is
// opened again. So the file is the same whether the sweep was interrupted or not.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "harness/core/result.hpp"

namespace attest {

// How a flight ended: "done", "diverged", or the verdict on the fault of a port: "crash".
inline constexpr const char* outcome_done = "done";
inline constexpr const char* outcome_diverged = "diverged";

// One flight of a sample.
struct FlightResult {
  std::string outcome = outcome_done;
  std::vector<double> metrics;  // empty unless done
};

struct SampleColumns {
  std::vector<std::string> dispersions, metrics;
  bool with_port = false;

  // "sample,mass,reference.outcome,reference.settles,port.outcome,port.settles\n".
  std::string header() const;
  // `flights`: of the reference, then of the port if there is one.
  std::string line(std::uint64_t index, const std::vector<double>& drawn,
                   const std::vector<FlightResult>& flights) const;
  // Of a metric. REQUIRES: there is one with this name.
  std::size_t place_of(const std::string& metric) const;
};

// The numbers of a line. Without a metric, because the flight was not done, it is NaN.
struct SampleRow {
  std::vector<double> drawn;
  std::vector<FlightResult> flights;  // of the reference, then of the port if there is one
};

// False: `line`, without its line break, is not the row of that sample.
bool read_row(std::string_view line, const SampleColumns& columns, std::uint64_t index,
              SampleRow& row);

// The samples of a shard, [begin, end).
struct SampleRange {
  std::uint64_t begin = 0, end = 0;
  std::uint64_t size() const { return end - begin; }
};

class SampleTable {
 public:
  // Makes the file, or continues it. The file is locked until this ends. Errors: another process
  // has it open; a line that is not of this table, with its number. `on_row`
  // gets the rows that are there.
  static Result<SampleTable> open(
      const std::filesystem::path& file, const SampleColumns& columns, const SampleRange& range,
      const std::function<void(const SampleRow&)>& on_row = [](const SampleRow&) {});
  SampleTable(SampleTable&& other) noexcept;
  SampleTable& operator=(SampleTable&&) = delete;
  ~SampleTable();

  std::uint64_t next() const { return next_; }  // the first sample that has no row

  // The row of sample next(). Errors: the disk is full.
  Result<void> append(std::string_view line);
  // Flushes to disk.
  Result<void> finish();

 private:
  SampleTable(std::filesystem::path file, int descriptor, std::uint64_t next)
      : file_(std::move(file)), descriptor_(descriptor), next_(next) {}

  std::filesystem::path file_;
  int descriptor_;
  std::uint64_t next_;
};

// All rows of one pilot: the reference or the port.
struct PilotData {
  std::vector<std::string> outcomes;         // of each sample
  std::vector<std::vector<double>> metrics;  // of each metric, of each sample; NaN unless done
};

struct SampleData {
  std::vector<std::vector<double>> drawn;  // of each dispersion, of each sample
  std::vector<PilotData> pilots;           // reference, then port

  std::size_t samples() const { return pilots.front().outcomes.size(); }
};

// Errors: a line that is not of this table, or an incomplete last line.
Result<SampleData> read_samples(const std::filesystem::path& file, const SampleColumns& columns,
                                const SampleRange& range);

}  // namespace attest
