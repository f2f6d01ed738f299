#include "harness/golden/recorded.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "controller/actuation/battery_status.hpp"
#include "controller/actuation/mixer.hpp"
#include "harness/casefile/parse.hpp"
#include "harness/core/suggestion.hpp"
#include "harness/host/file_format.hpp"
#include "harness/port/profiles.hpp"
#include "harness/trace/csv.hpp"
#include "harness/trace/csv_cells.hpp"
#include "harness/trace/provenance.hpp"

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

Result<void> check_mixer(const std::string& file, const ChannelSet& present,
                         const std::string& definition) {
  if (definition.empty()) {
    return fail_at(file, "mixer definition missing; pass --mixer \"R: 4x 10000 10000 10000 0\"");
  }
  const auto mixer = actuation::parse_mixer(definition);
  if (!mixer) return fail_at(file, fmt::format("mixer `{}`: {}", definition, mixer.error()));
  const ChannelSet outputs = channels_of(Module::mixer, "out/actuator_outputs.") & present;
  if (outputs.count() == mixer->rotors.size()) return {};
  return fail_at(file, fmt::format("has {} rotors, mixer `{}` has {}", outputs.count(), definition,
                                   mixer->rotors.size()));
}

bool is_one_of(const std::string& name, const std::vector<std::string>& names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// Whether the profile has those of the trace's parameters that any profile has.
bool has_parameters_of(const Trace& trace, const ProfileInfo& profile, Module module) {
  const auto own = parameter_names(module, std::string(profile.name));
  const auto all = parameter_names(module, "");
  return std::ranges::none_of(trace.parameters, [&](const ParameterChange& change) {
    return is_one_of(change.name, all) && !is_one_of(change.name, own);
  });
}

// Of a trace that does not say it: the newest profile of a released version that has the module. If
// the trace has parameters that only other profiles have, the newest of these. `first` is the first
// tick of the trace.
std::string assumed_profile(const Trace& first, Module module) {
  std::vector<const ProfileInfo*> candidates;  // the newest of a law first, released ones before
  for (const bool released : {true, false}) {
    for (const ProfileInfo& profile : known_profiles()) {
      const bool is_newest =
          !info_of(module).is_law() || contains(profile.modules, Module::rate_unit);
      if (contains(profile.modules, module) && is_newest && profile.as_of.empty() == released) {
        candidates.push_back(&profile);
      }
    }
  }
  if (candidates.empty()) return default_profile;
  const auto found = std::ranges::find_if(
      candidates, [&](const ProfileInfo* one) { return has_parameters_of(first, *one, module); });
  return std::string(found == candidates.end() ? candidates.front()->name : (*found)->name);
}

// Adds a note if the profile is assumed.
Result<ModuleUnderTest> subject_of(const TraceParts& reader, const Trace& first,
                                   const std::string& profile, const std::string& mixer,
                                   std::vector<std::string>& notes) {
  const std::filesystem::path file = reader.file();
  const auto provenance = provenance_of(file);
  if (!provenance) return tl::unexpected(provenance.error());
  ModuleUnderTest subject{profile, module_of(reader.present())};
  if (subject.profile.empty() && !first.profile.empty() && !find_profile(first.profile)) {
    return fail_at(reader.file(),
                   fmt::format("column {}: no such profile{}; --profile chooses one",
                               in_backquotes(std::string(profile_prefix) + first.profile),
                               suggestion(first.profile, known_profile_names())),
                   1);
  }
  if (subject.profile.empty()) subject.profile = first.profile;
  if (subject.profile.empty()) subject.profile = provenance->profile;
  if (subject.profile.empty()) {
    subject.profile = assumed_profile(first, subject.module);
    notes.push_back(
        fmt::format("judged as {}, because neither a column such as profile/px4-v1.18 nor a "
                    "provenance.toml next to it says its release; --profile chooses another",
                    subject.profile));
  }
  if (subject.module == Module::mixer) {
    subject.mixer = mixer.empty() ? mixer_of(file, *provenance) : mixer;
  } else if (!mixer.empty()) {
    return fail_at(reader.file(), "is no mixer trace; leave --mixer out");
  }
  return subject;
}

void note_ignored(const std::vector<std::string>& names, std::vector<std::string>& notes) {
  if (names.empty()) return;
  constexpr std::size_t most = 8;
  const auto end = names.begin() + static_cast<std::ptrdiff_t>(std::min(names.size(), most));
  const std::string more =
      names.size() > most ? fmt::format(" and {} more", names.size() - most) : "";
  notes.push_back(fmt::format("columns ignored, because attest has no such signals: {}{}",
                              fmt::join(names.begin(), end, ", "), more));
}

}  // namespace

