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
#include "harness/trace/provenance.hpp"

namespace attest {
namespace {

// The base of a trace (Provenance::base): it supplies the columns that the trace itself lacks.
class Base {
 public:
  static Result<std::unique_ptr<Base>> open(const std::filesystem::path& path,
                                            const std::string& folder) {
    const auto place = (path.parent_path() / folder / path.filename()).lexically_normal();
    const auto provenance = provenance_in(place.parent_path());
    if (!provenance) return tl::unexpected(provenance.error());
    return make(path, place, *provenance, TraceReader::open(place, TraceNeed::outputs));
  }

  static Result<std::unique_ptr<Base>> open(const TraceText& trace, const TraceText& base) {
    return make(trace.file, base.file, base.provenance,
                TraceReader::open(base, nullptr, TraceNeed::outputs));
  }

  const ChannelSet& present() const { return reader_.present(); }

  // The channels that the trace itself has.
  void set_own(const ChannelSet& own) { own_ = own; }

  // Reads the base's next tick, and fills in the channels that the trace itself does not have.
  // `more`: whether the trace has a next sample, which is then `sample`. `changes` becomes the
  // changes of the base.
  Result<void> complete(bool more, Sample& sample, std::vector<ParameterChange>& changes,
                        const CsvRows& rows) {
    const Sample own = sample;
    Sample base{};
    const auto base_has_more = reader_.next(base, changes);
    if (!base_has_more) return tl::unexpected(base_has_more.error());
    if (*base_has_more != more || (more && base.in.timestamp != own.in.timestamp)) {
      return fail_at(rows.file(), fmt::format("has other ticks than its base {}", reader_.file()));
    }
    sample = base;
    for (std::size_t i = 0; i < channels().size(); ++i) {
      const Channel& channel = channels()[i];
      if (own_[i]) copy_value(channel, own, sample);
    }
    return {};
  }

 private:
  static Result<std::unique_ptr<Base>> make(const std::filesystem::path& path,
                                            const std::filesystem::path& place,
                                            const Provenance& provenance,
                                            Result<TraceReader> reader) {
    if (!provenance.base.empty()) {
      return fail_at(path.string(),
                     fmt::format("its base {} has a base itself; name that one", place.string()));
    }
    if (!reader) return tl::unexpected(reader.error());
    return std::unique_ptr<Base>(new Base(std::move(*reader)));
  }

  explicit Base(TraceReader reader) : reader_(std::move(reader)) {}

  TraceReader reader_;
  ChannelSet own_;
};

// A file that has a base may have few columns of its own, with names that several modules have. So
// the base determines the module.
Module module_of_file(const CsvRows& rows, const Provenance& provenance, const Base* base) {
  if (base) return module_of(base->present());
  std::vector<std::string> names(rows.header().begin(), rows.header().end());
  for (const auto& [name, value] : provenance.constants) names.push_back(name);
  return module_with(names);
}

// Applies the constants: channels to `sample`, parameters as changes at tick 0.
Result<void> apply_constants(const std::map<std::string, double>& constants, const CsvRows& rows,
                             Module module, Sample& sample, ChannelSet& present,
                             std::vector<ParameterChange>& changes) {
  for (std::size_t i = 0; i < rows.header().size(); ++i) {
    if (!constants.contains(rows.header()[i])) continue;
    return rows.fail_at_name(i, fmt::format("{} is a column and also a constant of {}; remove one",
                                            in_backquotes(rows.header()[i]), provenance_name));
  }
  for (const auto& [name, value] : constants) {
    if (const auto index = find_channel(module, name)) {
      set_value(channels()[*index], sample, value);
      present.set(*index);
    } else if (const auto parameter = parameter_of(name)) {
      changes.push_back({0, std::string(*parameter), static_cast<float>(value)});
    }
  }
  return {};
}

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
  std::optional<RereadableFile> source;  // empty: `rows` has the whole text
  TraceNeed need;
  CsvRows rows;
  std::unique_ptr<Base> base{};  // null: the trace has all of its columns itself
  bool counts_rows = false;      // instead of a column of timestamps
  ChannelSet present{};
  ParameterColumns parameters{{}};
  std::vector<std::string> ignored{};        // names of columns
  std::vector<ParameterChange> constants{};  // parameters of the provenance, set at tick 0
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
        has_mixer_columns(impl->rows) ? impl->set_mixer_columns() : impl->read_provenance();
    if (!done) return tl::unexpected(done.error());
    return impl;
  }

