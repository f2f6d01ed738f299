#include "harness/trace/output_topics.hpp"

#include <array>
#include <cstring>
#include <vector>

#include <fmt/format.h>

namespace attest {
namespace {

// The topic whose flag is channel `flag`. In the ABI a topic is a struct that ends with
// `published`.
OutputTopic topic_with_flag(std::size_t flag) {
  const Channel& published = channels()[flag];
  OutputTopic topic{published.topic(), flag, {published.offset, 1}};
  std::size_t begin = published.offset;
  for (const Channel& channel : channels()) {
    const bool is_in_it =
        channel.is_output() && channel.module == published.module && channel.topic() == topic.name;
    if (is_in_it) begin = std::min(begin, channel.offset);
  }
  topic.block = {begin, published.offset + 1 - begin};
  return topic;
}

std::vector<OutputTopic> topics_of(Module module) {
  std::vector<OutputTopic> topics;
  for (std::size_t i = 0; i < channels().size(); ++i) {
    const Channel& channel = channels()[i];
    if (channel.is_published_flag() && channel.module == module)
      topics.push_back(topic_with_flag(i));
  }
  return topics;
}

}  // namespace

std::span<const OutputTopic> output_topics(Module module) {
  static const auto of_modules = [] {
    std::array<std::vector<OutputTopic>, module_count> all;
    for (const ModuleInfo& info : modules()) {
      all[static_cast<std::size_t>(info.module)] = topics_of(info.module);
    }
    return all;
  }();
  return of_modules[static_cast<std::size_t>(module)];
}

std::optional<std::size_t> published_flag(const Channel& output) {
  static const auto flags = [] {
    std::array<std::optional<std::size_t>, max_channels> all;
    for (std::size_t i = 0; i < channels().size(); ++i) {
      const Channel& channel = channels()[i];
      if (!channel.is_output()) continue;
      all[i] = find_channel(channel.module, fmt::format("out/{}.published", channel.topic()));
    }
    return all;
  }();
  return flags[static_cast<std::size_t>(&output - channels().data())];
}

bool is_published(const Channel& output, const Sample& sample) {
  const auto flag = published_flag(output);
  return !flag || value_of(channels()[*flag], sample) != 0;
}

void keep_unpublished(Module module, const Sample& before, Sample& now) {
  for (const OutputTopic& topic : output_topics(module)) {
    if (is_published(channels()[topic.published], now)) continue;
    std::memcpy(topic.block.in(now), topic.block.in(before), topic.block.size);
    set_value(channels()[topic.published], now, 0);
  }
}

void clear_published(Module module, Sample& sample) {
  for (const OutputTopic& topic : output_topics(module)) {
    set_value(channels()[topic.published], sample, 0);
  }
}

}  // namespace attest
