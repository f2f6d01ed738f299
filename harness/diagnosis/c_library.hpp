// The law with functions of this machine's C library in place of attest's own (attest_math.h). The
// library's float functions may be off by an ulp. So a correct port that calls them can fail at the
// level exact, and the reference with the same functions then gives the port's outputs.
#pragma once

#include <cstddef>
#include <map>
#include <string>
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

// One of these functions, and the function of the law that calls it: "atan2f@tilt_error".
using LibraryCall = std::string;

// The number of ticks at which the reference has the port's outputs if it calls the C library.
struct LibraryMatches {
  std::vector<std::size_t> with_set;               // element 0: the reference itself
  std::map<LibraryCall, std::size_t> with_single;  // only calls that matter in this vector

  // Without a call that does not matter here, the reference has the same outputs.
  std::size_t with(const LibraryCall& single) const;
};

// `got` has the port's outputs, which are compared at the level of `tolerances`. Calls that a run
// of the reference cannot tell from fewer ones are not run again.
Result<LibraryMatches> library_matches(const Trace& got, const Declarations& port,
                                       const Case& the_case, const Tolerances& tolerances);

// Describes a port that makes these calls. It is not in the catalogue of faults: such a port is
// correct. The reference stays valid until the program ends. One thread at a time.
const faults::Fault& port_that_calls(LibraryCalls calls);
const faults::Fault& port_that_calls(const LibraryCall& single);

}  // namespace attest
