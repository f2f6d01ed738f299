#include "harness/ulog/log_topics.hpp"

#include <algorithm>
#include <limits>

namespace attest {
namespace {

constexpr std::string_view publication_time = "timestamp_published";

struct StateOfChannel {
  std::string_view channel;
  LogState state;
};

// Source: the message vehicle_status in the documentation of PX4 v1.14 to v1.18.
constexpr StateOfChannel states[] = {
    {"in/vehicle_status.armed", {"arming_state", 2, 1}},
    {"in/vehicle_status.is_rotary_wing", {"vehicle_type", 1, 0}},
};

std::optional<LogState> state_of(const Channel& channel) {
  if (!info_of(channel.module).is_of_cascade()) return std::nullopt;  // has both flags
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

LogTopic& topic_in(std::vector<LogTopic>& topics, std::string_view name, bool is_output) {
  const auto known = std::find_if(topics.begin(), topics.end(), [&](const LogTopic& one) {
    return one.name == name && one.is_output == is_output;
  });
  return known != topics.end() ? *known
                               : topics.emplace_back(LogTopic{std::string(name), is_output});
}

void add(std::size_t index, std::vector<LogTopic>& topics) {
  const Channel& channel = channels()[index];
  LogTopic& topic = topic_in(topics, channel.topic(), channel.is_output());
  if (channel.type == ChannelType::bit || channel.is_published_flag()) {
    topic.is_new = index;
  } else {
    const auto field = channel.field() == "timestamp" ? publication_time : channel.field();
    topic.fields.push_back({index, std::string(field), state_of(channel), if_absent(channel.name)});
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

}  // namespace attest
