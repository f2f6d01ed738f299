#include "harness/ulog/trace_log.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "harness/trace/csv.hpp"
#include "harness/trace/plant_columns.hpp"
#include "harness/ulog/writer.hpp"

namespace attest {
namespace {

using Bytes = std::string;

// The elements of a field, for one tick.
struct LogField {
  std::string name;
  const char* type = "float";
  std::vector<std::function<void(const Trace&, std::size_t tick, Bytes&)>> elements;
};

struct LogTopic {
  std::string name;
  std::uint8_t multi_id = 0;
  std::function<bool(const Trace&, std::size_t tick)> is_new = [](const Trace&, std::size_t) {
    return true;
  };
  std::vector<LogField> floats, bytes;  // in this order: fields have descending sizes

  std::string definition() const {
    std::string text = name + ":uint64_t timestamp;";
    for (const auto* fields : {&floats, &bytes}) {
      for (const LogField& field : *fields) {
        const std::size_t count = field.elements.size();
        text += field.type + (count > 1 ? fmt::format("[{}]", count) : "") + " " + field.name + ";";
      }
    }
    return text;
  }

  Bytes data(const Trace& trace, std::size_t tick) const {
    Bytes data;
    const std::uint64_t timestamp = trace.samples[tick].in.timestamp;
    data.append(reinterpret_cast<const char*>(&timestamp), sizeof timestamp);
    for (const auto* fields : {&floats, &bytes}) {
      for (const LogField& field : *fields) {
        for (const auto& append : field.elements) append(trace, tick, data);
      }
    }
    return data;
  }
};

void append_float(float value, Bytes& bytes) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

// The topics by name and instance, in the order of their first column.
class Topics {
 public:
  // `column`: "vehicle_attitude.q[0]"; one without a topic is a topic with the field `value`.
  LogField& field(const std::string& column, std::uint8_t multi_id, bool is_byte) {
    std::string path = column.substr(0, column.find('['));
    const std::size_t dot = path.find('.');
    const std::string name = dot == std::string::npos ? "value" : path.substr(dot + 1);
    auto& fields = is_byte ? topic(path.substr(0, dot), multi_id).bytes
                           : topic(path.substr(0, dot), multi_id).floats;
    const auto known =
        std::find_if(fields.begin(), fields.end(), [&](const auto& f) { return f.name == name; });
    if (known != fields.end()) return *known;
    return fields.emplace_back(LogField{name, is_byte ? "uint8_t" : "float", {}});
  }

  LogTopic& topic(const std::string& name, std::uint8_t multi_id) {
    const auto known = std::find_if(topics_.begin(), topics_.end(), [&](const LogTopic& one) {
      return one.name == name && one.multi_id == multi_id;
    });
    if (known != topics_.end()) return *known;
    LogTopic& added = topics_.emplace_back();
    added.name = name;
    added.multi_id = multi_id;
    return added;
  }

  const std::vector<LogTopic>& all() const { return topics_; }

