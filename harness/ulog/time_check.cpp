#include "harness/ulog/time_check.hpp"

#include <algorithm>
#include <utility>

namespace attest::ulog {
namespace {

// A topic that is logged slowly is up to about this much behind the others.
constexpr std::uint64_t most_behind_us = 1'000'000;

// So many following samples decide. Several of them may be absurd, too. At the start of a log PX4
// writes the last sample of each topic, about 200, before a topic has its second one.
constexpr std::size_t enough_samples = 20, most_messages = 2000;

// Fewer following samples do not show that a sample is too early. So many of them may be absurd.
constexpr std::size_t least_samples = 8, most_absurd = 2;

// The time of a topic that is too early more often than this is from another clock.
constexpr int most_early = 4;

bool is_far_after(std::uint64_t time_us, std::uint64_t other_us, std::uint64_t limit_us) {
  return time_us > other_us && time_us - other_us > limit_us;
}

bool is_too_late(std::uint64_t time_us, const std::vector<std::uint64_t>& following) {
  const auto before = std::count_if(following.begin(), following.end(), [&](std::uint64_t other) {
    return is_far_after(time_us, other, most_ahead_us);
  });
  return 2 * static_cast<std::size_t>(before) > following.size();
}

// In a log with few samples, those that follow are far after the first one, and far apart.
bool is_too_early(std::uint64_t time_us, const std::vector<std::uint64_t>& following) {
  if (following.size() < least_samples) return false;
  const std::uint64_t begin = following[most_absurd];
  const std::uint64_t end = following[following.size() - 1 - most_absurd];
  return is_far_after(begin, time_us, most_behind_us) && begin - time_us > end - begin;
}

}  // namespace

TimeCheck::Topic& TimeCheck::topic_of(const Reader& reader, const Subscription& subscription) {
  if (topics_.size() <= subscription.index) topics_.resize(subscription.index + 1);
  Topic& topic = topics_[subscription.index];
  if (!std::exchange(topic.is_located, true)) {
    const auto time = reader.find(subscription.topic, subscription.multi_id, "timestamp");
    if (time && time->type == Type::u64) topic.time = *time;
  }
  return topic;
}

Result<TimeFit> TimeCheck::check_closely(Reader& reader, Message& message) {
  const Data& data = std::get<Data>(message);
  const std::size_t index = data.subscription->index;
  Topic& topic = topic_of(reader, *data.subscription);
  if (!topic.time) return TimeFit::plausible;
  const auto time_us = topic.time->of<std::uint64_t>(data);
  const bool is_first = !topic.last_us && topic.early < most_early;
  const bool is_ahead = !newest_us_ || is_far_after(time_us, *newest_us_, most_ahead_us);
  if (!is_ahead && !is_first) {
    topic.last_us = time_us;
    if (time_us > *newest_us_) newest_us_ = time_us;
    return TimeFit::plausible;
  }
  const auto place = reader.place_of_last();
  const auto following = read_ahead(reader, index, time_us);  // may move `topic`
  if (!following) return tl::unexpected(following.error());
  reader.return_to(place);
  if (const auto again = reader.next(message); !again) return tl::unexpected(again.error());
  if (is_ahead && is_too_late(time_us, *following)) return TimeFit::too_late;
  const bool is_behind = !newest_us_ || is_far_after(*newest_us_, time_us, most_behind_us);
  if (is_first && is_behind && is_too_early(time_us, *following)) {
    ++topics_[index].early;
    return TimeFit::too_early;
  }
  topics_[index].last_us = time_us;
  newest_us_ = std::max(newest_us_.value_or(time_us), time_us);
  return TimeFit::plausible;
}

// Takes only topics whose sample before was up to date: an event may be old at the start of a log,
// and some topics of PX4 always have the same time.
Result<std::vector<std::uint64_t>> TimeCheck::read_ahead(Reader& reader, std::size_t index,
                                                         std::uint64_t time_us) {
  std::vector<std::optional<std::uint64_t>> last_us;
  for (const Topic& topic : topics_) last_us.push_back(topic.last_us);
  last_us[index] = time_us;
  std::vector<std::uint64_t> found;
  Message message;
  for (std::size_t i = 0; i < most_messages && found.size() < enough_samples; ++i) {
    const auto more = reader.next(message);
    if (!more) return tl::unexpected(more.error());
    if (!*more || reader.is_appended()) break;
    const auto* const data = std::get_if<Data>(&message);
    if (data == nullptr) continue;
    const Topic& topic = topic_of(reader, *data->subscription);
    if (!topic.time) continue;
    last_us.resize(topics_.size());
    const auto other_us = topic.time->of<std::uint64_t>(*data);
    const auto before_us = std::exchange(last_us[data->subscription->index], other_us);
    if (!before_us || other_us <= *before_us) continue;
    if (newest_us_ && is_far_after(*newest_us_, *before_us, most_behind_us)) continue;
    found.push_back(other_us);
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace attest::ulog
