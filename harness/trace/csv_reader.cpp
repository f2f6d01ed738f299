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

}  // namespace

struct TraceReader::Impl {
  RereadableFile source;
  TraceNeed need;
  CsvRows rows;
  bool counts_rows = false;  // instead of a column of timestamps
  ChannelSet present{};
  ParameterColumns parameters{{}};
  std::vector<std::string> ignored{};  // names of columns
  std::vector<char> row{};
  std::size_t tick = 0;
  std::uint64_t last_timestamp = 0;

  // `file`: the name in messages.
  static Result<std::unique_ptr<Impl>> open(RereadableFile source, const std::string& file,
                                            TraceNeed need) {
    auto rows = CsvRows::open(source.path(), CsvRows::Unnamed::refused, file);
    if (!rows) return tl::unexpected(rows.error());
    auto impl = std::make_unique<Impl>(Impl{std::move(source), need, std::move(*rows)});
    const auto done =
        has_mixer_columns(impl->rows) ? impl->set_mixer_columns() : impl->set_columns();
    if (!done) return tl::unexpected(done.error());
    return impl;
  }

  Result<void> set_mixer_columns() {
    counts_rows = true;
    present.set(timestamp_channel);
    auto columns = mixer_columns_of(rows, present);
    if (!columns) return tl::unexpected(columns.error());
    rows.set_columns(*std::move(columns));
    make_row();
    return {};
  }

  Result<void> set_columns() {
    auto layout = layout_of(rows, module_with(rows.header()), need);
    if (!layout) return tl::unexpected(layout.error());
    present = layout->present;
    parameters = ParameterColumns(std::move(layout->parameters));
    ignored = std::move(layout->ignored);
    rows.set_columns(std::move(layout->columns));
    make_row();
    return check_need(present, need, rows.file());
  }

  // The channels that are no columns are 0.
  void make_row() {
    row.resize(parameters_offset + parameters.size());
    const Sample zero;
    std::memcpy(row.data(), &zero, sizeof zero);
  }

  Result<void> check_timestamp(const Sample& sample) const {
    if (tick == 0 || sample.in.timestamp > last_timestamp) return {};
    const auto column = std::find(rows.header().begin(), rows.header().end(), "timestamp");
    return rows.fail_at_cell(static_cast<std::size_t>(column - rows.header().begin()),
                             fmt::format("timestamp {} is not after the {} of the row above; "
                                         "timestamps must increase",
                                         sample.in.timestamp, last_timestamp));
  }

  // Makes room for the rows that follow, with some to spare because their lengths differ. Growing
  // step by step would touch twice the memory. The limit holds if the first row is unusually short.
  void reserve(std::size_t most, Trace& part) const {
    constexpr std::size_t most_reserved = 100'000;
    const std::size_t left = std::min(rows.rows_left(), most_reserved);
    part.samples.reserve(std::min(most, 2 + left + left / 4));
  }

  Result<bool> next(Sample& sample, std::vector<ParameterChange>& changes) {
    changes.clear();
    const auto more = rows.next(row.data());
    if (!more) return more;
    if (!*more && tick == 0) {
      return fail_at(rows.file(), "no rows; a trace has a row for each tick", 2);
    }
    if (!*more) return false;
    std::memcpy(&sample, row.data(), sizeof sample);
    if (counts_rows) sample.in.timestamp = tick;
    if (auto increases = check_timestamp(sample); !increases) {
      return tl::unexpected(increases.error());
    }
    if (tick == 0 || (sample.in.updated & ATTEST_UPDATED_PARAMETER_UPDATE) != 0) {
      parameters.record(tick, row.data() + parameters_offset, changes);
    }
    last_timestamp = sample.in.timestamp;
    ++tick;
    return true;
  }
};

TraceReader::TraceReader(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
TraceReader::TraceReader(TraceReader&&) noexcept = default;
TraceReader::~TraceReader() = default;

const std::string& TraceReader::file() const { return impl_->rows.file(); }
const ChannelSet& TraceReader::present() const { return impl_->present; }
const std::vector<std::string>& TraceReader::ignored() const { return impl_->ignored; }

Result<bool> TraceReader::next(Sample& sample, std::vector<ParameterChange>& changes) {
  return impl_->next(sample, changes);
}

Result<TraceReader> TraceReader::open(const std::filesystem::path& path, TraceNeed need) {
  // The file may be opened twice.
  auto source = RereadableFile::open(path);
  if (!source) return tl::unexpected(source.error());
  auto impl = Impl::open(*std::move(source), path.string(), need);
  if (!impl) return tl::unexpected(impl.error());
  return TraceReader(*std::move(impl));
}

Result<void> TraceReader::rewind() {
  auto again = Impl::open(std::move(impl_->source), impl_->rows.file(), impl_->need);
  if (!again) return tl::unexpected(again.error());
  impl_ = *std::move(again);
  return {};
}

Result<void> TraceReader::next_part(std::size_t most, Trace& part) {
  if (most == whole_trace) {
    if (auto limited = impl_->rows.limit_size(); !limited) return limited;
  }
  part.source = file();
  part.present = present();
  part.ignored_columns = ignored();
  part.samples.clear();
  part.parameters.clear();
  Sample sample;
  std::vector<ParameterChange> changes;
  while (part.samples.size() < most) {
    const auto more = next(sample, changes);
    if (!more) return tl::unexpected(more.error());
    if (!*more) return {};
    for (ParameterChange& change : changes) change.tick = part.samples.size();
    part.samples.push_back(sample);
    if (part.samples.size() == 1) impl_->reserve(most, part);
    part.parameters.insert(part.parameters.end(), changes.begin(), changes.end());
  }
  return {};
}

}  // namespace attest
