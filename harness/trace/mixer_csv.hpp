// Mixer traces as they were recorded from the firmware: what a mixer was given and what it answered
// with, a row a call. The same rules for numbers and errors as csv.hpp.
//
// Columns: roll, pitch, yaw, thrust, delta_out_max, out[0] ... out[rotors - 1], lower_limit,
// upper_limit, yaw_limit. The geometry is not in the file: provenance.toml has it under [mixers].
#pragma once

#include <filesystem>

#include "harness/core/result.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// As a trace of Module::mixer, whose timestamps count the rows. Errors as in csv.hpp: unreadable
// file, no header, unknown, repeated or missing column, a number of out[] columns other than 4, 6
// and 8, a bad row or cell, no rows.
Result<Trace> read_mixer_csv(const std::filesystem::path& path);

// Does the header have a column that only these files have? False for a file that has no header or
// cannot be read.
bool looks_like_mixer_csv(const std::filesystem::path& path);

}  // namespace attest
