// Reads a trace from a CSV file of a unit or of a mixer.
#pragma once

#include <filesystem>

#include "harness/core/result.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// False for a mixer trace (mixer_csv.hpp), which TraceReader (csv.hpp) cannot read.
bool is_streamed(const std::filesystem::path& path);

// Reads the whole trace, from a pipe too. A file whose header has a column of mixer traces is read
// by read_mixer_csv(), any other file by read_csv(). Errors: those of these two functions, and of
// RereadableFile::open().
Result<Trace> open_trace(const std::filesystem::path& path, TraceNeed need);

}  // namespace attest