  Result<void> set_mixer_columns() {
    counts_rows = true;
    present.set(timestamp_channel);
    auto columns = mixer_columns_of(rows, present);
    if (!columns) return tl::unexpected(columns.error());
    rows.set_columns(*std::move(columns));
    set_common({});
    return {};
  }

  Result<void> read_provenance() {
    const std::filesystem::path& path = source->path();
    const auto provenance = provenance_in(path.parent_path());
    if (!provenance) return tl::unexpected(provenance.error());
    if (!provenance->base.empty()) {
      auto opened = Base::open(path, provenance->base);
      if (!opened) return tl::unexpected(opened.error());
      base = std::move(*opened);
    }
    return set_columns(*provenance);
  }

  // REQUIRES: `base` is open if the provenance names one.
  Result<void> set_columns(const Provenance& provenance) {
    const Module module = module_of_file(rows, provenance, base.get());
    auto layout = layout_of(rows, module, need);
    if (!layout) return tl::unexpected(layout.error());
    present = layout->present;
    parameters = ParameterColumns(std::move(layout->parameters));
    ignored = std::move(layout->ignored);
    Sample common{};
    if (auto done = apply_constants(provenance.constants, rows, module, common, present, constants);
        !done) {
      return done;
    }
    if (base) {
      base->set_own(present);
      present |= base->present();
    }
    rows.set_columns(std::move(layout->columns));
    set_common(common);
    return check_need(present, need, rows.file());
  }

  // The values of the channels that are no columns.
  void set_common(const Sample& common) {
    row.resize(parameters_offset + parameters.size());
    std::memcpy(row.data(), &common, sizeof common);
  }

  Result<void> check_timestamp(const Sample& sample) const {
    if (tick == 0 || sample.in.timestamp > last_timestamp) return {};
    const auto column = std::find(rows.header().begin(), rows.header().end(), "timestamp");
    return rows.fail_at_cell(static_cast<std::size_t>(column - rows.header().begin()),
                             fmt::format("timestamp {} is not after the {} of the row above; "
                                         "timestamps must increase",
                                         sample.in.timestamp, last_timestamp));
  }

  Result<bool> next(Sample& sample, std::vector<ParameterChange>& changes) {
    changes.clear();
    const auto more = next_row(sample, changes);
    if (!more || !base) return more;
    const auto completed = base->complete(*more, sample, changes, rows);
    if (!completed) return tl::unexpected(completed.error());
    return more;
  }

  // Makes room for the rows that follow, with some to spare because their lengths differ. Growing
  // step by step would touch twice the memory. The limit holds if the first row is unusually short.
  void reserve(std::size_t most, Trace& part) const {
    constexpr std::size_t most_reserved = 100'000;
    const std::size_t left = std::min(rows.rows_left(), most_reserved);
    part.samples.reserve(std::min(most, 2 + left + left / 4));
  }

  // Reads the next row of the file itself, without the base.
  Result<bool> next_row(Sample& sample, std::vector<ParameterChange>& changes) {
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
    if (tick == 0) changes = constants;
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

Result<TraceReader> TraceReader::open(const TraceText& trace, const TraceText* base,
                                      TraceNeed need) {
  auto rows = CsvRows::of(trace.text, trace.file);
  if (!rows) return tl::unexpected(rows.error());
  auto impl = std::make_unique<Impl>(Impl{std::nullopt, need, std::move(*rows)});
  if (base != nullptr) {
    auto opened = Base::open(trace, *base);
    if (!opened) return tl::unexpected(opened.error());
    impl->base = std::move(*opened);
  }
  if (auto set = impl->set_columns(trace.provenance); !set) return tl::unexpected(set.error());
  return TraceReader(std::move(impl));
}

Result<void> TraceReader::rewind() {
  auto again = Impl::open(*std::move(impl_->source), impl_->rows.file(), impl_->need);
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
