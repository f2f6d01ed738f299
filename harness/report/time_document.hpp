// The report of `attest time`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "harness/measure/vector_times.hpp"
#include "harness/report/document.hpp"

namespace attest {

struct TimeRun {
  std::string port;
  int repeats = 1;
  std::optional<double> budget_us;
  CorpusTimes times;
  std::vector<std::uint64_t> instructions;  // of the slowest vector's steps; empty: not counted
  std::uint64_t allowed = 0;                // number of steps that may be over the budget
};

// The step times by module, of the slowest vectors, and by group and rate, compared with the
// budget; their distribution as a plot. A note for each failing vector: if failing vectors with the
// same reason follow, one more note has their number. Without a step that was timed, only notes.
Document time_document(const TimeRun& run);

// REQUIRES: at least one vector was timed.
//
// {"schema": "attest-time-1", "attest_version": ..., "port": ..., "repeats": 5, "budget_us": null,
//  "all": {figures}, "modules": {"rate_unit": {figures}}, "slowest": id, "instructions": [...],
//  "vectors": [{"id": ..., "module": "rate_unit", figures}, ...]}
// figures: members such as "max_ns" and "steps". A vector that was not timed has no figures.
std::string time_json(const TimeRun& run);

}  // namespace attest
