#include "harness/ulog/assumptions.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/core/suggestion.hpp"

namespace attest {
namespace {

struct Assumption {
  std::string_view word;  // "armed"
  std::string_view channel;
  double value;
  bool by_default;
};

constexpr Assumption of_controller[] = {
    {"armed", "in/actuator_armed.armed", 1, true},
    {"rotary_wing", "in/vehicle_status.is_rotary_wing", 1, true},
    {"vtol", "in/vehicle_status.is_vtol", 1, false},
    {"rates", "in/vehicle_control_mode.flag_control_rates_enabled", 1, true},
    {"attitude", "in/vehicle_control_mode.flag_control_attitude_enabled", 1, true},
    {"manual", "in/vehicle_control_mode.flag_control_manual_enabled", 1, true},
    {"auto", "in/vehicle_control_mode.flag_control_auto_enabled", 1, false},
    {"rattitude", "in/vehicle_control_mode.flag_control_rattitude_enabled", 1, false},
    {"velocity", "in/vehicle_control_mode.flag_control_velocity_enabled", 1, false},
};

// By default the setpoints of both units come from other modules, as in a mission. Setpoints from
// the sticks would depend on earlier steps.
constexpr Assumption of_attitude_unit[] = {
    {"armed", "in/vehicle_status.armed", 1, true},
    {"rotary_wing", "in/vehicle_status.is_rotary_wing", 1, true},
    {"vtol", "in/vehicle_status.is_vtol", 1, false},
    {"attitude", "in/vehicle_control_mode.flag_control_attitude_enabled", 1, true},
    {"manual", "in/vehicle_control_mode.flag_control_manual_enabled", 1, false},
    {"altitude", "in/vehicle_control_mode.flag_control_altitude_enabled", 1, false},
    {"velocity", "in/vehicle_control_mode.flag_control_velocity_enabled", 1, false},
    {"position", "in/vehicle_control_mode.flag_control_position_enabled", 1, false},
    {"flying", "in/vehicle_land_detected.landed", 0, true},
};

constexpr Assumption of_rate_unit[] = {
    {"armed", "in/vehicle_control_mode.flag_armed", 1, true},
    {"rotary_wing", "in/vehicle_status.is_rotary_wing", 1, true},
    {"rates", "in/vehicle_control_mode.flag_control_rates_enabled", 1, true},
    {"attitude", "in/vehicle_control_mode.flag_control_attitude_enabled", 1, true},
    {"manual", "in/vehicle_control_mode.flag_control_manual_enabled", 1, false},
    {"flying", "in/vehicle_land_detected.landed", 0, true},
};

constexpr struct {
  Module module;
  std::span<const Assumption> rows;
} tables[] = {{Module::mc_att_control, of_controller},
              {Module::attitude_unit, of_attitude_unit},
              {Module::rate_unit, of_rate_unit}};

std::span<const Assumption> assumptions(Module module) {
  for (const auto& table : tables) {
    if (table.module == module) return table.rows;
  }
  return {};
}

void add_once(std::string_view word, std::vector<std::string>& words) {
  if (std::find(words.begin(), words.end(), word) == words.end()) words.emplace_back(word);
}

const Channel& channel_of(const Assumption& one, const ulog::ModuleContents& log) {
  return channels()[*find_channel(log.module(), one.channel)];
}

bool has(const std::vector<std::string>& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

bool is_logged(const Assumption& one, const ulog::ModuleContents& log) {
  return log.input(channel_of(one, log).topic())->size() > 0;
}

}  // namespace

std::vector<std::string> assumption_words() {
  std::vector<std::string> words;
  for (const auto& table : tables) {
    for (const Assumption& one : table.rows) add_once(one.word, words);
  }
  return words;
}

std::vector<std::string> assumption_words(Module module, bool by_default) {
  std::vector<std::string> words;
  for (const Assumption& one : assumptions(module)) {
    if (one.by_default || !by_default) add_once(one.word, words);
  }
  return words;
}

std::vector<std::string> assume(const std::vector<std::string>& words,
                                const ulog::ModuleContents& log, Sample& sample) {
  std::vector<std::string> used;
  for (const Assumption& one : assumptions(log.module())) {
    const bool holds = words.empty() ? one.by_default : has(words, one.word);
    if (!holds || is_logged(one, log)) continue;
    const Channel& channel = channel_of(one, log);
    set_value(channel, sample, one.value);
    sample.in.updated |= channels()[updated_channel(log.module(), channel.topic())].bit;
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
      for (const Assumption& one : assumptions(log->module())) {
        if (one.word != word) continue;
        if (is_logged(one, *log)) logged = channel_of(one, *log).topic();
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
