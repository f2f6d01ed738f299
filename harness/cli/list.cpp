#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/casefile/flight_mode.hpp"
#include "harness/casefile/stimulus.hpp"
#include "harness/cli/new_folder.hpp"
#include "harness/cli/outputs.hpp"
#include "harness/cli/shared_arguments.hpp"
#include "harness/cli/suite_folder.hpp"
#include "harness/core/suite_files.hpp"
#include "harness/plant/vehicle.hpp"
#include "harness/port/features.hpp"
#include "harness/port/profiles.hpp"
#include "harness/report/text.hpp"
#include "harness/trace/channels.hpp"

namespace attest::cli {
namespace {

struct ListOptions {
  SelectionOptions select;
  bool groups = false, parameters = false, channels = false, modes = false, vehicles = false,
       features = false;
  std::string extract;  // a new folder; empty: not asked for
};

// The requested profiles; by default all.
Result<std::vector<const ProfileInfo*>> chosen_profiles(const std::vector<std::string>& names) {
  if (auto known = check_profiles(names); !known) return tl::unexpected(known.error());
  std::vector<const ProfileInfo*> profiles;
  for (const std::string& name : names) profiles.push_back(find_profile(name));
  if (!profiles.empty()) return profiles;
  for (const ProfileInfo& profile : known_profiles()) profiles.push_back(&profile);
  return profiles;
}

// A parameter and the profiles that have it with the same default and bounds.
struct Listed {
  Parameter parameter;
  std::string profiles;
};

std::vector<Listed> listed_parameters(Module module,
                                      const std::vector<const ProfileInfo*>& profiles) {
  std::vector<Listed> rows;
  for (const ProfileInfo* profile : profiles) {
    for (const Parameter& parameter : parameters_of(module, *profile)) {
      const auto same = std::find_if(rows.begin(), rows.end(), [&](const Listed& row) {
        const Parameter& other = row.parameter;
        return std::tie(other.name, other.default_value, other.min, other.max) ==
               std::tie(parameter.name, parameter.default_value, parameter.min, parameter.max);
      });
      Listed& row = same == rows.end() ? rows.emplace_back(Listed{parameter, ""}) : *same;
      row.profiles += fmt::format("{}{}", row.profiles.empty() ? "" : " ", profile->name);
    }
  }
  return rows;
}

// Notes which of the profiles were read before their release: apart from the list, which programs
// may read.
void note_as_of(const std::set<std::string_view>& names) {
  for (const ProfileInfo& profile : known_profiles()) {
    if (profile.as_of.empty() || !names.contains(profile.name)) continue;
    fmt::print(stderr, "attest: note: {} is the law as of {}; the final release may differ\n",
               profile.name, profile.as_of);
  }
}

void note_as_of(const std::vector<SelectedCase>& cases) {
  std::set<std::string_view> names;
  for (const SelectedCase& selected : cases) names.insert(selected.the_case.profile);
  note_as_of(names);
}

void list_parameters(const std::vector<const ProfileInfo*>& profiles) {
  constexpr const char* row = "{:<17}{:>9}{:>8}{:>8}  {:<8} {:<22} {}\n";
  const char* separator = "";
  for (const ModuleInfo& info : modules()) {
    const std::vector<Listed> rows = listed_parameters(info.module, profiles);
    if (rows.empty()) continue;
    fmt::print("{}of {}:\n", std::exchange(separator, "\n"), info.name);
    fmt::print(row, "parameter", "default", "min", "max", "unit", "profiles", "what it does");
    for (const auto& [parameter, names] : rows) {
      const auto bound = [](float value) {
        return std::isinf(value) ? std::string() : fmt::format("{}", value);
      };
      fmt::print(row, parameter.name, parameter.default_value, bound(parameter.min),
                 bound(parameter.max), parameter.unit, names, parameter.description);
    }
  }
  std::set<std::string_view> names;
  for (const ProfileInfo* profile : profiles) names.insert(profile->name);
  note_as_of(names);
}

std::string_view type_name(ChannelType type) {
  switch (type) {
    case ChannelType::u64:
      return "uint64";
    case ChannelType::f32:
      return "float32";
    case ChannelType::u8:
      return "uint8";
    default:
      return "bit";
  }
}

void list_channels() {
  fmt::print("{:<58}{:<9}{:<8}{:<16}{}\n", "signal", "type", "unit", "module", "written by");
  for (const Channel& channel : channels()) {
    const bool is_of_all = &channel == &channels().front();
    fmt::print("{:<58}{:<9}{:<8}{:<16}{}\n", channel.name, type_name(channel.type),
               unit_of(channel.quantity), is_of_all ? "all" : name_of(channel.module),
               channel.is_output() ? name_of(channel.stage) : "");
  }
}

// "flag_control_manual_enabled" -> "manual".
std::string short_name(std::string_view flag) {
  constexpr std::string_view begin = "flag_control_", end = "_enabled";
  return std::string(flag.substr(begin.size(), flag.size() - begin.size() - end.size()));
}

void list_modes(Module module) {
  fmt::print("{:<27}", "flight_mode");
  for (const auto flag : flag_names(module)) fmt::print("{:>10}", short_name(flag));
  fmt::print("\n");
  for (const FlightMode& mode : flight_modes(module)) {
    fmt::print("{:<27}", mode.name);
    for (const std::uint8_t flag : mode.flags) fmt::print("{:>10}", flag);
    fmt::print("\n");
  }
}

// The first sentence is enough for a list.
std::string first_sentence(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  const auto end = text.find(". ");
  return end == std::string::npos ? text : text.substr(0, end + 1);
}

void list_cases(const std::vector<SelectedCase>& cases) {
  std::size_t width = 0;
  for (const auto& selected : cases) width = std::max(width, selected.the_case.id().size());
  for (const auto& [the_case, configurations] : cases) {
    fmt::print("{:<{}}  {:>2} {}{}{}  {}\n", the_case.id(), width, configurations.size(),
               the_case.flight ? "configuration" : "rate", configurations.size() == 1 ? " " : "s",
               the_case.exact_only ? ", exact only" : "", first_sentence(the_case.why));
  }
}

void list_groups(const std::vector<SelectedCase>& cases) {
  std::map<std::string, std::pair<std::size_t, std::size_t>> groups;
  for (const auto& [the_case, configurations] : cases) {
    auto& [count, results] = groups[the_case.profile + "/" + the_case.group];
    ++count;
    results += configurations.size();
  }
  for (const auto& [name, counts] : groups) {
    fmt::print("{:<40} {:>4} cases {:>6} vectors\n", name, counts.first, counts.second);
  }
}

// The features with the number of open-loop cases that use each, at their first rate. What a flight
// uses is known only when it is flown.
void list_features(const std::vector<SelectedCase>& cases) {
  std::array<std::size_t, feature_count> users{};
  for (const auto& [the_case, configurations] : cases) {
    if (the_case.flight) continue;
    const Trace inputs = stimulate(the_case, configurations.front().rate.motor_unit);
    FeatureSet used = features_of(inputs, the_case.profile);
    if (the_case.instances != Instances::one) used |= only(Feature::instances);
    for (std::size_t i = 0; i < feature_count; ++i) users[i] += used[i] ? 1 : 0;
  }
  fmt::print("{:<18}{:>6}  {}\n", "feature", "cases", "a case or flight uses it if");
  for (std::size_t i = 0; i < feature_count; ++i) {
    fmt::print("{:<18}{:>6}  {}\n", features()[i].name, users[i], features()[i].what);
  }
}

// The numbers that distinguish the vehicles. models/<vehicle>.toml has all numbers.
Result<void> list_vehicles(const std::filesystem::path& models) {
  fmt::print("{:<14}{:>8}{:>8}{:>7}{:>7}{:>10}  {}\n", "vehicle", "mass kg", "rotors", "arm m",
             "hover", "tau ms", "what it is");
  for (const std::string& name : vehicle_names(models)) {
    const auto vehicle = read_vehicle(models / (name + ".toml"));
    if (!vehicle) return tl::unexpected(vehicle.error());
    fmt::print("{:<14}{:>8.3g}{:>8}{:>7.2g}{:>7.2f}{:>10}  {}\n", name, vehicle->mass_kg,
               vehicle->rotors.size(), vehicle->arm_m(), vehicle->hover_thrust(),
               fmt::format("{:g}/{:g}", vehicle->time_constant_up_s * 1e3,
                           vehicle->time_constant_down_s * 1e3),
               vehicle->description);
  }
  return {};
}

// Makes a folder with the files of the suite, which is in an archive.
Result<void> extract(const ListOptions& options, const Globals& globals, const SuiteFolder& suite) {
  if (archive_of(suite.root).empty()) {
    return fail_at(suite.root.string(),
                   "is a folder already; --extract is for a suite in an archive");
  }
  if (!options.select.selects_all()) {
    return fail("--extract copies the whole suite; leave out the options that select cases");
  }
  if (auto apart = check_output_folder(options.extract, globals.suite); !apart) return apart;
  const auto made = make_new_folder(options.extract, [&](const std::filesystem::path& folder) {
    return copy_suite_files(suite.root, folder);
  });
  if (made && !globals.quiet) {
    fmt::print("{} has the files of {}. To use them: attest --suite {} ...\n", options.extract,
               suite.root.string(), shell_word(options.extract));
  }
  return made;
}

int list_command(const ListOptions& options, const Globals& globals) {
  if (options.parameters) {
    const auto profiles = chosen_profiles(options.select.profiles);
    if (!profiles) return report_error(profiles.error());
    list_parameters(*profiles);
  }
  if (options.channels) list_channels();
  if (options.modes) {
    list_modes(Module::mc_att_control);
    fmt::print("\nof the cascade:\n");
    list_modes(Module::attitude_unit);
  }
  if (options.parameters || options.channels || options.modes) return exit_ok;

  const auto suite = find_suite(globals.suite);
  if (!suite) return report_error(suite.error());
  if (!options.extract.empty()) {
    const auto extracted = extract(options, globals, *suite);
    return extracted ? exit_ok : report_error(extracted.error());
  }
  if (options.vehicles) {
    const auto listed = list_vehicles(suite->models());
    return listed ? exit_ok : report_error(listed.error());
  }
  const auto cases = options.select.cases_in(suite->case_folders());
  if (!cases) return report_error(cases.error());
  if (options.features) {
    list_features(*cases);
  } else {
    options.groups ? list_groups(*cases) : list_cases(*cases);
  }
  note_as_of(*cases);
  return exit_ok;
}

}  // namespace

void add_list(const CommandLine& line) {
  auto options = std::make_shared<ListOptions>();
  const Command command = line.add("list", "List the cases with their reasons, or another table");
  add_selection(command, options->select);
  const std::vector<Option> tables = {
      command.flag("--groups", options->groups,
                   "List the groups with their numbers of cases and vectors"),
      command.flag("--parameters", options->parameters, "List the parameters of the law"),
      command.flag("--channels", options->channels,
                   "List the signals (columns of traces) with type, unit and module"),
      command.flag("--features", options->features,
                   "List the features of the law that a port can declare to lack, and how many of "
                   "the selected open-loop cases use each"),
      command.flag("--flight-modes", options->modes,
                   "List the flight modes and the flags that they set"),
      command.flag("--vehicles", options->vehicles, "List the vehicles with their main data")};
  const Option extract =
      command
          .option("--extract", options->extract,
                  "Copy the files of the suite from its archive to this new folder")
          .type("DIR");
  for (const Option& table : tables) extract.excludes(table);
  command.examples(
      {{"attest list --filter 'tpa/*'", "list the cases of a group with their reasons"},
       {"attest list --parameters --profile px4-v1.3.4",
        "list the parameters of one version of the law"},
       {"attest list --extract files", "copy the cases, goldens and models that were installed"}});
  command.runs(options, list_command);
}

}  // namespace attest::cli
