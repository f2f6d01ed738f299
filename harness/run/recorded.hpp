// A trace that was recorded elsewhere, and what of a port it is to be given to.
#pragma once

#include <filesystem>
#include <string>

#include "harness/core/result.hpp"
#include "harness/run/open_loop.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

struct Recorded {
  Trace trace;
  Subject subject;
};

// With inputs and outputs; of mixers also as mixer_csv.hpp. What `profile` and `mixer` leave empty
// the provenance.toml beside the file says, or else: px4-v1.5.5, and the unscaled geometry that the
// file is named after ("4x.csv"). Errors: of reading, and a mixer trace whose definition nobody
// says, is none, or has another number of rotors.
Result<Recorded> read_recorded(const std::filesystem::path& file, const std::string& profile = "",
                               const std::string& mixer = "");

// Errors: the part has no such parameter, or not of that value.
Result<void> check_parameter(Part part, const ParameterChange& change);

}  // namespace attest
