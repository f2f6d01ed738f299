// Which faults of the catalogue a suite catches, or a hunt finds, as a table.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "controller/faults/fault.hpp"
#include "harness/diagnosis/diagnose_catalogue.hpp"
#include "harness/diagnosis/fault_job.hpp"

namespace attest {

struct FaultFinding {
  const faults::Fault* fault = nullptr;
  std::string profile;
  FaultCatch found;
  bool by_hover = false, by_random_attitudes = false;
  HuntCatch hunted = {};

  // Whether an input exists in the profile for which the fault differs from the law.
  bool is_detectable() const;
  bool is_caught() const { return found.is_caught(); }
  bool is_caught_by_own_group() const;
};

// The faults that differ from the law in at least one of `profiles`.
std::vector<const faults::Fault*> detectable(std::vector<const faults::Fault*> faults,
                                             const std::vector<std::string>& profiles);

struct FaultSummary {
  std::size_t detectable = 0, caught = 0, by_hover = 0, by_random_attitudes = 0, by_naive = 0;
  std::vector<const FaultFinding*> survivors;     // detectable, not caught
  std::vector<const FaultFinding*> not_by_own;    // caught, but not by a case of their group
  std::vector<const FaultFinding*> false_alarms;  // not detectable in the profile, but caught
};
FaultSummary summary_of(const std::vector<FaultFinding>& findings);

// Of one profile: the faults for which the suite is wrong, a line each; empty: it is right.
std::vector<std::string> wrong_of_suite(const std::vector<FaultFinding>& findings);

// Markdown, of one profile: a row per group with its numbers of caught faults, a row per fault, and
// the totals.
std::string render_fault_table(const std::vector<FaultFinding>& findings);

// Markdown, of one profile: which of its detectable faults the suite catches, and which a hunt of
// each number of steps finds.
std::string render_hunted_faults(const std::vector<FaultFinding>& findings,
                                 const std::vector<std::size_t>& steps);

// Of one profile: the faults that the diagnosis does not name, and for how many the reports name
// the stage.
std::string render_self_diagnoses(const std::vector<SelfDiagnosis>& results,
                                  const std::string& profile);

// Markdown: which faults the log of a flight shows; if the reference does not agree with it, which
// faults agree. `findings`: of the faults that are detectable in its profile.
std::string render_faults_of_log(const std::string& log, const std::string& profile,
                                 const ReferenceOnLog& reference,
                                 const std::vector<FaultFinding>& findings);

// One line per fault: id, group, stage, profiles in which it is detectable, description.
std::string render_fault_list(const std::vector<const faults::Fault*>& faults);

}  // namespace attest
