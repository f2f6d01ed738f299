#include "harness/trace/csv_layout.hpp"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include "harness/core/suggestion.hpp"
#include "harness/trace/csv.hpp"
#include "harness/trace/plant_columns.hpp"

namespace attest {
namespace {

constexpr CsvColumn ignored_column{CellType::ignored, 0};

// The firmware of the cascade publishes this topic too; attest_cascade.h says why the ABI lacks it.
constexpr std::string_view left_out_of_the_abi = "out/actuator_controls_status.";

// Whether an unknown column is ignored: only in a trace to be replayed, and only if its name cannot
// be a misspelt one of attest's. `suggestion`: a similar known name, or empty.
bool may_be_ignored(std::string_view name, const CsvRows& rows, const std::string& suggestion,
                    TraceNeed need) {
  const auto& header = rows.header();
  const bool is_a_trace =
      std::find(header.begin(), header.end(), channels()[timestamp_channel].name) != header.end();
  if (need != TraceNeed::inputs_and_outputs || !is_a_trace) return false;
  if (name.starts_with(left_out_of_the_abi)) return true;
  return suggestion.empty() && !name.starts_with("in/") && !name.starts_with("out/");
}

}  // namespace

Result<void> refuse_golden(const CsvRows& rows) {
  if (rows.header().front() != "profiles") return {};
  return fail_at(rows.file(),
                 "is a golden, which has no inputs, and no trace; `attest vectors DIR` writes the "
                 "inputs, and `attest run` compares a port with the golden",
                 1, 1);
}

Result<CsvLayout> layout_of(const CsvRows& rows, Module module, TraceNeed need) {
  if (auto refused = refuse_golden(rows); !refused) return tl::unexpected(refused.error());
  CsvLayout layout;
  for (std::size_t i = 0; i < rows.header().size(); ++i) {
    const std::string_view name = rows.header()[i];
    if (const auto index = find_channel(module, name)) {
      const Channel& channel = channels()[*index];
      layout.columns.push_back({cell_type(channel.type), channel.offset, channel.bit});
      layout.present.set(*index);
    } else if (const auto parameter = parameter_of(name)) {
      const std::size_t offset = parameters_offset + sizeof(float) * layout.parameters.size();
      layout.columns.push_back({CellType::f32, offset});
      layout.parameters.emplace_back(*parameter);
    } else if (name.starts_with(profile_prefix)) {
      if (!layout.profile.empty()) {
        return rows.fail_at_name(
            i, fmt::format("another column says {}; keep the right one", layout.profile));
      }
      layout.columns.push_back(ignored_column);
      layout.profile = name.substr(profile_prefix.size());
    } else if (name.starts_with(plant_prefix)) {
      layout.columns.push_back(ignored_column);
    } else {
      std::vector<std::string> names;
      for (const std::string_view known : names_of(channels_of(module))) names.emplace_back(known);
      const std::string meant = suggestion(name, names);
      if (channels_named(name).any()) {
        return rows.fail_at_name(
            i, fmt::format("{} is of another module than {}; keep the columns of one module",
                           in_backquotes(name), name_of(module)));
      }
      if (!may_be_ignored(name, rows, meant, need)) {
        return rows.fail_at_name(
            i, fmt::format("unknown column {}{}", in_backquotes(name),
                           meant.empty() ? "; `attest list --channels` shows the columns of a trace"
                                         : meant));
      }
      layout.columns.push_back(ignored_column);
      layout.ignored.emplace_back(name);
    }
  }
  return layout;
}

Result<void> check_need(const ChannelSet& present, TraceNeed need, const std::string& file) {
  const auto missing = [&](std::string_view name, std::size_t others, std::string_view what_to_do) {
    const std::string more = others == 0 ? "" : fmt::format(" (nor {} others)", others);
    return fail_at(file, fmt::format("no column {}{}; {}", name, more, what_to_do), 1);
  };
  if (!present[timestamp_channel]) {
    return missing("timestamp", 0, "add the time of each sample in microseconds");
  }
  const Module module = module_of(present);
  const ChannelSet absent = channels_of(module, "in/") & ~present;
  if (need != TraceNeed::outputs && absent.any()) {
    const std::string_view name = channels()[absent._Find_first()].name;
    return missing(name, absent.count() - 1, "add the column");
  }
  if (need != TraceNeed::inputs && (present & channels_of(module, "out/")).none()) {
    return missing("out/...", 0, "add at least one output of the unit");
  }
  return {};
}

}  // namespace attest
