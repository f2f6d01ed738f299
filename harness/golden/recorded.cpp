#include "harness/golden/recorded.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "controller/actuation/battery_status.hpp"
#include "controller/actuation/mixer.hpp"
#include "harness/casefile/parse.hpp"
#include "harness/core/suggestion.hpp"
#include "harness/port/profiles.hpp"
#include "harness/trace/provenance.hpp"
#include "harness/trace/trace_file.hpp"

namespace attest {
namespace {

// A pipe has no provenance, because the provenance.toml of a folder describes the files in it.
Result<Provenance> provenance_of(const std::filesystem::path& file) {
  std::error_code unknown;
  if (std::filesystem::is_fifo(file, unknown)) return Provenance{};
  return provenance_in(file.parent_path());
}

std::string mixer_of(const std::filesystem::path& file, const Provenance& provenance) {
  const std::string stem = file.stem().string();
  const auto found = provenance.mixers.find(stem);
  if (found != provenance.mixers.end()) return found->second;
  const std::string unscaled = fmt::format("R: {} 10000 10000 10000 0", stem);
  return actuation::parse_mixer(unscaled) ? unscaled : "";
}

Result<void> check_mixer(const Trace& trace, const std::string& definition) {
  if (definition.empty()) {
    return fail_at(trace.source,
                   "mixer definition missing; pass --mixer \"R: 4x 10000 10000 10000 0\"");
  }
  const auto mixer = actuation::parse_mixer(definition);
  if (!mixer)
    return fail_at(trace.source, fmt::format("mixer `{}`: {}", definition, mixer.error()));
  const ChannelSet outputs = channels_of(Module::mixer, "out/actuator_outputs.") & trace.present;
  if (outputs.count() == mixer->rotors.size()) return {};
  return fail_at(trace.source, fmt::format("has {} rotors, mixer `{}` has {}", outputs.count(),
                                           definition, mixer->rotors.size()));
}

bool is_one_of(const std::string& name, const std::vector<std::string>& names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// The newest profile that has the module.
std::string newest_profile_of(Module module) {
  const auto all = known_profiles();
  const auto found = std::find_if(all.begin(), all.end(), [&](const ProfileInfo& profile) {
    return contains(profile.modules, module);
  });
  return std::string(found == all.end() ? default_profile : found->name);
}

// Removes parameters that only other profiles have: a trace of one version of the law may have been
// written with the columns of another version.
void leave_out_foreign_parameters(Recorded& recorded) {
  const Subject& subject = recorded.subject;
  const auto own = parameter_names(subject.module, subject.profile);
  const auto all = parameter_names(subject.module, "");
  std::set<std::string> foreign;
  for (const ParameterChange& change : recorded.trace.parameters) {
    if (!is_one_of(change.name, own) && is_one_of(change.name, all)) foreign.insert(change.name);
  }
  if (foreign.empty()) return;
  std::erase_if(recorded.trace.parameters,
                [&](const ParameterChange& change) { return foreign.contains(change.name); });
  recorded.notes.push_back(fmt::format("not set, because {} does not have them: {}",
                                       subject.profile, fmt::join(foreign, ", ")));
}

// Without a number of cells the battery's scale would stay 1. Recordings of the firmware that do
// not state the number had 3.
void give_cells(Recorded& recorded) {
  constexpr const char* name = "BAT_N_CELLS";
  constexpr float usual_cells = 3;
  if (recorded.subject.module != Module::battery_status) return;
  const auto& parameters = recorded.trace.parameters;
  const bool is_given =
      std::any_of(parameters.begin(), parameters.end(),
                  [](const ParameterChange& change) { return change.name == name; });
  if (is_given) return;
  recorded.trace.parameters.insert(recorded.trace.parameters.begin(), {0, name, usual_cells});
  recorded.notes.push_back(
      fmt::format("no column in/parameter.{0}: {1:g} cells are assumed; "
                  "`--param {0}=N` sets another number",
                  name, usual_cells));
}

void note_ignored_columns(Recorded& recorded) {
  const auto& names = recorded.trace.ignored_columns;
  if (names.empty()) return;
  constexpr std::size_t most = 8;
  const auto end = names.begin() + static_cast<std::ptrdiff_t>(std::min(names.size(), most));
  const std::string more =
      names.size() > most ? fmt::format(" and {} more", names.size() - most) : "";
  recorded.notes.push_back(fmt::format("columns ignored, because attest has no such signals: {}{}",
                                       fmt::join(names.begin(), end, ", "), more));
}

Result<void> check_parameters(Recorded& recorded) {
  leave_out_foreign_parameters(recorded);
  give_cells(recorded);
  for (const ParameterChange& change : recorded.trace.parameters) {
    if (auto checked = check_parameter(recorded.subject, change); !checked) {
      return fail_at(recorded.trace.source, checked.error().message);
    }
  }
  return {};
}

}  // namespace

Result<void> check_parameter(const Subject& subject, const ParameterChange& change) {
  const std::vector<std::string> names = parameter_names(subject.module, subject.profile);
  if (!is_one_of(change.name, names)) {
    return fail(fmt::format("unknown parameter `{}` of {} in {}{}", change.name,
                            name_of(subject.module), subject.profile,
                            suggestion(change.name, names)));
  }
  actuation::BatteryOptions battery;
  if (subject.module == Module::battery_status &&
      !actuation::set_battery_parameter(battery, change.name, change.value)) {
    return fail(fmt::format("{} cannot be {}", change.name, change.value));
  }
  return {};
}

Result<ParameterChange> parse_parameter(const std::string& text) {
  const auto equals = std::min(text.find('='), text.size());
  const char* const end = text.data() + text.size();
  float value = 0;
  const auto [rest, error] = std::from_chars(std::min(text.data() + equals + 1, end), end, value);
  if (equals == text.size() || error != std::errc{} || rest != end || !std::isfinite(value)) {
    return fail(
        fmt::format("--param {}: write NAME=VALUE with a finite number, such as "
                    "MC_ROLL_P=6.5",
                    text));
  }
  return ParameterChange{0, text.substr(0, equals), value};
}

void override_parameter(const ParameterChange& change, Trace& trace) {
  std::erase_if(trace.parameters,
                [&](const ParameterChange& other) { return other.name == change.name; });
  trace.parameters.insert(trace.parameters.begin(), change);
}

Result<Recorded> read_recorded(const std::filesystem::path& file, const std::string& profile,
                               const std::string& mixer) {
  auto trace = open_trace(file, TraceNeed::inputs_and_outputs);
  if (!trace) return tl::unexpected(trace.error());
  const auto folder_provenance = provenance_of(file);
  if (!folder_provenance) return tl::unexpected(folder_provenance.error());
  const Provenance& provenance = *folder_provenance;
  Recorded recorded{std::move(*trace), {profile, Module::mc_att_control, ""}, {}};
  Subject& subject = recorded.subject;
  subject.module = module_of(recorded.trace.present);
  note_ignored_columns(recorded);
  if (subject.profile.empty()) subject.profile = provenance.profile;
  if (subject.profile.empty()) subject.profile = newest_profile_of(subject.module);
  if (auto checked = check_parameters(recorded); !checked) {
    return tl::unexpected(checked.error());
  }
  if (subject.module != Module::mixer && !mixer.empty()) {
    return fail_at(recorded.trace.source, "is no mixer trace; leave --mixer out");
  }
  if (subject.module != Module::mixer) return recorded;
  subject.mixer = mixer.empty() ? mixer_of(file, provenance) : mixer;
  if (auto checked = check_mixer(recorded.trace, subject.mixer); !checked) {
    return tl::unexpected(checked.error());
  }
  return recorded;
}

}  // namespace attest
