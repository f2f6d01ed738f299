// Reads the log of a flight, for the commands that take a log.
#pragma once

#include <string>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/ulog/flight_log.hpp"

namespace attest::cli {

// The log with the profile to use: `profile` if it is not empty, else that of the log, else that of
// the release of PX4 that wrote it. If none of these exists, a log of the controller of v1.5.5 and
// v1.3.4 gets the nearest one, or default_profile if it does not say its release, and a note. A
// note also says that the firmware was no release. For `assumed`, see read_flight_log(). Errors:
// those of read_flight_log(); a log of v1.14 to v1.18 without such a profile; a profile without the
// units of the log; the file is no log.
Result<FlightLog> read_log(const std::string& file, const std::vector<std::string>& assumed,
                           const std::string& profile, bool whole = true);

// The same, but a log that cannot be replayed is no error: see FlightLog::too_little and
// no_profile, which also says that `profile` does not have the units of the log.
Result<FlightLog> read_any_log(const std::string& file, const std::vector<std::string>& assumed,
                               const std::string& profile, bool whole);

// Prints the notes on stderr.
void print_notes(const std::string& file, const std::vector<std::string>& notes);

}  // namespace attest::cli
