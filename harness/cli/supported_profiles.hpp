// The error of a command whose cases are all of releases that the port does not have.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "harness/casefile/select.hpp"
#include "harness/cli/globals.hpp"
#include "harness/cli/suite_folder.hpp"
#include "harness/core/result.hpp"
#include "harness/host/port_process.hpp"

namespace attest::cli {

// A command line for a profile. `port` is " --port lib:mine.so".
using CommandFor = std::function<std::string(const std::string& profile, const std::string& port)>;

// "lib:mine.so supports px4-v1.18, px4-v1.17, not px4-v1.5.5; write: attest run --profile px4-v1.18
// --port lib:mine.so". Asks the port about every profile. Empty if the port supports one of
// `missing`, if that is empty, or if the port crashes or does not answer.
std::optional<Error> supported_instead(const HostOptions& host,
                                       const std::vector<std::string>& missing,
                                       const CommandFor& command);

// A case that was found by `choice`, in the profiles that the port supports, in the order of
// known_profile_names(). Asks the port about every profile. Empty if `choice` is a file or says the
// profile.
std::vector<CaseChoice> choices_for_port(const CaseChoice& choice, const Case& the_case,
                                         const HostOptions& host);

// The same flight in the first profile of the port in which it flies at `rate`. Empty: there is no
// such profile, or choices_for_port() is empty.
std::optional<CaseChoice> flight_for_port(const CaseChoice& choice, const Case& the_case,
                                          const LoopRate& rate, const SuiteFolder& suite,
                                          const HostOptions& host);

// The port has none of the profiles about which it was asked, and made no mistake.
bool supports_none(const PortDescription& port);

// A port, and the flight to fly with it: that of the command line or, if the port does not have its
// profile, that of flight_for_port().
struct PreparedFlight {
  PortDescription port;  // its profiles: that of the flight, if the port has it
  CaseChoice choice;
};
// Errors: those of find_flight() and prepare_port().
Result<PreparedFlight> prepare_for_flight(const CaseChoice& choice, const LoopRate& rate,
                                          const SuiteFolder& suite, HostOptions& host);

// Those of the cases, each once.
std::vector<std::string> profiles_in(const std::vector<SelectedCase>& cases);

// `begin` with the hover flight of the profile, and with the other options of the command line:
// "attest sim px4-v1.18/flight/hover --rate 250:1000 --port lib:mine.so --html f.html".
CommandFor hover_command(const std::string& begin, const Globals& globals,
                         const std::string& case_name, const std::string& port);

}  // namespace attest::cli
