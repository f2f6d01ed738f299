#include "harness/trace/provenance.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <system_error>

#include <fmt/format.h>

#include "harness/core/file.hpp"
#include "harness/core/suggestion.hpp"
#include "harness/core/toml.hpp"

namespace attest {
namespace {

constexpr const char* constants_table = "constants";

bool is_integer_up_to(double value, double highest) {
  return value >= 0 && value <= highest && value == std::floor(value);
}

// One channel of that name; those of all modules have the same type.
std::optional<std::size_t> any_channel(std::string_view name) {
  const ChannelSet set = channels_named(name);
  return set.any() ? std::optional(set._Find_first()) : std::nullopt;
}

// The error of a constant; empty if it is valid.
std::string complaint_about(std::string_view name, double value) {
  const auto index = any_channel(name);
  if (!index && !parameter_of(name)) {
    const auto all = names_of(ChannelSet().set());
    const std::vector<std::string> names(all.begin(), all.end());
    return fmt::format("unknown signal `{}`{}", name, suggestion(name, names));
  }
  switch (index ? channels()[*index].type : ChannelType::f32) {
    case ChannelType::u64:
      if (name == channels()[0].name) {
        return fmt::format("`{}` cannot be a constant; record it as a column", name);
      }
      if (is_integer_up_to(value, 0x1p53)) return "";
      return fmt::format("{} is not a time for `{}`; write an integer [us]", value, name);
    case ChannelType::f32:
      if (!std::isfinite(value) || std::isfinite(static_cast<float>(value))) return "";
      return fmt::format("{} is too large for `{}`, a 32-bit float", value, name);
    case ChannelType::u8:
      if (is_integer_up_to(value, 255)) return "";
      return fmt::format("{} is not a flag for `{}`; write an integer from 0 to 255", value, name);
    case ChannelType::bit:
      if (is_integer_up_to(value, 1)) return "";
      return fmt::format("{} is not a bit for `{}`; write 0 or 1", value, name);
  }
  return "";
}

std::map<std::string, double> read_constants(const TomlTable& table) {
  std::map<std::string, double> constants;
  for (const std::string& name : table.keys()) {
    const double value = table.number(name);
    const std::string complaint = complaint_about(name, value);
    if (!complaint.empty()) table.error(name, complaint);
    constants[name] = value;
  }
  return constants;
}

std::map<std::string, std::string> read_texts(const TomlTable& root, std::string_view key) {
  std::map<std::string, std::string> texts;
  if (!root.has(key)) return texts;
  const TomlTable table = root.table(key);
  for (const std::string& name : table.keys()) texts[name] = table.text(name);
  return texts;
}

std::map<std::string, double> read_numbers(const TomlTable& root, std::string_view key) {
  std::map<std::string, double> numbers;
  if (!root.has(key)) return numbers;
  const TomlTable table = root.table(key);
  for (const std::string& name : table.keys()) numbers[name] = table.number(name);
  return numbers;
}

// Two values have the same canonical bits if they are the same in a trace file: -0 and 0 differ,
// all NaN are equal.
std::uint64_t canonical_bits(double value) {
  return std::bit_cast<std::uint64_t>(std::isnan(value) ? std::numeric_limits<double>::quiet_NaN()
                                                        : value);
}

// The value of a channel if it is the same in every sample, and a double can hold it.
std::optional<double> constant_value(const Channel& channel, const std::vector<Trace>& traces) {
  const Sample& first = traces.front().samples.front();
  constexpr std::uint64_t inexact_from = std::uint64_t{1} << 53;
  if (channel.type == ChannelType::u64 && integer_of(channel, first) >= inexact_from) return {};
  for (const Trace& trace : traces) {
    for (const Sample& sample : trace.samples) {
      if (!same_bits(channel, sample, first)) return std::nullopt;
    }
  }
  return value_of(channel, first);
}

bool is_same(const Channel& channel, const std::vector<Trace>& traces,
             const std::vector<Trace>& base) {
  for (std::size_t i = 0; i < traces.size(); ++i) {
    for (std::size_t tick = 0; tick < traces[i].samples.size(); ++tick) {
      if (!same_bits(channel, traces[i].samples[tick], base[i].samples[tick])) return false;
    }
  }
  return true;
}

// The value of a parameter if every trace with parameters sets it at tick 0 and always to the same
// value.
std::optional<double> constant_value(const std::string& parameter,
                                     const std::vector<Trace>& traces) {
  std::optional<double> value;
  for (const Trace& trace : traces) {
    if (trace.parameters.empty()) continue;
    bool is_set = false;
    for (const ParameterChange& change : trace.parameters) {
      if (change.name != parameter) continue;
      is_set = is_set || change.tick == 0;
      const auto changed = static_cast<double>(change.value);
      if (!is_set || (value && canonical_bits(*value) != canonical_bits(changed))) {
        return std::nullopt;
      }
      value = changed;
    }
    if (!is_set) return std::nullopt;
  }
  return value;
}

void write_constants(const std::map<std::string, double>& constants, TomlWriter& toml) {
  for (const auto& [name, value] : constants) {
    const auto index = any_channel(name);
    const bool is_flag = index && channels()[*index].type != ChannelType::f32;
    if (is_flag) {
      toml.set(constants_table, name, static_cast<std::int64_t>(value));
    } else {
      toml.set(constants_table, name, value);
    }
  }
}

}  // namespace

Result<Provenance> read_provenance(const std::filesystem::path& file) {
  return read_file(file).and_then(
      [&](const std::string& text) { return parse_provenance(text, file); });
}

Result<Provenance> parse_provenance(std::string_view text, const std::filesystem::path& file) {
  const auto toml = TomlFile::parse(text, file.string());
  if (!toml) return tl::unexpected(toml.error());
  const TomlTable root = toml->root();
  Provenance provenance;
  provenance.profile = root.text("profile", "");
  provenance.case_id = root.text("case_id", "");
  provenance.case_sha256 = root.text("case_sha256", "");
  provenance.reference = root.text("reference", "");
  provenance.compiler = root.text("compiler", "");
  provenance.reason = root.text("reason", "");
  if (root.has(constants_table)) {
    provenance.constants = read_constants(root.table(constants_table));
  }
  if (root.has("covers")) provenance.covers = root.texts("covers");
  provenance.mixers = read_texts(root, "mixers");
  provenance.sha256 = read_texts(root, "sha256");
  provenance.base = root.text("base", "");
  provenance.base_sha256 = read_texts(root, "base_sha256");
  provenance.horizon_s = read_numbers(root, "horizon_s");
  provenance.metrics = read_numbers(root, "metrics");
  provenance.models = read_texts(root, "models");
  if (const auto done = toml->finish(); !done) return tl::unexpected(done.error());
  return provenance;
}

Result<Provenance> provenance_in(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / provenance_name;
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) return Provenance{};
  return read_provenance(file);
}

