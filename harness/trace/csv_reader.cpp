#include <algorithm>
#include <bit>
#include <cstring>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "harness/core/suggestion.hpp"
#include "harness/trace/csv.hpp"
#include "harness/trace/csv_rows.hpp"
#include "harness/trace/plant_columns.hpp"
#include "harness/trace/provenance.hpp"

namespace attest {
namespace {

constexpr std::size_t timestamp_channel = 0;  // of channels()

// A row in memory is a Sample and the values of the parameter columns.
constexpr std::size_t parameters_offset = sizeof(Sample);
constexpr CsvColumn ignored_column{CellType::ignored, 0};

struct Layout {
  std::vector<CsvColumn> columns;
  std::vector<std::string> parameters;
  ChannelSet present;
  std::vector<std::string> ignored;
};

// The firmware of the cascade publishes this topic too; attest_cascade.h says why the ABI lacks it.
constexpr std::string_view left_out_of_the_abi = "out/actuator_controls_status.";

// Whether an unknown column is ignored: only in a trace to be replayed, and only if its name cannot
// be a misspelt one of attest's. `suggestion`: a similar known name, or empty.
bool may_be_ignored(std::string_view name, const CsvRows& rows, const std::string& suggestion,
                    TraceNeed need) {
  const auto& header = rows.header();
  const bool is_a_trace =
      std::find(header.begin(), header.end(), channels()[timestamp_channel].name) != header.end();
  if (need != TraceNeed::inputs_and_outputs || !is_a_trace) return false;
  if (name.starts_with(left_out_of_the_abi)) return true;
  return suggestion.empty() && !name.starts_with("in/") && !name.starts_with("out/");
}

Result<Layout> layout_of(const CsvRows& rows, Module module, TraceNeed need) {
  Layout layout;
  for (std::size_t i = 0; i < rows.header().size(); ++i) {
    const std::string_view name = rows.header()[i];
    if (const auto index = find_channel(module, name)) {
      const Channel& channel = channels()[*index];
      layout.columns.push_back({cell_type(channel.type), channel.offset, channel.bit});
      layout.present.set(*index);
    } else if (const auto parameter = parameter_of(name)) {
      const std::size_t offset = parameters_offset + sizeof(float) * layout.parameters.size();
      layout.columns.push_back({CellType::f32, offset});
      layout.parameters.emplace_back(*parameter);
    } else if (name.starts_with(plant_prefix)) {
      layout.columns.push_back(ignored_column);
    } else {
      std::vector<std::string> names;
      for (const std::string_view known : names_of(channels_of(module))) names.emplace_back(known);
      const std::string meant = suggestion(name, names);
      if (channels_named(name).any()) {
        return rows.fail_at_name(
            i, fmt::format("{} is of another module than {}; keep the columns of one module",
                           in_backquotes(name), name_of(module)));
      }
      if (!may_be_ignored(name, rows, meant, need)) {
        return rows.fail_at_name(i, fmt::format("unknown column {}{}", in_backquotes(name), meant));
      }
      layout.columns.push_back(ignored_column);
      layout.ignored.emplace_back(name);
    }
  }
  return layout;
}

// The base of a trace (Provenance::base): it supplies the columns that the trace itself lacks.
class Base {
 public:
  static Result<std::unique_ptr<Base>> open(const std::filesystem::path& path,
                                            const std::string& folder) {
    const auto place = (path.parent_path() / folder / path.filename()).lexically_normal();
    const auto provenance = provenance_in(place.parent_path());
    if (!provenance) return tl::unexpected(provenance.error());
    if (!provenance->base.empty()) {
      return fail_at(path.string(),
                     fmt::format("its base {} has a base itself; name that one", place.string()));
    }
    auto reader = TraceReader::open(place, TraceNeed::outputs);
    if (!reader) return tl::unexpected(reader.error());
    return std::unique_ptr<Base>(new Base(std::move(*reader)));
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

Result<void> check_need(const ChannelSet& present, TraceNeed need, const std::string& file) {
  const auto missing = [&](std::string_view name, std::size_t others, std::string_view what_to_do) {
    const std::string more = others == 0 ? "" : fmt::format(" (nor {} others)", others);
    return fail_at(file, fmt::format("no column {}{}; {}", name, more, what_to_do), 1);
  };
  if (!present[timestamp_channel]) {
    return missing("timestamp", 0, "add the time of each sample in microseconds");
  }
  const Module module = module_of(present);
  const ChannelSet absent = channels_of(module, "in/") & ~present;
  if (need != TraceNeed::outputs && absent.any()) {
    const std::string_view name = channels()[absent._Find_first()].name;
    return missing(
        name, absent.count() - 1,
        fmt::format("add the column, or an entry \"{}\" under [constants] in a {} next to "
                    "the file",
                    name, provenance_name));
  }
  if (need != TraceNeed::inputs && (present & channels_of(module, "out/")).none()) {
    return missing("out/...", 0, "add at least one output of the unit");
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
  CsvRows rows;
  ChannelSet present{};
  ParameterColumns parameters{{}};
  std::vector<std::string> ignored{};      // names of columns
  std::vector<ParameterChange> constants;  // parameters of the provenance, set at tick 0
  std::vector<char> row{};
  std::unique_ptr<Base> base{};  // null: the trace has all of its columns itself
  std::size_t tick = 0;
  std::uint64_t last_timestamp = 0;

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

  // Reads the next row of the file itself, without the base.
  Result<bool> next_row(Sample& sample, std::vector<ParameterChange>& changes) {
    const auto more = rows.next(row.data());
    if (!more) return more;
    if (!*more && tick == 0) {
      return fail_at(rows.file(), "no rows; a trace has a row for each tick", 2);
    }
    if (!*more) return false;
    std::memcpy(&sample, row.data(), sizeof sample);
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
  auto rows = CsvRows::open(path);
  if (!rows) return tl::unexpected(rows.error());
  const auto provenance = provenance_in(path.parent_path());
  if (!provenance) return tl::unexpected(provenance.error());
  std::unique_ptr<Base> base;
  if (!provenance->base.empty()) {
    auto opened = Base::open(path, provenance->base);
    if (!opened) return tl::unexpected(opened.error());
    base = std::move(*opened);
  }
  const Module module = module_of_file(*rows, *provenance, base.get());
  auto layout = layout_of(*rows, module, need);
  if (!layout) return tl::unexpected(layout.error());

  auto impl = std::make_unique<Impl>(Impl{std::move(*rows),
                                          layout->present,
                                          ParameterColumns(std::move(layout->parameters)),
                                          std::move(layout->ignored),
                                          {}});
  Sample common{};
  if (const auto done = apply_constants(provenance->constants, impl->rows, module, common,
                                        impl->present, impl->constants);
      !done) {
    return tl::unexpected(done.error());
  }
  if (base) {
    base->set_own(impl->present);
    impl->present |= base->present();
    impl->base = std::move(base);
  }
  if (const auto done = check_need(impl->present, need, impl->rows.file()); !done) {
    return tl::unexpected(done.error());
  }
  impl->rows.set_columns(std::move(layout->columns));
  impl->row.resize(parameters_offset + impl->parameters.size());
  std::memcpy(impl->row.data(), &common, sizeof common);
  return TraceReader(std::move(impl));
}

Result<Trace> read_csv(const std::filesystem::path& path, TraceNeed need) {
  auto reader = TraceReader::open(path, need);
  if (!reader) return tl::unexpected(reader.error());
  Trace trace;
  trace.source = reader->file();
  trace.present = reader->present();
  trace.ignored_columns = reader->ignored();
  Sample sample;
  std::vector<ParameterChange> changes;
  while (true) {
    const auto more = reader->next(sample, changes);
    if (!more) return tl::unexpected(more.error());
    if (!*more) return trace;
    trace.samples.push_back(sample);
    trace.parameters.insert(trace.parameters.end(), changes.begin(), changes.end());
  }
}

}  // namespace attest
