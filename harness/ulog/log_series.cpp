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
T value_in(const Data& data, const Column& column) {
  return load_as<T>(column.type, data.bytes.data() + column.offset);
}

// Keeps an integer from 0 to 255. Any other value, as a flag of another type, is true: 1.
std::uint8_t flag_of(float value) {
  const bool is_byte = value >= 0 && value <= 255 && value == std::floor(value);
  return is_byte ? static_cast<std::uint8_t>(value) : 1;
}

bool is_integer(const LogField& field) {
  return channels()[field.channel].type == ChannelType::u64;
}

// The bytes of the field's values. They are stored from the least significant byte on.
std::size_t bytes_of(const LogField& field) {
  switch (channels()[field.channel].type) {
    case ChannelType::u64:
      return sizeof(std::uint64_t);
    case ChannelType::f32:
      return sizeof(float);
    default:
      return 1;
  }
}

}  // namespace

LogSeries::LogSeries(LogTopic topic) : topic_(std::move(topic)) {
  for (const LogField& field : topic_.fields) {
    bytes_.push_back(bytes_of(field));
    row_bytes_ += bytes_.back();
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
  for (const LogField& field : topic_.fields) {
    places_.push_back(find_place(reader, subscription, field));
  }
}

std::uint64_t LogSeries::bits_of(const Data& data, std::size_t field) const {
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
  const auto time = value_in<std::uint64_t>(data, *time_);
  if (size_ > 0 && time <= newest_) {
    ++left_out_;
    return false;
  }
  newest_ = time;
  const auto before = std::exchange(newest_sample_time_, std::nullopt);
  if (sample_time_) newest_sample_time_ = value_in<std::uint64_t>(data, *sample_time_);
  if (!newest_sample_time_ || (before && *newest_sample_time_ < *before)) has_sample_times_ = false;
  ++size_;
  return true;
}

void LogSeries::add(const Reader& reader, const Data& data) {
  if (!count(reader, data)) return;
  times_.push_back(newest_);
  sample_times_.push_back(newest_sample_time_);
  unsigned char* at = values_.append(row_bytes_);
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const std::uint64_t bits = bits_of(data, i);
    std::memcpy(at, &bits, bytes_[i]);
    at += bytes_[i];
  }
}

void LogSeries::forget_before(std::size_t row) {
  const std::size_t rows = row - forgotten_;
  if (rows == 0) return;
  times_.drop_front(rows);
  sample_times_.drop_front(rows);
  values_.drop_front(rows * row_bytes_);
  forgotten_ = row;
}

void LogSeries::restart() {
  times_.clear();
  sample_times_.clear();
  values_.clear();
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
  if (row_bytes_ == 0) return;
  const unsigned char* at = &values_[(row - forgotten_) * row_bytes_];
  const auto table = channels();
  for (std::size_t i = 0; i < bytes_.size(); ++i) {
    const Channel& channel = table[topic_.fields[i].channel];
    std::uint64_t bits = 0;
    std::memcpy(&bits, at, bytes_[i]);
    at += bytes_[i];
    if (channel.type == ChannelType::f32) {
      set_value(channel, to, std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
    } else {
      set_integer(channel, to, bits);
    }
  }
}

}  // namespace attest::ulog
