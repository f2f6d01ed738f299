#include "harness/cli/read_log.hpp"

#include <cstdio>

#include <fmt/format.h>

#include "harness/golden/recorded.hpp"

namespace attest::cli {

Result<FlightLog> read_log(const std::string& file, const std::vector<std::string>& assumed,
                           const std::string& profile) {
  auto log = read_flight_log(file, assumed);
  if (!log) return log;
  if (!profile.empty()) log->profile = profile;
  if (log->profile.empty()) {
    log->profile = default_profile;
    log->notes.push_back(fmt::format("the profile is taken to be {} (--profile)", default_profile));
  }
  return log;
}

void print_notes(const std::string& file, const std::vector<std::string>& notes) {
  for (const std::string& note : notes) fmt::print(stderr, "attest: note: {}: {}\n", file, note);
}

}  // namespace attest::cli
