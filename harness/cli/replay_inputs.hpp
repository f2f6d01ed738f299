// The options of `attest replay`, and the traces and logs that it opens.
#pragma once

#include <string>
#include <vector>

#include "harness/cli/globals.hpp"
#include "harness/compare/log_agreement.hpp"
#include "harness/core/result.hpp"
#include "harness/golden/recorded.hpp"
#include "harness/host/file_format.hpp"
#include "harness/ulog/flight_log.hpp"

namespace attest::cli {

struct ReplayOptions {
  std::vector<std::string> files;
  HostOptions host;
  std::string profile;
  std::string level = "numeric";
  std::string mixer;
  std::vector<std::string> parameters;
  std::vector<std::string> assumed;  // assumption_words() for what a flight log lacks
  LogLimits log_limits;
  std::string html, json;  // files; empty: not wanted
  int jobs = 1;
};

// Whether `attest replay` takes files of this format.
bool is_replayed(const FileFormat& format);

// A trace, with the parameters of --param. Errors: it is no trace; a wrong --param.
Result<RecordedParts> recorded_in(const std::string& file, const ReplayOptions& options);

// A log, and in it the profile to replay it with. Errors: it is no log; --mixer; a --param that no
// unit in it has. `whole`: as for read_flight_log().
Result<FlightLog> log_in(const std::string& file, const ReplayOptions& options, bool whole);

// The values of --param whose parameter the unit has. REQUIRES: log_in() succeeded.
std::vector<ParameterChange> parameters_of(const ReplayOptions& options, const FlightLog& log,
                                           const LoggedUnit& unit);

}  // namespace attest::cli