 private:
  std::vector<LogTopic> topics_;
};

// "vehicle_status" of "in/updated.vehicle_status", or of "out/vehicle_status.published".
void set_freshness(const Channel& channel, const std::string& column, Topics& topics) {
  const bool is_update = channel.type == ChannelType::bit;
  const std::string name =
      is_update ? column.substr(column.find('.') + 1) : column.substr(0, column.find('.'));
  const std::uint8_t multi_id = is_update && name == "vehicle_rates_setpoint" ? 1 : 0;
  if (name == "parameter_update") return;
  topics.topic(name, multi_id).is_new = [&channel](const Trace& trace, std::size_t tick) {
    return value_of(channel, trace.samples[tick]) != 0;
  };
}

void add_channel(const Channel& channel, Topics& topics) {
  const std::string column(channel.name.substr(channel.name.find('/') + 1));
  if (channel.type == ChannelType::u64) return;
  if (channel.type == ChannelType::bit || column.ends_with(".published")) {
    return set_freshness(channel, column, topics);
  }
  const bool is_external = !channel.is_output() && column.starts_with("vehicle_rates_setpoint.");
  const bool is_byte = channel.type == ChannelType::u8;
  topics.field(column, is_external ? 1 : 0, is_byte)
      .elements.push_back([&channel, is_byte](const Trace& trace, std::size_t tick, Bytes& bytes) {
        const Sample& sample = trace.samples[tick];
        if (!is_byte) return append_float(float_of(channel, sample), bytes);
        bytes += static_cast<char>(static_cast<std::uint8_t>(value_of(channel, sample)));
      });
}

// battery_status has a field of the unit's inputs and one of the plant: it is logged at each tick.
void add_plant(Topics& topics) {
  for (const PlantColumn& column : plant_columns()) {
    const std::string name = column.name.substr(plant_prefix.size());
    topics.field(name, 0, false)
        .elements.push_back([&column](const Trace& trace, std::size_t tick, Bytes& bytes) {
          append_float(column.value(trace.plant[tick]), bytes);
        });
    topics.topic(name.substr(0, name.find_first_of(".[")), 0).is_new =
        [](const Trace&, std::size_t) { return true; };
  }
}

Topics topics_of(const Trace& trace) {
  Topics topics;
  const auto table = channels();
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (trace.present[i]) add_channel(table[i], topics);
  }
  if (!trace.plant.empty()) add_plant(topics);
  return topics;
}

Result<void> write_parameters(std::span<const ParameterChange> changes, ulog::Writer& writer) {
  for (const ParameterChange& change : changes) {
    if (auto written = writer.parameter(change.name, change.value); !written) return written;
  }
  return {};
}

Result<void> write_ticks(const Trace& trace, const Topics& topics, ulog::Writer& writer) {
  std::vector<std::uint16_t> ids;
  for (const LogTopic& topic : topics.all()) {
    const auto id = writer.subscribe(topic.name, topic.multi_id);
    if (!id) return tl::unexpected(id.error());
    ids.push_back(*id);
  }
  PendingChanges changes(trace.parameters);
  changes.take_until(0);
  for (std::size_t tick = 0; tick < trace.samples.size(); ++tick) {
    if (auto set = write_parameters(changes.take_until(tick), writer); !set) return set;
    for (std::size_t i = 0; i < ids.size(); ++i) {
      const LogTopic& topic = topics.all()[i];
      if (!topic.is_new(trace, tick)) continue;
      if (auto written = writer.data(ids[i], topic.data(trace, tick)); !written) return written;
    }
  }
  return {};
}

Result<void> write_log(const std::filesystem::path& path, const Trace& trace) {
  if (module_of(trace.present) != Module::mc_att_control) {
    return fail_at(path.string(), "a ULog is for traces of the controller; write a .csv");
  }
  const std::uint64_t start = trace.samples.empty() ? 0 : trace.samples.front().in.timestamp;
  auto writer = ulog::Writer::open(path, start);
  if (!writer) return tl::unexpected(writer.error());
  const Topics topics = topics_of(trace);
  if (auto set = writer->info("sys_name", "attest"); !set) return set;
  if (!trace.source.empty()) {
    if (auto set = writer->info("attest_source", trace.source); !set) return set;
  }
  if (auto set = write_parameters(PendingChanges(trace.parameters).take_until(0), *writer); !set) {
    return set;
  }
  for (const LogTopic& topic : topics.all()) {
    if (topic.multi_id > 0) continue;  // the same fields as those of instance 0
    if (auto defined = writer->define(topic.definition()); !defined) return defined;
  }
  if (auto written = write_ticks(trace, topics, *writer); !written) return written;
  return writer->commit();
}

}  // namespace

Result<void> write_trace(const std::filesystem::path& path, const Trace& trace) {
  if (path.extension() == ".ulg") return write_log(path, trace);
  CsvColumns columns = all_columns(trace);
  columns.plant = !trace.plant.empty();
  return write_csv(path, trace, columns);
}

}  // namespace attest
