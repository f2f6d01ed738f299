// A trace that was recorded elsewhere, with the profile and the module of a port to replay it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/loop/open_loop.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// The profile for a log of the controller that does not show whether it is of v1.5.5 or v1.3.4.
inline constexpr const char* default_profile = "px4-v1.5.5";

struct Recorded {
  Trace trace;
  Subject subject;
  // Assumptions and omissions that let a port replay the trace: one line each.
  std::vector<std::string> notes;
};

// Reads inputs and outputs. The file of a mixer may have the format of mixer_csv.hpp. An empty
// `profile` or `mixer` is taken from the provenance.toml in the folder of the file; a pipe has no
// provenance. Without an entry there, the profile is the newest that has the module (px4-v1.5.5 or
// px4-v1.16.0), and the mixer is the unscaled geometry that the file is named after ("4x.csv").
// Parameters that only other profiles have are left out. A battery without BAT_N_CELLS has 3 cells,
// as in the recordings of the firmware. Errors: those of open_trace() and check_parameter(); a
// mixer trace whose definition is missing, invalid, or of another number of rotors; a `mixer` for
// a trace of another module.
Result<Recorded> read_recorded(const std::filesystem::path& file, const std::string& profile = "",
                               const std::string& mixer = "");

// Errors: in that profile the module does not have such a parameter, or does not accept the value.
Result<void> check_parameter(const Subject& subject, const ParameterChange& change);

// Parses the text of --param: "MC_ROLL_P=6.5" is a change at tick 0. Errors: not NAME=VALUE with a
// finite number.
Result<ParameterChange> parse_parameter(const std::string& text);

// The change replaces all changes of that parameter in the trace.
void override_parameter(const ParameterChange& change, Trace& trace);

}  // namespace attest
