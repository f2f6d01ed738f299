#include "harness/report/html/signals_page.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/report/document.hpp"
#include "harness/report/failure_text.hpp"
#include "harness/report/text.hpp"
#include "harness/trace/output_topics.hpp"

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

std::string unit_of_signal(const std::string& name) {
  for (const ModuleInfo& info : modules()) {
    if (!info.is_unit()) continue;
    for (const char* prefix : {"out/", "in/"}) {
      if (const auto channel = find_channel(info.module, prefix + name)) {
        return std::string(unit_of(channels()[*channel].quantity));
      }
    }
  }
  return "";
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
  const std::string unit = unit_of_signal(want.name);
  Plot both{want.name, unit};
  both.series = {series_of(want, "want", clock), series_of(got, "got", clock, shift_us)};
  both.series[1].pattern = LinePattern::dashed;
  Plot difference{want.name + ": difference", unit};
  difference.series = {difference_of(got, want, clock, shift_us)};
  group.plots.push_back(std::move(both));
  group.plots.push_back(std::move(difference));
}

std::vector<Cell> row_of(const SignalComparison& signal) {
  const auto value = [](const std::optional<SignalPair>& pair) {
    return pair ? fmt::format("{:.4g}", std::abs(pair->got - pair->want)) : std::string();
  };
  return {signal.name,
          {signal.agrees()       ? "agrees"
           : signal.compared > 0 ? "differs"
                                 : "no timestamp in common",
           signal.agrees() ? Verdict::pass : Verdict::fail},
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
  return table;
}

std::string joined(const std::vector<std::string>& names) {
  return fmt::format("{}", fmt::join(names, ", "));
}

// One output in both traces, each at the ticks that published the output.
Plot plot_of_output(std::size_t index, const Channel& published, const Trace& want,
                    const Trace& got, const char* name_of_want) {
  const Channel& channel = channels()[index];
  Plot plot{std::string(channel.name), std::string(unit_of(channel.quantity))};
  plot.series = {{name_of_want, {}, {}}, {"got", {}, {}}};
  plot.series[1].pattern = LinePattern::dashed;
  const auto add = [&](const Trace& trace, PlotSeries& series) {
    for (const Sample& sample : trace.samples) {
      if (value_of(published, sample) == 0) continue;
      const auto elapsed_us = sample.in.timestamp - want.samples.front().in.timestamp;
      series.x.push_back(1e-6 * static_cast<double>(elapsed_us));
      series.y.push_back(float_of(channel, sample));
    }
  };
  add(want, plot.series[0]);
  add(got, plot.series[1]);
  return plot;
}

// The float32 outputs that `want` has, of topics with a flag `published`.
PlotGroup plots_of_outputs(const Trace& want, const Trace& got, const char* name_of_want,
                           std::string caption = "Outputs") {
  PlotGroup group{std::move(caption), time_label, {}};
  const Module module = module_of(want.present);
  const ChannelSet outputs = channels_of(module, "out/") & want.present;
  for (std::size_t i = 0; i < channels().size(); ++i) {
    if (!outputs[i] || channels()[i].type != ChannelType::f32) continue;
    const auto published = published_flag(channels()[i]);
    if (!published) continue;
    group.plots.push_back(plot_of_output(i, channels()[*published], want, got, name_of_want));
  }
  return group;
}

std::string deviation_text(const std::optional<Deviation>& deviation) {
  if (!deviation) return "";
  const Channel& channel = channels()[deviation->channel];
  return fmt::format("tick {}, {}: got {}, want {}", deviation->tick, channel_with_unit(channel),
                     value_text(channel, deviation->got), value_text(channel, deviation->want));
}

std::vector<Cell> row_of(const TopicAgreement& topic, const LoggedOutput& logged,
                         const LogLimits& limits) {
  const auto part = [&](std::size_t count) {
    const double all = static_cast<double>(std::max<std::size_t>(topic.paired, 1));
    return fmt::format("{:.1f}%", 100 * static_cast<double>(count) / all);
  };
  const Cell verdict = topic.not_judged.empty()
                           ? Cell(topic.agrees(limits) ? "agrees" : "differs",
                                  topic.agrees(limits) ? Verdict::pass : Verdict::fail)
                           : Cell("not judged");
  return {std::string(topic.topic),
          verdict,
          fmt::format("{} of {}", topic.paired, logged.samples),
          fmt::format("{:.3g}", topic.median),
          fmt::format("{:.3g}", topic.p90),
          fmt::format("{:.3g}", topic.p99),
          fmt::format("{:.3g}", topic.largest),
          part(topic.within),
          part(topic.between_samples),
          part(topic.unexplained())};
}

DocumentTable table_of(const LoggedUnit& unit, const LogResult& result, const LogLimits& limits) {
  DocumentTable table{
      fmt::format("How far the port is from the log: {}", info_of(unit.module).title),
      {"topic", "", "paired", "median", "90%", "99%", "largest", "within", "between samples",
       "not explained"}};
  for (std::size_t i = 0; i < result.topics.size(); ++i) {
    table.rows.push_back(row_of(result.topics[i], unit.outputs[i], limits));
  }
  return table;
}

// The first verdict that fails a run; else a pass if there is one; else that of the first unit.
Verdict worst_of(const std::vector<LogResult>& results) {
  Verdict worst = results.front().result.verdict;
  for (const LogResult& one : results) {
    const Verdict verdict = one.result.verdict;
    if (fails_a_run(verdict)) return verdict;
    if (verdict == Verdict::pass) worst = verdict;
  }
  return worst;
}

}  // namespace

