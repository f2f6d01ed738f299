#include "harness/ulog/trace_log.hpp"

#include <algorithm>
#include <functional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "harness/trace/csv.hpp"
#include "harness/trace/plant_columns.hpp"
#include "harness/ulog/log_topics.hpp"
#include "harness/ulog/writer.hpp"

namespace attest {
namespace {

using Bytes = std::string;

// A field, with the functions that append its elements at a tick.
struct Field {
  std::string name;
  const char* type;
  std::vector<std::function<void(const Trace&, std::size_t tick, Bytes&)>> elements;
};

struct Topic {
  std::string name;
  std::uint8_t multi_id = 0;
  std::function<bool(const Trace&, std::size_t tick)> is_new = [](const Trace&, std::size_t) {
    return true;
  };
  std::vector<Field> integers, floats, bytes;  // in this order: fields have descending sizes

  std::string definition() const {
    std::string text = name + ":uint64_t timestamp;";
    for (const auto* fields : {&integers, &floats, &bytes}) {
      for (const Field& field : *fields) {
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
    for (const auto* fields : {&integers, &floats, &bytes}) {
      for (const Field& field : *fields) {
        for (const auto& append : field.elements) append(trace, tick, data);
      }
    }
    return data;
  }
};

template <typename T>
void append(T value, Bytes& bytes) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

// The field of an element: "q" for "q[0]". Adds it if it is not there yet.
Field& field_in(std::vector<Field>& fields, std::string_view path, const char* type) {
  const std::string name(path.substr(0, path.find('[')));
  const auto known =
      std::find_if(fields.begin(), fields.end(), [&](const Field& f) { return f.name == name; });
  return known != fields.end() ? *known : fields.emplace_back(Field{name, type, {}});
}

Field& float_in(Topic& topic, std::string_view path) {
  return field_in(topic.floats, path, "float");
}

// The topics by name and instance, in the order of their first column.
class Topics {
 public:
  Topic& topic(const std::string& name, std::uint8_t multi_id) {
    const auto known = std::find_if(topics_.begin(), topics_.end(), [&](const Topic& one) {
      return one.name == name && one.multi_id == multi_id;
    });
    if (known != topics_.end()) return *known;
    Topic& added = topics_.emplace_back();
    added.name = name;
    added.multi_id = multi_id;
    return added;
  }

  const std::vector<Topic>& all() const { return topics_; }
  // The instances of a topic share its definition. So an instance without `integers` (times) gets
  // those of the other instance, with the time of the step, at which a unit publishes its own
  // topic.
  void complete_instances() {
    for (Topic& topic : topics_) {
      for (const Topic& other : topics_) {
        if (other.name != topic.name || !topic.integers.empty()) continue;
        for (const Field& missing : other.integers) add_time(topic, missing.name);
      }
    }
  }

 private:
  static void add_time(Topic& topic, const std::string& name) {
    field_in(topic.integers, name, "uint64_t")
        .elements.push_back([](const Trace& trace, std::size_t tick, Bytes& bytes) {
          append(trace.samples[tick].in.timestamp, bytes);
        });
  }

  std::vector<Topic> topics_;
};

void add_state(const LogState& state, const Channel& channel, Topic& topic) {
  field_in(topic.bytes, state.field, "uint8_t")
      .elements.push_back([&state, &channel](const Trace& trace, std::size_t tick, Bytes& bytes) {
        append(value_of(channel, trace.samples[tick]) != 0 ? state.if_true : state.if_false, bytes);
      });
}

void add_field(const LogField& from, Topic& topic) {
  const Channel& channel = channels()[from.channel];
  if (channel.type == ChannelType::u64) {
    field_in(topic.integers, from.name, "uint64_t")
        .elements.push_back([&channel](const Trace& trace, std::size_t tick, Bytes& bytes) {
          append(integer_of(channel, trace.samples[tick]), bytes);
        });
  } else if (channel.type == ChannelType::u8) {
    field_in(topic.bytes, from.name, "uint8_t")
        .elements.push_back([&channel](const Trace& trace, std::size_t tick, Bytes& bytes) {
          append(static_cast<std::uint8_t>(value_of(channel, trace.samples[tick])), bytes);
        });
    if (from.state) add_state(*from.state, channel, topic);
  } else {
    float_in(topic, from.name)
        .elements.push_back([&channel](const Trace& trace, std::size_t tick, Bytes& bytes) {
          append(float_of(channel, trace.samples[tick]), bytes);
        });
  }
}

void add_topic(const LogTopic& from, const Trace& trace, Topics& topics) {
  const bool has_flag = from.is_new && trace.present[*from.is_new];
  const bool has_fields =
      std::any_of(from.fields.begin(), from.fields.end(),
                  [&](const LogField& field) { return trace.present[field.channel]; });
  if (!has_flag && !has_fields) return;
  Topic& topic = topics.topic(from.name, from.multi_id);
  if (has_flag) {
    topic.is_new = [&flag = channels()[*from.is_new]](const Trace& of, std::size_t tick) {
      return value_of(flag, of.samples[tick]) != 0;
    };
  }
  for (const LogField& field : from.fields) {
    if (trace.present[field.channel]) add_field(field, topic);
  }
}

// The topic and the field for a column of the plant. A column without a topic becomes a topic with
// the field `value`. A unit of v1.14 to v1.18 receives an estimate of the true state at other
// times. So if the unit has a topic of that name, the true state is in the topic `..._groundtruth`,
// as in PX4's simulators.
std::pair<std::string, std::string> plant_field(std::string_view path, Module module,
                                                const std::vector<LogTopic>& layout) {
  const auto dot = path.find('.');
  std::string topic(path.substr(0, path.find_first_of(".[")));
  const bool is_known = std::any_of(layout.begin(), layout.end(),
                                    [&](const LogTopic& one) { return one.name == topic; });
  if (is_known && info_of(module).is_of_cascade()) topic += "_groundtruth";
  if (dot != path.npos) return {topic, std::string(path.substr(dot + 1))};
  return {topic, fmt::format("value{}", path.substr(std::min(path.find('['), path.size())))};
}

// A topic with a field of the plant is logged at each tick. For the controller of v1.5.5 and
// v1.3.4, this includes battery_status, which also has a field of the inputs.
void add_plant(Module module, const std::vector<LogTopic>& layout, Topics& topics) {
  for (const PlantColumn& column : plant_columns()) {
    const std::string_view path = std::string_view(column.name).substr(plant_prefix.size());
    const auto [name, field] = plant_field(path, module, layout);
    Topic& topic = topics.topic(name, 0);
    float_in(topic, field)
        .elements.push_back([&column](const Trace& trace, std::size_t tick, Bytes& bytes) {
          append(column.value(trace.plant[tick]), bytes);
        });
    topic.is_new = [](const Trace&, std::size_t) { return true; };
  }
}

Topics topics_of(const Trace& trace, const std::vector<LogTopic>& layout) {
  Topics topics;
  for (const LogTopic& topic : layout) add_topic(topic, trace, topics);
  if (!trace.plant.empty()) add_plant(module_of(trace.present), layout, topics);
  topics.complete_instances();
  return topics;
}

Result<void> define_topics(const Topics& topics, ulog::Writer& writer) {
  std::set<std::string> defined;
  for (const Topic& topic : topics.all()) {
    if (!defined.insert(topic.name).second) continue;
    if (auto done = writer.define(topic.definition()); !done) return done;
  }
  return {};
}

Result<void> write_parameters(std::span<const ParameterChange> changes, ulog::Writer& writer) {
  for (const ParameterChange& change : changes) {
    if (auto written = writer.parameter(change.name, change.value); !written) return written;
  }
  return {};
}

Result<void> write_ticks(const Trace& trace, const Topics& topics, ulog::Writer& writer) {
  std::vector<std::uint16_t> ids;
  for (const Topic& topic : topics.all()) {
    const auto id = writer.subscribe(topic.name, topic.multi_id);
    if (!id) return tl::unexpected(id.error());
    ids.push_back(*id);
  }
  PendingChanges changes(trace.parameters);
  changes.take_until(0);
  for (std::size_t tick = 0; tick < trace.samples.size(); ++tick) {
    if (auto set = write_parameters(changes.take_until(tick), writer); !set) return set;
    for (std::size_t i = 0; i < ids.size(); ++i) {
      const Topic& topic = topics.all()[i];
      if (!topic.is_new(trace, tick)) continue;
      if (auto written = writer.data(ids[i], topic.data(trace, tick)); !written) return written;
    }
  }
  return {};
}

}  // namespace

Result<void> write_log(AtomicFile file, const Trace& trace) {
  const Module module = module_of(trace.present);
  if (!info_of(module).is_unit()) {
    return fail_at(file.path().string(),
                   "a ULog is for traces of the controller or of a unit of it; write a .csv");
  }
  const std::uint64_t start = trace.samples.empty() ? 0 : trace.samples.front().in.timestamp;
  ulog::Writer writer(std::move(file), start);
  const std::vector<LogTopic> layout = log_topics(module);  // the topics refer to it
  const Topics topics = topics_of(trace, layout);
  if (auto set = writer.info("sys_name", "attest"); !set) return set;
  if (!trace.source.empty()) {
    if (auto set = writer.info("attest_source", trace.source); !set) return set;
  }
  if (auto set = write_parameters(PendingChanges(trace.parameters).take_until(0), writer); !set) {
    return set;
  }
  if (auto defined = define_topics(topics, writer); !defined) return defined;
  if (auto written = write_ticks(trace, topics, writer); !written) return written;
  return writer.commit();
}

}  // namespace attest
