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
  std::string first_difference;  // the file and the difference; empty when all conform
};

// Replays every trace below `folder` (golden/recorded) on the built-in reference. A trace conforms
// if the outputs agree to the bit, or within the tolerance that the provenance next to the trace
// states. Errors: a trace or provenance cannot be read, a trace was edited, the folder has no
// traces.
Result<RecordedCheck> check_recorded(const std::filesystem::path& folder);

// The groups, such as "px4-v1.5.5/tpa", that the recordings below `folder` cover according to their
// provenances. Errors: a provenance cannot be read.
Result<std::set<std::string>> covered_groups(const std::filesystem::path& folder);

}  // namespace attest
