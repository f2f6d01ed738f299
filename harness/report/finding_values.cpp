#include "harness/report/finding_values.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "harness/casefile/baseline.hpp"
#include "harness/compare/allowed_deviation.hpp"
#include "harness/report/failure_text.hpp"
#include "harness/report/html/plots.hpp"
#include "harness/report/output_plots.hpp"

namespace attest {
namespace {

constexpr std::size_t most_ticks_of_table = 3;
constexpr std::size_t most_plotted_outputs = 8;

// The ticks of a finding that the port has answered.
struct Shown {
  explicit Shown(const HuntFinding& finding)
      : module(module_of(finding.trace.present)),
        end(finding.failure.first->tick + 1),
        begin(end - finding.got.samples.size()),
        got(finding.got) {
    want.source = finding.trace.source;
    want.present = finding.trace.present;
    const auto ticks = finding.trace.samples.begin();
    want.samples.assign(ticks + static_cast<std::ptrdiff_t>(begin),
                        ticks + static_cast<std::ptrdiff_t>(end));
    for (const ParameterChange& change : finding.trace.parameters) {
      if (change.tick >= end) continue;
      want.parameters.push_back(change);
      want.parameters.back().tick -= std::min(change.tick, begin);
    }
    if (finding.failure.compared == Level::numeric)
      allowed = allowed_deviations(want, Tolerances());
    const Trace* const known = allowed.samples.empty() ? nullptr : &allowed;
    outputs = curves_to_plot(curves_of(got, want, known), finding.failure.first->channel,
                             most_plotted_outputs);
  }

  std::size_t ticks_of_table() const { return std::min(got.samples.size(), most_ticks_of_table); }

  Module module;
  std::size_t end, begin;  // ticks of the case
  const Trace& got;
  Trace want;
  Trace allowed;                // without ticks at the level exact
  std::vector<Curves> outputs;  // that deviate
};

bool has_values(const HuntFinding& finding) {
  return finding.failure.first && !finding.got.samples.empty();
}

std::string number_text(double value) { return fmt::format("{}", static_cast<float>(value)); }

class ValuesTable {
 public:
  explicit ValuesTable(const HuntFinding& finding)
      : shown_(finding), first_(shown_.got.samples.size() - shown_.ticks_of_table()) {
    for (const Sample& sample : finding.trace.samples) ticks_us_.push_back(sample.in.timestamp);
    table_.caption = finding.name + ": values";
    table_.id = finding.name;
    table_.rows_in_text = 0;
    table_.header = {"signal"};
    for (std::size_t i = first_; i < shown_.got.samples.size(); ++i) {
      table_.header.push_back(fmt::format("tick {}", shown_.begin + i));
    }
  }

  DocumentTable with_rows() {
    const Sample plain = baseline_sample(shown_.module);
    const ChannelSet inputs = channels_of(shown_.module, "in/") & shown_.want.present;
    const bool has_clock = info_of(shown_.module).is_unit();
    if (has_clock) add_input(channels()[timestamp_channel]);
    for (std::size_t i = 0; i < channels().size(); ++i) {
      if (inputs[i] && matters(channels()[i], plain)) add_input(channels()[i]);
    }
    add_parameters();
    for (const Curves& output : shown_.outputs) add_output(output);
    return std::move(table_);
  }

 private:
  // Without news, a topic has its baseline, and its times are those of a tick.
  bool matters(const Channel& channel, const Sample& plain) const {
    const std::span<const Sample> samples = shown_.want.samples;
    if (channel.type == ChannelType::u64) {
      return std::ranges::any_of(samples.subspan(first_), [&](const Sample& one) {
        return std::ranges::find(ticks_us_, integer_of(channel, one)) == ticks_us_.end();
      });
    }
    // At the first tick of a case each topic is new.
    if (channel.type == ChannelType::bit) {
      return std::ranges::any_of(samples.subspan(shown_.begin == 0 ? 1 : 0),
                                 [&](const Sample& one) { return value_of(channel, one) != 0; });
    }
    return std::ranges::any_of(samples,
                               [&](const Sample& one) { return !same_bits(channel, one, plain); });
  }

  void add_input(const Channel& channel) {
    std::vector<Cell> row = {channel_with_unit(channel)};
    for (std::size_t i = first_; i < shown_.want.samples.size(); ++i) {
      const Sample& sample = shown_.want.samples[i];
      row.emplace_back(channel.type == ChannelType::u64
                           ? std::to_string(integer_of(channel, sample))
                           : number_text(value_of(channel, sample)));
    }
    table_.rows.push_back(std::move(row));
  }

  void add_parameters() {
    std::map<std::string_view, std::vector<Cell>> rows;
    for (const ParameterChange& change : shown_.want.parameters) {
      std::vector<Cell>& row = rows[change.name];
      row.resize(1 + shown_.ticks_of_table());
      row[0].text = fmt::format("{}{}", parameter_prefix, change.name);
      for (std::size_t i = std::max(change.tick, first_); i < shown_.want.samples.size(); ++i) {
        row[1 + i - first_].text = number_text(change.value);
      }
    }
    for (auto& [name, row] : rows) table_.rows.push_back(std::move(row));
  }

  void add_output(const Curves& output) {
    const std::string name = channel_with_unit(channels()[output.channel]);
    std::vector<Cell> got = {name + ", got"}, want = {name + ", want"},
                      allowed = {name + ", allowed"};
    for (std::size_t i = first_; i < output.size(); ++i) {
      const bool deviates = output.deviating > 0 && i >= output.first_tick;
      got.emplace_back(number_text(output.got[i]),
                       deviates ? std::optional(Verdict::fail) : std::nullopt);
      want.emplace_back(number_text(output.want[i]));
      if (!output.allowed.empty()) allowed.emplace_back(fmt::format("{:.3g}", output.allowed[i]));
    }
    const bool is_flag = channels()[output.channel].type != ChannelType::f32;
    table_.rows.push_back(std::move(got));
    table_.rows.push_back(std::move(want));
    if (!is_flag && allowed.size() > 1) table_.rows.push_back(std::move(allowed));
  }

  const Shown shown_;
  const std::size_t first_;              // the tick of the first column, in Shown
  std::vector<std::uint64_t> ticks_us_;  // of the case
  DocumentTable table_;
};

}  // namespace

DocumentTable values_of(const HuntFinding& finding) {
  return has_values(finding) ? ValuesTable(finding).with_rows() : DocumentTable();
}

PlotGroup plots_of(const HuntFinding& finding) {
  PlotGroup group{finding.name, sample_time, {}};
  if (!has_values(finding) || finding.got.samples.size() <= most_ticks_of_table) return group;
  const Shown shown(finding);
  const Trace* const allowed = shown.allowed.samples.empty() ? nullptr : &shown.allowed;
  for (const Curves& output : shown.outputs) {
    group.plots.push_back(plot_of_output(output.channel, shown.want, shown.got, "want", allowed));
    group.plots.back().marks = {mark_of_first(*finding.failure.first, shown.want)};
  }
  return group;
}

}  // namespace attest
