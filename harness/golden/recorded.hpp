// A trace that was recorded elsewhere, and what of a port it is to be given to.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/loop/open_loop.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

struct Recorded {
  Trace trace;
  Subject subject;
  // What was taken for granted, or left out, so that the trace can be given to a port: a line each.
  std::vector<std::string> notes;
};

// With inputs and outputs; of mixers also as mixer_csv.hpp. What `profile` and `mixer` leave empty
// the provenance.toml in the folder of the file says, or else: px4-v1.5.5, and the unscaled
// geometry that the file is named after ("4x.csv"). Parameters that the profile does not have are
// left out. A battery without BAT_N_CELLS has 3 cells, as in the recordings of the firmware.
// Errors: of reading, and a mixer trace whose definition is missing, invalid, or of another number
// of rotors.
Result<Recorded> read_recorded(const std::filesystem::path& file, const std::string& profile = "",
                               const std::string& mixer = "");

// Errors: the module has no such parameter in that profile, or not of that value.
Result<void> check_parameter(const Subject& subject, const ParameterChange& change);

}  // namespace attest
