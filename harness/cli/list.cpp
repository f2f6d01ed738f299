#include <algorithm>
#include <filesystem>
#include <map>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "controller/actuation/battery_status.hpp"
#include "controller/actuation/unit_table.hpp"
#include "controller/reference/parameters.hpp"
#include "harness/casefile/flight_mode.hpp"
#include "harness/cli/command.hpp"
#include "harness/cli/suite_folder.hpp"
#include "harness/core/suggestion.hpp"
#include "harness/plant/vehicle.hpp"
#include "harness/trace/channels.hpp"

namespace attest::cli {
namespace {

// The requested profiles; by default all.
Result<std::vector<reference::Profile>> chosen_profiles(const std::vector<std::string>& names) {
  const auto all = reference::profile_names();
  std::vector<reference::Profile> profiles;
  for (const std::string& name : names) {
    const auto profile = reference::profile_from_name(name);
    if (!profile) {
      return fail(fmt::format("no profile `{}`{}; there are {}", name,
                              suggestion(name, {all.begin(), all.end()}), fmt::join(all, ", ")));
    }
    profiles.push_back(*profile);
  }
  if (!profiles.empty()) return profiles;
  for (const std::string_view name : all) profiles.push_back(*reference::profile_from_name(name));
  return profiles;
}

// The names of the profiles for which `has` is true.
template <typename Has>
std::string names_of(const std::vector<reference::Profile>& profiles, Has has) {
  std::vector<std::string> names;
  for (const reference::Profile profile : profiles) {
    if (has(profile)) names.emplace_back(name_of(profile));
  }
  return fmt::format("{}", fmt::join(names, " "));
}

void list_parameters(const std::vector<reference::Profile>& profiles) {
  constexpr const char* row = "{:<17}{:>9}{:>8}{:>8}  {:<8} {:<22} {}\n";
  fmt::print(row, "parameter", "default", "min", "max", "unit", "profiles", "what it does");
  for (const auto& info : reference::parameter_table()) {
    const std::string names =
        names_of(profiles, [&](auto profile) { return info.profiles.contains(profile); });
    if (names.empty()) continue;
    fmt::print(row, info.name, info.default_value, info.min, info.max, info.unit, names,
               info.description);
  }
  const std::string names = names_of(
      profiles, [](auto profile) { return actuation::is_profile(name_of(profile).data()); });
  if (names.empty()) return;
  fmt::print("\nof battery_status:\n");
  for (const auto& info : actuation::battery_parameters()) {
    fmt::print(row, info.name, info.default_value, "", "", info.unit, names, info.description);
  }
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
  fmt::print("{:<58}{:<9}{:<7}{}\n", "channel", "type", "unit", "written by");
  for (const Channel& channel : channels()) {
    fmt::print("{:<58}{:<9}{:<7}{}\n", channel.name, type_name(channel.type),
               unit_of(channel.quantity), channel.is_output() ? name_of(channel.stage) : "");
  }
}

void list_modes() {
  fmt::print("{:<19}manual auto rates attitude rattitude velocity\n", "flight_mode");
  for (const FlightMode& mode : flight_modes()) {
    const auto& flag = mode.flags;
    fmt::print("{:<19}{:>6} {:>4} {:>5} {:>8} {:>9} {:>8}\n", mode.name, flag[0], flag[1], flag[2],
               flag[3], flag[4], flag[5]);
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

}  // namespace

int list_command(const ListOptions& options, const Globals& globals) {
  if (options.parameters) {
    const auto profiles = chosen_profiles(options.select.profiles);
    if (!profiles) return report_error(profiles.error());
    list_parameters(*profiles);
  }
  if (options.channels) list_channels();
  if (options.modes) list_modes();
  if (options.parameters || options.channels || options.modes) return exit_ok;

  const auto suite = find_suite(globals.suite);
  if (!suite) return report_error(suite.error());
  if (options.vehicles) {
    const auto listed = list_vehicles(suite->models());
    return listed ? exit_ok : report_error(listed.error());
  }
  const auto cases = options.select.cases_in(suite->case_folders());
  if (!cases) return report_error(cases.error());
  options.groups ? list_groups(*cases) : list_cases(*cases);
  return exit_ok;
}

}  // namespace attest::cli
