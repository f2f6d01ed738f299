#include "harness/casefile/parse_topic.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "harness/casefile/baseline.hpp"
#include "harness/casefile/flight_mode.hpp"
#include "harness/casefile/parse_signal.hpp"
#include "harness/core/suggestion.hpp"
#include "harness/trace/channels.hpp"

namespace attest {
namespace {

constexpr std::string_view control_mode = "vehicle_control_mode";

constexpr const char* not_a_flag =
    "is a flag: a constant, a step or samples of whole numbers from 0 to 255";

// Flags are bytes: a signal with other values has no meaning for them.
bool is_byte_signal(const Signal& signal) {
  const auto is_byte = [](double v) { return v >= 0 && v <= 255 && v == std::floor(v); };
  if (const auto* constant = std::get_if<Constant>(&signal)) return is_byte(constant->value);
  if (const auto* step = std::get_if<Step>(&signal))
    return is_byte(step->from) && is_byte(step->to);
  if (const auto* samples = std::get_if<Samples>(&signal)) {
    return !samples->linear && std::all_of(samples->values.begin(), samples->values.end(), is_byte);
  }
  return false;
}

void parse_field(const TomlTable& table, const std::string& key, FieldStimulus& field) {
  if (const std::string of_hover = key + "_of_hover"; field.of_hover && table.has(of_hover)) {
    field.signal = parse_signal(table, of_hover);
    if (table.has(key)) table.error(key, fmt::format("`{}` is given too; keep one", of_hover));
    return;
  }
  if (!table.has(key)) return;
  field.of_hover = false;
  field.replacement.reset();
  field.signal = parse_signal(table, key);
  if (channels()[field.channel].type == ChannelType::u8 && !is_byte_signal(field.signal)) {
    table.error(key, not_a_flag);
  }
}

// `q = [w, x, y, z]` or `q = { tilt_deg = ..., ... }`. Single components (`"q[1]"`) are fields like
// any other. `first` is the index of the w component in the topic's fields.
void parse_quaternion(const TomlTable& table, const std::string& key, TopicStimulus& topic,
                      std::size_t first) {
  for (std::size_t i = 0; i < 4; ++i) {
    const std::string component = fmt::format("{}[{}]", key, i);
    if (table.has(key) && table.has(component)) {
      return table.error(component, fmt::format("`{}` is given too; keep one", key));
    }
  }
  switch (table.kind(key)) {
    case TomlKind::absent:
      return;
    case TomlKind::array: {
      const std::vector<double> q = table.numbers(key);
      if (q.size() != 4) return table.error(key, "needs four numbers: [w, x, y, z]");
      for (std::size_t i = 0; i < 4; ++i) topic.fields[first + i].signal = Constant{q[i]};
      return;
    }
    default: {
      topic.attitudes.push_back({topic.fields[first].channel, parse_attitude(table, key)});
      const auto begin = topic.fields.begin() + static_cast<std::ptrdiff_t>(first);
      topic.fields.erase(begin, begin + 4);
    }
  }
}

std::vector<std::string> mode_names(Module module) {
  std::vector<std::string> names;
  for (const FlightMode& mode : flight_modes(module)) names.emplace_back(mode.name);
  return names;
}

std::optional<Signal> parse_in_transition(const TomlTable& table) {
  constexpr const char* key = "in_transition";
  if (!table.has(key)) return std::nullopt;
  Signal signal = parse_signal(table, key);
  if (!is_byte_signal(signal)) table.error(key, not_a_flag);
  return signal;
}

struct ModeSequence {
  std::vector<Span> times;
  std::vector<const FlightMode*> modes;  // each from its time on

