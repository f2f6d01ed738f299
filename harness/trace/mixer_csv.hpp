// Mixer traces as recorded from the firmware: the inputs and outputs of a mixer, one row per call.
// The same rules for numbers and errors as in csv.hpp.
//
// Columns: roll, pitch, yaw, thrust, delta_out_max, out[0] ... out[rotors - 1], lower_limit,
// upper_limit, yaw_limit. The geometry is not in the file: provenance.toml has it under [mixers].
#pragma once

#include <filesystem>

#include "harness/core/result.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// Returns a trace of Module::mixer; its timestamps count the rows from 0. Errors: unreadable file,
// no header, unknown, repeated or missing column, a number of out[] columns other than 4, 6 and 8,
// a bad row or cell, no rows.
Result<Trace> read_mixer_csv(const std::filesystem::path& path);

// True if the header has a column that only mixer traces have. False for a file that has no header
// or cannot be read.
bool looks_like_mixer_csv(const std::filesystem::path& path);

}  // namespace attest
