#include "harness/ulog/assumptions.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/core/suggestion.hpp"

namespace attest {
namespace {

// A table of attitude_unit and rate_unit has the setpoints come from outside, as in a mission: then
// they do not depend on earlier steps.
constexpr FlightAssumption assumptions[] = {
#define MODULE mc_att_control
#define ROW(word, channel, value, by_default) \
  { word, Module::MODULE, "in/" channel, value, by_default }
    ROW("armed", "actuator_armed.armed", 1, true),
    ROW("rotary_wing", "vehicle_status.is_rotary_wing", 1, true),
    ROW("vtol", "vehicle_status.is_vtol", 1, false),
    ROW("rates", "vehicle_control_mode.flag_control_rates_enabled", 1, true),
    ROW("attitude", "vehicle_control_mode.flag_control_attitude_enabled", 1, true),
    ROW("manual", "vehicle_control_mode.flag_control_manual_enabled", 1, true),
    ROW("auto", "vehicle_control_mode.flag_control_auto_enabled", 1, false),
    ROW("rattitude", "vehicle_control_mode.flag_control_rattitude_enabled", 1, false),
    ROW("velocity", "vehicle_control_mode.flag_control_velocity_enabled", 1, false),
#undef MODULE
#define MODULE attitude_unit
    ROW("armed", "vehicle_status.armed", 1, true),
    ROW("rotary_wing", "vehicle_status.is_rotary_wing", 1, true),
    ROW("vtol", "vehicle_status.is_vtol", 1, false),
    ROW("attitude", "vehicle_control_mode.flag_control_attitude_enabled", 1, true),
    ROW("manual", "vehicle_control_mode.flag_control_manual_enabled", 1, false),
    ROW("altitude", "vehicle_control_mode.flag_control_altitude_enabled", 1, false),
    ROW("velocity", "vehicle_control_mode.flag_control_velocity_enabled", 1, false),
    ROW("position", "vehicle_control_mode.flag_control_position_enabled", 1, false),
    ROW("flying", "vehicle_land_detected.landed", 0, true),
#undef MODULE
#define MODULE rate_unit
    ROW("armed", "vehicle_control_mode.flag_armed", 1, true),
    ROW("rotary_wing", "vehicle_status.is_rotary_wing", 1, true),
    ROW("rates", "vehicle_control_mode.flag_control_rates_enabled", 1, true),
    ROW("attitude", "vehicle_control_mode.flag_control_attitude_enabled", 1, true),
    ROW("manual", "vehicle_control_mode.flag_control_manual_enabled", 1, false),
    ROW("flying", "vehicle_land_detected.landed", 0, true),
#undef MODULE
#undef ROW
};

void add_once(std::string_view word, std::vector<std::string>& words) {
  if (std::find(words.begin(), words.end(), word) == words.end()) words.emplace_back(word);
}

std::string_view topic_of(std::string_view channel) {
  channel.remove_prefix(channel.find('/') + 1);
  return channel.substr(0, channel.find('.'));
}

bool has(const std::vector<std::string>& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

bool is_logged(const FlightAssumption& one, const ulog::ModuleContents& log) {
  return log.input(topic_of(one.channel))->size() > 0;
}

std::uint32_t updated_bit(Module module, std::string_view topic) {
  return channels()[*find_channel(module, fmt::format("in/updated.{}", topic))].bit;
}

}  // namespace

std::span<const FlightAssumption> flight_assumptions() { return assumptions; }

std::vector<std::string> assumption_words() {
  std::vector<std::string> words;
  for (const FlightAssumption& one : assumptions) add_once(one.word, words);
  return words;
}

std::vector<std::string> assumption_words(Module module, bool by_default) {
  std::vector<std::string> words;
  for (const FlightAssumption& one : assumptions) {
    if (one.module == module && (one.by_default || !by_default)) add_once(one.word, words);
  }
  return words;
}

std::vector<std::string> assume(const std::vector<std::string>& words,
                                const ulog::ModuleContents& log, Sample& sample) {
  std::vector<std::string> used;
  for (const FlightAssumption& one : assumptions) {
    const bool holds = words.empty() ? one.by_default : has(words, one.word);
    if (one.module != log.module() || !holds || is_logged(one, log)) continue;
    set_value(channels()[*find_channel(one.module, one.channel)], sample, one.value);
    sample.in.updated |= updated_bit(one.module, topic_of(one.channel));
    add_once(one.word, used);
  }
  return used;
}

Result<void> check_assumed(const std::vector<std::string>& words,
                           std::span<const ulog::ModuleContents* const> modules) {
  std::vector<std::string> known;
  for (const ulog::ModuleContents* log : modules) {
    for (const std::string& word : assumption_words(log->module(), false)) add_once(word, known);
  }
  for (const std::string& word : words) {
    if (!has(known, word)) {
      return fail(fmt::format("--assume {}: unknown{}; write some of {}", word,
                              suggestion(word, known), fmt::join(known, ", ")));
    }
    std::string_view logged;
    bool has_effect = false;
    for (const ulog::ModuleContents* log : modules) {
      for (const FlightAssumption& one : assumptions) {
        if (one.module != log->module() || one.word != word) continue;
        if (is_logged(one, *log)) logged = topic_of(one.channel);
        has_effect = has_effect || !is_logged(one, *log);
      }
    }
    if (has_effect) continue;
    return fail(
        fmt::format("has the topic {}, so --assume {} has no effect; leave it out", logged, word));
  }
  return {};
}

}  // namespace attest
