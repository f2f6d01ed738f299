// Traces in files of any format that attest reads.
#pragma once

#include <filesystem>

#include "harness/core/result.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// Whether TraceReader (csv.hpp) can read it tick by tick.
bool is_streamed(const std::filesystem::path& path);

// The whole trace. A CSV whose header names columns of a mixer trace is read as one
// (mixer_csv.hpp), any other file as csv.hpp says. Errors: those of the two readers.
Result<Trace> open_trace(const std::filesystem::path& path, TraceNeed need);

}  // namespace attest
