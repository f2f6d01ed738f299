// The changes that blessing a case would make to its golden.
#pragma once

#include <string>

#include "harness/golden/new_goldens.hpp"

namespace attest {

// One line: the number of traces, ticks and channels that differ from `made`, and the largest
// deviation; or that the golden is new or replaced as a whole. Values are compared as at the exact
// level. If no value differs, the line says whether the case file, the vehicle's files, metrics or
// horizons changed. Empty if the golden is up to date. Errors: the origins of the old goldens were
// edited.
Result<std::string> change_of_golden(const Case& the_case, const MadeGolden& made,
                                     const Goldens& goldens);

}  // namespace attest
