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
  std::string suite_folder;     // as --suite gives it; empty: the suite was found
  std::string port;             // as given
  PortDescription description;  // as it declares
  std::string load;             // "none"
  LiveOptions live;
  RealtimeBudget budget;
  StressResults results;  // of all rates; those of one rate follow each other
  bool interrupted = false;
};

// "pass" when every rate passed; "fail" when one failed; "partial" when some passed and the others
// could not be judged, or the run was interrupted; "none" when no rate could be judged.
std::string_view verdict_of(const StressRun& run);
// The rates whose result is neither a pass nor a failure: "1000".
std::vector<std::string> rates_not_judged(const StressRun& run);

// One result, several lines, printed when its flight has ended.
std::string render_stress(const StressResult& stress, TerminalStyle style);

// The privileges that the operating system granted and refused; the last line, with the totals.
std::string render_privileges(const std::vector<RealtimePrivilege>& privileges);
std::string render_stress_end(const StressRun& run, TerminalStyle style);

// "1000", or "250:1000, attitude unit".
std::string rate_of(const StressResult& stress);

// Which unit of the cascade was the reference's, because the port has one of the two. Empty: none.
std::string note_on_units(const StressRun& run);

// The same run for the common reports, with one result for each rate: JUnit uses it. Of the units
// of the cascade the result is that of the unit with the gravest verdict, with the reasons of all.
RunResult run_of(const StressRun& run);

// As stress.schema.json describes it.
std::string stress_json(const StressRun& run);

// "8.13 us", "1.02 ms", "312 ns".
std::string human_time(Nanoseconds time);

}  // namespace attest
