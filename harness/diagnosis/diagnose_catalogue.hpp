// The quality of the diagnosis: each fault of the catalogue is diagnosed as if it were a port.
#pragma once

#include <string>
#include <vector>

#include "harness/casefile/select.hpp"
#include "harness/diagnosis/diagnose.hpp"

namespace attest {

struct SelfDiagnosis {
  const faults::Fault* fault = nullptr;
  std::optional<Diagnosis> diagnosis;  // empty: it agrees with the law on all vectors

  // Whether the fault is the first suspect, or in its ambiguity group.
  bool is_named() const;
  bool is_stage_named() const;
};

// For the faults that are detectable in the profile, on one vector per case, at 250 Hz where there
// is one. `cases` are open loop, all of that profile.
std::vector<SelfDiagnosis> diagnose_catalogue(const std::vector<SelectedCase>& cases,
                                              const std::string& profile);

}  // namespace attest
