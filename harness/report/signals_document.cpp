#include "harness/report/signals_document.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/report/text.hpp"

namespace attest {
namespace {

constexpr const char* time_label = "time from the first sample [s]";

// Converts times to seconds from the first sample of all sources.
class SecondsOf {
 public:
  explicit SecondsOf(const std::vector<const TimedSignals*>& sources) {
    for (const TimedSignals* source : sources) {
      for (const TimedSignal& signal : source->all) {
        begin_us_ = std::min(begin_us_, signal.times_us.front());
      }
    }
  }

  double seconds(std::uint64_t time_us, std::int64_t shift_us = 0) const {
    const auto elapsed_us = static_cast<std::int64_t>(time_us - begin_us_) - shift_us;
    return 1e-6 * static_cast<double>(elapsed_us);
  }

 private:
  std::uint64_t begin_us_ = std::numeric_limits<std::uint64_t>::max();
};

// A plot with the unit of the signal. A difference within the tolerance looks small in it.
Plot plot_of_signal(const std::string& name) {
  for (const ModuleInfo& info : modules()) {
    if (!info.has_law()) continue;
    for (const char* prefix : {"out/", "in/"}) {
      const auto channel = find_channel(info.module, prefix + name);
      if (!channel) continue;
      Plot plot{name, std::string(unit_of(channels()[*channel].quantity))};
      if (channels()[*channel].is_output()) {
        plot.least_span = 4 * Tolerances().of(*channel).absolute;
      }
      return plot;
    }
  }
  return {name};
}

PlotSeries series_of(const TimedSignal& signal, const std::string& name, const SecondsOf& clock,
                     std::int64_t shift_us = 0) {
  PlotSeries series{name, {}, signal.values};
  for (const std::uint64_t time_us : signal.times_us) {
    series.x.push_back(clock.seconds(time_us, shift_us));
  }
  return series;
}

// The difference at the times at which both signals have a sample.
PlotSeries difference_of(const TimedSignal& got, const TimedSignal& want, const SecondsOf& clock,
                         std::int64_t shift_us) {
  PlotSeries series{"got - want", {}, {}};
  std::size_t i = 0;
  for (std::size_t j = 0; j < want.times_us.size(); ++j) {
    const auto at = static_cast<std::int64_t>(want.times_us[j]) + shift_us;
    while (i < got.times_us.size() && static_cast<std::int64_t>(got.times_us[i]) < at) ++i;
    if (i == got.times_us.size()) break;
    if (static_cast<std::int64_t>(got.times_us[i]) != at) continue;
    series.x.push_back(clock.seconds(want.times_us[j]));
    series.y.push_back(got.values[i] - want.values[j]);
  }
  return series;
}

// Adds two plots: both signals, and their difference.
void add_pair(const TimedSignal& got, const TimedSignal& want, const SecondsOf& clock,
              std::int64_t shift_us, PlotGroup& group) {
  Plot both = plot_of_signal(want.name);
  both.series = {series_of(want, "want", clock), series_of(got, "got", clock, shift_us)};
  both.series[1].pattern = LinePattern::dashed;
  Plot difference = plot_of_signal(want.name);
  difference.title += ": difference";
  difference.series = {difference_of(got, want, clock, shift_us)};
  group.plots.push_back(std::move(both));
  group.plots.push_back(std::move(difference));
}

std::string tolerance_text(const Tolerance& tolerance) {
  if (tolerance.relative == 0) return fmt::format("{:g}", tolerance.absolute);
  return fmt::format("{:g} or {:g} of the value", tolerance.absolute, tolerance.relative);
}

std::string pair_text(const char* which, const SignalPair& pair) {
  return fmt::format("  {} at {} us: got {}, want {}", which, pair.time_us, pair.got, pair.want);
}

void add_deviating(const SignalComparison& signal, std::vector<Cell>& lines) {
  lines.emplace_back(fmt::format("{}: {} of {} samples deviate by more than {}", signal.name,
                                 signal.deviating, signal.compared,
                                 tolerance_text(signal.tolerance)));
  lines.emplace_back(pair_text("first", *signal.first));
  lines.emplace_back(pair_text("worst", *signal.worst));
}

// "only in the first: 3 signals: a, b, c".
void add_names(const char* what, const std::vector<std::string>& names, std::vector<Cell>& lines) {
  constexpr std::size_t most = 8;
  if (names.empty()) return;
  const auto end = names.begin() + static_cast<std::ptrdiff_t>(std::min(names.size(), most));
  lines.emplace_back(fmt::format("{}: {}: {}{}", what, counted(names.size(), "signal"),
                                 fmt::join(names.begin(), end, ", "),
                                 names.size() > most ? ", ..." : ""));
}

// Two flights may have a few times in common by chance.
void add_doubt(std::size_t compared, std::size_t only_got, std::size_t only_want,
               std::vector<Cell>& lines) {
  if (100 * compared >= compared + std::min(only_got, only_want)) return;
  lines.emplace_back(fmt::format(
      "only {} of {} in the second have a time of the first; these may be two flights (--shift US)",
      compared, counted(compared + only_want, "sample")));
}

void add_shift(const TimeShift& shift, std::vector<Cell>& lines) {
  lines.emplace_back(fmt::format("the first {} the second by {} us, estimated from {}",
                                 shift.us > 0 ? "lags behind" : "is ahead of", std::abs(shift.us),
                                 shift.signal));
  lines.emplace_back(
      fmt::format("  with this shift (--shift {}) its difference is {:.3g} instead of {:.3g} (rms)",
                  shift.us, shift.rms, shift.rms_unshifted));
}

// The signals that deviate, what only one source has, and the time by which one lags.
std::vector<Cell> lines_on(const SignalsComparison& comparison) {
  std::vector<Cell> lines;
  std::vector<std::string> not_compared;
  std::size_t only_got = 0, only_want = 0;
  for (const SignalComparison& signal : comparison.signals) {
    if (signal.compared == 0) {
      not_compared.push_back(signal.name);
    } else if (!signal.agrees()) {
      add_deviating(signal, lines);
    }
    only_got += signal.only_got;
    only_want += signal.only_want;
  }
  add_names("no timestamp in common, so no sample was compared", not_compared, lines);
  add_doubt(comparison.compared(), only_got, only_want, lines);
  if (only_got + only_want > 0) {
    lines.emplace_back(fmt::format(
        "samples at times that the other does not have: {} in the first, {} in the second",
        only_got, only_want));
  }
  add_names("only in the first", comparison.only_in_got, lines);
  add_names("only in the second", comparison.only_in_want, lines);
  if (comparison.shift) add_shift(*comparison.shift, lines);
  return lines;
}

std::vector<Cell> row_of(const SignalComparison& signal) {
  const auto value = [](const std::optional<SignalPair>& pair) {
    return pair ? fmt::format("{:.4g}", std::abs(pair->got - pair->want)) : std::string();
  };
  return {signal.name,
          signal.agrees() || signal.compared > 0 ? agreement_cell(signal.agrees())
                                                 : Cell("no timestamp in common", Verdict::fail),
          fmt::to_string(signal.compared),
          fmt::to_string(signal.deviating),
          signal.first ? fmt::to_string(signal.first->time_us) : "",
          value(signal.worst)};
}

// Signals that differ come first.
DocumentTable table_of(const SignalsComparison& comparison) {
  DocumentTable table{"Signals that both have",
                      {"signal", "", "samples", "deviating", "first [us]", "largest difference"}};
  for (const bool agrees : {false, true}) {
    for (const SignalComparison& signal : comparison.signals) {
      if (signal.agrees() == agrees) table.rows.push_back(row_of(signal));
    }
  }
  table.below = lines_on(comparison);
  table.rows_in_text = 0;
  return table;
}

}  // namespace

Document signals_document(const std::vector<TimedSignals>& sources,
                          const std::vector<std::string>& names) {
  std::vector<const TimedSignals*> all;
  std::vector<std::string> files;
  Document document;
  for (const TimedSignals& source : sources) {
    all.push_back(&source);
    files.push_back(source.source);
    for (const std::string& note : source.notes)
      document.notes.push_back({source.source + ": " + note});
  }
  const SecondsOf clock(all);
  document.head = {Conclusion::measured, fmt::format("{}", fmt::join(files, ", ")),
                   counted(names.size(), "signal")};
  PlotGroup group{"", time_label, {}};
  for (const std::string& name : names) {
    Plot plot = plot_of_signal(name);
    for (const TimedSignals& source : sources) {
      if (const TimedSignal* signal = source.find(name)) {
        plot.series.push_back(series_of(*signal, source.source, clock));
        if (plot.series.size() > 1) plot.series.back().pattern = LinePattern::dashed;
      }
    }
    group.plots.push_back(std::move(plot));
  }
  document.groups = {std::move(group)};
  return document;
}

Document comparison_document(const SignalsComparison& comparison, const TimedSignals& got,
                             const TimedSignals& want, std::int64_t shift_us) {
  Document document;
  document.head = {comparison.agrees() ? Conclusion::pass : Conclusion::fail,
                   fmt::format("{} (got), {} (want), by time{}", got.source, want.source,
                               shift_us == 0 ? "" : fmt::format(", shifted by {} us", shift_us)),
                   fmt::format("{} of {} common signals agree, {} samples",
                               comparison.signals.size() - comparison.deviating_signals(),
                               comparison.signals.size(), comparison.compared())};
  document.facts = {{"only in got", fmt::format("{}", fmt::join(comparison.only_in_got, ", "))},
                    {"only in want", fmt::format("{}", fmt::join(comparison.only_in_want, ", "))}};
  document.tables = {table_of(comparison)};
  const SecondsOf clock({&got, &want});
  PlotGroup group{"Signals that differ", time_label, {}};
  for (const SignalComparison& signal : comparison.signals) {
    if (signal.agrees() || group.plots.size() == 2 * most_plotted_signals) continue;
    add_pair(*got.find(signal.name), *want.find(signal.name), clock, shift_us, group);
  }
  if (!group.plots.empty()) document.groups = {std::move(group)};
  return document;
}

}  // namespace attest
