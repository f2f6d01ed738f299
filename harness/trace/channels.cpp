#include "harness/trace/channels.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <unordered_map>
#include <vector>

#include <fmt/format.h>

#include "harness/core/agreement.hpp"
#include "harness/trace/module_table.hpp"

namespace attest {
namespace {

template <typename T>
void store(Sample& sample, std::size_t offset, T value) {
  std::memcpy(reinterpret_cast<char*>(&sample) + offset, &value, sizeof value);
}

// The first channel, timestamp, belongs to every module.
bool is_of(Module module, std::size_t index) {
  return index == 0 || channel_table[index].module == module;
}

using Places = std::unordered_map<std::string_view, std::size_t>;

// The index of each name of a module. Without it, finding the columns of a file is a third of the
// time to open it.
const Places& places_of(Module module) {
  static const auto places = [] {
    std::array<Places, module_count> all;
    for (const ModuleInfo& info : modules()) {
      for (std::size_t i = 0; i < channel_table.size(); ++i) {
        if (!is_of(info.module, i)) continue;
        all[static_cast<std::size_t>(info.module)].emplace(channel_table[i].name, i);
      }
    }
    return all;
  }();
  return places[static_cast<std::size_t>(module)];
}

}  // namespace

std::string_view Channel::topic() const {
  if (type == ChannelType::bit) return name.substr(name.find('.') + 1);
  const std::size_t begin = name.find('/') + 1;
  return name.substr(begin, name.find('.') - begin);
}

std::string_view Channel::field() const {
  return type == ChannelType::bit ? "updated" : name.substr(name.find('.') + 1);
}

std::span<const Channel> channels() { return channel_table; }

std::optional<std::size_t> find_channel(Module module, std::string_view name) {
  const Places& places = places_of(module);
  const auto found = places.find(name);
  return found == places.end() ? std::nullopt : std::optional(found->second);
}

std::optional<std::string_view> parameter_of(std::string_view column) {
  if (!column.starts_with(parameter_prefix)) return std::nullopt;
  column.remove_prefix(parameter_prefix.size());
  if (column.empty()) return std::nullopt;
  return column;
}

ChannelSet channels_of(Module module, std::string_view prefix) {
  ChannelSet set;
  for (std::size_t i = 0; i < channel_table.size(); ++i) {
    set[i] = is_of(module, i) && channel_table[i].name.starts_with(prefix);
  }
  return set;
}

Module module_of(const ChannelSet& channels) {
  for (std::size_t i = 1; i < channel_table.size(); ++i) {
    if (channels[i]) return channel_table[i].module;
  }
  return Module::mc_att_control;
}

std::vector<std::size_t> outputs_by_stage(const ChannelSet& set) {
  std::vector<std::size_t> outputs;
  for (std::size_t i = 0; i < channel_table.size(); ++i) {
    if (set[i] && channel_table[i].is_output()) outputs.push_back(i);
  }
  std::stable_sort(outputs.begin(), outputs.end(), [](std::size_t a, std::size_t b) {
    return channel_table[a].stage < channel_table[b].stage;
  });
  return outputs;
}

ChannelSet channels_named(std::string_view name) {
  ChannelSet set;
  for (std::size_t i = 0; i < channel_table.size(); ++i) set[i] = channel_table[i].name == name;
  return set;
}

std::vector<std::string_view> names_of(const ChannelSet& set) {
  std::vector<std::string_view> names;
  for (std::size_t i = 0; i < channel_table.size(); ++i) {
    if (!set[i]) continue;
    const auto known = std::find(names.begin(), names.end(), channel_table[i].name);
    if (known == names.end()) names.push_back(channel_table[i].name);
  }
  return names;
}

Module module_with(std::span<const std::string> names) {
  Module best = Module::mc_att_control;
  std::size_t most = 0;
  for (const ModuleInfo& info : modules()) {
    const auto known = static_cast<std::size_t>(std::count_if(
        names.begin(), names.end(),
        [&](const std::string& name) { return find_channel(info.module, name).has_value(); }));
    if (known <= most) continue;
    most = known;
    best = info.module;
  }
  return best;
}

std::size_t updated_channel(Module module, std::string_view topic) {
  return *find_channel(module, fmt::format("in/updated.{}", topic));
}

std::vector<std::string_view> updated_topics(Module module) {
  std::vector<std::string_view> topics;
  for (const Channel& channel : channel_table) {
    if (channel.module != module || channel.type != ChannelType::bit) continue;
    topics.push_back(channel.topic());
  }
  return topics;
}

std::string_view unit_of(Quantity quantity) {
  switch (quantity) {
    case Quantity::time:
      return "us";
    case Quantity::duration:
      return "s";
    case Quantity::angle:
      return "rad";
    case Quantity::rate:
      return "rad/s";
    case Quantity::angular_acceleration:
      return "rad/s^2";
    case Quantity::voltage:
      return "V";
    case Quantity::current:
      return "A";
    default:
      return "";
  }
}

std::string_view name_of(Stage stage) { return stage_names[static_cast<std::size_t>(stage)]; }

std::optional<Stage> stage_named(std::string_view name) {
  for (std::size_t i = 0; i < stage_count; ++i) {
    if (name_of(static_cast<Stage>(i)) == name) return static_cast<Stage>(i);
  }
  return std::nullopt;
}

std::vector<std::string_view> names_of(const StageSet& stages) {
  std::vector<std::string_view> names;
  for (std::size_t i = 0; i < stage_count; ++i) {
    if (stages[i]) names.push_back(name_of(static_cast<Stage>(i)));
  }
  return names;
}

void set_value(const Channel& channel, Sample& sample, double value) {
  switch (channel.type) {
    case ChannelType::u64:
      return store(sample, channel.offset, static_cast<std::uint64_t>(value));
    case ChannelType::f32:
      return store(sample, channel.offset, static_cast<float>(value));
    case ChannelType::u8:
      return store(sample, channel.offset, static_cast<std::uint8_t>(value));
    case ChannelType::bit: {
      const auto word = value_at<std::uint32_t>(sample, channel.offset);
      const std::uint32_t cleared = word & ~channel.bit;
      return store(sample, channel.offset, value != 0 ? cleared | channel.bit : cleared);
    }
  }
}

void set_integer(const Channel& channel, Sample& sample, std::uint64_t value) {
  if (channel.type == ChannelType::u64) return store(sample, channel.offset, value);
  store(sample, channel.offset, static_cast<std::uint8_t>(value));
}

void copy_value(const Channel& channel, const Sample& from, Sample& to) {
  if (channel.type == ChannelType::u64) return set_integer(channel, to, integer_of(channel, from));
  set_value(channel, to, value_of(channel, from));
}

float float_of(const Channel& channel, const Sample& sample) {
  return value_at<float>(sample, channel.offset);
}

bool same_bits(const Channel& channel, const Sample& a, const Sample& b) {
  if (channel.type == ChannelType::f32) {
    return same_bits(float_of(channel, a), float_of(channel, b));
  }
  if (channel.type == ChannelType::u64) return integer_of(channel, a) == integer_of(channel, b);
  return value_of(channel, a) == value_of(channel, b);
}

std::uint64_t integer_of(const Channel& channel, const Sample& sample) {
  return value_at<std::uint64_t>(sample, channel.offset);
}

}  // namespace attest
