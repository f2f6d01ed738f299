#include "harness/compare/timed_signals.hpp"

#include <algorithm>
#include <cstring>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "harness/trace/csv_rows.hpp"
#include "harness/trace/plant_columns.hpp"
#include "harness/ulog/flight_log.hpp"
#include "harness/ulog/reader.hpp"

namespace attest {
namespace {

// Appends a sample. False: its time is not after the one before.
bool add(TimedSignal& signal, std::uint64_t time_us, float value) {
  if (!signal.times_us.empty() && time_us <= signal.times_us.back()) return false;
  signal.times_us.push_back(time_us);
  signal.values.push_back(value);
  return true;
}

// The numbers of a subscription's topic.
struct Topic {
  std::optional<ulog::Column> time;
  std::vector<std::pair<ulog::Column, TimedSignal>> signals;
  std::size_t left_out = 0;
};

std::string name_of_topic(const ulog::Subscription& subscription) {
  return subscription.multi_id == 0
             ? subscription.topic
             : fmt::format("{}[{}]", subscription.topic, subscription.multi_id);
}

Topic topic_of(const ulog::Subscription& subscription) {
  Topic topic;
  for (const ulog::Field& leaf : subscription.format->leaves) {
    if (leaf.type == ulog::Type::character) continue;
    if (leaf.name == "timestamp" && leaf.type == ulog::Type::u64) {
      topic.time = ulog::Column{&subscription, leaf.type, leaf.offset};
      continue;
    }
    for (std::uint32_t i = 0; i < leaf.count; ++i) {
      const std::string index = leaf.is_array ? fmt::format("[{}]", i) : "";
      const ulog::Column column{&subscription, leaf.type,
                                leaf.offset + i * ulog::bytes_of(leaf.type)};
      const std::string name = name_of_topic(subscription) + "." + leaf.name + index;
      topic.signals.push_back({column, {name, {}, {}}});
    }
  }
  return topic;
}

void add_data(const ulog::Data& data, Topic& topic) {
  if (!topic.time) return;
  const auto time_us = topic.time->of<std::uint64_t>(data);
  bool is_later = true;
  for (auto& [column, signal] : topic.signals) {
    is_later = add(signal, time_us, column.of<float>(data)) && is_later;
  }
  topic.left_out += is_later ? 0 : 1;
}

Result<TimedSignals> signals_of_log(const std::filesystem::path& path) {
  auto reader = ulog::Reader::open(path);
  if (!reader) return tl::unexpected(reader.error());
  std::map<std::string, Topic> topics;
  std::vector<Topic*> by_subscription;
  ulog::Message message;
  while (true) {
    const auto more = reader->next(message);
    if (!more) return tl::unexpected(more.error());
    if (!*more) break;
    const auto* data = std::get_if<ulog::Data>(&message);
    if (data == nullptr || data->subscription->format == nullptr) continue;
    const std::size_t index = data->subscription->index;
    if (by_subscription.size() <= index) by_subscription.resize(index + 1);
    if (by_subscription[index] == nullptr) {
      const std::string name = name_of_topic(*data->subscription);
      by_subscription[index] =
          &topics.try_emplace(name, topic_of(*data->subscription)).first->second;
    }
    add_data(*data, *by_subscription[index]);
  }
  TimedSignals signals{path.string(), {}, {}};
  for (auto& [name, topic] : topics) {
    for (auto& [column, signal] : topic.signals) signals.all.push_back(std::move(signal));
    if (topic.left_out == 0) continue;
    signals.notes.push_back(
        fmt::format("{} samples of {} left out, because their timestamps do "
                    "not increase",
                    topic.left_out, name));
  }
  if (const auto damages = reader->damage().total(); damages > 0) {
    signals.notes.push_back(fmt::format("damaged in {} places; the first: byte {}: {}", damages,
                                        reader->damage().first[0].offset,
                                        reader->damage().first[0].message));
  }
  return signals;
}

std::string name_in_log(std::string_view column) {
  constexpr std::string_view external = "in/vehicle_rates_setpoint.";
  if (column.starts_with(external)) {
    return fmt::format("vehicle_rates_setpoint[1].{}", column.substr(external.size()));
  }
  const bool is_of_plant = column.starts_with(plant_prefix);
  for (const std::string_view prefix :
       {std::string_view("in/"), std::string_view("out/"), plant_prefix}) {
    if (column.starts_with(prefix)) column.remove_prefix(prefix.size());
  }
  std::string name(column);
  // "rotor_speed[0]": a topic with the field `value`.
  if (is_of_plant && name.find('.') == std::string::npos) {
    name.insert(std::min(name.find('['), name.size()), ".value");
  }
  return name;
}

// Times and the values of the other columns of a row, as CsvRows writes them.
struct Row {
  static constexpr std::size_t time = 0, first = sizeof(std::uint64_t);
  std::vector<char> bytes;

  template <typename T>
  T at(std::size_t offset) const {
    T value;
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
  }
};

Result<TimedSignals> signals_of_csv(const std::filesystem::path& path) {
  auto rows = CsvRows::open(path);
  if (!rows) return tl::unexpected(rows.error());
  TimedSignals signals{path.string(), {}, {}};
  std::vector<CsvColumn> columns;
  bool has_time = false;
  for (const std::string& name : rows->header()) {
    if (name == "timestamp") {
      columns.push_back({CellType::u64, Row::time});
      has_time = true;
      continue;
    }
    columns.push_back({CellType::f32, Row::first + sizeof(float) * signals.all.size()});
    signals.all.push_back({name_in_log(name), {}, {}});
  }
  if (!has_time) {
    return fail_at(path.string(), "no column timestamp; add the time of each row in microseconds",
                   1);
  }
  rows->set_columns(std::move(columns));
  Row row{std::vector<char>(Row::first + sizeof(float) * signals.all.size())};
  std::size_t left_out = 0;
  while (true) {
    const auto more = rows->next(row.bytes.data());
    if (!more) return tl::unexpected(more.error());
    if (!*more) break;
    bool is_later = true;
    for (std::size_t i = 0; i < signals.all.size(); ++i) {
      const auto value = row.at<float>(Row::first + sizeof(float) * i);
      is_later = add(signals.all[i], row.at<std::uint64_t>(Row::time), value) && is_later;
    }
    left_out += is_later ? 0 : 1;
  }
  if (left_out > 0) {
    signals.notes.push_back(
        fmt::format("{} rows left out, because their timestamps do not increase", left_out));
  }
  return signals;
}

}  // namespace

const TimedSignal* TimedSignals::find(const std::string& name) const {
  const auto found = std::lower_bound(
      all.begin(), all.end(), name,
      [](const TimedSignal& signal, const std::string& wanted) { return signal.name < wanted; });
  return found != all.end() && found->name == name ? &*found : nullptr;
}

Result<TimedSignals> read_timed_signals(const std::filesystem::path& path) {
  auto signals = is_log(path) ? signals_of_log(path) : signals_of_csv(path);
  if (!signals) return signals;
  std::erase_if(signals->all, [](const TimedSignal& signal) { return signal.values.empty(); });
  if (signals->all.empty()) return fail_at(path.string(), "has no sample of a signal");
  std::stable_sort(signals->all.begin(), signals->all.end(),
                   [](const TimedSignal& a, const TimedSignal& b) { return a.name < b.name; });
  return signals;
}

}  // namespace attest
