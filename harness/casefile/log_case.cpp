#include "harness/casefile/log_case.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/casefile/baseline.hpp"
#include "harness/casefile/parse.hpp"
#include "harness/casefile/parse_limits.hpp"
#include "harness/core/agreement.hpp"
#include "harness/core/rate.hpp"
#include "harness/core/toml.hpp"
#include "harness/port/profiles.hpp"

namespace attest {
namespace {

constexpr double us_per_s = 1e6;

double seconds(std::uint64_t time_us) { return static_cast<double>(time_us) / us_per_s; }

// Ticks [begin, end) of a log or, if it has a rate, of a trace whose ticks are at multiples of the
// period.
struct Ticks {
  const Trace& log;
  std::size_t begin = 0, end = 0;
  Module module = Module::mc_att_control;
  std::optional<Rate> rate = {};

  std::size_t size() const { return end - begin; }
  const Sample& operator[](std::size_t tick) const { return log.samples[tick]; }
  // Since the tick `begin`.
  std::uint64_t time_us(std::size_t tick) const {
    return log.samples[tick].in.timestamp - log.samples[begin].in.timestamp;
  }
  double time_s(std::size_t tick) const { return seconds(time_us(tick)); }
  // In periods, or without a rate in seconds. A key of the time ends with unit().
  double time(std::size_t tick) const {
    return rate ? static_cast<double>(period(tick)) : time_s(tick);
  }
  const char* unit() const { return rate ? "ticks" : "s"; }
  // The period whose begin, in whole microseconds, is the time of the tick. REQUIRES: a rate.
  std::int64_t period(std::size_t tick) const {
    const auto time = static_cast<std::int64_t>(time_us(tick));
    const Nanoseconds next{(time + 1) * 1000};  // the first nanosecond after this microsecond
    return rate->ticks_in(next) - 1;
  }
  // The time from the first tick to the last, plus one mean period. REQUIRES: two ticks.
  std::uint64_t duration_us() const {
    const std::uint64_t whole = time_us(end - 1);
    return whole + (whole + size() - 2) / (size() - 1);
  }
};

// The values of a field or a parameter over time. Repeated values are left out.
class History {
 public:
  void add(double time, double value) {
    if (!values_.empty() && same_bits(values_.back(), value)) return;
    times_.push_back(time);
    values_.push_back(value);
  }

  bool is_constant() const { return values_.size() == 1; }
  bool is_always(double value) const { return is_constant() && same_bits(values_.front(), value); }

  // `unit`: Ticks::unit().
  void write(std::string_view table, std::string_view key, const std::string& unit,
             TomlWriter& toml) const {
    if (is_constant()) return toml.set(table, key, values_.front());
    toml.set(table, key, "signal", "samples");
    toml.set(table, key, "times_" + unit, times_);
    toml.set(table, key, "values", values_);
  }

