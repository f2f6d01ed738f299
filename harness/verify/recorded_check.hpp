// The outside judge of the reference: traces recorded from the original firmware.
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

// Replays every trace below `folder` (golden/recorded) on the built-in reference: to the bit,
// except where the provenance beside a trace states a tolerance. Errors: a trace that cannot be
// read, no traces at all.
Result<RecordedCheck> check_recorded(const std::filesystem::path& folder);

// The groups, "px4-v1.5.5/tpa", whose behaviour the recordings below `folder` show, as the
// provenance of each says. What no recording covers, only our own code has seen. Errors: a
// provenance that cannot be read.
Result<std::set<std::string>> covered_groups(const std::filesystem::path& folder);

}  // namespace attest
