#include "harness/casefile/parse.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "controller/actuation/mixer.hpp"
#include "harness/casefile/parse_flight.hpp"
#include "harness/casefile/parse_limits.hpp"
#include "harness/casefile/parse_profiles.hpp"
#include "harness/casefile/parse_rates.hpp"
#include "harness/casefile/parse_signal.hpp"
#include "harness/casefile/parse_topic.hpp"
#include "harness/casefile/parse_unit.hpp"
#include "harness/core/file.hpp"
#include "harness/core/printable.hpp"
#include "harness/core/suite_files.hpp"
#include "harness/core/toml.hpp"
#include "harness/port/profiles.hpp"

namespace attest {
namespace {

namespace fs = std::filesystem;

// The keys that give reasons or select profiles. They have no effect on inputs, expected outputs
// and tolerances.
constexpr std::array<std::string_view, 8> no_meaning{
    "why",      "rates_why", "tolerance.why", "flight.vehicles_why", "flight.plants_why",
    "profiles", "since",     "until"};

constexpr std::array<std::pair<std::string_view, Instances>, 7> instances_by_name{{
    {"again", Instances::again},
    {"together", Instances::together},
    {"crossed", Instances::crossed},
    {"after_many", Instances::after_many},
    {"among_many", Instances::among_many},
    {"other_profiles", Instances::other_profiles},
    {"two_threads", Instances::two_threads},
}};

Instances parse_instances(const TomlTable& root) {
  constexpr const char* key = "instances";
  if (!root.has(key)) return Instances::one;
  if (root.has("flight")) root.error(key, "is for open loop; leave [flight] out");
  const std::string text = root.text(key);
  std::vector<std::string_view> names;
  for (const auto& [name, instances] : instances_by_name) {
    if (text == name) return instances;
    names.push_back(name);
  }
  root.error(key, fmt::format("must be one of {}", fmt::join(names, ", ")));
  return Instances::one;
}

void check_module(const TomlTable& root, const Case& parsed) {
  for (const std::string& name : parsed.profiles) {
    const ProfileInfo* const profile = find_profile(name);
    if (!profile || contains(profile->modules, parsed.module)) continue;
    std::vector<std::string_view> names;
    for (const ModuleInfo& info : modules()) {
      if (contains(profile->modules, info.module)) names.push_back(info.name);
    }
    root.error("module", fmt::format("{} has no {}; its modules are {}", name,
                                     name_of(parsed.module), fmt::join(names, ", ")));
  }
}

// In a flight of the cascade the case is that of the rate unit, which commands the motors.
void parse_module_of_flight(const TomlTable& root, Case& parsed) {
  const ProfileInfo* const profile = find_profile(parsed.profile);
  const bool is_cascade = profile && contains(profile->modules, Module::rate_unit);
  if (!is_cascade) return;
  if (root.has("module")) {
    root.text("module");
    root.error("module", "both units of the cascade take part in a flight; leave it out");
  }
  parsed.module = Module::rate_unit;
  parsed.attitude_loop.emplace();
}

void parse_key_of_module(const TomlTable& root, const char* key, Case& parsed) {
  const auto module = module_named(root.text(key));
  const bool is_valid = module && info_of(*module).case_table.empty();
  if (!is_valid) {
    std::vector<std::string_view> names;
    for (const ModuleInfo& info : modules()) {
      if (info.case_table.empty()) names.push_back(info.name);
    }
    const auto last = names.end() - 1;
    root.error(key, fmt::format("must be {} or {}", fmt::join(names.begin(), last, ", "), *last));
  }
  if (parsed.module != Module::mc_att_control) {
    root.error(key, "is not for cases of mixer and battery estimate");
  } else if (is_valid) {
    parsed.module = *module;
  }
}

// A table such as `[mixer]`, or `module`, names the module under test. Without them it is the
// controller, or in a flight of the cascade the rate unit.
void parse_module(const TomlTable& root, Case& parsed) {
  constexpr const char* key = "module";
  for (const ModuleInfo& info : modules()) {
    if (info.case_table.empty() || !root.has(info.case_table)) continue;
    if (root.has("flight")) {
      root.error(info.case_table, "is a case of its own; leave [flight] out");
    }
    if (parsed.module == Module::mc_att_control) {
      parsed.module = info.module;
    } else {
      root.error(info.case_table,
                 fmt::format("`{}` is given too; keep one", info_of(parsed.module).case_table));
    }
  }
  if (root.has("flight")) {
    parse_module_of_flight(root, parsed);
  } else if (root.has(key)) {
    parse_key_of_module(root, key, parsed);
  }
  check_module(root, parsed);
  if (parsed.module != Module::mixer) return;
  const TomlTable table = root.table("mixer");
  parsed.mixer = table.text("definition");
  if (const auto mixer = actuation::parse_mixer(parsed.mixer); !mixer) {
    table.error("definition", mixer.error());
  }
}

void check_parameter_name(const TomlTable& table, const std::string& name, const Case& parsed) {
  for (const std::string& profile : parsed.profiles) {
    if (!find_profile(profile)) continue;  // its parameters are not known, either
    std::vector<std::string> known = parameter_names(parsed.module, profile);
    if (parsed.attitude_loop) {
      const auto others = parameter_names(Module::attitude_unit, profile);
      known.insert(known.end(), others.begin(), others.end());
    }
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    table.error(name,
                fmt::format("unknown parameter `{}`{}; `attest list --parameters --profile "
                            "{}` shows those of {}",
                            name, hint_for_parameter(name, profile, known), profile, profile));
    return;
  }
}

std::vector<ParameterStimulus> parse_parameters(const TomlTable& root, const Case& parsed) {
  std::vector<ParameterStimulus> parameters;
  if (!root.has("parameters")) return parameters;
  const TomlTable table = root.table("parameters");
  for (const std::string& name : table.keys()) {
    parameters.push_back({name, parse_signal(table, name)});
    check_parameter_name(table, name, parsed);
    if (!info_of(parsed.module).is_unit() && varies(parameters.back().signal)) {
      table.error(name, "does not change while it runs: give one value");
    }
  }
  return parameters;
}

void parse_tolerances(const TomlTable& root, Case& parsed) {
  if (!root.has("tolerance")) return;
  const TomlTable table = root.table("tolerance");
  parsed.tolerance_why = table.text("why");
  // The name of a topic comes before those of its fields, so that a field overrides its topic.
  std::vector<std::string> names = table.keys();
  std::sort(names.begin(), names.end());
  for (const std::string& name : names) {
    if (name == "why") continue;
    const TomlTable values = table.table(name);
    const Tolerance tolerance{values.number("absolute"), values.number("relative", 0)};
    const bool is_sane = tolerance.absolute >= 0 && tolerance.relative >= 0 &&
                         std::isfinite(tolerance.absolute) && std::isfinite(tolerance.relative);
    if (!is_sane) values.error("absolute", "tolerances must be finite and not negative");
    if (!Tolerances().set(name, tolerance)) {
      table.error(name, fmt::format("`{}` is no output topic or signal; `attest list --channels` "
                                    "shows them all",
                                    name));
    }
    parsed.tolerances.push_back({name, tolerance});
  }
}

// The path gives profile, group and name: cases/<profile>/<group>/<name>.toml.
void parse_identity(const TomlTable& root, const fs::path& file, Case& parsed) {
  // Normalised, because otherwise the folder of "./roll.toml" would be named ".".
  const fs::path folder = fs::absolute(file).lexically_normal().parent_path();
  parsed.name = file.stem().string();
  if (printable_part(parsed.name) != parsed.name) {
    root.error("group", fmt::format("a case must not be named `{}`: only UTF-8 without control "
                                    "characters; rename the file",
                                    printable_part(parsed.name)));
  }
  parsed.profile = folder.parent_path().filename().string();
  parsed.profiles = parse_profiles(root, parsed.profile);
  parsed.group = root.text("group");
  parsed.why = root.text("why");
  if (root.has("group") && parsed.group != folder.filename()) {
    root.error("group", fmt::format("is `{}`, but the folder is `{}`", parsed.group,
                                    folder.filename().string()));
  }
  if (root.has("why") && parsed.why.empty()) root.error("why", "must say why the case exists");
}

// The number of ticks at the fastest rate; 0 without a rate, which parse_rates() reports.
std::int64_t most_ticks(const Case& parsed) {
  return parsed.rates.empty() ? 0 : tick_count(parsed.duration, parsed.rates.back().motor_unit);
}

void parse_duration(const TomlTable& root, Case& parsed) {
  parsed.duration = parse_span(root, "duration");
  const Span& duration = parsed.duration;
  const std::string key = span_key(root, "duration");
  if (key.empty()) return;
  if (parsed.attitude_loop && duration.in == Span::In::ticks) {
    root.error(key, "the two units have different ticks: give `duration_s`");
  }
  if (!(duration.amount >= 1e-6)) root.error(key, "must be positive");
  if (duration.in == Span::In::ticks && duration.amount != std::floor(duration.amount)) {
    root.error(key, "must be a whole number");
  }
  if (most_ticks(parsed) > max_ticks) {
    root.error(key, fmt::format("is more than {} ticks at {} Hz", max_ticks,
                                parsed.rates.back().to_string()));
  }
}

// The folder of models: <suite>/cases/<profile>/<group>/<name>.toml uses <suite>/models.
fs::path models_of_suite(const fs::path& file) {
  const fs::path folder = fs::absolute(file).lexically_normal().parent_path();
  return folder.parent_path().parent_path().parent_path() / "models";
}

void parse_units(const TomlTable& root, Case& parsed) {
  std::vector<Rate> rates, attitude_rates;
  for (const LoopRate& rate : parsed.rates) {
    rates.push_back(rate.motor_unit);
    attitude_rates.push_back(rate.attitude_unit.value_or(rate.motor_unit));
  }
  parsed.unit = parse_unit(root);
  check_unit(root, "unit", parsed.unit, rates, parsed.duration);
  if (!parsed.attitude_loop) return;
  constexpr const char* name = "attitude_unit";
  parsed.attitude_loop->unit = parse_unit(root, name);
  check_unit(root, name, parsed.attitude_loop->unit, attitude_rates, parsed.duration);
  for (const char* table : {"unit", name}) {
    if (root.has(table) && root.table(table).has("trigger")) {
      root.table(table).error("trigger",
                              "is for the controller; the units of the cascade are "
                              "stepped at their own rates");
    }
  }
  if (root.has(name) && root.table(name).has("start_s")) {
    root.table(name).error("start_s", "is that of [unit]: both units have one clock");
  }
  parsed.attitude_loop->topics = parse_topics(root, Module::attitude_unit, true);
}

void parse_body(const TomlTable& root, Case& parsed) {
  if (root.integer("schema") != schema_version && root.has("schema")) {
    root.error("schema", fmt::format("must be {}", schema_version));
  }
  parse_module(root, parsed);
  parsed.rates = parse_rates(root, parsed);
  parse_duration(root, parsed);
  if (root.has("level")) {
    parsed.exact_only = root.text("level") == "exact";
    if (!parsed.exact_only) root.error("level", "must be exact");
  }
  parsed.instances = parse_instances(root);
  parse_units(root, parsed);
  parsed.parameters = parse_parameters(root, parsed);
  parsed.topics = parse_topics(root, parsed.module, root.has("flight"));
  if (root.has("flight")) parse_flight(root, models_of_suite(parsed.file), parsed);
  parse_tolerances(root, parsed);
  check_limits(root, parsed);
}

}  // namespace

Result<Case> parse_case(const fs::path& file) {
  return read_suite_file(file).and_then(
      [&](const std::string& text) { return parse_case_text(text, file); });
}

Result<Case> parse_case_text(std::string_view text, const fs::path& file) {
  auto toml = TomlFile::parse(text, file.string());
  if (!toml) return tl::unexpected(toml.error());
  Case parsed;
  parsed.file = file;
  parsed.file_sha256 = sha256(text);
  parsed.sha256 = sha256(toml->canonical(no_meaning));
  const TomlTable root = toml->root();
  parse_identity(root, file, parsed);
  parse_body(root, parsed);
  if (auto done = toml->finish(); !done) return tl::unexpected(done.error());
  return parsed;
}

Result<std::vector<fs::path>> find_case_files(const CaseFolders& folders) {
  std::map<std::string, fs::path> by_path;  // below its folder -> the file
  for (const fs::path& folder : folders) {
    auto found = suite_files_below(folder);
    if (!found) return found;
    std::erase_if(*found, [](const fs::path& file) { return file.extension() != ".toml"; });
    for (fs::path& file : *found) {
      std::string below = file.native().substr(folder.native().size());
      by_path.insert_or_assign(by_path.end(), std::move(below), std::move(file));
    }
    if (found->empty()) {
      return fail_at(folder.string(), "no case files (<profile>/<group>/<behaviour>.toml) in here");
    }
  }
  std::vector<fs::path> files;
  for (auto& [path, file] : by_path) files.push_back(std::move(file));
  return files;
}

}  // namespace attest
