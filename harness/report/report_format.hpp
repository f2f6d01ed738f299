// The reports that a run can write to a file. The options of `run` and `merge` are made from this
// list.
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
  bool plots_traces = false;  // the report reads Report::traces
};

std::span<const ReportFormat> report_formats();

}  // namespace attest
