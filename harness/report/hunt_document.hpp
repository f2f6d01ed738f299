// The report of `attest hunt`.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "harness/diagnosis/hunt.hpp"
#include "harness/report/document.hpp"
#include "harness/verify/run_result.hpp"

namespace attest {

struct HuntReport {
  RunResult run;  // of the port, without results
  std::uint64_t seed = 1;
  std::vector<std::string> notes;  // on what the hunt began with
  HuntRun found;
  // Of each finding: the files that were written, and the command that runs them; empty: none.
  struct Written {
    std::string case_file, trace_file, command;
  };
  std::vector<Written> written;
};

// A row for each finding, and below the table its diagnosis, its case and its command.
Document hunt_document(const HuntReport& report);

// A result for each finding.
RunResult run_of(const HuntReport& report);

// {"schema": "attest-hunt-1", "attest_version": ..., "port": ..., "level": ..., "seed": 1,
//  "trials": ..., "steps": ..., "ended_early": reason or "", "notes": [...], "findings": [{"name":
//  ..., "fault": id or null, "trials": 12, "result": {as in the report of run}, "case": text,
//  "case_file": ..., "trace_file": ..., "command": ...}]}. Deterministic.
std::string hunt_json(const HuntReport& report);

}  // namespace attest
