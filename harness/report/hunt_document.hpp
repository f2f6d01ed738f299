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
  std::string suite;  // the folder with the case files; empty: none were written
};

enum class HuntCases : std::uint8_t { shown, left_out };

// A row for each finding, and below the table what deviates, its files and its command. The cases
// are below the table, too, or left out; without files, a note then says how to get them.
Document hunt_document(const HuntReport& report, HuntCases cases);

// A result for each finding.
RunResult run_of(const HuntReport& report);

// {"schema": "attest-hunt-1", "attest_version": ..., "port": ..., "level": ..., "seed": 1,
//  "trials": ..., "steps": ..., "ended_early": reason or "", "notes": [...], "findings": [{"name":
//  ..., "fault": id or null, "fits": number of faults, "trials": 12, "result": {as in the report of
//  run}, "case": text, "case_file": ..., "trace_file": ..., "command": ...}]}. Deterministic.
std::string hunt_json(const HuntReport& report);

}  // namespace attest
