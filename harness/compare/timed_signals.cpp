#include "harness/compare/timed_signals.hpp"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "harness/trace/csv.hpp"
#include "harness/trace/csv_layout.hpp"
#include "harness/trace/csv_rows.hpp"
#include "harness/trace/plant_columns.hpp"
#include "harness/ulog/left_out.hpp"
#include "harness/ulog/log_topics.hpp"
#include "harness/ulog/reader.hpp"
#include "harness/ulog/time_check.hpp"

namespace attest {
namespace {

struct LeftOut {
  std::size_t not_later = 0, absurd = 0, too_late = 0, without_time = 0;

  void add_to(ulog::LeftOutSamples& samples, const std::string& topic) const {
    samples.add(ulog::LeftOutSamples::not_later, topic, not_later);
    samples.add(ulog::LeftOutSamples::absurd, topic, absurd);
    samples.add(beyond(), topic, too_late);
    samples.add(ulog::LeftOutSamples::without_time, topic, without_time);
  }

  // For rows, which have no topic.
  void note_rows(std::vector<std::string>& notes) const {
    const auto add = [&](std::size_t count, const std::string& why) {
      if (count == 0) return;
      notes.push_back(
          fmt::format("{} row{} left out, because {}", count, count == 1 ? "" : "s", why));
    };
    add(not_later, ulog::LeftOutSamples::not_later);
    add(too_late, beyond());
  }

