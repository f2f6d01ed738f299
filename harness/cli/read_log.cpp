#include "harness/cli/read_log.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

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

// The number of minor releases between the profile and the release, as v1.14 to v1.16 are two.
int distance(std::string_view profile, const ulog::Release& release) {
  int major = 0, minor = 0;
  std::sscanf(std::string(profile).c_str(), "px4-v%d.%d", &major, &minor);
  return std::abs(100 * (release.major - major) + release.minor - minor);
}

// The newest of the nearest ones.
std::string_view nearest_profile(const FlightLog& log) {
  const auto names = profiles_for(log);
  return *std::min_element(names.begin(), names.end(), [&](const auto& a, const auto& b) {
    return distance(a, *log.release) < distance(b, *log.release);
  });
}

// What is uncertain about the law of the log's release, of which there is a profile.
void add_doubts(FlightLog& log) {
  if (!log.release->is_final()) {
    const std::string branch = log.branch.empty() ? "" : " of the branch " + log.branch;
    log.notes.push_back(fmt::format(
        "PX4 {} is {} {} build{}, whose law may differ from {}", log.release->to_string(),
        log.release->kind() == "alpha" || log.release->kind() == "rc" ? "an" : "a",
        log.release->kind(), branch, log.profile));
  }
  const std::string_view as_of = find_profile(log.profile)->as_of;
  if (!as_of.empty()) {
    log.notes.push_back(
        fmt::format("{} is the law of {}; the final release may differ", log.profile, as_of));
  }
}

// A log of the controller without a profile of its own gets the nearest.
void take_nearest(FlightLog& log) {
  log.profile = log.release ? nearest_profile(log) : default_profile;
  log.notes.push_back(
      log.release
          ? fmt::format("PX4 {} wrote the log, and attest has no profile of this release; the "
                        "profile is taken to be the nearest, {}, whose law may differ (--profile)",
                        log.release->to_string(), log.profile)
          : fmt::format("the profile is taken to be {}, because the log does not say which release "
                        "of PX4 wrote it (--profile)",
                        log.profile));
}

void choose_profile(FlightLog& log) {
  if (!log.profile.empty()) return;
  log.profile = profile_of(log);
  if (!log.profile.empty()) {
    log.notes.push_back(fmt::format("the profile is {}, because PX4 {} wrote the log (--profile)",
                                    log.profile, log.release->to_string()));
    return add_doubts(log);
  }
  if (log.units.front().module == Module::mc_att_control) return take_nearest(log);
  const std::string names = fmt::format("{}", fmt::join(profiles_for(log), ", "));
  log.no_profile = log.release
                       ? fmt::format(
                             "was written by PX4 {}, whose law attest does not have; name the "
                             "law with --profile, one of {} (the nearest is {})",
                             log.release->to_string(), names, nearest_profile(log))
                       : fmt::format(
                             "does not say which release of PX4 wrote it (ver_sw_release); name "
                             "the law with --profile, one of {}",
                             names);
}

// The law of another release explains a log badly, and then the log judges no port.
void take_given(const std::string& profile, FlightLog& log) {
  log.profile = profile;
  const std::string own = profile_of(log);
  if (own.empty() || own == profile) return;
  log.notes.push_back(fmt::format("PX4 {} wrote the log, whose profile is {}, but --profile is {}",
                                  log.release->to_string(), own, profile));
}

// A profile that attest does not know is accepted, because a port may know it.
void check_profile(FlightLog& log) {
  const ProfileInfo* const known = find_profile(log.profile);
  if (known == nullptr || has_units_of(log, *known)) return;
  log.no_profile = fmt::format("is of the {}, which {} does not have; --profile is one of {}",
                               info_of(log.units.front().module).title, log.profile,
                               fmt::join(profiles_for(log), ", "));
}

}  // namespace

Result<FlightLog> read_any_log(const std::string& file, const std::vector<std::string>& assumed,
                               const std::string& profile, bool whole) {
  auto log = read_as<&FileFormat::read_log>(file, assumed, whole);
  if (!log) return log;
  if (!profile.empty()) take_given(profile, *log);
  choose_profile(*log);
  check_profile(*log);
  if (log->units.size() > 1 && !log->too_little.empty()) log->notes.push_back(log->too_little);
  return log;
}

Result<FlightLog> read_log(const std::string& file, const std::vector<std::string>& assumed,
                           const std::string& profile, bool whole) {
  auto log = read_any_log(file, assumed, profile, whole);
  if (log && !log->too_little.empty()) return fail_at(file, log->too_little);
  if (log && !log->no_profile.empty()) return fail_at(file, log->no_profile);
  return log;
}

void print_notes(const std::string& file, const std::vector<std::string>& notes) {
  for (const std::string& note : notes) fmt::print(stderr, "attest: note: {}: {}\n", file, note);
}

}  // namespace attest::cli
