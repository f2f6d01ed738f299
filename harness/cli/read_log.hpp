// The log of a flight, as the commands that take one read it.
#pragma once

#include <string>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/ulog/flight_log.hpp"

namespace attest::cli {

// The log with the profile to use: `profile` if it is not empty, else that of the log, else that of
// the release of PX4 that wrote it. If there is none of these, a log of the old controller gets
// default_profile, and a note. `assumed` and errors: see read_flight_log(). Also errors: no profile
// for a log of v1.14 to v1.16; a profile without the units of the log.
Result<FlightLog> read_log(const std::string& file, const std::vector<std::string>& assumed,
                           const std::string& profile);

// On stderr.
void print_notes(const std::string& file, const std::vector<std::string>& notes);

}  // namespace attest::cli
