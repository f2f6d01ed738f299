#include "harness/trace/mixer_csv.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include <fmt/format.h>

#include "harness/core/suggestion.hpp"

namespace attest {
namespace {

struct Named {
  std::string_view name;
  std::string_view channel;
};

constexpr std::array<Named, 16> mixer_columns = {{
    {"roll", "in/actuator_controls_0.control[0]"},
    {"pitch", "in/actuator_controls_0.control[1]"},
    {"yaw", "in/actuator_controls_0.control[2]"},
    {"thrust", "in/actuator_controls_0.control[3]"},
    {"delta_out_max", "in/mixer.delta_out_max"},
    {"out[0]", "out/actuator_outputs.output[0]"},
    {"out[1]", "out/actuator_outputs.output[1]"},
    {"out[2]", "out/actuator_outputs.output[2]"},
    {"out[3]", "out/actuator_outputs.output[3]"},
    {"out[4]", "out/actuator_outputs.output[4]"},
    {"out[5]", "out/actuator_outputs.output[5]"},
    {"out[6]", "out/actuator_outputs.output[6]"},
    {"out[7]", "out/actuator_outputs.output[7]"},
    {"lower_limit", "out/multirotor_motor_limits.lower_limit"},
    {"upper_limit", "out/multirotor_motor_limits.upper_limit"},
    {"yaw_limit", "out/multirotor_motor_limits.yaw"},
}};

bool is_out(std::string_view name) { return name.starts_with("out["); }

// The columns of a mixer with that many rotors.
std::vector<Named> columns_for(std::size_t rotors) {
  std::vector<Named> columns;
  std::size_t outs = 0;
  for (const Named& named : mixer_columns) {
    if (!is_out(named.name) || outs++ < rotors) columns.push_back(named);
  }
  return columns;
}

const Named* find(std::string_view name) {
  const auto found = std::find_if(mixer_columns.begin(), mixer_columns.end(),
                                  [&](const Named& named) { return named.name == name; });
  return found == mixer_columns.end() ? nullptr : &*found;
}

Result<std::vector<CsvColumn>> columns_of(const CsvRows& rows, ChannelSet& present) {
  std::vector<CsvColumn> columns;
  for (std::size_t i = 0; i < rows.header().size(); ++i) {
    const std::string_view name = rows.header()[i];
    const Named* named = find(name);
    if (named == nullptr) {
      std::vector<std::string> names;
      for (const Named& known : mixer_columns) names.emplace_back(known.name);
      return rows.fail_at_name(i, fmt::format("unknown column {} in a mixer trace{}",
                                              in_backquotes(name), suggestion(name, names)));
    }
    const std::size_t index = *find_channel(Module::mixer, named->channel);
    columns.push_back({cell_type(channels()[index].type), channels()[index].offset});
    present.set(index);
  }
  return columns;
}

// Checks that there are 4, 6 or 8 out[] columns, and all other columns of a mixer.
Result<void> check_rotors(const CsvRows& rows) {
  const std::vector<std::string>& header = rows.header();
  const auto rotors = static_cast<std::size_t>(std::count_if(header.begin(), header.end(), is_out));
  if (rotors != 4 && rotors != 6 && rotors != 8) {
    return fail_at(rows.file(),
                   fmt::format("{} out[] columns; a mixer has 4, 6 or 8 rotors", rotors), 1);
  }
  for (const Named& named : columns_for(rotors)) {
    if (std::find(header.begin(), header.end(), named.name) != header.end()) continue;
    return fail_at(rows.file(), fmt::format("no column {}; add it", named.name), 1);
  }
  return {};
}

}  // namespace

Result<std::vector<CsvColumn>> mixer_columns_of(const CsvRows& rows, ChannelSet& present) {
  auto columns = columns_of(rows, present);
  if (!columns) return columns;
  if (auto checked = check_rotors(rows); !checked) return tl::unexpected(checked.error());
  return columns;
}

bool has_mixer_columns(const CsvRows& rows) {
  return std::any_of(rows.header().begin(), rows.header().end(),
                     [](const std::string& name) { return find(name) != nullptr; });
}

}  // namespace attest
