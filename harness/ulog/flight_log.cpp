#include "harness/ulog/flight_log.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/core/printable.hpp"
#include "harness/core/suggestion.hpp"
#include "harness/ulog/log_series.hpp"

namespace attest {
namespace {

using ulog::LogSeries;

constexpr std::string_view control_state = "control_state";

constexpr std::string_view system_of_attest = "attest";  // as trace_log.cpp writes it

constexpr FlightAssumption assumptions[] = {
    {"armed", "in/actuator_armed.armed", true},
    {"rotary_wing", "in/vehicle_status.is_rotary_wing", true},
    {"vtol", "in/vehicle_status.is_vtol", false},
    {"rates", "in/vehicle_control_mode.flag_control_rates_enabled", true},
    {"attitude", "in/vehicle_control_mode.flag_control_attitude_enabled", true},
    {"manual", "in/vehicle_control_mode.flag_control_manual_enabled", true},
    {"auto", "in/vehicle_control_mode.flag_control_auto_enabled", false},
    {"rattitude", "in/vehicle_control_mode.flag_control_rattitude_enabled", false},
    {"velocity", "in/vehicle_control_mode.flag_control_velocity_enabled", false},
};

// The series of every topic that the controller reads or publishes.
std::vector<LogSeries> series_of_controller() {
  std::vector<LogSeries> all;
  const auto table = channels();
  const ChannelSet own = channels_of(Module::mc_att_control);
  for (std::size_t i = 0; i < table.size(); ++i) {
    const Channel& channel = table[i];
    if (!own[i] || channel.type == ChannelType::u64 || channel.type == ChannelType::bit) continue;
    const std::string_view path = channel.name.substr(channel.name.find('/') + 1);
    const std::string_view topic = path.substr(0, path.find('.'));
    const std::string_view field = path.substr(topic.size() + 1);
    if (field == "published") continue;
    const bool is_output = channel.is_output();
    const auto known = std::find_if(all.begin(), all.end(), [&](const LogSeries& series) {
      return series.topic() == topic && series.is_output() == is_output;
    });
    LogSeries& series = known != all.end() ? *known : all.emplace_back(topic, is_output);
    series.add_field(std::string(field), i);
  }
  return all;
}

// Everything of the log that concerns the controller.
struct Contents {
  std::vector<LogSeries> series = series_of_controller();
  std::vector<ParameterChange> parameters;  // by the number of control_state samples before
  std::string system, firmware, source;
  std::set<std::string> other_topics;
  std::size_t dropouts = 0;
  std::vector<std::string> damage;

