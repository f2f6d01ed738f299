// Checks the reference against traces recorded from the original firmware.
#pragma once

#include <cstddef>
#include <filesystem>
#include <set>
#include <string>

#include "harness/core/result.hpp"

namespace attest {

struct RecordedCheck {
  std::size_t traces = 0;
  std::size_t conforming = 0;
  std::string first_difference;  // file and what differs; empty when all conform
};

// Replays every trace below `folder` (golden/recorded) on the built-in reference. A trace conforms
// if the outputs agree to the bit, or within the tolerance that the provenance next to the trace
// states. Errors: a trace that cannot be read or was edited; a folder without traces.
Result<RecordedCheck> check_recorded(const std::filesystem::path& folder);

// The groups, "px4-v1.5.5/tpa", whose behaviour the recordings below `folder` show, according to
// their provenances. All other groups were checked by our own code only. Errors: a provenance that
// cannot be read.
Result<std::set<std::string>> covered_groups(const std::filesystem::path& folder);

}  // namespace attest