  static std::string beyond() { return fmt::format("the time is beyond {} us", latest_us); }
};

// Appends value(i) to each signal i, unless the sample is left out.
template <typename Signals, typename Value>
void add_sample(Signals& signals, std::uint64_t time_us, LeftOut& left_out, Value value) {
  if (time_us > static_cast<std::uint64_t>(latest_us)) {
    ++left_out.too_late;
    return;
  }
  for (std::size_t i = 0; i < signals.size(); ++i) {
    TimedSignal& signal = signals[i];
    if (!signal.times_us.empty() && time_us <= signal.times_us.back()) {
      ++left_out.not_later;
      return;
    }
    signal.times_us.push_back(time_us);
    signal.values.push_back(value(i));
  }
}

struct TimedTopic {
  std::optional<ulog::Column> time;
  std::vector<ulog::Column> columns;
  std::vector<TimedSignal> signals;  // of columns
  LeftOut left_out;
};

std::string name_of_topic(const std::string& topic, std::uint8_t multi_id) {
  return multi_id == 0 ? topic : fmt::format("{}[{}]", topic, multi_id);
}

TimedTopic topic_of(const ulog::Subscription& subscription) {
  TimedTopic topic;
  const std::string name = name_of_topic(subscription.topic, subscription.multi_id);
  for (const ulog::Field& leaf : subscription.format->leaves) {
    if (leaf.type == ulog::Type::character) continue;
    if (leaf.name == "timestamp" && leaf.type == ulog::Type::u64 && !leaf.is_array) {
      topic.time = ulog::Column{&subscription, leaf.type, leaf.offset};
      continue;
    }
    for (std::uint32_t i = 0; i < leaf.count; ++i) {
      const std::string index = leaf.is_array ? fmt::format("[{}]", i) : "";
      topic.columns.push_back(
          {&subscription, leaf.type, leaf.offset + i * ulog::bytes_of(leaf.type)});
      topic.signals.push_back({name + "." + leaf.name + index, {}, {}});
    }
  }
  return topic;
}

void add_data(const ulog::Data& data, ulog::TimeFit fit, TimedTopic& topic) {
  if (!topic.time) {
    ++topic.left_out.without_time;
    return;
  }
  if (fit == ulog::TimeFit::too_late) {
    ++topic.left_out.absurd;
    return;
  }
  add_sample(topic.signals, topic.time->of<std::uint64_t>(data), topic.left_out,
             [&](std::size_t i) { return topic.columns[i].of<float>(data); });
}

// By topic and instance: the name of a topic may look like that of an instance of another one.
using TopicsOfLog = std::map<std::pair<std::string, std::uint8_t>, TimedTopic>;

Result<TimedSignals> all_signals_of_log(const std::filesystem::path& path) {
  auto reader = ulog::Reader::open(path);
  if (!reader) return tl::unexpected(reader.error());
  TopicsOfLog topics;
  std::vector<TimedTopic*> by_subscription;
  ulog::TimeCheck times;
  ulog::Message message;
  while (true) {
    const auto more = reader->next(message);
    if (!more) return tl::unexpected(more.error());
    if (!*more) break;
    if (!std::holds_alternative<ulog::Data>(message)) continue;
    const auto fit = times.check(*reader, message);
    if (!fit) return tl::unexpected(fit.error());
    const auto* data = &std::get<ulog::Data>(message);
    if (data->subscription->format == nullptr) continue;
    const std::size_t index = data->subscription->index;
    if (by_subscription.size() <= index) by_subscription.resize(index + 1);
    if (by_subscription[index] == nullptr) {
      const ulog::Subscription& subscription = *data->subscription;
      const auto [added, is_new] = topics.try_emplace({subscription.topic, subscription.multi_id});
      if (is_new) added->second = topic_of(subscription);
      by_subscription[index] = &added->second;
    }
    add_data(*data, *fit, *by_subscription[index]);
  }
  TimedSignals signals{path.string(), {}, {}};
  ulog::LeftOutSamples left_out;
  for (auto& [instance, topic] : topics) {
    std::move(topic.signals.begin(), topic.signals.end(), std::back_inserter(signals.all));
    const auto& [name, multi_id] = instance;
    topic.left_out.add_to(left_out, name_of_topic(name, multi_id));
  }
  signals.notes = left_out.notes();
  if (const auto damages = reader->damage().total(); damages > 0) {
    signals.notes.push_back(fmt::format("damaged in {} place{}; the first: byte {}: {}", damages,
                                        damages == 1 ? "" : "s", reader->damage().first[0].offset,
                                        reader->damage().first[0].message));
  }
  return signals;
}

// Channel -> its name in the log that attest writes for a trace.
using NamesInLog = std::map<std::string_view, std::string>;

NamesInLog names_in_log(const std::vector<std::string>& columns) {
  const Module of_columns = module_with(columns);
  const Module module = info_of(of_columns).is_unit() ? of_columns : Module::mc_att_control;
  NamesInLog found;
  for (const LogTopic& topic : log_topics(module)) {
    for (const LogField& field : topic.fields) {
      found[channels()[field.channel].name] =
          name_of_topic(topic.name, topic.multi_id) + "." + field.name;
    }
  }
  return found;
}

std::string name_in_log(std::string_view column, const NamesInLog& in_log) {
  if (const auto known = in_log.find(column); known != in_log.end()) return known->second;
  const bool is_of_plant = column.starts_with(plant_prefix);
  for (const std::string_view prefix :
       {std::string_view("in/"), std::string_view("out/"), plant_prefix}) {
    if (column.starts_with(prefix)) column.remove_prefix(prefix.size());
  }
  std::string name(column);
  // "rotor_speed[0]" becomes "rotor_speed.value[0]": a topic with the field `value`.
  if (is_of_plant && name.find('.') == std::string::npos) {
    name.insert(std::min(name.find('['), name.size()), ".value");
  }
  return name;
}

// A row as CsvRows writes it: the time, then the values of the other columns.
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

Result<TimedSignals> all_signals_of_csv(const std::filesystem::path& path) {
  auto rows = CsvRows::open(path);
  if (!rows) return tl::unexpected(rows.error());
  if (auto refused = refuse_golden(*rows); !refused) return tl::unexpected(refused.error());
  if (auto limited = rows->limit_size(); !limited) return tl::unexpected(limited.error());
  TimedSignals signals{path.string(), {}, {}};
  std::vector<CsvColumn> columns;
  bool has_time = false;
  const NamesInLog in_log = names_in_log(rows->header());
  for (const std::string& name : rows->header()) {
    if (name == "timestamp") {
      columns.push_back({CellType::u64, Row::time});
      has_time = true;
      continue;
    }
    if (name.starts_with(profile_prefix)) {
      columns.push_back({CellType::ignored, 0});
      continue;
    }
    columns.push_back({CellType::f32, Row::first + sizeof(float) * signals.all.size()});
    signals.all.push_back({name_in_log(name, in_log), {}, {}});
  }
  if (!has_time) {
    return fail_at(path.string(), "no column timestamp; add the time of each row in microseconds",
                   1);
  }
  rows->set_columns(std::move(columns));
  Row row{std::vector<char>(Row::first + sizeof(float) * signals.all.size())};
  LeftOut left_out;
  while (true) {
    const auto more = rows->next(row.bytes.data());
    if (!more) return tl::unexpected(more.error());
    if (!*more) break;
    add_sample(signals.all, row.at<std::uint64_t>(Row::time), left_out,
               [&](std::size_t i) { return row.at<float>(Row::first + sizeof(float) * i); });
  }
  left_out.note_rows(signals.notes);
  return signals;
}

// REQUIRES: sorted by name.
void leave_out_repeated_names(TimedSignals& signals) {
  const auto repeated = [](const TimedSignal& a, const TimedSignal& b) { return a.name == b.name; };
  const auto first = std::adjacent_find(signals.all.begin(), signals.all.end(), repeated);
  if (first == signals.all.end()) return;
  const std::string name = first->name;
  const auto end = std::unique(first, signals.all.end(), repeated);
  signals.notes.push_back(
      fmt::format("{} signal{} left out, because another one has the same name; the first: {}",
                  signals.all.end() - end, signals.all.end() - end == 1 ? "" : "s", name));
  signals.all.erase(end, signals.all.end());
}

}  // namespace

const TimedSignal* TimedSignals::find(const std::string& name) const {
  const auto found = std::lower_bound(
      all.begin(), all.end(), name,
      [](const TimedSignal& signal, const std::string& wanted) { return signal.name < wanted; });
  return found != all.end() && found->name == name ? &*found : nullptr;
}

Result<TimedSignals> in_order(TimedSignals signals) {
  std::erase_if(signals.all, [](const TimedSignal& signal) { return signal.values.empty(); });
  if (signals.all.empty()) return fail_at(signals.source, "has no sample of a signal");
  std::stable_sort(signals.all.begin(), signals.all.end(),
                   [](const TimedSignal& a, const TimedSignal& b) { return a.name < b.name; });
  leave_out_repeated_names(signals);
  return signals;
}

Result<TimedSignals> signals_of_log(const std::filesystem::path& path) {
  return all_signals_of_log(path).and_then(in_order);
}

Result<TimedSignals> signals_of_csv(const std::filesystem::path& path) {
  return all_signals_of_csv(path).and_then(in_order);
}

}  // namespace attest
