// All that the reports of a run say but for its diagnosis: the verdicts, and what they are about.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "harness/compare/tolerance.hpp"
#include "harness/verify/verdict.hpp"

namespace attest {

// What held the port during the run.
struct Limits {
  bool own_process = true;        // false: it shared that of its judge
  double timeout_s = 0;           // for each answer
  std::optional<int> memory_gib;  // empty: none
  int file_mib = 0;               // of each file it writes
};

// Everything the reports say, in the order of the cases, for any number of jobs.
struct RunResult {
  std::string attest_version;
  std::string command = "run";  // of attest, that made it: run or stress
  std::string timing;           // the file that was replayed; empty: the cases' own times
  std::string port;             // as given: "lib:./libmine.so"
  std::string port_name;        // as the port says
  std::string port_version;
  std::optional<int> fraction_bits;  // of a port in fixed point
  std::optional<Rate> fixed_step;    // of a port that knows only its own sample time
  Level level = Level::numeric;
  std::vector<Rate> rates;  // selected, ascending
  std::string selection;    // the options that selected less than all: "--group tpa"; or empty
  bool all_configurations = false;  // of each case that was selected, all were
  // "profile/group" -> how many cases the suite has at each rate, selected or not.
  std::map<std::string, std::map<Rate, std::size_t>> suite;
  std::string suite_folder;  // as --suite gives it; empty: the suite was found
  std::string cases_version = "unversioned", golden_version = "unversioned";  // of the suite
  std::string suite_sha256;                                                   // of its content
  bool suite_is_released = false;  // that content is the one this attest was released with
  std::string port_sha256;         // of its library; empty: the port is part of attest
  Limits limits;                   // of the port
  std::string date;                // of the run, UTC: "2026-03-31"
  std::vector<CaseResult> results;
  std::vector<Error> errors;   // of the environment: a golden that cannot be read, ...
  bool stopped_early = false;  // --fail-fast

  std::size_t count(Verdict verdict) const;
  bool failed() const;  // any verdict that fails a run
};

}  // namespace attest