 private:
  std::vector<double> times_;
  std::vector<double> values_;
};

// The ticks at which the topic was new; also the first tick, if the topic was new before it.
std::vector<std::size_t> releases(const Ticks& ticks, std::uint32_t bit) {
  const auto is_new = [&](const Sample& sample) { return (sample.in.updated & bit) != 0; };
  const auto first = ticks.log.samples.begin();
  std::vector<std::size_t> found;
  if (std::any_of(first, first + static_cast<std::ptrdiff_t>(ticks.begin), is_new)) {
    found.push_back(ticks.begin);
  }
  for (std::size_t tick = ticks.begin; tick < ticks.end; ++tick) {
    if (is_new(ticks[tick]) && (found.empty() || found.back() < tick)) found.push_back(tick);
  }
  return found;
}

std::vector<std::size_t> all_of(const Ticks& ticks) {
  std::vector<std::size_t> all(ticks.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = ticks.begin + i;
  return all;
}

double seconds_from(std::uint64_t from_us, std::uint64_t time_us) {
  return static_cast<double>(static_cast<std::int64_t>(time_us - from_us)) / us_per_s;
}

// The number with the fewest digits that becomes the same float.
double short_decimal(double value) {
  return std::isfinite(value) ? std::stod(fmt::format("{}", static_cast<float>(value))) : value;
}

// The value of a field as the case has it: times since the tick that received the sample,
// armed_time since the first tick (SCHEMA.md). The reset counter of a log counts from the first
// tick on, because the unit that starts there knows of no earlier reset.
double case_value(const Ticks& ticks, std::size_t tick, const Channel& channel) {
  const Sample& sample = ticks[tick];
  if (channel.type == ChannelType::u64) {
    const bool of_start = channel.name.ends_with(".armed_time");
    return seconds_from(ticks[of_start ? ticks.begin : tick].in.timestamp,
                        integer_of(channel, sample));
  }
  double value = value_of(channel, sample);
  if (ticks.rate && channel.type == ChannelType::f32) value = short_decimal(value);
  if (ticks.rate || !channel.name.ends_with(".quat_reset_counter")) return value;
  const auto since_begin = static_cast<int>(value - value_of(channel, ticks[ticks.begin]));
  return static_cast<std::uint8_t>(since_begin);  // modulo 256, as the counter
}

// Writes the fields of a topic; with a rate, without those that have the baseline. Returns whether
// each field is constant.
bool write_fields(const Ticks& ticks, std::string_view topic,
                  const std::vector<std::size_t>& released, TomlWriter& toml) {
  bool is_constant = true;
  const ChannelSet fields = channels_of(ticks.module, fmt::format("in/{}.", topic));
  for (std::size_t i = 0; i < channels().size(); ++i) {
    const Channel& channel = channels()[i];
    if (!fields[i] || channel.is_output()) continue;
    History history;
    for (const std::size_t tick : released) {
      history.add(ticks.time(tick), case_value(ticks, tick, channel));
    }
    const double plain =
        channel.type == ChannelType::f32 ? short_decimal(baseline(channel)) : baseline(channel);
    // The table of a battery makes the case one of a battery estimate.
    const bool may_be_left_out = ticks.rate && ticks.module != Module::battery_status;
    const bool is_left_out = may_be_left_out && history.is_always(plain);
    if (!is_left_out) history.write(topic, channel.field(), ticks.unit(), toml);
    is_constant = is_constant && history.is_constant();
  }
  return is_constant;
}

void write_topic(const Ticks& ticks, std::string_view topic, std::uint32_t bit, TomlWriter& toml) {
  const std::vector<std::size_t> released = releases(ticks, bit);
  if (released.empty()) return toml.set(topic, "publish", "never");
  const bool is_constant = write_fields(ticks, topic, released, toml);
  if (is_constant && released == std::vector{ticks.begin}) return;
  std::vector<double> times;
  for (const std::size_t tick : released) times.push_back(ticks.time(tick));
  toml.set(topic, fmt::format("publish_at_{}", ticks.unit()), times);
}

// Of a module whose topics are all new at every tick.
void write_topics_without_bits(const Ticks& ticks, TomlWriter& toml) {
  std::set<std::string_view> topics;
  const ChannelSet inputs = channels_of(ticks.module, "in/");
  for (std::size_t i = 0; i < channels().size(); ++i)
    if (inputs[i]) topics.insert(channels()[i].topic());
  for (const std::string_view topic : topics) write_fields(ticks, topic, all_of(ticks), toml);
}

void write_topics(const Ticks& ticks, TomlWriter& toml) {
  if (!info_of(ticks.module).is_unit()) return write_topics_without_bits(ticks, toml);
  write_fields(ticks, info_of(ticks.module).step_topic, all_of(ticks), toml);
  for (const std::string_view topic : updated_topics(ticks.module)) {
    if (topic == "parameter_update") continue;
    write_topic(ticks, topic, channels()[updated_channel(ticks.module, topic)].bit, toml);
  }
}

// If attest does not know the profile: the default of attest's first profile.
std::optional<float> default_of_parameter(Module module, const std::string& profile,
                                          std::string_view name) {
  const auto* const known = find_profile(profile);
  for (const Parameter& parameter :
       parameters_of(module, known != nullptr ? *known : known_profiles().front())) {
    if (parameter.name == name) return parameter.default_value;
  }
  return std::nullopt;
}

// Before its first change in the log, a parameter has its default.
void write_parameters(const Ticks& ticks, const std::string& profile, TomlWriter& toml) {
  const auto own = parameter_names(ticks.module, profile);
  std::map<std::string, float> at_begin;
  std::map<std::string, History> histories;
  for (const ParameterChange& change : ticks.log.parameters) {
    if (std::find(own.begin(), own.end(), change.name) == own.end()) continue;
    if (change.tick <= ticks.begin) at_begin[change.name] = change.value;
  }
  for (const auto& [name, value] : at_begin) histories[name].add(0, value);
  for (const ParameterChange& change : ticks.log.parameters) {
    if (change.tick <= ticks.begin || change.tick >= ticks.end) continue;
    const auto before = default_of_parameter(ticks.module, profile, change.name);
    if (!before || std::find(own.begin(), own.end(), change.name) == own.end()) continue;
    const auto [history, is_first] = histories.try_emplace(change.name);
    if (is_first) history->second.add(0, *before);
    history->second.add(ticks.time(change.tick), change.value);
  }
  for (const auto& [key, values] : histories) values.write("parameters", key, ticks.unit(), toml);
}

std::string identifier(std::string text) {
  for (char& c : text) {
    const bool is_kept = std::isalnum(static_cast<unsigned char>(c)) != 0;
    c = is_kept ? c : '_';
  }
  return text.empty() ? "log" : text;
}

std::string case_name(const Trace& log, const LogPart& part) {
  std::string name = std::filesystem::path(log.source).stem().string();
  if (part.from_s > 0) name += fmt::format("_from_{}s", part.from_s);
  if (std::isfinite(part.to_s)) name += fmt::format("_to_{}s", part.to_s);
  // A log of the cascade becomes one case for each unit, so the name has the unit.
  const Module module = module_of(log.present);
  if (info_of(module).is_of_cascade()) name += fmt::format("_{}", name_of(module));
  return identifier(name);
}

Result<Ticks> ticks_of(const Trace& log, const LogPart& part) {
  const Module module = module_of(log.present);
  const std::string topic(info_of(module).step_topic);
  const Ticks whole{log, 0, log.samples.size(), module};
  if (whole.size() < 2) return fail_at(log.source, "has fewer than 2 samples of " + topic);
  const double length_s = seconds(whole.duration_us());
  if (!(part.from_s < part.to_s)) {
    return fail(fmt::format("the part from {} s to {} s is empty: it must begin before it ends",
                            part.from_s, part.to_s));
  }
  const bool is_beyond = std::isfinite(part.to_s) && part.to_s > length_s;
  if (part.from_s < 0 || part.from_s >= length_s || is_beyond) {
    return fail_at(log.source, fmt::format("the part is beyond the log, whose samples of {} "
                                           "are from 0 to {:.6g} s",
                                           topic, length_s));
  }
  const auto before = [&](double time_s) {
    const auto first =
        std::partition_point(log.samples.begin(), log.samples.end(), [&](const Sample& sample) {
          return seconds(sample.in.timestamp - log.samples.front().in.timestamp) < time_s;
        });
    return static_cast<std::size_t>(first - log.samples.begin());
  };
  const Ticks ticks{log, before(part.from_s), before(part.to_s), module};
  if (ticks.size() >= 2) return ticks;
  return fail_at(log.source, fmt::format("has {} samples of {} in this part; a case "
                                         "needs at least 2",
                                         ticks.size(), topic));
}

Result<void> check_length(const Ticks& ticks) {
  const Rate fastest = standard_rates().back();
  const double longest_s = static_cast<double>(max_ticks) * fastest.period_s();
  const double duration_s = seconds(ticks.duration_us());
  if (duration_s <= longest_s) return {};
  return fail_at(ticks.log.source,
                 fmt::format("the part of {:.6g} s is more than {} ticks at {} Hz; choose at "
                             "most {:g} s (--from, --to)",
                             duration_s, max_ticks, fastest.to_string(), longest_s));
}

std::string reason(const Ticks& ticks, const std::vector<std::string>& notes) {
  const std::uint64_t first = ticks.log.samples.front().in.timestamp;
  std::string text = fmt::format(
      "What the {} received in the flight {}, from {} s to {} s after the first {} of its log.",
      info_of(ticks.module).title, std::filesystem::path(ticks.log.source).filename().string(),
      seconds(ticks[ticks.begin].in.timestamp - first),
      seconds(ticks[ticks.begin].in.timestamp - first + ticks.duration_us()),
      info_of(ticks.module).step_topic);
  for (const std::string& note : notes) text += fmt::format("\n- {}", note);
  return text;
}

}  // namespace

Result<LogCase> case_of_log(const Trace& log, const std::string& profile, const LogPart& part,
                            const std::vector<std::string>& notes) {
  const auto ticks = ticks_of(log, part);
  if (!ticks) return tl::unexpected(ticks.error());
  if (auto checked = check_length(*ticks); !checked) return tl::unexpected(checked.error());
  LogCase made{case_name(log, part), "", std::string(info_of(ticks->module).step_topic),
               ticks->size(), seconds(ticks->duration_us())};
  TomlWriter toml;
  toml.set("", "schema", schema_version);
  toml.set("", "profiles", std::vector<std::string>{profile});
  toml.set("", "group", log_case_group);
  if (info_of(ticks->module).is_of_cascade()) toml.set("", "module", name_of(ticks->module));
  toml.set("", "why", reason(*ticks, notes));
  toml.set("", "duration_s", made.duration_s);
  toml.set("unit", "start_s", seconds((*ticks)[ticks->begin].in.timestamp));
  write_parameters(*ticks, profile, toml);
  write_topics(*ticks, toml);
  made.toml = toml.to_string();
  return made;
}

namespace {

// The module of the case, and the ticks at which it runs.
void write_ticks(const Ticks& ticks, const TraceCase& about, TomlWriter& toml) {
  const ModuleInfo& info = info_of(ticks.module);
  if (info.is_of_cascade() || info.is_law()) toml.set("", "module", info.name);
  if (ticks.module == Module::mixer) toml.set("mixer", "definition", about.mixer);
  toml.set("", "rates_hz", std::vector<double>{about.rate.hertz()});
  toml.set("", "rates_why", about.rates_why);
  toml.set("", "duration_ticks", ticks.period(ticks.end - 1) + 1);
  if (!info.is_unit()) return;
  toml.set("unit", "start_s", seconds(ticks[ticks.begin].in.timestamp));
  std::vector<std::int64_t> dropped;
  std::int64_t next = 0;  // period
  for (std::size_t tick = ticks.begin; tick < ticks.end; ++tick, ++next) {
    for (; next < ticks.period(tick); ++next) dropped.push_back(next);
  }
  if (!dropped.empty()) toml.set("unit", "drop_ticks", dropped);
}

}  // namespace

std::string case_of_trace(const Trace& trace, const TraceCase& about) {
  const Ticks ticks{trace, 0, trace.samples.size(), module_of(trace.present), about.rate};
  TomlWriter toml;
  toml.set("", "schema", schema_version);
  toml.set("", "profiles", std::vector<std::string>{about.profile});
  toml.set("", "group", about.group);
  toml.set("", "why", about.why);
  if (about.exact_only) toml.set("", "level", "exact");
  write_ticks(ticks, about, toml);
  write_parameters(ticks, about.profile, toml);
  write_topics(ticks, toml);
  return toml.to_string();
}

}  // namespace attest
