// The files of a hunt.
#pragma once

#include <string>

#include "harness/core/result.hpp"
#include "harness/report/hunt_document.hpp"

namespace attest::cli {

// Writes each finding as a case of the suite `out`, and its inputs with the right outputs as a
// trace. `out` may be empty.
Result<void> write_findings(const std::string& out, HuntReport& report);

}  // namespace attest::cli
