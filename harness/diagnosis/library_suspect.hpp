// The suspect of a diagnosis at the level exact: functions of the C library.
#pragma once

#include <optional>
#include <vector>

#include "harness/diagnosis/search.hpp"

namespace attest {

// Whether the vector has the port's bits.
inline bool passes(const ExactVector& vector) { return vector.library.with_set[0] == vector.ticks; }

// Of the calls that explain the most vectors, those of the fewest functions. All calls of a
// function come before a single one that explains no more. Empty if no calls explain half of the
// vectors that do not pass.
std::optional<Suspect> find_library_calls(const std::vector<ExactVector>& vectors);

}  // namespace attest
