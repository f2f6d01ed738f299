// The reports that a run can write to a file. The options of `attest run` and the writing of files
// both use this list.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>

#include "harness/diagnosis/diagnose.hpp"
#include "harness/verify/run_result.hpp"

namespace attest {

struct ReportFormat {
  std::string option;  // of `attest run`: "--junit"
  std::string help;
  std::function<std::string(const RunResult&, const std::optional<Diagnosis>&)> render;
};

std::span<const ReportFormat> report_formats();

}  // namespace attest
