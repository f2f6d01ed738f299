// Traces in files of any format that attest reads.
#pragma once

#include <filesystem>

#include "harness/core/result.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// True if TraceReader (csv.hpp) can read the file tick by tick.
bool is_streamed(const std::filesystem::path& path);

// Reads the whole trace, from a pipe too. A CSV whose header names columns of a mixer trace is read
// as one (mixer_csv.hpp), any other file as in csv.hpp. Errors: those of the two readers.
Result<Trace> open_trace(const std::filesystem::path& path, TraceNeed need);

}  // namespace attest
