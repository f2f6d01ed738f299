#include "harness/cli/supported_profiles.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/cli/find_case.hpp"
#include "harness/cli/shared_arguments.hpp"
#include "harness/core/suite_files.hpp"
#include "harness/loop/flight.hpp"
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

std::vector<CaseChoice> choices_for_port(const CaseChoice& choice, const Case& the_case,
                                         const HostOptions& host) {
  const bool says_profile = !choice.profile.empty() || choice.name.starts_with(the_case.profile);
  if (is_suite_file(choice.name) || says_profile) return {};
  const auto port = describe_port(host, known_profile_names());
  if (!port) return {};
  std::vector<CaseChoice> choices;
  for (const std::string& profile : port->profiles) {
    choices.push_back({the_case.group + "/" + the_case.name, profile});
  }
  return choices;
}

std::optional<CaseChoice> flight_for_port(const CaseChoice& choice, const Case& the_case,
                                          const LoopRate& rate, const SuiteFolder& suite,
                                          const HostOptions& host) {
  for (const CaseChoice& one : choices_for_port(choice, the_case, host)) {
    const auto flight = find_flight(one, rate, suite);
    if (flight && check_rate(*flight, rate_of_flight(*flight, rate))) return one;
  }
  return std::nullopt;
}

bool supports_none(const PortDescription& port) {
  return port.profiles.empty() && port.hangs.empty() && port.goes_wrong.empty();
}

Result<PreparedFlight> prepare_for_flight(const CaseChoice& choice, const LoopRate& rate,
                                          const SuiteFolder& suite, HostOptions& host) {
  const auto the_case = find_flight(choice, rate, suite);
  if (!the_case) return tl::unexpected(the_case.error());
  const HostOptions fresh = host;
  auto port = prepare_port(host, {the_case->profile});
  if (!port) return tl::unexpected(port.error());
  PreparedFlight prepared{*std::move(port), choice};
  if (!supports_none(prepared.port)) return prepared;
  if (const auto other = flight_for_port(choice, *the_case, rate, suite, fresh)) {
    prepared.choice = *other;
    prepared.port.profiles = {other->profile};
  }
  return prepared;
}

std::vector<std::string> profiles_in(const std::vector<SelectedCase>& cases) {
  std::vector<std::string> profiles;
  for (const SelectedCase& one : cases) {
    const std::string& profile = one.the_case.profile;
    if (std::ranges::find(profiles, profile) == profiles.end()) profiles.push_back(profile);
  }
  return profiles;
}

namespace {

// The words of the command line except the case, its profile, its rates and the port: " --html f".
std::string other_words(const std::vector<std::string>& words, const std::string& case_name,
                        const std::string& port) {
  constexpr std::array replaced{"--case", "--profile", "--rate", "--rates", "--port"};
  std::string others;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    const std::string name = word.substr(0, word.find('='));
    if (std::ranges::find(replaced, name) != replaced.end()) {
      i += name == word ? 1 : 0;  // its value
    } else if (full_case_name(word) != case_name && port_of_file(word) != port) {
      others += " " + shell_word(word);
    }
  }
  return others;
}

}  // namespace

CommandFor hover_command(const std::string& begin, const Globals& globals,
                         const std::string& case_name, const std::string& port) {
  return [begin, others = other_words(globals.words, case_name, port)](
             const std::string& profile, const std::string& port_option) {
    const bool is_cascade = contains(find_profile(profile)->modules, Module::attitude_unit);
    return fmt::format("{} {}/flight/hover --rate {}{}{}", begin, profile,
                       is_cascade ? "250:1000" : "250", port_option, others);
  };
}

}  // namespace attest::cli
