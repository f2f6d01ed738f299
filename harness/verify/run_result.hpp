// The content of a run's reports, except the diagnosis: the verdicts and their context.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "harness/casefile/select.hpp"
#include "harness/compare/tolerance.hpp"
#include "harness/port/lacks.hpp"
#include "harness/process/barrier.hpp"
#include "harness/verify/verdict.hpp"

namespace attest {

// The limits of the port during the run.
struct Limits {
  bool own_process = true;        // false: it shared the judge's process
  double timeout_s = 0;           // for each answer
  std::optional<int> memory_gib;  // empty: no limit
  int file_mib = 0;               // of each file that the port writes
  BarrierParts barrier;           // that the kernel had
};

// Vectors that were selected, but not run.
struct NotRun {
  std::string profile, group;
  LoopRate rate;
  std::size_t vectors = 0;
};

// The results are in the order of the cases, for any number of jobs.
struct RunResult {
  std::string attest_version;
  std::string command = "run";  // the command that was run: run or stress
  std::string timing;           // file of the recorded times; empty: the cases' own times
  std::string port;             // as given: "lib:./libmine.so"
  std::string port_name;        // declared by the port
  std::string port_version;
  ModuleSet port_modules;                   // declared by the port
  std::optional<int> fraction_bits;         // of a port in fixed point
  std::optional<Rate> fixed_step;           // of a port with a fixed sample time
  std::vector<ParameterChange> parameters;  // of --param; they replace the cases' own
  Lacks lacks;                              // declared by the port
  Level level = Level::numeric;
  std::vector<LoopRate> rates;      // selected, ascending
  std::string selection;            // the options that selected vectors, except --shard
  bool all_configurations = false;  // each selected case is selected in all its configurations
  Shard shard;                      // the part of the selected vectors that was run
  std::size_t selected = 0;         // vectors of that shard
  // "profile/group" -> the number of the suite's vectors at each rate, selected or not.
  std::map<std::string, std::map<LoopRate, std::size_t>> suite;
  std::string suite_folder;  // as given with --suite; empty: not given
  // For people and services that open the files: paths from the folder where attest was started.
  std::map<std::string, std::string> case_files;    // "profile/group/name" -> the case file
  std::map<std::string, std::string> golden_files;  // the same -> the file of its golden
  std::map<std::string, std::string> whys;          // the same -> Case::why
  std::string cases_version = "unversioned", golden_version = "unversioned";  // of the suite
  std::string suite_reference;          // the port that made the goldens; empty: attest's reference
  std::string suite_sha256;             // of the suite's content
  bool suite_is_released = false;       // this attest was released with that content
  std::string port_sha256;              // of the port's files; empty: the port is part of attest
  std::vector<std::string> port_files;  // that a program named in the handshake
  Limits limits;                        // of the port
  std::string date;                     // of the run, UTC: "2026-03-31"
  std::vector<VectorResult> results;
  std::vector<Error> errors;    // of the environment, such as a golden that cannot be read
  bool stopped_early = false;   // vectors were left out, for example after --fail-fast
  std::vector<NotRun> not_run;  // then: the vectors that were left out

  // The options that selected vectors: "--group tpa --shard 2/4"; empty: all were selected.
  std::string selection_text() const;

  std::size_t count(Verdict verdict) const;
  bool failed() const;  // any verdict that fails a run
};

}  // namespace attest
