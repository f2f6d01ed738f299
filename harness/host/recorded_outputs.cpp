#include "harness/host/recorded_outputs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/trace/output_topics.hpp"

namespace attest {
namespace {

constexpr std::size_t timestamp_channel = 0;  // index in channels()

// From the identifier of a signal to its index in channels().
std::map<std::string, std::size_t> channels_by_identifier(Module module) {
  std::map<std::string, std::size_t> known;
  const ChannelSet of_module = channels_of(module);
  for (std::size_t i = 0; i < channels().size(); ++i) {
    if (of_module[i]) known[identifier_of(channels()[i].name)] = i;
  }
  return known;
}

// The index of each column in channels(); empty for a column that is ignored.
using ColumnChannels = std::vector<std::optional<std::size_t>>;

ColumnChannels channels_of_columns(const Table& table, const Manifest& manifest, Module module) {
  const auto known = channels_by_identifier(module);
  ColumnChannels found;
  for (const Column& column : table) {
    const auto renamed = manifest.columns.find(column.name);
    const std::string name =
        identifier_of(renamed == manifest.columns.end() ? column.name : renamed->second);
    auto channel = known.find(name);
    if (channel == known.end()) channel = known.find("out_" + name);
    found.push_back(channel == known.end() ? std::nullopt : std::optional(channel->second));
  }
  return found;
}

double microseconds(const std::string& unit) {
  if (unit == "s") return 1e6;
  return unit == "ms" ? 1e3 : 1;
}

// The least time between two ticks [us].
double shortest_period_us(const Trace& trace) {
  double shortest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < trace.samples.size(); ++i) {
    const auto period = trace.samples[i].in.timestamp - trace.samples[i - 1].in.timestamp;
    shortest = std::min(shortest, static_cast<double>(period));
  }
  return shortest;
}

// Compares the times of the rows with those of the ticks.
class Times {
 public:
  Times(const std::vector<double>& column, const std::string& unit, const Trace& trace)
      : times_us_(column), unit_(unit), trace_(trace) {
    for (double& time : times_us_) time *= microseconds(unit);
    // Large enough for times in seconds with few digits, too small to match another tick.
    constexpr double part_of_a_period = 0.25;
    allowed_us_ = std::max(0.5, part_of_a_period * shortest_period_us(trace));
  }

  // Describes the first difference. Empty if each row has the time of its tick.
  std::string complaint() const {
    const std::size_t rows = times_us_.size(), ticks = trace_.samples.size();
    std::size_t row = 0;
    while (row < std::min(rows, ticks) && is_at(row, row)) ++row;
    if (row == rows && row == ticks) return "";
    if (row == rows) {
      return fmt::format("ends after tick {} of {}: it is cut off", rows - 1, ticks);
    }
    if (row == ticks) return fmt::format("has more rows than the {} ticks", ticks);
    if (std::string unit = other_unit(); !unit.empty()) return unit;
    if (is_reordered()) {
      return fmt::format(
          "its rows are not in the order of time: row {} is at {:.0f} us, tick {} "
          "at {} us; sort the rows by time",
          row + 1, times_us_[row], row, at(row));
    }
    if (const auto tick = tick_at(row); tick && *tick > row) {
      return fmt::format("has no row for tick {} at {} us; write a row for each tick", row,
                         at(row));
    }
    if (row > 0 && is_at(row, row - 1)) {
      return fmt::format("has two rows for tick {} at {} us", row - 1, at(row - 1));
    }
    return fmt::format(
        "row {} is at {:.0f} us, tick {} at {} us; give each row the time of its "
        "inputs, or leave out the column timestamp",
        row + 1, times_us_[row], row, at(row));
  }

 private:
  std::uint64_t at(std::size_t tick) const { return trace_.samples[tick].in.timestamp; }

  bool is_at(std::size_t row, std::size_t tick) const {
    return std::abs(times_us_[row] - static_cast<double>(at(tick))) <= allowed_us_;
  }

  std::optional<std::size_t> tick_at(std::size_t row) const {
    for (std::size_t tick = 0; tick < trace_.samples.size(); ++tick) {
      if (is_at(row, tick)) return tick;
    }
    return std::nullopt;
  }

  // The complaint if times in another unit (s, ms, us, ns) fit the first and the last tick.
  std::string other_unit() const {
    constexpr std::array units{std::pair{"s", 1e6}, std::pair{"ms", 1e3}, std::pair{"us", 1.0},
                               std::pair{"ns", 1e-3}};
    const std::size_t last = std::min(times_us_.size(), trace_.samples.size()) - 1;
    for (const auto& [name, factor] : units) {
      if (name == unit_) continue;
      const auto fits = [&, scale = factor](std::size_t row) {
        const double time_us = times_us_[row] / microseconds(unit_) * scale;
        return std::abs(time_us - static_cast<double>(at(row))) <= allowed_us_;
      };
      if (!fits(0) || !fits(last)) continue;
      return fmt::format("its times are in {}, not in {}; {}", name, unit_,
                         std::string_view(name) == "ns"
                             ? "write them in s, ms or us"
                             : fmt::format("write time = \"{}\" in {}", name, manifest_name));
    }
    return "";
  }

  bool is_reordered() const {
    if (times_us_.size() != trace_.samples.size()) return false;
    std::vector<double> sorted = times_us_;
    std::sort(sorted.begin(), sorted.end());
    for (std::size_t i = 0; i < sorted.size(); ++i) {
      if (std::abs(sorted[i] - static_cast<double>(at(i))) > allowed_us_) return false;
    }
    return true;
  }

