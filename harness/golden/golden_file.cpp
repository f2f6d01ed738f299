#include "harness/golden/golden_file.hpp"

#include <algorithm>
#include <cstring>
#include <set>
#include <sstream>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/trace/csv_rows.hpp"
#include "harness/trace/csv_text.hpp"

namespace attest {
namespace {

constexpr std::string_view configurations_column = "configurations";
constexpr std::string_view tick_column = "tick";
constexpr std::string_view horizon_column = "horizon_s";
constexpr std::string_view metric_prefix = "metric/";

bool same_outputs(const GoldenTrace& a, const GoldenTrace& b) {
  if (a.ticks != b.ticks || a.horizon_s || b.horizon_s) return false;
  for (std::size_t i = 0; i < channels().size(); ++i) {
    if (!a.outputs.present[i]) continue;
    for (std::size_t k = 0; k < a.ticks.size(); ++k) {
      if (!same_bits(channels()[i], a.outputs.samples[k], b.outputs.samples[k])) return false;
    }
  }
  return true;
}

// Gives traces that are equal to an earlier one's to that one.
std::vector<GoldenTrace> with_shared_traces(std::vector<GoldenTrace> traces) {
  std::vector<GoldenTrace> distinct;
  for (GoldenTrace& trace : traces) {
    const auto equal = std::find_if(distinct.begin(), distinct.end(), [&](const GoldenTrace& one) {
      return same_outputs(one, trace);
    });
    if (equal == distinct.end()) {
      distinct.push_back(std::move(trace));
    } else {
      equal->configurations.insert(equal->configurations.end(), trace.configurations.begin(),
                                   trace.configurations.end());
    }
  }
  return distinct;
}

void write_header(const GoldenTrace& trace, CsvText& text) {
  text.name(configurations_column);
  text.name(tick_column);
  for (std::size_t i = 0; i < channels().size(); ++i) {
    if (trace.outputs.present[i]) text.name(channels()[i].name);
  }
  if (trace.horizon_s) text.name(horizon_column);
  for (const auto& [name, value] : trace.metrics) {
    text.name(fmt::format("{}{}", metric_prefix, name));
  }
  text.end_row();
}

void write_rows(const GoldenTrace& trace, CsvText& text) {
  const std::vector<Sample>& samples = trace.outputs.samples;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const bool begins = k == 0;
    const auto unless_repeated = [&](double value) { begins ? text.number(value) : text.name(""); };
    text.name(begins ? fmt::format("{}", fmt::join(trace.configurations, " ")) : "");
    text.integer(trace.ticks[k]);
    for (std::size_t i = 0; i < channels().size(); ++i) {
      if (!trace.outputs.present[i]) continue;
      const Channel& channel = channels()[i];
      if (!begins && same_bits(channel, samples[k], samples[k - 1])) {
        text.name("");
      } else {
        text.value_of(channel, samples[k]);
      }
    }
    if (trace.horizon_s) unless_repeated(*trace.horizon_s);
    for (const auto& [name, value] : trace.metrics) unless_repeated(value);
    text.end_row();
  }
}

// The begin of a row in memory, at the address of the row, where CsvRows writes it. The horizon and
// the metrics follow it, as doubles; their number depends on the file.
struct RowBegin {
  Sample sample;
  std::string_view configurations;
  std::uint64_t tick;
};

struct Layout {
  ChannelSet present;
  bool has_horizon = false;
  std::vector<std::string> metrics;

