// The law with functions of this machine's C library in place of attest's own (attest_math.h). The
// library's float functions may be off by an ulp. So a correct port that calls them can fail at the
// level exact, and the reference with the same functions then gives the port's outputs.
#pragma once

#include <cstddef>
#include <vector>

#include "controller/faults/fault.hpp"
#include "harness/casefile/case.hpp"
#include "harness/compare/tolerance.hpp"
#include "harness/host/declarations.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// Functions of the C library that a port calls; bit i is sinf, cosf, asinf, acosf, expf or atan2f.
using LibraryCalls = unsigned;
inline constexpr LibraryCalls library_call_sets = 1 << 6;

// For each set of calls, the number of ticks at which the reference with these calls has the port's
// outputs. Element 0 is that of the reference itself. Empty: not compared.
using LibraryMatches = std::vector<std::size_t>;

// `got` has the port's outputs, which are compared at the level of `tolerances`. A set that a run
// of the reference cannot tell from a smaller one is not run again.
Result<LibraryMatches> library_matches(const Trace& got, const Declarations& port,
                                       const Case& the_case, const Tolerances& tolerances);

// Describes a port that makes these calls. It is not in the catalogue of faults: such a port is
// correct. The reference stays valid until the program ends.
const faults::Fault& port_that_calls(LibraryCalls calls);

}  // namespace attest
