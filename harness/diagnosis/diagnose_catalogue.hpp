// Measures the quality of the report: diagnoses each fault of the catalogue as if it were a port,
// and compares the stages that the report names for its first deviations with that of the fault.
#pragma once

#include <string>
#include <vector>

#include "harness/casefile/select.hpp"
#include "harness/diagnosis/diagnose.hpp"

namespace attest {

// Whether the report of a failing vector ("look first at the ...") names the stage of a fault.
enum class StageLine {
  own,    // it does, alone or with others
  later,  // the fault's stage has no output; the report names a stage that uses its results
  wrong,
};

// `reported`: Deviation::stages of the first deviation.
StageLine stage_line(faults::Stage stage, const StageSet& reported);

struct SelfDiagnosis {
  const faults::Fault* fault = nullptr;
  std::optional<Diagnosis> diagnosis;  // empty: the fault agrees with the law on all vectors
  std::vector<StageLine> stage_lines;  // of the failing vectors

  // Whether the fault is the first suspect, or in its ambiguity group.
  bool is_named() const;
  bool is_stage_named() const;
  // The result for more than half of the failing vectors; without such a majority `wrong`.
  StageLine usual_stage_line() const;
};

// For each fault that is detectable in the profile. Uses one vector per case, at 250 Hz if the case
// has that rate, and leaves out long cases (is_long()). REQUIRES: `cases` are open-loop cases of
// that profile.
std::vector<SelfDiagnosis> diagnose_catalogue(const std::vector<SelectedCase>& cases,
                                              const std::string& profile);

}  // namespace attest