  std::vector<double> times_us_;
  std::string unit_;
  const Trace& trace_;
  double allowed_us_ = 0;
};

std::string wrong_rows(const Table& table, const ColumnChannels& channel_of,
                       const Manifest& manifest, const Trace& trace) {
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (channel_of[i] == timestamp_channel) {
      return Times(table[i].values, manifest.time, trace).complaint();
    }
  }
  const std::size_t rows = table.front().values.size(), ticks = trace.samples.size();
  if (rows == ticks) return "";
  return fmt::format("has {} for {} ticks; write a row for each row of the inputs",
                     rows > ticks ? "more rows" : fmt::format("{} rows", rows), ticks);
}

// A message about the outputs of the trace's module that the table lacks; empty if it has all.
std::string missing_outputs(const Table& table, const ChannelSet& present, const Manifest& manifest,
                            const Trace& trace) {
  const ChannelSet wanted =
      channels_of(module_of(trace.present), "out/") & ~manifest.lacks.outputs & ~present;
  if (wanted.none()) return "";
  std::vector<std::string> names;
  for (std::size_t i = 0; i < channels().size(); ++i) {
    if (wanted[i]) names.emplace_back(channels()[i].name);
  }
  constexpr std::size_t most = 3;
  const std::size_t others = names.size() - std::min(names.size(), most);
  names.resize(std::min(names.size(), most));
  std::string message = fmt::format(
      "no column {}{}; add it, name it in [columns] of {}, or list it under lacks there",
      fmt::join(names, ", "), others == 0 ? "" : fmt::format(" (nor {} others)", others),
      manifest_name);
  if (const auto ignored = ignored_columns(table, manifest, module_of(trace.present));
      !ignored.empty()) {
    message += fmt::format(
        ". The file also has {}",
        fmt::join(ignored.begin(),
                  ignored.begin() + static_cast<std::ptrdiff_t>(std::min(ignored.size(), most)),
                  ", "));
  }
  return message;
}

bool is_value_of(const Channel& channel, double value) {
  if (channel.type == ChannelType::f32) return true;
  const double highest = channel.type == ChannelType::bit ? 1 : 255;
  return value >= 0 && value <= highest && value == std::floor(value);
}

// The channels of all columns. Error: two columns of one channel.
Result<ChannelSet> present_in(const Table& table, const ColumnChannels& channel_of,
                              const std::string& file) {
  ChannelSet present;
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (!channel_of[i]) continue;
    if (present[*channel_of[i]]) {
      return fail_at(file, fmt::format("two columns are {}; `{}` is the second",
                                       channels()[*channel_of[i]].name, table[i].name));
    }
    present.set(*channel_of[i]);
  }
  return present;
}

// Clears the outputs, but sets each flag `published` of the outputs that the port lacks to 1.
void clear_outputs(const Manifest& manifest, Trace& trace) {
  const Module module = module_of(trace.present);
  for (Sample& sample : trace.samples) {
    sample.clear_outputs();
    for (std::size_t i = 0; i < channels().size(); ++i) {
      const Channel& channel = channels()[i];
      if (channel.module != module || !manifest.lacks.outputs[i]) continue;
      if (channel.is_published_flag()) set_value(channel, sample, 1);
    }
  }
}

Result<void> set_outputs(const Column& column, const Channel& channel, const std::string& file,
                         Trace& trace) {
  for (std::size_t tick = 0; tick < trace.samples.size(); ++tick) {
    const double value = column.values[tick];
    if (!is_value_of(channel, value)) {
      return fail_at(file, fmt::format("tick {}: {} is no flag for {}; write 0 or 1", tick, value,
                                       channel.name));
    }
    set_value(channel, trace.samples[tick], value);
  }
  return {};
}

}  // namespace

void keep_unpublished(Trace& trace) {
  const Module module = module_of(trace.present);
  Sample before{};
  for (Sample& sample : trace.samples) {
    keep_unpublished(module, before, sample);
    before.copy_outputs(sample);
  }
}

std::vector<std::string> ignored_columns(const Table& table, const Manifest& manifest,
                                         Module module) {
  const auto channel_of = channels_of_columns(table, manifest, module);
  const std::string parameter = identifier_of(parameter_prefix) + '_';
  std::vector<std::string> ignored;
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (channel_of[i] || table[i].name.empty()) continue;
    if (!identifier_of(table[i].name).starts_with(parameter)) ignored.push_back(table[i].name);
  }
  return ignored;
}

Result<void> set_recorded_outputs(const Table& table, const Manifest& manifest,
                                  const std::string& file, Trace& trace) {
  if (table.front().values.empty()) return fail_at(file, "has no rows");
  const auto channel_of = channels_of_columns(table, manifest, module_of(trace.present));
  const auto present = present_in(table, channel_of, file);
  if (!present) return tl::unexpected(present.error());
  for (std::string complaint : {missing_outputs(table, *present, manifest, trace),
                                wrong_rows(table, channel_of, manifest, trace)}) {
    if (!complaint.empty()) return fail_at(file, std::move(complaint));
  }
  clear_outputs(manifest, trace);
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (!channel_of[i] || manifest.lacks.outputs[*channel_of[i]]) continue;
    const Channel& channel = channels()[*channel_of[i]];
    if (!channel.is_output()) continue;
    if (auto set = set_outputs(table[i], channel, file, trace); !set) return set;
  }
  keep_unpublished(trace);
  return {};
}

}  // namespace attest
