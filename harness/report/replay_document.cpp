#include "harness/report/replay_document.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/report/failure_text.hpp"
#include "harness/report/output_plots.hpp"
#include "harness/report/text.hpp"

namespace attest {
namespace {

std::string deviation_text(const std::optional<Deviation>& deviation) {
  if (!deviation) return "";
  const Channel& channel = channels()[deviation->channel];
  return fmt::format("tick {}, {}: got {}, want {}", deviation->tick, channel_with_unit(channel),
                     value_text(channel, deviation->got), value_text(channel, deviation->want));
}

// "97.6%", of the paired samples.
std::string part_text(std::size_t count, const TopicAgreement& topic) {
  const auto paired = static_cast<double>(std::max<std::size_t>(topic.paired, 1));
  return fmt::format("{:.1f}%", 100 * static_cast<double>(count) / paired);
}

std::string title_of(const TopicAgreement& topic) {
  return topic.condition.empty() ? std::string(topic.topic)
                                 : fmt::format("{}, {}", topic.topic, topic.condition);
}

// `logged`: the samples of the topic in the log.
std::vector<Cell> row_of(const TopicAgreement& topic, std::size_t logged, const LogLimits& limits) {
  const Cell verdict = topic.not_judged.empty()
                           ? agreement_cell(topic.agrees(limits))
                           : Cell(std::string(name_of(RowVerdict::not_judged)));
  return {title_of(topic),
          verdict,
          fmt::format("{} of {}", topic.paired, logged),
          fmt::format("{:.3g}", topic.median),
          fmt::format("{:.3g}", topic.p90),
          fmt::format("{:.3g}", topic.p99),
          fmt::format("{:.3g}", topic.largest),
          part_text(topic.within, topic),
          part_text(topic.between_samples, topic),
          part_text(topic.unexplained(), topic)};
}

// The lines about the deviations of a topic. `said`: the reason of the verdict, which is not
// repeated.
void add_deviations(const TopicAgreement& topic, const LogLimits& limits, const std::string& said,
                    std::vector<Cell>& lines) {
  const auto add = [&]<typename... T>(fmt::format_string<T...> text, T&&... values) {
    lines.emplace_back(fmt::format(text, std::forward<T>(values)...));
  };
  const auto add_part = [&](std::size_t count, const std::string& what) {
    add("  {:6} {:>6}  {}", count, part_text(count, topic), what);
  };
  if (topic.paired > 0) {
    add("  off by: median {:.3g}, 90% up to {:.3g}, 99% up to {:.3g}, largest {:.3g}{}",
        topic.median, topic.p90, topic.p99, topic.largest,
        topic.worst ? fmt::format(" at {:.3f} s in {}",
                                  1e-6 * static_cast<double>(topic.worst->timestamp_us),
                                  channels()[topic.worst->channel].name)
                    : "");
    add_part(topic.within, fmt::format("within {:g}", limits.within));
  }
  if (topic.within != topic.paired) {
    if (topic.condition.empty()) {
      add_part(topic.between_samples,
               "explained: port and log are within the reference's values at this and the two "
               "neighbouring samples");
    }
    add_part(topic.unexplained(), "not explained");
    if (topic.mistakes > 0) add_part(topic.mistakes, "wrong where the reference agrees");
    if (topic.missing > 0) add_part(topic.missing, "not published by the port");
    if (topic.non_finite > 0) {
      add_part(topic.non_finite, "NaN or infinity where the log has a number");
    }
  }
  if (!topic.not_judged.empty()) {
    add("  not judged{}{}", topic.not_judged == said ? "" : ": ",
        topic.not_judged == said ? "" : topic.not_judged);
  } else if (topic.first_unexplained) {
    const LoggedPair& pair = *topic.first_unexplained;
    const Channel& channel = channels()[pair.channel];
    if (topic.condition.empty()) {
      add("  first one not explained: tick {}, {:.3f} s after tick 0, in {}", pair.tick,
          pair.after_s, channel_with_unit(channel));
    } else {
      add("  first one: at {:.3f} s in {}", 1e-6 * static_cast<double>(pair.timestamp_us),
          channel_with_unit(channel));
    }
    add("    got    {}", value_text(channel, pair.got));
    add("    logged {}", value_text(channel, pair.logged));
  }
}

// The bars that decided.
std::string bars_of(const LogResult& result, const LogLimits& limits) {
  std::string out = fmt::format("  passes if at least {:g}% of the {} are within {:g} of the log",
                                100 * limits.least_part(result.single_steps.has_value()),
                                result.single_steps ? "single steps" : "samples", limits.within);
  if (result.single_steps) return out;
  return out + fmt::format(", and at most {:g}% differ without an explanation",
                           100 * limits.most_unexplained);
}

// The lines about the ticks of a unit of which the log has `logged`.
void add_ticks(const LoggedUnit& unit, const TopicAgreement& topic, const LoggedOutput& logged,
               std::vector<Cell>& lines) {
  lines.emplace_back(fmt::format("{}: {} of {} logged samples paired with a {}", title_of(topic),
                                 logged.paired, logged.samples, unit.step_topic));
  if (topic.left_out == 0) return;
  lines.emplace_back(fmt::format(
      "  {} of them left out: the log does not have all that they depend on", topic.left_out));
}

void add_single_steps(const SingleSteps& steps, std::vector<Cell>& lines) {
  lines.emplace_back(fmt::format("{} of {} logged steps have all their inputs in the log",
                                 steps.with_own_setpoint + steps.with_given_setpoint,
                                 steps.logged));
  for (const auto& [why, outputs] : steps.left_out) {
    lines.emplace_back(fmt::format("  {:6} left out: {}", outputs, why));
  }
}

// In which modes a unit publishes a setpoint depends on its inputs.
bool is_always_published(std::string_view topic) {
  return topic != "vehicle_rates_setpoint" && topic != "vehicle_attitude_setpoint";
}

std::vector<std::string> absent_topics(const LoggedUnit& unit) {
  const ChannelSet outputs = channels_of(unit.module, "out/");
  std::vector<std::string> present, absent;
  for (std::size_t i = 0; i < channels().size(); ++i) {
    const std::string topic(channels()[i].topic());
    if (!outputs[i] || !is_always_published(topic)) continue;
    std::vector<std::string>& names = unit.trace.present[i] ? present : absent;
    if (names.empty() || names.back() != topic) names.push_back(topic);
  }
  std::erase_if(absent, [&](const std::string& topic) {
    return std::ranges::find(present, topic) != present.end();
  });
  return absent;
}

constexpr const char* beyond_single_steps = "computed from earlier steps, which the log lacks";

// The outputs of a log that its single steps do not show: a whole topic, or some of its fields.
void add_beyond_single_steps(const LoggedUnit& unit, const LogResult& result,
                             std::vector<NotJudged>& found) {
  for (const LoggedOutput& output : unit.outputs) {
    std::vector<std::string> fields;
    std::size_t all = 0;
    const ChannelSet topic = channels_of(unit.module, fmt::format("out/{}.", output.topic));
    for (std::size_t i = 0; i < channels().size(); ++i) {
      const Channel& channel = channels()[i];
      if (!topic[i] || !unit.trace.present[i] || channel.quantity == Quantity::flag) continue;
      ++all;
      if (!result.want.present[i])
        fields.push_back(fmt::format("{}.{}", output.topic, channel.field()));
    }
    if (output.samples == 0 || fields.empty()) continue;
    if (fields.size() == all) fields = {output.topic};
    for (std::string& field : fields) {
      found.push_back({std::move(field), beyond_single_steps});
    }
  }
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

std::string meaning_of_pass(const std::string& log) {
  return fmt::format(
      "a pass by a log proves little, because a flight shows few mistakes of the law; which ones, "
      "and their share: attest faults --log {}",
      shell_word(log));
}

std::string title_of(const LoggedUnit& log) {
  if (log.module == Module::mc_att_control) return log.trace.source;
  return fmt::format("{}: {}", log.trace.source, info_of(log.module).title);
}

const LoggedOutput& output_of(const LoggedUnit& unit, std::string_view topic) {
  return *std::ranges::find(unit.outputs, topic, &LoggedOutput::topic);
}

std::vector<NotJudged> not_judged_in(const LoggedUnit& unit, const LogResult& result) {
  std::vector<NotJudged> found;
  for (std::size_t i = 0; i < result.topics.size(); ++i) {
    const TopicAgreement& topic = result.topics[i];
    const bool is_published = result.single_steps || output_of(unit, topic.topic).samples > 0;
    if (!is_published || topic.not_judged.empty()) continue;
    const bool is_in_part = !result.single_steps &&
                            std::ranges::any_of(result.topics, [&](const TopicAgreement& other) {
                              return other.topic == topic.topic && other.not_judged.empty();
                            });
    found.push_back({is_in_part ? fmt::format("the rest of {}", topic.topic) : title_of(topic),
                     topic.not_judged});
  }
  if (result.single_steps) add_beyond_single_steps(unit, result, found);
  for (const std::string& topic : absent_topics(unit)) found.push_back({topic, "not in the log"});
  return found;
}

DocumentTable unit_table(const LoggedUnit& unit, const LogResult& result, const LogLimits& limits) {
  DocumentTable table{
      fmt::format("How far the port is from the log: {}", info_of(unit.module).title),
      {"topic", "", "paired", "median", "90%", "99%", "largest", "within", "between samples",
       "not explained"}};
  table.rows_in_text = 0;
  if (is_judged(result.result.verdict)) table.below.emplace_back(bars_of(result, limits));
  if (result.single_steps) add_single_steps(*result.single_steps, table.below);
  for (std::size_t i = 0; i < result.topics.size(); ++i) {
    const TopicAgreement& topic = result.topics[i];
    if (result.single_steps) {
      table.rows.push_back(row_of(topic, result.single_steps->logged, limits));
      table.below.emplace_back(title_of(topic));
    } else {
      const LoggedOutput& output = output_of(unit, topic.topic);
      if (output.samples == 0) continue;  // the unit never published it
      table.rows.push_back(row_of(topic, output.samples, limits));
      add_ticks(unit, topic, output, table.below);
    }
    add_deviations(topic, limits, result.result.reason, table.below);
  }
  if (!result.single_steps) return table;
  std::vector<NotJudged> beyond;
  add_beyond_single_steps(unit, result, beyond);
  std::vector<std::string> names;
  for (const NotJudged& one : beyond) names.push_back(one.what);
  if (names.empty()) return table;
  table.below.emplace_back(fmt::format("{}", fmt::join(names, ", ")));
  table.below.emplace_back(fmt::format("  not judged: {}", beyond_single_steps));
  return table;
}

Document log_document(const FlightLog& log, const std::vector<LogResult>& results,
                      const LogLimits& limits, const std::string& port) {
  Document document;
  const Verdict verdict = worst_of(results);
  std::vector<std::string> ticks;
  if (verdict == Verdict::pass) {
    document.notes.push_back({meaning_of_pass(log.units.front().trace.source)});
  }
  for (std::size_t i = 0; i < results.size(); ++i) {
    const LoggedUnit& unit = log.units[i];
    const VectorResult& result = results[i].result;
    const std::string title(info_of(unit.module).title);
    const Trace& logged = results[i].single_steps ? results[i].want : unit.trace;
    ticks.push_back(results[i].single_steps ? counted(result.ticks, "single step")
                                            : counted(unit.trace.samples.size(), "tick"));
    document.facts.push_back({title, std::string(name_of(result.verdict))});
    if (!result.reason.empty()) {
      document.notes.push_back({title + ": " + result.reason, fails_a_run(result.verdict)});
    }
    if (is_judged(result.verdict)) {
      for (const auto& [what, why] : not_judged_in(unit, results[i])) {
        document.notes.push_back({fmt::format("{}: not judged: {} ({})", title, what, why)});
      }
    }
    if (!results[i].topics.empty()) document.tables.push_back(unit_table(unit, results[i], limits));
    if (logged.samples.empty()) continue;
    document.groups.push_back(plots_of_outputs(logged, results[i].got, "logged",
                                               fmt::format("Outputs of the {}", title)));
  }
  document.head = {verdict, log.units.front().trace.source,
                   fmt::format("{}, {}, {}", port, log.profile, fmt::join(ticks, " and "))};
  for (const std::string& note : log.notes) document.notes.push_back({note});
  return document;
}

Document trace_document(const Trace& want, const Trace& got, const VectorResult& result,
                        const std::string& port) {
  Document document;
  document.head = {result.verdict, want.source,
                   fmt::format("{}, {}, {} ticks", port, result.profile, want.samples.size())};
  if (!result.reason.empty()) document.notes.push_back({result.reason, true});
  document.facts = {{"first deviation", deviation_text(result.first)},
                    {"worst deviation", deviation_text(result.worst)}};
  PlotGroup outputs = plots_of_outputs(want, got, "want");
  if (result.first) {
    for (Plot& plot : outputs.plots) plot.marks = {mark_of_first(*result.first, want)};
  }
  if (!outputs.plots.empty()) document.groups = {std::move(outputs)};
  return document;
}

}  // namespace attest
