// The reports that a run can write to a file. The options of `attest run` and the writing of files
// both use this list.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "harness/report/report.hpp"

namespace attest {

struct ReportFormat {
  std::string option;  // of `attest run`: "--junit"
  std::string help;
  std::function<std::string(const Report&)> render;
  bool plots_traces = false;  // it reads Report::traces
};

std::span<const ReportFormat> report_formats();

}  // namespace attest
