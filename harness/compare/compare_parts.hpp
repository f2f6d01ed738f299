// Compares two traces of any length.
#pragma once

#include "harness/compare/compare.hpp"
#include "harness/trace/trace_parts.hpp"

namespace attest {

// Same as compare(). The traces are read part by part, in memory that does not grow with their
// length; whole at the events level, which looks ahead. Errors: those of TraceParts.
Result<Comparison> compare_parts(TraceParts& got, TraceParts& want, const Tolerances& tolerances);

}  // namespace attest
