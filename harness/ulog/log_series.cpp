#include "harness/ulog/log_series.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

namespace attest::ulog {
namespace {

std::optional<Column> find(const Reader& reader, const Subscription& subscription,
                           std::string_view field) {
  const auto column = reader.find(subscription.topic, subscription.multi_id, field);
  return column ? std::optional(*column) : std::nullopt;
}

// Finds the field of a time, which must be a u64.
std::optional<Column> find_time(const Reader& reader, const Subscription& subscription,
                                std::string_view field) {
  const auto column = find(reader, subscription, field);
  return column && column->type == Type::u64 ? column : std::nullopt;
}

template <typename T>
T value_in(const char* data, const Column& column) {
  return load_as<T>(column.type, data + column.offset);
}

// Keeps an integer from 0 to 255. Any other value, as a flag of another type, is true: 1.
std::uint8_t flag_of(float value) {
  const bool is_byte = value >= 0 && value <= 255 && value == std::floor(value);
  return is_byte ? static_cast<std::uint8_t>(value) : 1;
}

bool is_integer(const LogField& field) {
  return channels()[field.channel].type == ChannelType::u64;
}

// The type of a number in a log whose bytes a channel has.
Type type_of(const Channel& channel) {
  if (channel.type == ChannelType::f32) return Type::f32;
  return channel.type == ChannelType::u64 ? Type::u64 : Type::u8;
}

}  // namespace

LogSeries::LogSeries(LogTopic topic) : topic_(std::move(topic)) {
  for (const LogField& field : topic_.fields) {
    const Channel& channel = channels()[field.channel];
    add({channel.offset, channel.offset, bytes_of(type_of(channel))}, of_sample_);
  }
}

void LogSeries::add(const SameBytes& more, std::vector<SameBytes>& parts) {
  const bool follows = !parts.empty() && parts.back().from + parts.back().count == more.from &&
                       parts.back().to + parts.back().count == more.to;
  if (follows) {
    parts.back().count += more.count;
  } else {
    parts.push_back(more);
  }
}

LogSeries::Place LogSeries::find_place(const Reader& reader, const Subscription& subscription,
                                       const LogField& field) const {
  const auto find_one = is_integer(field) ? find_time : find;
  if (const auto column = find_one(reader, subscription, field.name)) return {column, {}};
  if (is_integer(field) && field.is_time_of_topic()) {
    return {find_time(reader, subscription, "timestamp"), {}};
  }
  if (!field.state) return {};
  return {find(reader, subscription, field.state->field), field.state->if_true};
}

void LogSeries::locate(const Reader& reader, const Subscription& subscription) {
  located_ = subscription.index;
  time_ = find_time(reader, subscription, "timestamp");
  sample_time_ = find_time(reader, subscription, "timestamp_sample");
  places_.clear();
  of_row_.clear();
  converted_.clear();
  for (const LogField& field : topic_.fields) {
    const Channel& channel = channels()[field.channel];
    const Place place = find_place(reader, subscription, field);
    if (place.column && !place.state && place.column->type == type_of(channel)) {
      add({place.column->offset, channel.offset, bytes_of(place.column->type)}, of_row_);
    } else {
      converted_.push_back(places_.size());
    }
    places_.push_back(place);
  }
  // The samples that were added have the same format, because they are of the same topic.
  if (subscription.format) row_bytes_ = subscription.format->least_bytes;
}

std::uint64_t LogSeries::bits_of(const char* data, std::size_t field) const {
  const Place& place = places_[field];
  const bool is_byte = channels()[topic_.fields[field].channel].type == ChannelType::u8;
  if (!place.column) {
    const float absent = topic_.fields[field].if_absent;
    return is_byte ? flag_of(absent) : std::bit_cast<std::uint32_t>(absent);
  }
  if (is_integer(topic_.fields[field])) return value_in<std::uint64_t>(data, *place.column);
  const auto value = value_in<float>(data, *place.column);
  if (place.state) return value == static_cast<float>(*place.state) ? 1 : 0;
  return is_byte ? flag_of(value) : std::bit_cast<std::uint32_t>(value);
}

bool LogSeries::count(const Reader& reader, const Data& data) {
  if (located_ != data.subscription->index) locate(reader, *data.subscription);
  if (!time_) {
    ++without_time_;
    return false;
  }
  const auto time = load<std::uint64_t>(data.bytes.data() + time_->offset);
  if (size_ > 0 && time <= newest_) {
    ++left_out_;
    return false;
  }
  newest_ = time;
  const auto before = std::exchange(newest_sample_time_, std::nullopt);
  if (sample_time_) {
    newest_sample_time_ = load<std::uint64_t>(data.bytes.data() + sample_time_->offset);
  }
  if (!newest_sample_time_ || (before && *newest_sample_time_ < *before)) has_sample_times_ = false;
  ++size_;
  return true;
}

void LogSeries::add(const Reader& reader, const Data& data) {
  if (!count(reader, data)) return;
  times_.push_back({newest_, newest_sample_time_});
  std::memcpy(rows_.append(row_bytes_), data.bytes.data(), row_bytes_);
}

void LogSeries::forget(std::size_t rows) {
  times_.drop_front(rows);
  rows_.drop_front(rows * row_bytes_);
  forgotten_ += rows;
}

void LogSeries::restart() {
  times_.clear();
  rows_.clear();
  size_ = left_out_ = absurd_ = without_time_ = forgotten_ = 0;
  newest_ = 0;
  newest_sample_time_.reset();
  has_sample_times_ = true;
}

std::vector<const LogField*> LogSeries::missing_fields() const {
  std::vector<const LogField*> missing;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    if (!places_[i].column) missing.push_back(&topic_.fields[i]);
  }
  return missing;
}

std::vector<std::size_t> LogSeries::logged_channels() const {
  std::vector<std::size_t> logged;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    if (places_[i].column) logged.push_back(topic_.fields[i].channel);
  }
  return logged;
}

void LogSeries::copy(std::size_t row, Sample& to) const {
  if (topic_.fields.empty()) return;
  const char* const data = &rows_[(row - forgotten_) * row_bytes_];
  copy_all(of_row_, data, reinterpret_cast<char*>(&to));
  for (const std::size_t field : converted_) {
    const Channel& channel = channels()[topic_.fields[field].channel];
    const std::uint64_t bits = bits_of(data, field);
    if (channel.type == ChannelType::f32) {
      set_value(channel, to, std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
    } else {
      set_integer(channel, to, bits);
    }
  }
}

void LogSeries::copy_fields(const Sample& from, Sample& to) const {
  copy_all(of_sample_, reinterpret_cast<const char*>(&from), reinterpret_cast<char*>(&to));
}

void LogSeries::copy_all(const std::vector<SameBytes>& parts, const char* from, char* to) {
  for (const SameBytes& part : parts) std::memcpy(to + part.to, from + part.from, part.count);
}

}  // namespace attest::ulog
