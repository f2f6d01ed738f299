// A trace that was recorded elsewhere, and the part of a port that receives it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/loop/open_loop.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// The profile of a log of the controller of v1.5.5 and v1.3.4, if the log does not show which of
// the two it is.
inline constexpr const char* default_profile = "px4-v1.5.5";

struct Recorded {
  Trace trace;
  Subject subject;
  // Assumptions and omissions that let a port replay the trace: one line each.
  std::vector<std::string> notes;
};

// Reads inputs and outputs. The file of a mixer may have the format of mixer_csv.hpp. An empty
// `profile` or `mixer` is taken from the provenance.toml in the folder of the file; a pipe has
// none. Without an entry there, the profile is the newest that has the module (px4-v1.5.5 or
// px4-v1.16.0), and the mixer is the unscaled geometry that the file is named after ("4x.csv").
// Parameters that the profile does not have are left out. A battery without BAT_N_CELLS has 3
// cells, as in the recordings of the firmware. Errors: of reading, and a mixer trace whose
// definition is missing, invalid, or of another number of rotors.
Result<Recorded> read_recorded(const std::filesystem::path& file, const std::string& profile = "",
                               const std::string& mixer = "");

// Errors: in that profile the module does not have such a parameter, or does not accept the value.
Result<void> check_parameter(const Subject& subject, const ParameterChange& change);

// The text of --param: "MC_ROLL_P=6.5" is a change at tick 0. Errors: other text.
Result<ParameterChange> parse_parameter(const std::string& text);

// The change replaces all changes of that parameter in the trace.
void override_parameter(const ParameterChange& change, Trace& trace);

}  // namespace attest