Result<void> check_parameter(const ModuleUnderTest& subject, const ParameterChange& change) {
  const std::vector<std::string> names = parameter_names(subject.module, subject.profile);
  if (!is_one_of(change.name, names)) {
    return fail(fmt::format("unknown parameter `{}` of {} in {}{}", change.name,
                            name_of(subject.module), subject.profile,
                            hint_for_parameter(change.name, subject.profile, names)));
  }
  actuation::BatteryOptions battery;
  if (subject.module == Module::battery_status &&
      !actuation::set_battery_parameter(battery, change.name, change.value)) {
    return fail(fmt::format("{} cannot be {}", change.name, change.value));
  }
  return {};
}

void override_parameter(const ParameterChange& change, Trace& trace) {
  std::erase_if(trace.parameters,
                [&](const ParameterChange& other) { return other.name == change.name; });
  trace.parameters.insert(trace.parameters.begin(), change);
}

Result<RecordedParts> RecordedParts::open(const std::filesystem::path& file,
                                          const std::string& profile, const std::string& mixer) {
  auto reader = read_as<&FileFormat::open>(file, TraceNeed::inputs_and_outputs);
  if (!reader) return tl::unexpected(reader.error());
  // Each parameter of a file has a value at the first tick.
  Trace first;
  if (auto read = (*reader)->next_part(1, first); !read) return tl::unexpected(read.error());
  std::vector<std::string> notes;
  auto subject = subject_of(**reader, first, profile, mixer, notes);
  if (!subject) return tl::unexpected(subject.error());
  note_ignored(first.ignored_columns, notes);
  RecordedParts parts(*std::move(reader), *std::move(subject));
  parts.notes_ = std::move(notes);
  parts.adapt_parameters(first);
  if (parts.subject_.module == Module::mixer) {
    auto checked = check_mixer(parts.file(), parts.present(), parts.subject_.mixer);
    if (!checked) return tl::unexpected(checked.error());
  }
  if (auto begun = parts.rewind(); !begun) return tl::unexpected(begun.error());
  return parts;
}

// Leaves out the parameters that only other profiles have: a trace of one version of the law may
// have been written with the columns of another version.
void RecordedParts::adapt_parameters(const Trace& first) {
  const auto own = parameter_names(subject_.module, subject_.profile);
  const auto all = parameter_names(subject_.module, "");
  for (const ParameterChange& change : first.parameters) {
    if (!is_one_of(change.name, own) && is_one_of(change.name, all)) foreign_.insert(change.name);
  }
  if (!foreign_.empty()) {
    notes_.push_back(fmt::format("not set, because {} does not have them: {}", subject_.profile,
                                 fmt::join(foreign_, ", ")));
  }
  if (subject_.module == Module::battery_status) give_cells(first);
}

// Without a number of cells the battery's scale would stay 1. Recordings of the firmware that do
// not state the number had 3.
void RecordedParts::give_cells(const Trace& first) {
  constexpr const char* name = "BAT_N_CELLS";
  constexpr float usual_cells = 3;
  const bool is_given =
      std::any_of(first.parameters.begin(), first.parameters.end(),
                  [](const ParameterChange& change) { return change.name == name; });
  if (is_given) return;
  added_.push_back({0, name, usual_cells});
  notes_.push_back(
      fmt::format("no column in/parameter.{0}: {1:g} cells are assumed; "
                  "`--param {0}=N` sets another number",
                  name, usual_cells));
}

void RecordedParts::override_parameter(const ParameterChange& change) {
  overridden_.insert(change.name);
  std::erase_if(added_, [&](const ParameterChange& one) { return one.name == change.name; });
  added_.insert(added_.begin(), change);
}

Result<void> RecordedParts::next_part(std::size_t most, Trace& part) {
  if (auto read = reader_->next_part(most, part); !read) return read;
  auto& changes = part.parameters;
  std::erase_if(changes,
                [&](const ParameterChange& change) { return foreign_.contains(change.name); });
  for (const ParameterChange& change : changes) {
    if (auto checked = check_parameter(subject_, change); !checked) {
      return fail_at(file(), checked.error().message);
    }
  }
  std::erase_if(changes,
                [&](const ParameterChange& change) { return overridden_.contains(change.name); });
  if (std::exchange(is_at_begin_, false)) {
    changes.insert(changes.begin(), added_.begin(), added_.end());
  }
  return {};
}

Result<void> RecordedParts::rewind() {
  is_at_begin_ = true;
  return reader_->rewind();
}

Result<Recorded> read_recorded(const std::filesystem::path& file, const std::string& profile,
                               const std::string& mixer) {
  auto parts = RecordedParts::open(file, profile, mixer);
  if (!parts) return tl::unexpected(parts.error());
  Recorded recorded{{}, parts->subject(), parts->notes()};
  const auto read = parts->next_part(std::numeric_limits<std::size_t>::max(), recorded.trace);
  if (!read) return tl::unexpected(read.error());
  return recorded;
}

}  // namespace attest