std::string signals_page(const std::vector<TimedSignals>& sources,
                         const std::vector<std::string>& names) {
  std::vector<const TimedSignals*> all;
  std::vector<std::string> files;
  Document page;
  for (const TimedSignals& source : sources) {
    all.push_back(&source);
    files.push_back(source.source);
    for (const std::string& note : source.notes)
      page.notes.push_back({source.source + ": " + note});
  }
  const SecondsOf clock(all);
  page.head = {Verdict::pass, "plots", joined(files), counted(names.size(), "signal")};
  PlotGroup group{"", time_label, {}};
  for (const std::string& name : names) {
    Plot plot{name, unit_of_signal(name)};
    for (const TimedSignals& source : sources) {
      if (const TimedSignal* signal = source.find(name)) {
        plot.series.push_back(series_of(*signal, source.source, clock));
        if (plot.series.size() > 1) plot.series.back().pattern = LinePattern::dashed;
      }
    }
    group.plots.push_back(std::move(plot));
  }
  page.groups = {std::move(group)};
  return html_page(page);
}

std::string comparison_page(const SignalsComparison& comparison, const TimedSignals& got,
                            const TimedSignals& want, std::int64_t shift_us) {
  Document page;
  const bool agrees = comparison.agrees();
  page.head = {agrees ? Verdict::pass : Verdict::fail, agrees ? "agree" : "differ",
               got.source + " and " + want.source,
               fmt::format("{} of {} common signals agree, {} samples",
                           comparison.signals.size() - comparison.deviating_signals(),
                           comparison.signals.size(), comparison.compared())};
  page.facts = {{"got", got.source},
                {"want", want.source},
                {"got was moved earlier by [us]", shift_us == 0 ? "" : fmt::to_string(shift_us)},
                {"only in got", joined(comparison.only_in_got)},
                {"only in want", joined(comparison.only_in_want)}};
  if (comparison.shift) {
    page.notes.push_back(
        {fmt::format("got lags by {} us, estimated from {}; --shift auto compares "
                     "without this time",
                     comparison.shift->us, comparison.shift->signal)});
  }
  page.tables = {table_of(comparison)};
  const SecondsOf clock({&got, &want});
  PlotGroup group{"Signals that differ", time_label, {}};
  for (const SignalComparison& signal : comparison.signals) {
    if (signal.agrees() || group.plots.size() == 2 * most_plotted_signals) continue;
    add_pair(*got.find(signal.name), *want.find(signal.name), clock, shift_us, group);
  }
  if (!group.plots.empty()) page.groups = {std::move(group)};
  return html_page(page);
}

std::string log_page(const FlightLog& log, const std::vector<LogResult>& results,
                     const LogLimits& limits, const std::string& port) {
  Document page;
  const Verdict verdict = worst_of(results);
  std::vector<std::string> ticks;
  page.facts = {{"agreement", fmt::format("at least {:g}% of the samples within {:g}, at most "
                                          "{:g}% not explained",
                                          100 * limits.least_part_within, limits.within,
                                          100 * limits.most_unexplained)}};
  for (std::size_t i = 0; i < results.size(); ++i) {
    const LoggedUnit& unit = log.units[i];
    const VectorResult& result = results[i].result;
    const std::string title(info_of(unit.module).title);
    ticks.push_back(fmt::format("{} ticks", unit.trace.samples.size()));
    page.facts.push_back({title, std::string(name_of(result.verdict))});
    if (!result.reason.empty()) {
      page.notes.push_back({title + ": " + result.reason, fails_a_run(result.verdict)});
    }
    if (!results[i].topics.empty()) page.tables.push_back(table_of(unit, results[i], limits));
    if (unit.trace.samples.empty()) continue;
    page.groups.push_back(plots_of_outputs(unit.trace, results[i].got, "logged",
                                           fmt::format("Outputs of the {}", title)));
  }
  page.head = {verdict, std::string(name_of(verdict)), log.units.front().trace.source,
               fmt::format("{}, {}, {}", port, log.profile, fmt::join(ticks, " and "))};
  for (const std::string& note : log.notes) page.notes.push_back({note});
  return html_page(page);
}

std::string trace_page(const Trace& want, const Trace& got, const VectorResult& result,
                       const std::string& port) {
  Document page;
  page.head = {result.verdict, std::string(name_of(result.verdict)), want.source,
               fmt::format("{}, {}, {} ticks", port, result.profile, want.samples.size())};
  if (!result.reason.empty()) page.notes.push_back({result.reason, true});
  page.facts = {{"first deviation", deviation_text(result.first)},
                {"worst deviation", deviation_text(result.worst)}};
  PlotGroup outputs = plots_of_outputs(want, got, "want");
  if (result.first) {
    const double first_s =
        1e-6 * static_cast<double>(result.first->timestamp_us - want.samples.front().in.timestamp);
    for (Plot& plot : outputs.plots) plot.marks = {{first_s, "first deviation"}};
  }
  if (!outputs.plots.empty()) page.groups = {std::move(outputs)};
  return html_page(page);
}

}  // namespace attest