  template <typename ValueOf>
  Signal signal_of(const ValueOf& value_of) const {
    if (modes.size() == 1) return Constant{static_cast<double>(value_of(*modes[0]))};
    Samples samples{times, {}, false};
    for (const FlightMode* mode : modes) samples.values.push_back(value_of(*mode));
    return samples;
  }
};

// `"ACRO"`, or `{ times_ticks = [0, 20], modes = ["ACRO", "POSCTL"] }`. Empty after an error.
std::optional<ModeSequence> parse_modes(const TomlTable& table, const char* key, Module module) {
  ModeSequence sequence{{Span{}}, {}};
  std::vector<std::string> names;
  if (table.kind(key) == TomlKind::table) {
    const TomlTable given = table.table(key);
    sequence.times = parse_spans(given, "times");
    names = given.texts("modes");
  } else {
    names = {table.text(key)};
  }
  if (names.size() != sequence.times.size() || names.empty()) {
    table.error(key, "needs one mode a time, at least one");
    return std::nullopt;
  }
  for (const std::string& name : names) {
    sequence.modes.push_back(find_flight_mode(module, name));
    if (sequence.modes.back()) continue;
    table.error(
        key, fmt::format("unknown flight mode `{}`{}", name, suggestion(name, mode_names(module))));
    return std::nullopt;
  }
  return sequence;
}

void parse_flight_mode(const TomlTable& table, Module module, TopicStimulus& topic) {
  constexpr const char* key = "flight_mode";
  if (!table.has(key)) {
    if (table.has("in_transition"))
      table.error("in_transition", "needs a `flight_mode` in the same table");
    return;
  }
  const auto sequence = parse_modes(table, key, module);
  if (!sequence) return;
  const bool has_transition = !info_of(module).is_of_cascade();
  const auto transition = has_transition ? parse_in_transition(table) : std::nullopt;
  const auto& flags = flag_names(module);
  for (FieldStimulus& field : topic.fields) {
    const auto found = std::find(flags.begin(), flags.end(), channels()[field.channel].field());
    if (found == flags.end()) continue;  // flag_armed
    const auto flag = static_cast<std::size_t>(found - flags.begin());
    field.signal = sequence->signal_of([&](const FlightMode& mode) { return mode.flags[flag]; });
    if (!transition) continue;
    field.replacement = {*transition, sequence->signal_of([&](const FlightMode& mode) {
                           return mode.flags_in_transition()[flag];
                         })};
  }
}

void parse_irregularity(const TomlTable& table, Publication& publication) {
  if (const auto delay = parse_optional_span(table, "delay")) publication.delay = *delay;
  publication.jitter = table.number("jitter", 0);
  if (!(publication.jitter >= 0 && publication.jitter < 1)) {
    table.error("jitter", "is a fraction of a period: must be 0 or more, and less than 1");
  }
  publication.seed = static_cast<std::uint64_t>(table.integer("seed", 1));
  if (table.has("drop_samples")) publication.drops = table.integers("drop_samples");
  const bool irregular = publication.jitter > 0 || !publication.drops.empty();
  if (irregular && publication.when != Publication::When::periodic) {
    table.error("", "`jitter` and `drop_samples` need a period or a rate");
  }
}

Publication parse_publication(const TomlTable& table) {
  using When = Publication::When;
  Publication publication;
  const bool at_times = table.has("publish_at_ticks") || table.has("publish_at_s");
  const bool by_period = table.has("period_ticks") || table.has("period_s");
  const bool by_rate = table.has("rate_hz");
  const std::string publish = table.text("publish", "");
  if (at_times + by_period + by_rate + !publish.empty() > 1) {
    table.error("", "give one of `publish`, `publish_at_...`, `period_...` and `rate_hz`");
  }
  if (publish == "never") publication.when = When::never;
  if (publish == "every_tick") publication.when = When::every_tick;
  if (!publish.empty() && publication.when == When::automatic) {
    table.error("publish", "must be \"never\" or \"every_tick\"");
  }
  if (at_times) {
    publication.when = When::at_times;
    publication.times = parse_spans(table, "publish_at");
  }
  if (by_period) {
    publication.when = When::periodic;
    publication.period = parse_span(table, "period");
    const Span& period = publication.period;
    if (!(period.amount >= 1e-6)) table.error(span_key(table, "period"), "must be positive");
    if (period.in == Span::In::ticks && period.amount != std::floor(period.amount)) {
      table.error("period_ticks",
                  "must be a whole number; other periods are `period_s` or `rate_hz`");
    }
  }
  if (by_rate) {
    publication.when = When::periodic;
    const auto rate = Rate::parse(fmt::format("{}", table.number("rate_hz")));
    if (rate) publication.rate = *rate;
    if (!rate) table.error("rate_hz", rate.error().message);
  }
  if (const auto phase = parse_optional_span(table, "phase")) {
    publication.phase = *phase;
    if (publication.when != When::periodic) table.error("", "a phase needs a period or a rate");
  }
  parse_irregularity(table, publication);
  return publication;
}

TopicStimulus baseline_topic(Module module, std::string_view name, std::uint32_t updated_bit,
                             bool is_flight) {
  TopicStimulus topic{std::string(name), updated_bit, {}, {}, {}};
  const auto table = channels();
  for (std::size_t i = 0; i < table.size(); ++i) {
    const bool is_field = table[i].module == module && !table[i].is_output() &&
                          table[i].type != ChannelType::bit && table[i].topic() == name;
    if (!is_field) continue;
    const auto of_hover = is_flight ? baseline_of_hover(table[i]) : std::nullopt;
    const double value =
        of_hover.value_or(is_flight ? baseline_in_flight(table[i]) : baseline(table[i]));
    topic.fields.push_back({i, Constant{value}, of_hover.has_value()});
  }
  return topic;
}

// Of a unit: its step topic, and each topic with an updated bit. Of another module: all its topics.
std::vector<TopicStimulus> baseline_topics(const ModuleInfo& of, bool is_flight) {
  std::vector<TopicStimulus> topics;
  for (const Channel& channel : channels().subspan(1)) {  // 0 is the timestamp
    if (channel.module != of.module || channel.is_output()) continue;
    const bool has_bit = of.is_unit() && channel.topic() != of.step_topic;
    const bool is_bit = channel.type == ChannelType::bit;
    if (has_bit != is_bit || channel.bit == ATTEST_UPDATED_PARAMETER_UPDATE) continue;
    if (!topics.empty() && topics.back().topic == channel.topic()) continue;
    topics.push_back(baseline_topic(of.module, channel.topic(), channel.bit, is_flight));
  }
  return topics;
}

// The keys of the topic's quaternions: "q" of "q[0]".
std::vector<std::string> quaternions_of(const TopicStimulus& topic) {
  std::vector<std::string> keys;
  for (const FieldStimulus& field : topic.fields) {
    const Channel& channel = channels()[field.channel];
    const std::string_view name = channel.field();
    if (channel.quantity != Quantity::quaternion || !name.ends_with("[0]")) continue;
    keys.emplace_back(name.substr(0, name.size() - 3));
  }
  return keys;
}

std::size_t index_of(const std::string& field, const TopicStimulus& topic) {
  const auto found = std::find_if(
      topic.fields.begin(), topic.fields.end(),
      [&](const FieldStimulus& one) { return channels()[one.channel].field() == field; });
  return static_cast<std::size_t>(found - topic.fields.begin());
}

void parse_topic(const TomlTable& table, TopicStimulus& topic) {
  const Module module = channels()[topic.fields.front().channel].module;
  if (topic.topic == control_mode) parse_flight_mode(table, module, topic);
  for (FieldStimulus& field : topic.fields) {
    const std::string name(channels()[field.channel].field());
    parse_field(table, name, field);
  }
  for (const std::string& key : quaternions_of(topic)) {
    parse_quaternion(table, key, topic, index_of(key + "[0]", topic));
  }
  // A topic without an updated bit, such as control_state, is new at every step.
  if (topic.updated_bit != 0) topic.publication = parse_publication(table);
}

// Whether the plant or the actuators compute the topic in a flight.
bool is_computed(const std::string& topic, Module module) {
  return topic == info_of(module).step_topic || topic == "multirotor_motor_limits" ||
         topic == "control_allocator_status";
}

void leave_out_computed(const TomlTable& root, Module module, std::vector<TopicStimulus>& topics) {
  std::erase_if(topics, [&](const TopicStimulus& topic) {
    // The rate unit receives the attitude unit's setpoints and, if the file has this topic, the
    // file's.
    const bool is_own = module == Module::rate_unit && topic.topic == "vehicle_rates_setpoint";
    if (is_own) return !root.has(topic.topic);
    if (!is_computed(topic.topic, module)) return false;
    if (root.has(topic.topic)) {
      root.table(topic.topic);
      root.error(topic.topic, "comes from the plant in a flight; see [flight]");
    }
    return true;
  });
}

}  // namespace

std::vector<TopicStimulus> parse_topics(const TomlTable& root, Module module, bool is_flight) {
  std::vector<TopicStimulus> topics = baseline_topics(info_of(module), is_flight);
  if (is_flight) leave_out_computed(root, module, topics);
  for (TopicStimulus& topic : topics) {
    if (root.has(topic.topic)) parse_topic(root.table(topic.topic), topic);
  }
  return topics;
}

}  // namespace attest
