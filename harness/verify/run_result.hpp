// The content of a run's reports, except the diagnosis: the verdicts and their context.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "harness/casefile/select.hpp"
#include "harness/compare/tolerance.hpp"
#include "harness/verify/verdict.hpp"

namespace attest {

// The limits of the port during the run.
struct Limits {
  bool own_process = true;        // false: it shared the judge's process
  double timeout_s = 0;           // for each answer
  std::optional<int> memory_gib;  // empty: no limit
  int file_mib = 0;               // of each file it writes
};

// The results are in the order of the cases, for any number of jobs.
struct RunResult {
  std::string attest_version;
  std::string command = "run";  // the command of attest that made it: run or stress
  std::string timing;           // the file that was replayed; empty: the cases' own times
  std::string port;             // as given: "lib:./libmine.so"
  std::string port_name;        // declared by the port
  std::string port_version;
  std::optional<int> fraction_bits;         // of a port in fixed point
  std::optional<Rate> fixed_step;           // of a port with a fixed sample time
  std::vector<ParameterChange> parameters;  // of --param, in place of the cases'
  ChannelSet not_recorded;                  // outputs that a recorded port does not have
  Level level = Level::numeric;
  std::vector<LoopRate> rates;      // selected, ascending
  std::string selection;            // the options that selected a part, except --shard
  bool all_configurations = false;  // of each selected case, all were selected
  Shard shard;                      // the part of the selected vectors that was run
  std::size_t selected = 0;         // vectors of that shard
  // "profile/group" -> how many cases the suite has at each rate, selected or not.
  std::map<std::string, std::map<LoopRate, std::size_t>> suite;
  std::string suite_folder;  // as --suite gives it; empty: the suite was found
  std::string cases_version = "unversioned", golden_version = "unversioned";  // of the suite
  std::string suite_reference;     // the port whose outputs its goldens are; empty: attest's own
  std::string suite_sha256;        // of its content
  bool suite_is_released = false;  // this attest was released with that content
  std::string port_sha256;         // of its library; empty: the port is part of attest
  Limits limits;                   // of the port
  std::string date;                // of the run, UTC: "2026-03-31"
  std::vector<CaseResult> results;
  std::vector<Error> errors;   // of the environment: a golden that cannot be read, ...
  bool stopped_early = false;  // --fail-fast

  // The options that selected a part: "--group tpa --shard 2/4"; empty: everything.
  std::string selection_text() const;

  std::size_t count(Verdict verdict) const;
  bool failed() const;  // any verdict that fails a run
};

}  // namespace attest