std::string to_toml(const Provenance& provenance) {
  TomlWriter toml;
  const auto set = [&](std::string_view key, const std::string& value) {
    if (!value.empty()) toml.set("", key, value);
  };
  set("profile", provenance.profile);
  set("case_id", provenance.case_id);
  set("case_sha256", provenance.case_sha256);
  set("reference", provenance.reference);
  set("compiler", provenance.compiler);
  set("reason", provenance.reason);
  set("base", provenance.base);
  write_constants(provenance.constants, toml);
  for (const auto& [stem, geometry] : provenance.mixers) toml.set("mixers", stem, geometry);
  for (const auto& [name, hash] : provenance.sha256) toml.set("sha256", name, hash);
  for (const auto& [name, hash] : provenance.base_sha256) toml.set("base_sha256", name, hash);
  for (const auto& [stem, value] : provenance.horizon_s) toml.set("horizon_s", stem, value);
  for (const auto& [name, value] : provenance.metrics) toml.set("metrics", name, value);
  for (const auto& [name, hash] : provenance.models) toml.set("models", name, hash);
  return toml.to_string();
}

namespace {

constexpr std::string_view seal_prefix = "# SHA-256 of the lines above: ";

}  // namespace

std::string sealed(std::string_view toml) {
  return fmt::format("{}{}{}\n", toml, seal_prefix, sha256(toml));
}

Result<void> check_seal(std::string_view text, const std::filesystem::path& file) {
  const std::size_t seal = text.rfind(seal_prefix);
  if (seal != std::string_view::npos && text == sealed(text.substr(0, seal))) return {};
  return fail_at(file.string(),
                 "was changed after it was blessed (the SHA-256 in its last line is of other "
                 "text); restore it from version control, or bless it anew");
}

Division divide(const std::vector<Trace>& traces) {
  const CsvColumns all = all_columns(traces.front());
  Division division{{all.channels, {}}, {}};
  for (std::size_t i = 0; i < channels().size(); ++i) {
    const Channel& channel = channels()[i];
    if (!all.channels[i] || i == 0) continue;
    if (const auto value = constant_value(channel, traces)) {
      division.columns.channels.reset(i);
      division.constants[std::string(channel.name)] = *value;
    }
  }
  for (const std::string& parameter : all.parameters) {
    if (const auto value = constant_value(parameter, traces)) {
      division.constants[std::string(parameter_prefix) + parameter] = *value;
    } else {
      division.columns.parameters.push_back(parameter);
    }
  }
  return division;
}

Division divide(const std::vector<Trace>& traces, const std::vector<Trace>& base) {
  Division division = divide(traces);
  for (std::size_t i = 0; i < channels().size(); ++i) {
    const Channel& channel = channels()[i];
    if (i == 0 || !traces.front().present[i] || !is_same(channel, traces, base)) continue;
    division.columns.channels.reset(i);
    division.constants.erase(std::string(channel.name));
  }
  division.columns.parameters.clear();
  std::erase_if(division.constants,
                [](const auto& constant) { return parameter_of(constant.first).has_value(); });
  return division;
}

Result<void> add_origin(const std::filesystem::path& folder, const std::string& profile,
                        const std::map<std::string, std::string>& mixers) {
  auto provenance = provenance_in(folder);
  if (!provenance) return tl::unexpected(provenance.error());
  provenance->profile = profile;
  for (const auto& [stem, mixer] : mixers) provenance->mixers[stem] = mixer;
  return write_file(folder / provenance_name, to_toml(*provenance), AtomicFile::Special::replaced);
}

}  // namespace attest
