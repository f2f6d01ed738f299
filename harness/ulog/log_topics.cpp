#include "harness/ulog/log_topics.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace attest {
namespace {

constexpr std::string_view publication_time = "timestamp_published";

struct StateOfChannel {
  std::string_view channel;
  LogState state;
};

// Source: the message vehicle_status in the documentation of PX4 v1.14 to v1.16.
constexpr StateOfChannel states[] = {
    {"in/vehicle_status.armed", {"arming_state", 2, 1}},
    {"in/vehicle_status.is_rotary_wing", {"vehicle_type", 1, 0}},
};

std::optional<LogState> state_of(const Channel& channel) {
  if (channel.module == Module::mc_att_control) return std::nullopt;  // has both flags
  const auto* const found =
      std::find_if(std::begin(states), std::end(states),
                   [&](const StateOfChannel& one) { return one.channel == channel.name; });
  return found == std::end(states) ? std::nullopt : std::optional(found->state);
}

// unaided_heading (from the gyros alone) is in the topic from v1.16 on; NaN means that there is no
// such heading.
float if_absent(std::string_view channel) {
  if (channel == "in/vehicle_local_position.unaided_heading") {
    return std::numeric_limits<float>::quiet_NaN();
  }
  return channel == "in/vehicle_local_position.heading_good_for_control" ? 1 : 0;
}

// "vehicle_status" and "armed" of "in/vehicle_status.armed".
std::pair<std::string, std::string> topic_and_field(std::string_view channel) {
  channel.remove_prefix(channel.find('/') + 1);
  const auto dot = channel.find('.');
  return {std::string(channel.substr(0, dot)), std::string(channel.substr(dot + 1))};
}

LogTopic& topic_in(std::vector<LogTopic>& topics, const std::string& name, bool is_output) {
  const auto known = std::find_if(topics.begin(), topics.end(), [&](const LogTopic& one) {
    return one.name == name && one.is_output == is_output;
  });
  return known != topics.end() ? *known : topics.emplace_back(LogTopic{name, is_output});
}

void add(std::size_t index, std::vector<LogTopic>& topics) {
  const Channel& channel = channels()[index];
  auto [topic, field] = topic_and_field(channel.name);
  if (channel.type == ChannelType::bit) {
    topic_in(topics, field, false).is_new = index;
  } else if (channel.is_output() && field == "published") {
    topic_in(topics, topic, true).is_new = index;
  } else {
    if (field == "timestamp") field = publication_time;
    topic_in(topics, topic, channel.is_output())
        .fields.push_back({index, std::move(field), state_of(channel), if_absent(channel.name)});
  }
}

}  // namespace

bool LogField::is_time_of_topic() const {
  return name == publication_time || name == "timestamp_sample";
}

std::vector<LogTopic> log_topics(Module module) {
  std::vector<LogTopic> topics;
  const ChannelSet own = channels_of(module);
  for (std::size_t i = 1; i < channels().size(); ++i) {  // 0 is the timestamp
    if (own[i]) add(i, topics);
  }
  for (LogTopic& topic : topics) {
    const auto is_twin = [&](const LogTopic& other) {
      return other.name == topic.name && other.is_output;
    };
    if (!topic.is_output && std::any_of(topics.begin(), topics.end(), is_twin)) topic.multi_id = 1;
  }
  return topics;
}

std::string step_topic(Module module) {
  const auto topics = log_topics(module);
  return std::find_if(topics.begin(), topics.end(),
                      [](const LogTopic& topic) { return !topic.is_output && !topic.is_new; })
      ->name;
}

}  // namespace attest
