#include "harness/trace/mixer_csv.hpp"

#include <algorithm>
#include <span>
#include <string_view>

#include <fmt/format.h>

#include "harness/core/nearest.hpp"
#include "harness/trace/csv_rows.hpp"
#include "harness/trace/csv_text.hpp"

namespace attest {
namespace {

struct Named {
  std::string_view name;
  CsvColumn column;
};

constexpr Named number(std::string_view name, std::size_t offset) {
  return {name, {ChannelType::f32, offset, 0}};
}

constexpr Named out(std::string_view name, std::size_t rotor) {
  return number(name, offsetof(MixerSample, out) + rotor * sizeof(float));
}

constexpr Named flag(std::string_view name, std::size_t offset) {
  return {name, {ChannelType::u8, offset, 0}};
}

constexpr std::array<Named, 16> table = {{
    number("roll", offsetof(MixerSample, roll)),
    number("pitch", offsetof(MixerSample, pitch)),
    number("yaw", offsetof(MixerSample, yaw)),
    number("thrust", offsetof(MixerSample, thrust)),
    number("delta_out_max", offsetof(MixerSample, delta_out_max)),
    out("out[0]", 0),
    out("out[1]", 1),
    out("out[2]", 2),
    out("out[3]", 3),
    out("out[4]", 4),
    out("out[5]", 5),
    out("out[6]", 6),
    out("out[7]", 7),
    flag("lower_limit", offsetof(MixerSample, lower_limit)),
    flag("upper_limit", offsetof(MixerSample, upper_limit)),
    flag("yaw_limit", offsetof(MixerSample, yaw_limit)),
}};

bool is_out(std::string_view name) { return name.starts_with("out["); }

// The columns of a mixer with that many rotors, in file order.
std::vector<Named> columns_for(std::size_t rotors) {
  std::vector<Named> columns;
  std::size_t outs = 0;
  for (const Named& named : table) {
    if (!is_out(named.name) || outs++ < rotors) columns.push_back(named);
  }
  return columns;
}

const Named* find(std::string_view name) {
  const auto found = std::find_if(table.begin(), table.end(),
                                  [&](const Named& named) { return named.name == name; });
  return found == table.end() ? nullptr : &*found;
}

Result<std::vector<CsvColumn>> columns_of(const CsvRows& rows) {
  std::vector<CsvColumn> columns;
  for (std::size_t i = 0; i < rows.header().size(); ++i) {
    const std::string_view name = rows.header()[i];
    const Named* named = find(name);
    if (named == nullptr) {
      std::vector<std::string> names;
      for (const Named& known : table) names.emplace_back(known.name);
      return rows.fail_at_name(i, fmt::format("unknown column {} in a mixer trace{}",
                                              in_backquotes(name), suggestion(name, names)));
    }
    columns.push_back(named->column);
  }
  return columns;
}

// The number of rotors, once all columns for them are there.
Result<std::size_t> rotors_of(const CsvRows& rows) {
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
  return rotors;
}

}  // namespace

Result<MixerTrace> read_mixer_csv(const std::filesystem::path& path) {
  auto rows = CsvRows::open(path);
  if (!rows) return tl::unexpected(rows.error());
  auto columns = columns_of(*rows);
  if (!columns) return tl::unexpected(columns.error());
  const auto rotors = rotors_of(*rows);
  if (!rotors) return tl::unexpected(rotors.error());
  rows->set_columns(*std::move(columns));

  MixerTrace trace{rows->file(), *rotors, {}};
  MixerSample sample{};
  while (true) {
    const auto more = rows->next(&sample);
    if (!more) return tl::unexpected(more.error());
    if (!*more) break;
    trace.samples.push_back(sample);
  }
  if (trace.samples.empty()) {
    return fail_at(rows->file(), "no rows; a mixer trace has a row for each call", 2);
  }
  return trace;
}

Result<void> write_mixer_csv(const MixerTrace& trace, AtomicFile& file) {
  CsvText text(file);
  for (const Named& named : columns_for(trace.rotors)) text.name(named.name);
  text.end_row();
  for (const MixerSample& sample : trace.samples) {
    for (const float value :
         {sample.roll, sample.pitch, sample.yaw, sample.thrust, sample.delta_out_max}) {
      text.number(value);
    }
    for (const float value : std::span(sample.out).first(trace.rotors)) text.number(value);
    for (const std::uint8_t limit : {sample.lower_limit, sample.upper_limit, sample.yaw_limit}) {
      text.integer(limit);
    }
    text.end_row();
  }
  return text.finish();
}

bool looks_like_mixer_csv(const std::filesystem::path& path) {
  const auto rows = CsvRows::open(path);
  return rows && std::any_of(rows->header().begin(), rows->header().end(),
                             [](const std::string& name) { return find(name) != nullptr; });
}

}  // namespace attest
