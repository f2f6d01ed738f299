// A committed file with the worst costs of a port, as the port counts them: a regression test of
// the cost of a step. There is a row for each group of cases at a rate: finer than a module, so
// that a growth is found where another group is worse; coarser than a vector, so that people can
// review a change of the file.
//
// {"schema": "attest-cost-budget-1", "port": "acme-fc", "unit": "cycles", "clock_hz": 25000000.0,
//  "worst": [
//     {"cost": 2011, "group": "rates", "module": "mc_att_control", "profile": "px4-v1.5.5",
//      "rate_hz": "250", "tick": 3, "vector": "px4-v1.5.5/rates/p_alone@250hz"}, ...]}
//
// Each row is on a line of its own.
#pragma once

#include <compare>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/measure/vector_times.hpp"

namespace attest {

// What a row is of.
struct CostGroup {
  std::string profile, module, group, rate_hz;

  std::string to_string() const;  // "px4-v1.5.5/rates at 250 Hz, rate_unit"
  friend auto operator<=>(const CostGroup&, const CostGroup&) = default;
};

struct WorstCost {
  std::int64_t cost = 0;
  std::string vector;  // with the worst step
  std::size_t tick = 0;
};

struct CostBudget {
  std::string port;     // its declared name
  CostCounter counter;  // as declared
  std::map<CostGroup, WorstCost> worst;
};

CostBudget cost_budget_of(const CorpusTimes& times, std::string port, const CostCounter& counter);

std::string text_of(const CostBudget& budget);  // of the file

// Errors: no such file; not a file of this kind; a member that is missing, or wrong.
Result<CostBudget> read_cost_budget(const std::filesystem::path& path);

// Errors: `file` is of another port, another unit or another clock, or lacks a profile of `now`.
// Counts of another clock are other counts: the wait states of the memory depend on it.
Result<void> check_same_port(const CostBudget& file, const CostBudget& now,
                             const std::filesystem::path& path);

// A row whose worst cost is another than in the file, or that is not in the file.
struct CostChange {
  CostGroup group;
  std::optional<std::int64_t> before;  // empty: not in the file
  WorstCost now;
  bool fails = false;  // grew by more than the allowance, or is not in the file

  double growth_percent() const;  // REQUIRES: before > 0
  // "2,011 -> 2,190, +8.9%, in px4-v1.5.5/large_angle/flip@250hz"
  std::string to_string() const;
};

// In the order of decreasing growth; those that are not in the file come first. Rows of the file
// that are not in `now` are ignored: a run may select cases.
std::vector<CostChange> changes(const CostBudget& file, const CostBudget& now,
                                double allowed_growth_percent);

}  // namespace attest
