#include "harness/cli/supported_profiles.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/core/suite_files.hpp"
#include "harness/port/profiles.hpp"
#include "harness/report/text.hpp"

namespace attest::cli {

std::optional<Error> supported_instead(const HostOptions& host,
                                       const std::vector<std::string>& missing,
                                       const CommandFor& command) {
  if (missing.empty()) return std::nullopt;
  HostOptions fresh = host;
  fresh.said = std::nullopt;
  const auto port = describe_port(fresh, known_profile_names());
  if (!port || !port->hangs.empty() || !port->goes_wrong.empty()) return std::nullopt;
  const std::vector<std::string>& supported = port->profiles;
  const auto is_supported = [&](const std::string& profile) {
    return std::ranges::find(supported, profile) != supported.end();
  };
  if (std::ranges::any_of(missing, is_supported)) return std::nullopt;
  if (supported.empty()) {
    return Error{
        fmt::format("{} supports no profile: its create() returned NULL for each of {}; attest "
                    "smoke {} shows more",
                    host.port, fmt::join(known_profile_names(), ", "), shell_word(host.port))};
  }
  return Error{fmt::format("{} supports {}, not {}; write: {}", host.port,
                           fmt::join(supported, ", "), fmt::join(missing, ", "),
                           command(supported.front(), " --port " + shell_word(host.port)))};
}

std::vector<std::string> ids_for_port(const std::string& name, const Case& the_case,
                                      const HostOptions& host) {
  if (is_suite_file(name) || name.starts_with(the_case.profile)) return {};
  const auto port = describe_port(host, known_profile_names());
  if (!port) return {};
  std::vector<std::string> ids;
  for (const std::string& profile : port->profiles) {
    ids.push_back(fmt::format("{}/{}/{}", profile, the_case.group, the_case.name));
  }
  return ids;
}

std::vector<std::string> profiles_in(const std::vector<SelectedCase>& cases) {
  std::vector<std::string> profiles;
  for (const SelectedCase& one : cases) {
    const std::string& profile = one.the_case.profile;
    if (std::ranges::find(profiles, profile) == profiles.end()) profiles.push_back(profile);
  }
  return profiles;
}

CommandFor hover_command(const std::string& begin) {
  return [begin](const std::string& profile, const std::string& port) {
    const bool is_cascade = contains(find_profile(profile)->modules, Module::attitude_unit);
    return fmt::format("{} {}/flight/hover --rate {}{}", begin, profile,
                       is_cascade ? "250:1000" : "250", port);
  };
}

}  // namespace attest::cli
