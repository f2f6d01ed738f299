#include <algorithm>

#include <fmt/format.h>

#include "harness/core/file.hpp"
#include "harness/trace/csv.hpp"
#include "harness/trace/csv_text.hpp"
#include "harness/trace/parameter_values.hpp"
#include "harness/trace/plant_columns.hpp"

namespace attest {
namespace {

// Checks that the reader will find every change again in the parameter's column: the parameter has
// a value from the first row on, and PARAMETER_UPDATE is set where it changes.
Result<void> check_changes(const Trace& trace, const std::string& parameter) {
  bool has_value = false;
  for (const ParameterChange& change : trace.parameters) {
    if (change.name != parameter) continue;
    has_value = has_value || change.tick == 0;
    if (!has_value) {
      return fail_at(trace.source, fmt::format("parameter {} changes at tick {} but has no value "
                                               "before; set it at tick 0",
                                               parameter, change.tick));
    }
    const bool in_trace = change.tick < trace.samples.size();
    const bool announced =
        in_trace && (trace.samples[change.tick].in.updated & ATTEST_UPDATED_PARAMETER_UPDATE) != 0;
    if (change.tick > 0 && !announced) {
      return fail_at(trace.source, fmt::format("parameter {} changes at tick {}, which does not "
                                               "have in/updated.parameter_update; set it there",
                                               parameter, change.tick));
    }
  }
  if (!has_value && !trace.samples.empty()) {
    return fail_at(trace.source,
                   fmt::format("parameter {} has no value; set it at tick 0", parameter));
  }
  return {};
}

std::vector<const Channel*> chosen(const ChannelSet& set, bool outputs) {
  std::vector<const Channel*> list;
  for (std::size_t i = 0; i < channels().size(); ++i) {
    if (set[i] && channels()[i].is_output() == outputs) list.push_back(&channels()[i]);
  }
  return list;
}

}  // namespace

CsvColumns all_columns(const Trace& trace) {
  CsvColumns columns{trace.present, {}};
  for (const ParameterChange& change : trace.parameters) {
    const auto found = std::find(columns.parameters.begin(), columns.parameters.end(), change.name);
    if (found == columns.parameters.end()) columns.parameters.push_back(change.name);
  }
  return columns;
}

Result<void> write_csv(const std::filesystem::path& path, const Trace& trace,
                       const CsvColumns& columns) {
  return AtomicFile::open(path).and_then(
      [&](AtomicFile&& file) { return write_csv(std::move(file), trace, columns); });
}

Result<void> write_csv(AtomicFile file, const Trace& trace, const CsvColumns& columns) {
  for (const std::string& parameter : columns.parameters) {
    if (auto checked = check_changes(trace, parameter); !checked) return checked;
  }
  const std::vector<const Channel*> inputs = chosen(columns.channels, false);
  const std::vector<const Channel*> outputs = chosen(columns.channels, true);
  CsvText text(file);
  for (const Channel* channel : inputs) text.name(channel->name);
  for (const std::string& parameter : columns.parameters) {
    text.name(fmt::format("{}{}", parameter_prefix, parameter));
  }
  for (const Channel* channel : outputs) text.name(channel->name);
  if (!columns.profile.empty()) text.name(fmt::format("{}{}", profile_prefix, columns.profile));
  if (columns.plant) {
    for (const PlantColumn& column : plant_columns()) text.name(column.name);
  }
  text.end_row();

  ParameterValues parameters(trace, columns.parameters);
  for (std::size_t tick = 0; tick < trace.samples.size(); ++tick) {
    const Sample& sample = trace.samples[tick];
    for (const Channel* channel : inputs) text.value_of(*channel, sample);
    for (const float value : parameters.at(tick)) text.number(value);
    for (const Channel* channel : outputs) text.value_of(*channel, sample);
    if (!columns.profile.empty()) text.number(1.0f);
    if (columns.plant) {
      for (const PlantColumn& column : plant_columns()) {
        text.number(column.value(trace.plant[tick]));
      }
    }
    text.end_row();
  }
  if (auto written = text.finish(); !written) return written;
  return file.commit();
}

}  // namespace attest
