// Measures the quality of the diagnosis: diagnoses each fault of the catalogue as if it were a
// port.
#pragma once

#include <string>
#include <vector>

#include "harness/casefile/select.hpp"
#include "harness/diagnosis/diagnose.hpp"

namespace attest {

struct SelfDiagnosis {
  const faults::Fault* fault = nullptr;
  std::optional<Diagnosis> diagnosis;  // empty: the fault agrees with the law on all vectors

  // Whether the fault is the first suspect, or in its ambiguity group.
  bool is_named() const;
  bool is_stage_named() const;
};

// For each fault that is detectable in the profile. Uses one vector per case, at 250 Hz if the case
// has that rate, and leaves out long cases (is_long()). REQUIRES: `cases` are open-loop cases of
// that profile.
std::vector<SelfDiagnosis> diagnose_catalogue(const std::vector<SelectedCase>& cases,
                                              const std::string& profile);

}  // namespace attest
