#include "harness/ulog/log_series.hpp"

#include <algorithm>
#include <cmath>

namespace attest::ulog {
namespace {

std::optional<Column> find(const Reader& reader, const Subscription& subscription,
                           std::string_view field) {
  const auto column = reader.find(subscription.topic, subscription.multi_id, field);
  return column ? std::optional(*column) : std::nullopt;
}

// The same for a time, which must be an integer.
std::optional<Column> find_time(const Reader& reader, const Subscription& subscription,
                                std::string_view field) {
  const auto column = find(reader, subscription, field);
  return column && column->type == Type::u64 ? column : std::nullopt;
}

template <typename T>
T value_in(const Data& data, const Column& column) {
  return load_as<T>(column.type, data.bytes.data() + column.offset);
}

// A flag of any type as a byte that is true if the flag is.
double flag_of(float value) {
  const bool is_byte = value >= 0 && value <= 255 && value == std::floor(value);
  return is_byte ? value : 1;
}

}  // namespace

LogSeries::LogSeries(std::string_view topic, bool is_output)
    : topic_(topic),
      is_output_(is_output),
      multi_id_(!is_output && topic == "vehicle_rates_setpoint" ? 1 : 0) {}

void LogSeries::add_field(std::string field, std::size_t channel) {
  fields_.push_back(std::move(field));
  channels_.push_back(channel);
}

void LogSeries::locate(const Reader& reader, const Subscription& subscription) {
  located_ = subscription.index;
  time_ = find_time(reader, subscription, "timestamp");
  sample_time_ = find_time(reader, subscription, "timestamp_sample");
  columns_.clear();
  for (const std::string& field : fields_) columns_.push_back(find(reader, subscription, field));
}

void LogSeries::add(const Reader& reader, const Data& data) {
  if (located_ != data.subscription->index) locate(reader, *data.subscription);
  if (!time_) {
    ++without_time_;
    return;
  }
  const auto time = value_in<std::uint64_t>(data, *time_);
  if (!times_.empty() && time <= times_.back()) {
    ++left_out_;
    return;
  }
  times_.push_back(time);
  if (sample_time_) sample_times_.push_back(value_in<std::uint64_t>(data, *sample_time_));
  for (const auto& column : columns_) {
    values_.push_back(column ? value_in<float>(data, *column) : 0.0f);
  }
}

std::optional<std::uint64_t> LogSeries::sample_time(std::size_t row) const {
  if (sample_times_.size() != times_.size()) return std::nullopt;
  return sample_times_[row];
}

std::size_t LogSeries::first_after(std::uint64_t time) const {
  return static_cast<std::size_t>(std::upper_bound(times_.begin(), times_.end(), time) -
                                  times_.begin());
}

std::vector<std::string> LogSeries::missing_fields() const {
  std::vector<std::string> missing;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    if (!columns_[i]) missing.push_back(fields_[i]);
  }
  return missing;
}

std::vector<std::size_t> LogSeries::logged_channels() const {
  std::vector<std::size_t> logged;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    if (columns_[i]) logged.push_back(channels_[i]);
  }
  return logged;
}

void LogSeries::copy(std::size_t row, Sample& to) const {
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    const Channel& channel = attest::channels()[channels_[i]];
    const float value = values_[row * channels_.size() + i];
    set_value(channel, to, channel.type == ChannelType::u8 ? flag_of(value) : value);
  }
}

bool LogSeries::advance_to(std::uint64_t time, Sample& to) {
  const std::size_t before = next_;
  while (next_ < size() && times_[next_] <= time) ++next_;
  if (next_ == before) return false;
  copy(next_ - 1, to);
  return true;
}

}  // namespace attest::ulog
