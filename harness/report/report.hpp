// The input of every report of a run.
#pragma once

#include <filesystem>
#include <optional>

#include "harness/diagnosis/diagnose.hpp"
#include "harness/verify/run_result.hpp"

namespace attest {

struct Report {
  const RunResult& run;
  std::optional<Diagnosis> diagnosis;
  // The folder of save_traces(), with the traces of some failing vectors; empty: no traces.
  std::filesystem::path traces;
};

}  // namespace attest
