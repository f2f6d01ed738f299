// The summary of a sweep as JSON, for other programs.
#pragma once

#include <string>

#include "harness/sweep/identity.hpp"
#include "harness/sweep/summary.hpp"

namespace attest {

// Numbers that are not finite are null. Ends with a line break.
std::string summary_json(const SweepIdentity& identity, const SampleColumns& columns,
                         const SweepSummary& summary);

}  // namespace attest
