#include "harness/diagnosis/hunt_inputs.hpp"

#include <algorithm>
#include <array>
#include <cstring>

namespace attest {
namespace {

std::size_t size_of(ChannelType type) {
  return type == ChannelType::u64   ? sizeof(std::uint64_t)
         : type == ChannelType::f32 ? sizeof(float)
                                    : sizeof(std::uint8_t);
}

void add(const Channel& channel, std::vector<HuntTopic>& topics) {
  const auto same = [&](const HuntTopic& topic) { return topic.name == channel.topic(); };
  auto found = std::ranges::find_if(topics, same);
  if (found == topics.end()) {
    topics.push_back({channel.topic(), 0, channel.offset, 0, {}, {}});
    found = topics.end() - 1;
  }
  const std::size_t end =
      std::max(found->begin + found->size, channel.offset + size_of(channel.type));
  found->begin = std::min(found->begin, channel.offset);
  found->size = end - found->begin;
  found->fields.push_back(&channel);
  if (channel.type == ChannelType::u64) found->times.push_back(&channel);
}

std::vector<HuntTopic> topics_of(Module module) {
  std::vector<HuntTopic> topics;
  const ChannelSet inputs = channels_of(module, "in/");
  for (std::size_t i = 0; i < channels().size(); ++i) {
    if (inputs[i] && channels()[i].type != ChannelType::bit) add(channels()[i], topics);
  }
  for (HuntTopic& topic : topics) {
    for (const std::string_view with_bit : updated_topics(module)) {
      if (with_bit == topic.name) topic.bit = channels()[updated_channel(module, with_bit)].bit;
    }
  }
  return topics;
}

}  // namespace

std::size_t HuntInputs::steps() const {
  std::size_t steps = 0;
  for (const HuntTick& tick : ticks) steps += 1 + tick.quiet;
  return steps;
}

void HuntTopic::copy(const Sample& from, Sample& to) const {
  std::memcpy(reinterpret_cast<std::byte*>(&to) + begin,
              reinterpret_cast<const std::byte*>(&from) + begin, size);
}

bool HuntTopic::has_same(const Sample& one, const Sample& other) const {
  return std::memcmp(reinterpret_cast<const std::byte*>(&one) + begin,
                     reinterpret_cast<const std::byte*>(&other) + begin, size) == 0;
}

bool contains(std::span<const ModuleUnderTest> subjects, const std::string& profile,
              Module module) {
  return std::ranges::any_of(subjects, [&](const ModuleUnderTest& subject) {
    return subject.profile == profile && subject.module == module;
  });
}

std::span<const HuntTopic> hunt_topics(Module module) {
  static const auto all = [] {
    std::array<std::vector<HuntTopic>, module_count> made;
    for (const ModuleInfo& info : modules()) {
      made[static_cast<std::size_t>(info.module)] = topics_of(info.module);
    }
    return made;
  }();
  return all[static_cast<std::size_t>(module)];
}

std::uint32_t parameter_bit(Module module) {
  static const auto all = [] {  // asked at each tick
    std::array<std::uint32_t, module_count> bits{};
    for (const ModuleInfo& info : modules()) {
      for (const std::string_view topic : updated_topics(info.module)) {
        if (topic != "parameter_update") continue;
        bits[static_cast<std::size_t>(info.module)] =
            channels()[updated_channel(info.module, topic)].bit;
      }
    }
    return bits;
  }();
  return all[static_cast<std::size_t>(module)];
}

bool is_from_first_tick(const Channel& channel) { return channel.field() == "armed_time"; }

std::int64_t relative_us(const Channel& channel, const Sample& sample) {
  return static_cast<std::int64_t>(integer_of(channel, sample));
}

void set_relative_us(const Channel& channel, Sample& sample, std::int64_t time_us) {
  set_integer(channel, sample, static_cast<std::uint64_t>(time_us));
}

}  // namespace attest
