#include "harness/casefile/parse_signal.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "harness/core/suggestion.hpp"

namespace attest {
namespace {

// Of two alternative keys, the one that is present. They give the same value in different units.
struct Spelled {
  std::string key;
  bool first = true;
};

std::optional<Spelled> spelled(const TomlTable& table, const std::string& first,
                               const std::string& second) {
  const bool has_first = table.has(first);
  const bool has_second = table.has(second);
  if (has_first && has_second) {
    table.error(second, fmt::format("`{}` is given too; keep one of them", first));
  }
  if (!has_first && !has_second) return std::nullopt;
  return Spelled{has_first ? first : second, has_first};
}

// The longest case has 1e6 ticks. At the slowest rate (0.001 Hz) they last 1e9 s. So all times fit
// into 64 bits of nanoseconds.
constexpr double longest_in_ticks = 1e6;
constexpr double longest_in_seconds = 1e9;

Span checked_span(const TomlTable& table, const Spelled& key, double amount) {
  const double limit = key.first ? longest_in_ticks : longest_in_seconds;
  if (!(amount >= 0 && amount <= limit)) {
    table.error(key.key, fmt::format("must be a time from 0 up to {:.0f}", limit));
    amount = amount > limit ? limit : 0;
  }
  return {amount, key.first ? Span::In::ticks : Span::In::seconds};
}

Frequency parse_frequency(const TomlTable& table, const std::string& hertz,
                          const std::string& cycles) {
  const auto found = spelled(table, hertz, cycles);
  if (!found) {
    table.error("", fmt::format("needs `{}` (over the whole case) or `{}`", cycles, hertz));
    return {};
  }
  return {table.number(found->key), found->first ? Frequency::In::hertz : Frequency::In::cycles};
}

Step parse_step(const TomlTable& table) {
  return {table.number("from"), table.number("to"), parse_span(table, "at")};
}

Ramp parse_ramp(const TomlTable& table) {
  const Span start = parse_optional_span(table, "start").value_or(Span{});
  const Ramp ramp{table.number("from"), table.number("to"), start, parse_span(table, "end")};
  if (start.in == ramp.end.in && !(start.amount < ramp.end.amount)) {
    table.error("", "the ramp must end after its start");
  }
  return ramp;
}

Sine parse_sine(const TomlTable& table) {
  return {table.number("mean", 0), table.number("amplitude"), table.number("phase_deg", 0),
          parse_frequency(table, "frequency_hz", "cycles")};
}

Chirp parse_chirp(const TomlTable& table) {
  return {table.number("mean", 0), table.number("amplitude"),
          parse_frequency(table, "from_hz", "from_cycles"),
          parse_frequency(table, "to_hz", "to_cycles")};
}

RandomWalk parse_random_walk(const TomlTable& table) {
  const RandomWalk walk{static_cast<std::uint64_t>(table.integer("seed")),
                        table.number("start", 0),
                        table.number("step"),
                        table.number("min"),
                        table.number("max"),
                        parse_optional_span(table, "every").value_or(Span{1, Span::In::ticks})};
  if (!(walk.min < walk.max)) table.error("max", "must be above `min`");
  if (!(walk.start >= walk.min && walk.start <= walk.max)) {
    table.error("start", "must lie between `min` and `max`");
  }
  if (const std::string key = span_key(table, "every"); !(walk.every.amount >= 1e-6)) {
    table.error(key, "must be at least 1e-6");
  }
  return walk;
}

Samples parse_samples(const TomlTable& table) {
  Samples samples{parse_spans(table, "times"), table.numbers("values"),
                  table.boolean("linear", false)};
  if (samples.times.empty() || samples.times.size() != samples.values.size()) {
    table.error("values", fmt::format("has {} values for {} times; give one value for each time, "
                                      "at least one",
                                      samples.values.size(), samples.times.size()));
    return {{Span{}}, {0}, false};
  }
  return samples;
}

Signal parse_signal_table(const TomlTable& table) {
  const std::string kind = table.text("signal");
  if (kind == "constant") return Constant{table.number("value")};
  if (kind == "step") return parse_step(table);
  if (kind == "ramp") return parse_ramp(table);
  if (kind == "sine") return parse_sine(table);
  if (kind == "chirp") return parse_chirp(table);
  if (kind == "random_walk") return parse_random_walk(table);
  if (kind == "samples") return parse_samples(table);
  static const std::vector<std::string> kinds = {"constant", "step",        "ramp",   "sine",
                                                 "chirp",    "random_walk", "samples"};
  if (!kind.empty()) {
    table.error("signal", fmt::format("unknown signal `{}`{}; the kinds are {}", kind,
                                      suggestion(kind, kinds), fmt::join(kinds, ", ")));
  }
  return Constant{};
}

}  // namespace

std::string span_key(const TomlTable& table, const std::string& stem) {
  for (const char* const unit : {"_ticks", "_s"}) {
    if (table.has(stem + unit)) return stem + unit;
  }
  return "";
}

std::optional<Span> parse_optional_span(const TomlTable& table, const std::string& stem) {
  const auto found = spelled(table, stem + "_ticks", stem + "_s");
  if (!found) return std::nullopt;
  return checked_span(table, *found, table.number(found->key));
}

Span parse_span(const TomlTable& table, const std::string& stem) {
  const auto span = parse_optional_span(table, stem);
  if (!span) {
    table.error("", fmt::format("needs `{0}_ticks` (of the unit's loop) or `{0}_s`", stem));
  }
  return span.value_or(Span{});
}

std::vector<Span> parse_spans(const TomlTable& table, const std::string& stem) {
  const auto found = spelled(table, stem + "_ticks", stem + "_s");
  if (!found) {
    table.error("", fmt::format("needs `{0}_ticks` (of the unit's loop) or `{0}_s`", stem));
    return {};
  }
  std::vector<Span> spans;
  double last = -std::numeric_limits<double>::infinity();
  for (const double amount : table.numbers(found->key)) {
    if (!(amount > last)) {
      table.error(found->key, "must increase");
      break;
    }
    spans.push_back(checked_span(table, *found, amount));
    last = amount;
  }
  return spans;
}

Signal parse_signal(const TomlTable& table, const std::string& key) {
  switch (table.kind(key)) {
    case TomlKind::boolean:
      return Constant{table.boolean(key, false) ? 1.0 : 0.0};
    case TomlKind::table:
      return parse_signal_table(table.table(key));
    default:
      return Constant{table.number(key)};
  }
}

AngleKeys angle_keys(const TomlTable& table) {
  constexpr AngleKeys tilt{Angles::tilt_azimuth_yaw, {"tilt_deg", "azimuth_deg", "yaw_deg"}};
  constexpr AngleKeys euler{Angles::roll_pitch_yaw, {"roll_deg", "pitch_deg", "yaw_deg"}};
  if (!table.has(euler.keys[0]) && !table.has(euler.keys[1])) return tilt;
  for (const std::string other : {tilt.keys[0], tilt.keys[1]}) {
    if (!table.has(other)) continue;
    table.error(
        other, fmt::format("`{}` is given too: an attitude has roll and pitch, or tilt and azimuth",
                           euler.keys[table.has(euler.keys[0]) ? 0 : 1]));
  }
  return euler;
}

AttitudeSignal parse_attitude(const TomlTable& table, const std::string& key) {
  const TomlTable angles = table.table(key);
  const auto [by, keys] = angle_keys(angles);
  AttitudeSignal attitude;
  attitude.by = by;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (angles.has(keys[i])) attitude.angles_deg[i] = parse_signal(angles, keys[i]);
  }
  attitude.sign = angles.number("sign", 1);
  attitude.norm = angles.number("norm", 1);
  if (attitude.sign != 1 && attitude.sign != -1) angles.error("sign", "must be 1 or -1");
  return attitude;
}

}  // namespace attest
