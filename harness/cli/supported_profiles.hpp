// The error of a command whose cases are all of releases that the port does not have.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "harness/casefile/select.hpp"
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

// The ids of a case that was found by `name`, in the profiles that the port supports, in the order
// of known_profile_names(). Asks the port about every profile. Empty if `name` is that of a file or
// begins with the profile.
std::vector<std::string> ids_for_port(const std::string& name, const Case& the_case,
                                      const HostOptions& host);

// Those of the cases, each once.
std::vector<std::string> profiles_in(const std::vector<SelectedCase>& cases);

// `begin` with the hover flight of the profile: "attest sim px4-v1.18/flight/hover --rate 250:1000
// --port lib:mine.so".
CommandFor hover_command(const std::string& begin);

}  // namespace attest::cli
