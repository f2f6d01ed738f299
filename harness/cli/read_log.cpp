#include "harness/cli/read_log.hpp"

#include <algorithm>
#include <cstdio>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/golden/recorded.hpp"
#include "harness/host/file_format.hpp"
#include "harness/port/profiles.hpp"

namespace attest::cli {
namespace {

bool has_units_of(const FlightLog& log, const ProfileInfo& profile) {
  return std::all_of(log.units.begin(), log.units.end(), [&](const LoggedUnit& unit) {
    return contains(profile.modules, unit.module);
  });
}

std::vector<std::string_view> profiles_for(const FlightLog& log) {
  std::vector<std::string_view> names;
  for (const ProfileInfo& profile : known_profiles()) {
    if (has_units_of(log, profile)) names.push_back(profile.name);
  }
  return names;
}

// The profile of the log's minor release: px4-v1.14.4 for a log of v1.14.3, px4-v1.17 for one of
// v1.17.0. Empty: there is no such profile.
std::string profile_of(const FlightLog& log) {
  if (!log.release) return "";
  const std::string minor = fmt::format("px4-v{}.{}", log.release->major, log.release->minor);
  for (const std::string_view name : profiles_for(log)) {
    if (name == minor || name.starts_with(minor + ".")) return std::string(name);
  }
  return "";
}

void choose_profile(FlightLog& log) {
  if (!log.profile.empty()) return;
  log.profile = profile_of(log);
  if (!log.profile.empty()) {
    log.notes.push_back(fmt::format("the profile is {}, because PX4 {} wrote the log (--profile)",
                                    log.profile, log.release->to_string()));
    const std::string_view as_of = find_profile(log.profile)->as_of;
    if (!as_of.empty()) {
      log.notes.push_back(
          fmt::format("{} is the law of {}; the final release may differ", log.profile, as_of));
    }
    return;
  }
  if (log.units.front().module == Module::mc_att_control) {
    log.profile = default_profile;
    log.notes.push_back(fmt::format("the profile is taken to be {} (--profile)", default_profile));
    return;
  }
  log.no_profile = fmt::format("{}; name the law with --profile, one of {}",
                               log.release ? fmt::format("was written by PX4 {}, whose law attest "
                                                         "does not have",
                                                         log.release->to_string())
                                           : "does not say which release of PX4 wrote it "
                                             "(ver_sw_release)",
                               fmt::join(profiles_for(log), ", "));
}

// A profile that attest does not know is accepted, because a port may know it.
Result<void> check_profile(const std::string& file, const FlightLog& log) {
  const ProfileInfo* const known = find_profile(log.profile);
  if (known == nullptr || has_units_of(log, *known)) return {};
  return fail_at(file, fmt::format("is of the {}, which {} does not have; --profile is one of {}",
                                   info_of(log.units.front().module).title, log.profile,
                                   fmt::join(profiles_for(log), ", ")));
}

}  // namespace

Result<FlightLog> read_any_log(const std::string& file, const std::vector<std::string>& assumed,
                               const std::string& profile, bool whole) {
  auto log = read_as<&FileFormat::read_log>(file, assumed, whole);
  if (!log) return log;
  if (!profile.empty()) log->profile = profile;
  choose_profile(*log);
  if (!log->no_profile.empty()) return log;
  if (auto checked = check_profile(file, *log); !checked) return tl::unexpected(checked.error());
  return log;
}

Result<FlightLog> read_log(const std::string& file, const std::vector<std::string>& assumed,
                           const std::string& profile, bool whole) {
  auto log = read_any_log(file, assumed, profile, whole);
  if (log && !log->no_profile.empty()) return fail_at(file, log->no_profile);
  return log;
}

void print_notes(const std::string& file, const std::vector<std::string>& notes) {
  for (const std::string& note : notes) fmt::print(stderr, "attest: note: {}: {}\n", file, note);
}

}  // namespace attest::cli
