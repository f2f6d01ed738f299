#include "harness/host/table.hpp"

#include "harness/trace/csv.hpp"
#include "harness/trace/parameter_values.hpp"
#include "harness/trace/plant_columns.hpp"

namespace attest {
namespace {

bool is_of_a_name(char c) {
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

void add_channels(const Trace& trace, bool outputs, Table& table) {
  for (std::size_t i = 0; i < channels().size(); ++i) {
    const Channel& channel = channels()[i];
    if (!trace.present[i] || channel.is_output() != outputs) continue;
    Column& column = table.emplace_back(Column{std::string(channel.name), {}, channel.type});
    for (const Sample& sample : trace.samples) column.values.push_back(value_of(channel, sample));
  }
}

}  // namespace

Table table_of(const Trace& trace) {
  Table table = inputs_of(trace);
  add_channels(trace, true, table);
  if (trace.plant.empty()) return table;
  for (const PlantColumn& from : plant_columns()) {
    Column& column = table.emplace_back(Column{from.name, {}});
    for (const PlantSample& sample : trace.plant) column.values.push_back(from.value(sample));
  }
  return table;
}

Table inputs_of(const Trace& trace) {
  Table table;
  add_channels(trace, false, table);
  const std::vector<std::string> names = all_columns(trace).parameters;
  const std::size_t first = table.size();
  for (const std::string& name : names) {
    table.push_back({std::string(parameter_prefix) + name, {}, ChannelType::f32});
  }
  ParameterValues parameters(trace, names);
  for (std::size_t tick = 0; tick < trace.samples.size(); ++tick) {
    const std::vector<float>& values = parameters.at(tick);
    for (std::size_t i = 0; i < values.size(); ++i) table[first + i].values.push_back(values[i]);
  }
  return table;
}

std::string identifier_of(std::string_view name) {
  std::string identifier;
  bool is_gap = false;
  for (const char c : name) {
    if (!is_of_a_name(c)) {
      is_gap = !identifier.empty();
      continue;
    }
    if (is_gap) identifier += '_';
    is_gap = false;
    identifier += c;
  }
  return identifier;
}

}  // namespace attest
