// The report of `attest time`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "harness/measure/cost_budget.hpp"
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
  std::string port_name = {};               // as the port declares it
  std::optional<CostCounter> counter = {};  // TimeOptions::counter
  std::string budget_file = {};             // `changes` are against it; empty: none was given
  std::vector<CostChange> changes = {};
};

// The costs of the steps by module, of the slowest vectors, and by group and rate, compared with
// the budget; at each rate the share of the period that the slowest step takes; the distribution as
// a plot. With a counter, costs are in its unit; if the unit has a duration, the budget is compared
// with it. The changes against the budget file are notes. A note for each failing vector: if
// failing vectors with the same reason follow, one more note has their number. Without a step that
// was timed, only notes.
Document time_document(const TimeRun& run);

// REQUIRES: at least one vector was timed.
//
// {"schema": "attest-time-1", "attest_version": ..., "port": ..., "repeats": 5, "budget_us": null,
//  "all": {figures}, "modules": {"rate_unit": {figures}}, "slowest": id, "instructions": [...],
//  "counter": null, "budget_file": null, "changes": [],
//  "periods": [{"module": ..., "rate_hz": "250", "share": 0.12, "vector": id}, ...],
//  "vectors": [{"id": ..., "module": "rate_unit", figures}, ...]}
// figures: members such as "max_ns" and "steps". A vector that was not timed has no figures. With a
// counter, {"unit": "cycles", "clock_hz": 25e6}, figures are counts, such as "max_cycles"; those of
// cycles have times, too.
std::string time_json(const TimeRun& run);

}  // namespace attest
