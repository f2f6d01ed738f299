// How good diagnosis is: each fault of the catalogue, taken for a port, is diagnosed.
#pragma once

#include <string>
#include <vector>

#include "harness/casefile/select.hpp"
#include "harness/diagnosis/diagnose.hpp"

namespace attest {

struct SelfDiagnosis {
  const faults::Fault* fault = nullptr;
  std::optional<Diagnosis> diagnosis;  // empty: none of the vectors tells it from the law

  // Named first, or as good as the one that is.
  bool is_named() const;
  bool is_stage_named() const;
};

// Of the faults that the profile can tell, on one vector a case, at 250 Hz where there is one.
// `cases` are open loop, all of that profile.
std::vector<SelfDiagnosis> diagnose_catalogue(const std::vector<SelectedCase>& cases,
                                              faults::Profile profile);

}  // namespace attest
