// What a suite is worth: which wrong controllers it catches.
#pragma once

#include <string>
#include <vector>

#include "controller/faults/fault.hpp"
#include "harness/diagnosis/fault_job.hpp"

namespace attest {

struct FaultFinding {
  const faults::Fault* fault = nullptr;
  std::string profile;
  FaultCatch found;
  bool by_hover = false, by_random_attitudes = false;

  // In the profile, is there an input that tells it from the law?
  bool is_detectable() const;
  bool is_caught() const { return found.is_caught(); }
  bool is_caught_by_own_group() const;
};

struct FaultSummary {
  std::size_t detectable = 0, caught = 0, by_hover = 0, by_random_attitudes = 0, by_naive = 0;
  std::vector<const FaultFinding*> survivors;     // detectable, caught by nothing
  std::vector<const FaultFinding*> not_by_own;    // caught, but not by a case of their group
  std::vector<const FaultFinding*> false_alarms;  // equivalent to the law, and yet caught
};
FaultSummary summary_of(const std::vector<FaultFinding>& findings);

// Markdown: a row a group with what of it is caught, a row a fault, and the figures. Of one
// profile.
std::string render_fault_table(const std::vector<FaultFinding>& findings);

// One line a fault: id, group, stage, profiles that can tell it, what it does.
std::string render_fault_list();

}  // namespace attest
