// A stress run as text: a block per rate and unit, with the idle machine for comparison.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "harness/host/port_process.hpp"
#include "harness/measure/stress.hpp"
#include "harness/report/terminal.hpp"

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

// "fail": a rate failed; "pass": every rate passed; "none": no rate passed, because none could be
// judged; "partial": some rates passed, and the others could not be judged, or the run was
// interrupted.
std::string_view verdict_of(const StressRun& run);
// The rates whose result is neither a pass nor a failure: "1000".
std::vector<std::string> rates_not_judged(const StressRun& run);

// The text of one result, several lines.
std::string render_stress(const StressResult& stress, TerminalStyle style);

// The privileges that the operating system granted and refused.
std::string render_privileges(const std::vector<RealtimePrivilege>& privileges);
// The last line, with the totals.
std::string render_stress_end(const StressRun& run, TerminalStyle style);

// "1000", or "250:1000, attitude unit".
std::string rate_of(const StressResult& stress);

// A note on the unit of the cascade that the reference flew, because the port has only the other
// one. Empty: the port flew all units.
std::string note_on_units(const StressRun& run);

// The run for reports that know no units, such as JUnit, with one result for each rate. For the
// cascade, the result is that of the unit with the graver verdict, with the reasons of both units.
RunResult run_of(const StressRun& run);

// As stress.schema.json describes it.
std::string stress_json(const StressRun& run);

// "8.13 us", "1.02 ms", "312 ns".
std::string human_time(Nanoseconds time);

}  // namespace attest
