// The outside judge of the reference: traces recorded from the original firmware.
#pragma once

#include <cstddef>
#include <filesystem>
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

}  // namespace attest
