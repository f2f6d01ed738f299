#include <algorithm>
#include <bit>
#include <cstring>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "harness/core/rereadable_file.hpp"
#include "harness/trace/csv.hpp"
#include "harness/trace/csv_layout.hpp"
#include "harness/trace/csv_rows.hpp"
#include "harness/trace/mixer_csv.hpp"

namespace attest {
namespace {

// Turns the values of parameter columns into changes.
class ParameterColumns {
 public:
  explicit ParameterColumns(std::vector<std::string> names)
      : names_(std::move(names)), values_(names_.size()) {}

  std::size_t size() const { return names_.size() * sizeof(float); }

  // `row` points to size() bytes, a float for each name.
  void record(std::size_t tick, const char* row, std::vector<ParameterChange>& changes) {
    for (std::size_t i = 0; i < names_.size(); ++i) {
      float value = 0;
      std::memcpy(&value, row + i * sizeof value, sizeof value);
      // By bits, so that NaN is equal to itself and -0 is not 0.
      const auto bits = std::bit_cast<std::uint32_t>(value);
      if (values_[i] == bits) continue;
      values_[i] = bits;
      changes.push_back({tick, names_[i], value});
    }
  }

 private:
  std::vector<std::string> names_;
  std::vector<std::optional<std::uint32_t>> values_;  // bits of the values last set
};

class CsvReader final : public TraceParts {
 public:
  // `file`: the name in messages.
  CsvReader(RereadableFile source, std::string file, TraceNeed need)
      : source_(std::move(source)), file_(std::move(file)), need_(need) {}

  const std::string& file() const override { return file_; }
  const ChannelSet& present() const override { return present_; }

  // Opens the file (again).
  Result<void> rewind() override {
    auto rows = CsvRows::open(source_.path(), CsvRows::Unnamed::refused, file_);
    if (!rows) return tl::unexpected(rows.error());
    rows_ = *std::move(rows);
    tick_ = 0;
    present_.reset();
    counts_rows_ = has_mixer_columns(*rows_);
    return counts_rows_ ? set_mixer_columns() : set_columns();
  }

  Result<void> next_part(std::size_t most, Trace& part) override {
    if (most == whole_trace) {
      if (auto limited = rows_->limit_size(); !limited) return limited;
    }
    part.source = file_;
    part.present = present_;
    part.profile = profile_;
    part.ignored_columns = ignored_;
    part.samples.clear();
    part.parameters.clear();
    while (part.samples.size() < most) {
      const auto more = next(part);
      if (!more) return tl::unexpected(more.error());
      if (!*more) return {};
      if (part.samples.size() == 1) reserve(most, part);
    }
    return {};
  }

 private:
  Result<void> set_mixer_columns() {
    present_.set(timestamp_channel);
    auto columns = mixer_columns_of(*rows_, present_);
    if (!columns) return tl::unexpected(columns.error());
    rows_->set_columns(*std::move(columns));
    make_row();
    return {};
  }

  Result<void> set_columns() {
    auto layout = layout_of(*rows_, module_with(rows_->header()), need_);
    if (!layout) return tl::unexpected(layout.error());
    present_ = layout->present;
    parameters_ = ParameterColumns(std::move(layout->parameters));
    ignored_ = std::move(layout->ignored);
    profile_ = std::move(layout->profile);
    rows_->set_columns(std::move(layout->columns));
    make_row();
    return check_need(present_, need_, file_);
  }

  // The channels that are no columns are 0.
  void make_row() {
    row_.resize(parameters_offset + parameters_.size());
    const Sample zero;
    std::memcpy(row_.data(), &zero, sizeof zero);
  }

  Result<void> check_timestamp(const Sample& sample) const {
    if (tick_ == 0 || sample.in.timestamp > last_timestamp_) return {};
    const auto column = std::find(rows_->header().begin(), rows_->header().end(), "timestamp");
    return rows_->fail_at_cell(static_cast<std::size_t>(column - rows_->header().begin()),
                               fmt::format("timestamp {} is not after the {} of the row above; "
                                           "timestamps must increase",
                                           sample.in.timestamp, last_timestamp_));
  }

  // Makes room for the rows that follow, with some to spare because their lengths differ. Growing
  // step by step would touch twice the memory. The limit holds if the first row is unusually short.
  void reserve(std::size_t most, Trace& part) const {
    constexpr std::size_t most_reserved = 100'000;
    const std::size_t left = std::min(rows_->rows_left(), most_reserved);
    part.samples.reserve(std::min(most, 2 + left + left / 4));
  }

  // Appends the next tick. Returns false after the last one.
  Result<bool> next(Trace& part) {
    const auto more = rows_->next(row_.data());
    if (!more) return more;
    if (!*more && tick_ == 0) return fail_at(file_, "no rows; a trace has a row for each tick", 2);
    if (!*more) return false;
    Sample& sample = part.samples.emplace_back();
    std::memcpy(&sample, row_.data(), sizeof sample);
    if (counts_rows_) sample.in.timestamp = tick_;
    if (auto increases = check_timestamp(sample); !increases) {
      return tl::unexpected(increases.error());
    }
    if (tick_ == 0 || (sample.in.updated & ATTEST_UPDATED_PARAMETER_UPDATE) != 0) {
      parameters_.record(part.samples.size() - 1, row_.data() + parameters_offset, part.parameters);
    }
    last_timestamp_ = sample.in.timestamp;
    ++tick_;
    return true;
  }

  RereadableFile source_;
  std::string file_;
  TraceNeed need_;
  std::optional<CsvRows> rows_;  // REQUIRES: rewind() succeeded
  bool counts_rows_ = false;     // instead of a column of timestamps
  ChannelSet present_;
  ParameterColumns parameters_{{}};
  std::vector<std::string> ignored_;  // names of columns
  std::string profile_;
  std::vector<char> row_;
  std::size_t tick_ = 0;
  std::uint64_t last_timestamp_ = 0;
};

}  // namespace

Result<std::unique_ptr<TraceParts>> open_csv(const std::filesystem::path& path, TraceNeed need) {
  // The file may be opened twice.
  auto source = RereadableFile::open(path);
  if (!source) return tl::unexpected(source.error());
  auto reader = std::make_unique<CsvReader>(*std::move(source), path.string(), need);
  if (auto begun = reader->rewind(); !begun) return tl::unexpected(begun.error());
  return reader;
}

Result<Trace> read_csv(const std::filesystem::path& path, TraceNeed need) {
  const auto reader = open_csv(path, need);
  if (!reader) return tl::unexpected(reader.error());
  Trace trace;
  if (auto read = (*reader)->next_part(whole_trace, trace); !read) {
    return tl::unexpected(read.error());
  }
  return trace;
}

}  // namespace attest
