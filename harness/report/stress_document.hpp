// The report of `attest stress`.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "harness/host/port_process.hpp"
#include "harness/measure/stress.hpp"
#include "harness/report/document.hpp"

namespace attest {

struct StressRun {
  std::string suite_folder;     // the value of --suite; empty: not given
  std::string case_file;        // as RunResult::case_files
  std::string port;             // the value of --port
  PortDescription description;  // as the port declares
  std::string load;             // for people; "none" without load
  LiveOptions live;
  RealtimeBudget budget;
  StressResults results;  // of all rates; the results of one rate follow each other
  bool interrupted = false;
};

// fail: a rate failed; pass: every rate passed; none: no rate passed, because none could be judged;
// partial: some rates passed, and the others could not be judged, or the run was interrupted.
Conclusion conclusion_of(const StressRun& run);
// The rates whose result is neither a pass nor a failure: "1000".
std::vector<std::string> rates_not_judged(const StressRun& run);

// The times of one result, compared with the idle machine; below it, its counts, its outputs and
// its verdict.
DocumentTable result_table(const StressResult& stress);

// The privileges that the operating system granted and refused.
std::vector<Fact> privileges_of(const StressResult& stress);

// For each rate and unit: verdict and reason, the times as tables and plots, and a timeline of the
// flight.
Document stress_document(const StressRun& run);

// A note on the unit of the cascade that the reference flew, because the port has only the other
// one. Empty: the port flew all units.
std::string note_on_units(const StressRun& run);
// A note that the port counts its execution times. Empty: the host measures them.
std::string note_on_cost(const StressRun& run);

// The run for reports that know no units, such as JUnit, with one result for each rate. For the
// cascade, the result is that of the unit with the graver verdict, with the reasons of both units.
RunResult run_of(const StressRun& run);

// As stress.schema.json describes it.
std::string stress_json(const StressRun& run);

}  // namespace attest