  std::size_t number_of_doubles() const { return metrics.size() + (has_horizon ? 1 : 0); }
  std::size_t row_size() const { return sizeof(RowBegin) + number_of_doubles() * sizeof(double); }
};

Result<Layout> set_columns(CsvRows& rows, Module module) {
  Layout layout;
  std::vector<CsvColumn> columns;
  for (std::size_t i = 0; i < rows.header().size(); ++i) {
    const std::string_view name = rows.header()[i];
    const auto channel = find_channel(module, name);
    if (channel && (channels()[*channel].is_output() || *channel == timestamp_channel)) {
      const Channel& found = channels()[*channel];
      columns.push_back({cell_type(found.type), found.offset, found.bit});
      layout.present.set(*channel);
    } else if (i == 0 && name == configurations_column) {
      columns.push_back({CellType::text, offsetof(RowBegin, configurations)});
    } else if (i == 1 && name == tick_column) {
      columns.push_back({CellType::u64, offsetof(RowBegin, tick)});
    } else if (name == horizon_column && layout.number_of_doubles() == 0) {
      columns.push_back({CellType::f64, layout.row_size()});
      layout.has_horizon = true;
    } else if (name.starts_with(metric_prefix)) {
      columns.push_back({CellType::f64, layout.row_size()});
      layout.metrics.emplace_back(name.substr(metric_prefix.size()));
    } else {
      return rows.fail_at_name(i, fmt::format("{} is no column of a golden of {}; bless it anew",
                                              in_backquotes(name), name_of(module)));
    }
  }
  if (rows.header().size() < 3 || rows.header()[0] != configurations_column ||
      rows.header()[1] != tick_column) {
    return fail_at(rows.file(),
                   "is not a golden: its first columns must be `configurations` and "
                   "`tick`, and then outputs follow; bless it anew",
                   1);
  }
  rows.set_columns(std::move(columns));
  return layout;
}

// Reads the rows into traces.
class Reader {
 public:
  Reader(CsvRows rows, Layout layout)
      : rows_(std::move(rows)), layout_(std::move(layout)), row_(layout_.row_size()) {
    const RowBegin zero{};
    std::memcpy(row_.data(), &zero, sizeof zero);
  }

  Result<std::vector<GoldenTrace>> read() {
    while (true) {
      fixed_part().configurations = {};
      const auto more = rows_.next(row_.data());
      if (!more) return tl::unexpected(more.error());
      if (!*more) break;
      if (auto added = add_row(); !added) return tl::unexpected(added.error());
    }
    if (traces_.empty()) return fail_at(rows_.file(), "no rows; bless it anew", 2);
    return std::move(traces_);
  }

 private:
  RowBegin& fixed_part() { return *reinterpret_cast<RowBegin*>(row_.data()); }

  Result<void> add_row() {
    if (!fixed_part().configurations.empty()) {
      if (auto begun = start_trace(); !begun) return begun;
    } else if (traces_.empty()) {
      return rows_.fail_at_cell(0, "the first row names no configuration; bless it anew");
    }
    GoldenTrace& trace = traces_.back();
    const std::uint64_t tick = fixed_part().tick;
    if (!trace.ticks.empty() && tick <= trace.ticks.back()) {
      return rows_.fail_at_cell(1, fmt::format("tick {} is not after the {} of the row above; "
                                               "bless it anew",
                                               tick, trace.ticks.back()));
    }
    trace.ticks.push_back(tick);
    trace.outputs.samples.push_back(fixed_part().sample);
    return {};
  }

  Result<void> start_trace() {
    GoldenTrace trace;
    trace.outputs.present = layout_.present;
    std::istringstream names{std::string(fixed_part().configurations)};
    for (std::string name; names >> name;) {
      if (!known_.insert(name).second) {
        return rows_.fail_at_cell(0, fmt::format("{} has two traces; bless it anew", name));
      }
      trace.configurations.push_back(std::move(name));
    }
    const auto number = [&](std::size_t index) {
      double value = 0;
      std::memcpy(&value, row_.data() + sizeof(RowBegin) + index * sizeof value, sizeof value);
      return value;
    };
    const std::size_t first_metric = layout_.has_horizon ? 1 : 0;
    if (layout_.has_horizon) trace.horizon_s = number(0);
    for (std::size_t i = 0; i < layout_.metrics.size(); ++i) {
      trace.metrics[layout_.metrics[i]] = number(first_metric + i);
    }
    traces_.push_back(std::move(trace));
    return {};
  }

  CsvRows rows_;
  Layout layout_;
  std::vector<char> row_;
  std::vector<GoldenTrace> traces_;
  std::set<std::string> known_;  // configurations
};

}  // namespace

std::string golden_text(std::vector<GoldenTrace> traces) {
  std::string text;
  CsvText csv(text);
  write_header(traces.front(), csv);
  for (const GoldenTrace& trace : with_shared_traces(std::move(traces))) write_rows(trace, csv);
  static_cast<void>(csv.finish());  // a string cannot fail
  return text;
}

Result<std::vector<GoldenTrace>> parse_golden(std::string_view text,
                                              const std::filesystem::path& path, Module module) {
  auto rows = CsvRows::of(text, path);
  if (!rows) return tl::unexpected(rows.error());
  auto layout = set_columns(*rows, module);
  if (!layout) return tl::unexpected(layout.error());
  return Reader(*std::move(rows), *std::move(layout)).read();
}

}  // namespace attest