  LogSeries& inputs(std::string_view topic) { return find(topic, false); }
  LogSeries& find(std::string_view topic, bool is_output) {
    return *std::find_if(series.begin(), series.end(), [&](const LogSeries& one) {
      return one.topic() == topic && one.is_output() == is_output;
    });
  }
};

std::string text_of(const ulog::KeyValue& value) {
  const auto end = std::min(value.bytes.find('\0'), value.bytes.size());
  return std::string(printable_part(value.bytes.substr(0, end)));
}

void read_value(const ulog::KeyValue& value, Contents& log) {
  if (value.kind == 'P') {
    const auto number = ulog::load_as<float>(value.type, value.bytes.data());
    const std::size_t tick = log.inputs(control_state).size();
    log.parameters.push_back({tick, std::string(value.name), number});
  } else if (value.kind == 'I' && value.type == ulog::Type::character) {
    if (value.name == "sys_name") log.system = text_of(value);
    if (value.name == "ver_sw") log.firmware = text_of(value);
    if (value.name == "attest_source") log.source = text_of(value);
  }
}

void read_data(const ulog::Reader& reader, const ulog::Data& data, Contents& log) {
  for (LogSeries& series : log.series) {
    if (series.accepts(*data.subscription)) return series.add(reader, data);
  }
  log.other_topics.insert(data.subscription->topic);
}

Result<Contents> contents_of(const std::filesystem::path& path) {
  auto reader = ulog::Reader::open(path);
  if (!reader) return tl::unexpected(reader.error());
  Contents log;
  ulog::Message message;
  while (true) {
    const auto more = reader->next(message);
    if (!more) return tl::unexpected(more.error());
    if (!*more) break;
    if (reader->is_appended()) continue;
    if (const auto* data = std::get_if<ulog::Data>(&message)) read_data(*reader, *data, log);
    if (const auto* value = std::get_if<ulog::KeyValue>(&message)) read_value(*value, log);
    if (std::holds_alternative<ulog::Dropout>(message)) ++log.dropouts;
  }
  const ulog::Damage& damage = reader->damage();
  for (const auto& finding : damage.first) {
    log.damage.push_back(fmt::format("byte {}: {}", finding.offset, finding.message));
  }
  if (damage.total() > damage.first.size()) {
    log.damage.push_back(fmt::format("and {} more", damage.total() - damage.first.size()));
  }
  return log;
}

Result<void> check_topics(const std::filesystem::path& path, Contents& log) {
  if (log.inputs(control_state).size() == 0) {
    const bool is_newer = log.other_topics.contains("vehicle_angular_velocity") ||
                          log.other_topics.contains("vehicle_attitude");
    return fail_at(
        path.string(),
        fmt::format(
            "no sample of the topic control_state, which the controller of PX4 v1.5.5 and "
            "v1.3.4 reads{}",
            is_newer ? "; is the log of another version of PX4, or without this topic?" : ""));
  }
  if (log.inputs("vehicle_attitude_setpoint").size() == 0) {
    return fail_at(path.string(), "no sample of the topic vehicle_attitude_setpoint");
  }
  const bool has_outputs =
      std::any_of(log.series.begin(), log.series.end(), [](const LogSeries& series) {
        return series.is_output() && series.size() > 0 && !series.logged_channels().empty();
      });
  if (!has_outputs) {
    return fail_at(path.string(),
                   "no sample of vehicle_rates_setpoint or actuator_controls_0, so "
                   "there is nothing to compare a port with");
  }
  for (const char* topic : {"control_state", "vehicle_attitude_setpoint"}) {
    for (const std::string& missing : log.inputs(topic).missing_fields()) {
      if (missing == "landing_gear" || missing == "disable_mc_yaw_control") continue;
      return fail_at(path.string(), fmt::format("the topic {} has no field {}; is the log of "
                                                "another version of PX4?",
                                                topic, missing));
    }
  }
  return {};
}

// In a log of attest, a topic without samples was not published.
Result<std::vector<FlightAssumption>> chosen(const std::vector<std::string>& words,
                                             bool is_of_attest) {
  std::vector<FlightAssumption> all;
  std::vector<std::string> names;
  for (const FlightAssumption& one : assumptions) names.emplace_back(one.word);
  for (const std::string& word : words) {
    const auto known = std::find(names.begin(), names.end(), word);
    if (known == names.end()) {
      return fail(fmt::format("--assume {}: unknown{}; write some of {}", word,
                              suggestion(word, names), fmt::join(names, ", ")));
    }
    all.push_back(assumptions[known - names.begin()]);
  }
  if (words.empty() && !is_of_attest) {
    std::copy_if(std::begin(assumptions), std::end(assumptions), std::back_inserter(all),
                 [](const FlightAssumption& one) { return one.by_default; });
  }
  return all;
}

std::string_view topic_of(std::string_view channel) {
  channel.remove_prefix(channel.find('/') + 1);
  return channel.substr(0, channel.find('.'));
}

std::uint32_t updated_bit(std::string_view topic) {
  const auto index = find_channel(Module::mc_att_control, fmt::format("in/updated.{}", topic));
  return index ? channels()[*index].bit : 0;
}

// The sample before the first tick, with `updated` set for the topics that were assumed.
Result<Sample> assumed_sample(const std::filesystem::path& path,
                              const std::vector<std::string>& words, Contents& log,
                              std::vector<std::string>& notes) {
  const auto all = chosen(words, log.system == system_of_attest);
  if (!all) return tl::unexpected(all.error());
  Sample sample{};
  std::vector<std::string_view> used;
  for (const FlightAssumption& one : *all) {
    const std::string_view topic = topic_of(one.channel);
    if (log.inputs(topic).size() > 0) {
      if (words.empty()) continue;
      return fail_at(path.string(), fmt::format("has the topic {}, so --assume {} has no effect; "
                                                "leave it out",
                                                topic, one.word));
    }
    set_value(channels()[*find_channel(Module::mc_att_control, one.channel)], sample, 1);
    sample.in.updated |= updated_bit(topic);
    used.push_back(one.word);
  }
  if (!used.empty()) {
    notes.push_back(fmt::format("assumed, because the log does not have it: {} (--assume)",
                                fmt::join(used, ", ")));
  }
  return sample;
}

// The ticks with their inputs.
void fill_inputs(Contents& log, Sample sample, Trace& trace) {
  const LogSeries& ticks = log.inputs(control_state);
  for (std::size_t tick = 0; tick < ticks.size(); ++tick) {
    for (LogSeries& series : log.series) {
      if (series.is_output() || series.topic() == control_state) continue;
      if (series.advance_to(ticks.time(tick), sample)) {
        sample.in.updated |= updated_bit(series.topic());
      }
    }
    ticks.copy(tick, sample);
    sample.in.timestamp = ticks.time(tick);
    trace.samples.push_back(sample);
    sample.in.updated = 0;
  }
}

void fill_parameters(std::vector<ParameterChange> changes, Trace& trace) {
  const std::size_t ticks = trace.samples.size();
  std::erase_if(changes, [&](const ParameterChange& change) { return change.tick >= ticks; });
  for (const ParameterChange& change : changes) {
    if (change.tick > 0) {
      trace.samples[change.tick].in.updated |= ATTEST_UPDATED_PARAMETER_UPDATE;
    }
  }
  trace.parameters = std::move(changes);
}

// The tick that the output answers.
std::optional<std::size_t> tick_of(const LogSeries& output, std::size_t row,
                                   const LogSeries& ticks) {
  const auto exact = output.sample_time(row);
  const auto after = ticks.first_after(exact ? *exact : output.time(row));
  if (after == 0) return std::nullopt;
  if (exact && ticks.time(after - 1) != *exact) return std::nullopt;
  return after - 1;
}

// Ticks that do not publish get the values of the tick before, as the ABI has it.
void hold_unpublished(const LogSeries& output, const Channel& published, Trace& trace) {
  for (std::size_t tick = 1; tick < trace.samples.size(); ++tick) {
    Sample& sample = trace.samples[tick];
    if (value_of(published, sample) != 0) continue;
    for (const std::size_t index : output.channels()) {
      const Channel& channel = channels()[index];
      set_value(channel, sample, value_of(channel, trace.samples[tick - 1]));
    }
  }
}

LoggedOutput fill_outputs(const LogSeries& output, const LogSeries& ticks, Trace& trace) {
  LoggedOutput logged{std::string(output.topic()), output.size(), 0};
  const auto published =
      find_channel(Module::mc_att_control, fmt::format("out/{}.published", output.topic()));
  trace.present.set(*published);
  for (const std::size_t channel : output.logged_channels()) trace.present.set(channel);
  for (std::size_t row = 0; row < output.size(); ++row) {
    const auto tick = tick_of(output, row, ticks);
    if (!tick || value_of(channels()[*published], trace.samples[*tick]) != 0) continue;
    output.copy(row, trace.samples[*tick]);
    set_value(channels()[*published], trace.samples[*tick], 1);
    ++logged.paired;
  }
  hold_unpublished(output, channels()[*published], trace);
  return logged;
}

void add_missing(const LogSeries& series, std::vector<std::string>& notes) {
  std::vector<std::string> missing = series.missing_fields();
  if (missing.empty()) return;
  for (std::string& field : missing) field.insert(0, series.topic() + ".");
  notes.push_back(fmt::format("not in the log, so {}: {}",
                              series.is_output() ? "not compared" : "0", fmt::join(missing, ", ")));
}

void add_notes(const Contents& log, std::vector<std::string>& notes) {
  if (!log.system.empty()) {
    notes.push_back(
        fmt::format("logged by {}{}{}", log.system, log.firmware.empty() ? "" : " ", log.firmware));
  }
  for (const LogSeries& series : log.series) {
    if (series.size() > 0) add_missing(series, notes);
    if (series.left_out() > 0) {
      notes.push_back(
          fmt::format("{} samples of {} left out, because their timestamps do not "
                      "increase",
                      series.left_out(), series.topic()));
    }
    if (series.without_time() > 0) {
      notes.push_back(fmt::format("{} samples of {} left out, because the topic has no timestamp",
                                  series.without_time(), series.topic()));
    }
  }
  if (log.dropouts > 0) {
    notes.push_back(fmt::format("the logger lost messages {} times", log.dropouts));
  }
  for (const std::string& damage : log.damage) notes.push_back("damaged: " + damage);
}

}  // namespace

std::span<const FlightAssumption> flight_assumptions() { return assumptions; }

bool is_log(const std::filesystem::path& path) {
  return path.extension() == ".ulg" || path.extension() == ".ulog";
}

Result<FlightLog> read_flight_log(const std::filesystem::path& path,
                                  const std::vector<std::string>& assumed) {
  auto log = contents_of(path);
  if (!log) return tl::unexpected(log.error());
  if (auto checked = check_topics(path, *log); !checked) return tl::unexpected(checked.error());
  FlightLog flight;
  flight.is_of_attest = log->system == system_of_attest;
  flight.profile = log->source.substr(0, std::min(log->source.find('/'), log->source.size()));
  add_notes(*log, flight.notes);
  const auto first = assumed_sample(path, assumed, *log, flight.notes);
  if (!first) return tl::unexpected(first.error());
  flight.trace.source = path.string();
  flight.trace.present = channels_of(Module::mc_att_control, "in/");
  flight.trace.present.set(0);  // timestamp
  fill_inputs(*log, *first, flight.trace);
  fill_parameters(std::move(log->parameters), flight.trace);
  flight.has_every_step = log->dropouts == 0 && log->damage.empty();
  for (const LogSeries& series : log->series) {
    if (series.left_out() + series.without_time() > 0) flight.has_every_step = false;
    if (!series.is_output() || series.size() == 0 || series.logged_channels().empty()) continue;
    flight.outputs.push_back(fill_outputs(series, log->inputs(control_state), flight.trace));
    if (flight.outputs.back().paired < series.size()) flight.has_every_step = false;
  }
  return flight;
}

}  // namespace attest
