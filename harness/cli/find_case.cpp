#include "harness/cli/find_case.hpp"

#include <algorithm>
#include <filesystem>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/casefile/parse.hpp"
#include "harness/casefile/select.hpp"
#include "harness/cli/shared_arguments.hpp"
#include "harness/core/suite_files.hpp"
#include "harness/port/port.hpp"
#include "harness/port/profiles.hpp"

namespace attest::cli {
namespace {

// Keeps only the cases of the law that flies at `rate`. Keeps all cases if no case is of that law.
void keep_law(const LoopRate& rate, std::vector<SelectedCase>& found) {
  const auto is_of_law = [&](const SelectedCase& one) {
    return one.the_case.attitude_loop.has_value() == rate.attitude_unit.has_value();
  };
  if (std::none_of(found.begin(), found.end(), is_of_law)) return;
  std::erase_if(found, [&](const SelectedCase& one) { return !is_of_law(one); });
}

// Keeps only flights, or the cases in open loop of these modules, unless no case is one.
void keep_kind(const std::optional<ModuleSet>& open_loop_of, std::vector<SelectedCase>& found) {
  const auto is_meant = [&](const SelectedCase& one) {
    if (!open_loop_of) return one.the_case.flight.has_value();
    return !one.the_case.flight && contains(*open_loop_of, one.the_case.module);
  };
  if (std::none_of(found.begin(), found.end(), is_meant)) return;
  std::erase_if(found, [&](const SelectedCase& one) { return !is_meant(one); });
}

// A case file, in the profile if one is given.
Result<Case> read_case(const CaseChoice& choice) {
  auto parsed = parse_case(choice.name);
  if (!parsed || choice.profile.empty()) return parsed;
  if (std::ranges::find(parsed->profiles, choice.profile) != parsed->profiles.end()) {
    return parsed->in_profile(choice.profile);
  }
  return fail_at(choice.name, fmt::format("is no case of {}, but of {}", choice.profile,
                                          fmt::join(parsed->profiles, ", ")));
}

bool is_group(const std::string& name, const SuiteFolder& suite) {
  return std::ranges::any_of(suite.groups(), [&](const std::string& group) {
    return group.substr(group.find('/') + 1) == name;
  });
}

// `rate`: of a flight; `open_loop_of`: of a case in open loop. One of them is given.
Result<Case> find_case(const CaseChoice& choice, const SuiteFolder& suite,
                       const std::optional<LoopRate>& rate,
                       const std::optional<ModuleSet>& open_loop_of) {
  const std::string& name = choice.name;
  if (is_port(name)) {
    return fail(fmt::format("{} is a port, not a case; write the case before it", name));
  }
  // A folder may have the name of a case by chance, so it is not a case file.
  if (is_suite_file(name) || name.ends_with(".toml")) return read_case(choice);
  Selection selection;
  selection.filters = {full_case_name(name)};
  if (!choice.profile.empty()) selection.profiles = {choice.profile};
  auto found = select_cases(suite.case_folders(), selection);
  if (!found && is_group(name, suite)) {
    return fail(
        fmt::format("`{0}` is a group of cases; name one of them: `attest list --group {0}` "
                    "shows them",
                    name));
  }
  if (!found) return tl::unexpected(found.error());
  keep_kind(open_loop_of, *found);
  if (rate) keep_law(*rate, *found);
  const Case& first = found->front().the_case;
  for (const SelectedCase& one : *found) {
    if (one.the_case.group == first.group && one.the_case.name == first.name) continue;
    return fail(fmt::format("`{}` matches {} cases, for example {} and {}; give the id of one",
                            name, found->size(), first.id(), one.the_case.id()));
  }
  const std::vector<std::string> profiles = known_profile_names();
  return std::ranges::min_element(*found, {},
                                  [&](const SelectedCase& one) {
                                    return std::ranges::find(profiles, one.the_case.profile);
                                  })
      ->the_case;
}

Result<PlantConfiguration> find_plant_configuration(const Case& the_case,
                                                    const std::string& vehicle,
                                                    const std::string& plant) {
  PlantConfiguration plant_configuration{vehicle.empty() ? the_case.flight->lead_vehicle : vehicle,
                                         the_case.flight->plant_configurations.front().plant};
  if (plant.empty()) return plant_configuration;
  const auto kind = parse_plant_kind(plant);
  if (!kind) return tl::unexpected(kind.error());
  plant_configuration.plant = *kind;
  return plant_configuration;
}

}  // namespace

Result<Case> find_flight(const CaseChoice& choice, const LoopRate& rate, const SuiteFolder& suite) {
  auto the_case = find_case(choice, suite, rate, std::nullopt);
  if (the_case && !the_case->flight) {
    return fail(fmt::format("{} has no [flight]: its inputs are scripted; `attest run` runs it",
                            the_case->id()));
  }
  return the_case;
}

Result<Case> find_open_loop_case(const CaseChoice& choice, const SuiteFolder& suite,
                                 const ModuleSet& modules) {
  auto the_case = find_case(choice, suite, std::nullopt, modules);
  if (the_case && the_case->flight) {
    return fail(fmt::format("{} is a flight; `attest sim --out F` flies it and writes its trace",
                            the_case->id()));
  }
  return the_case;
}

LoopRate rate_of_flight(const Case& the_case, const LoopRate& given) {
  if (!the_case.attitude_loop || given.attitude_unit) return given;
  return {std::min(Rate::hz(250), given.motor_unit), given.motor_unit};
}

Result<ChosenFlight> choose_flight(const CaseChoice& choice, const LoopRate& rate,
                                   const std::string& vehicle, const std::string& plant,
                                   const SuiteFolder& suite) {
  auto the_case = find_flight(choice, rate, suite);
  if (!the_case) return tl::unexpected(the_case.error());
  auto plant_configuration = find_plant_configuration(*the_case, vehicle, plant);
  if (!plant_configuration) return tl::unexpected(plant_configuration.error());
  auto vehicle_model = VehicleModel::load(suite.models(), plant_configuration->vehicle);
  if (!vehicle_model) return tl::unexpected(vehicle_model.error());
  return ChosenFlight{std::move(*the_case), std::move(*plant_configuration),
                      std::move(*vehicle_model)};
}

Result<TimedFlight> find_timed_flight(const std::string& file, const SuiteFolder& suite) {
  auto timing = read_timing(file);
  if (!timing) return tl::unexpected(timing.error());
  auto the_case = find_flight({timing->case_id, ""}, timing->configuration.rate, suite);
  if (!the_case) return tl::unexpected(the_case.error());
  if (the_case->sha256 != timing->case_sha256) {
    return fail_at(file, fmt::format("was recorded with another {}: the file has changed since",
                                     the_case->file.string()));
  }
  auto vehicle_model =
      VehicleModel::load(suite.models(), timing->configuration.plant_configuration->vehicle);
  if (!vehicle_model) return tl::unexpected(vehicle_model.error());
  Case as_long = with_timing(std::move(*the_case), *timing);
  return TimedFlight{std::move(as_long), std::move(*timing), std::move(*vehicle_model)};
}

}  // namespace attest::cli
