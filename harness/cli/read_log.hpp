// The log of a flight, as the commands that take one read it.
#pragma once

#include <string>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/ulog/flight_log.hpp"

namespace attest::cli {

// The log with the profile to use: `profile` if it is not empty, else that of the log, else
// default_profile, with a note. `assumed` and errors: see read_flight_log().
Result<FlightLog> read_log(const std::string& file, const std::vector<std::string>& assumed,
                           const std::string& profile);

// On stderr.
void print_notes(const std::string& file, const std::vector<std::string>& notes);

}  // namespace attest::cli
