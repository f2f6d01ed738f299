// What all commands share: exit codes, errors, and the options of several commands.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "harness/casefile/select.hpp"
#include "harness/core/result.hpp"
#include "harness/host/port_process.hpp"

namespace attest::cli {

enum Exit : int {
  exit_ok = 0,
  exit_failed = 1,        // a vector or check failed, or the user refused `bless`
  exit_usage = 2,         // wrong usage, no result, or the environment: files, ports, goldens
  exit_interrupted = 130  // Ctrl-C or SIGTERM; the number that shells give after Ctrl-C
};

// The options of all commands.
struct Globals {
  std::string suite;   // folder with cases/ and golden/; empty: find_suite() searches for it
  bool quiet = false;  // print only failures and errors
  std::vector<std::string> words;  // the command line as it was given, without the command
  // The barrier of all ports (HostOptions::barrier). The command line completes it.
  std::shared_ptr<BarrierOptions> barrier = std::make_shared<BarrierOptions>();
};

// Prints "attest: error: <file:line: message>" on stderr, and returns exit_usage. If the command
// was interrupted, prints that and returns exit_interrupted.
int report_error(const Error& error);

// Errors: those of LoopRate::parse().
Result<std::vector<LoopRate>> parse_rates(const std::vector<std::string>& texts);

// A case as the command line names it.
struct CaseChoice {
  std::string name;     // of its file; or its name, a pattern or its id
  std::string profile;  // empty: not given
};

// --filter, --exclude, --group, --profile, --rate, --vehicle, --plant, --core, --core-flights,
// --shard and --rerun-failed, as text until they are used.
struct SelectionOptions {
  std::vector<std::string> filters, excludes, groups, profiles, rates, vehicles, plants;
  std::string shard = "1/1";
  bool core = false;          // only the vectors in open loop that the file CORE of the cases names
  bool core_flights = false;  // only the flights that it names
  std::string rerun_failed;   // a JSON report: only vectors that failed in it; empty: no report
  bool last_failed = false;   // rerun_failed is the report of the last run in this folder

  bool selects_all() const {
    return filters.empty() && excludes.empty() && groups.empty() && profiles.empty() &&
           rates.empty() && vehicles.empty() && plants.empty() && !core && !core_flights &&
           shard == "1/1" && rerun_failed.empty();
  }

  // The given options as text, except --profile and --shard: "--group tpa --rate 250".
  std::string narrowing() const;

  // The selected cases below `folders`. Errors: those of select_cases; text that is not a rate or a
  // shard; no file CORE, or none of its vectors is selected; a --rerun-failed that is no report, or
  // in which no selected vector failed.
  Result<std::vector<SelectedCase>> cases_in(const CaseFolders& folders) const;
};

// The results of `run` and `merge` for people and for other programs.
struct ReportOptions {
  std::map<std::string, std::string> files;  // file by ReportFormat::option; empty: no such report
  bool diagnose = true;                      // name the probable mistake if a vector fails
  bool verbose = false;                      // the summary has every failing case
  bool github = false;                       // annotations and a job summary for GitHub Actions
};

}  // namespace attest::cli
