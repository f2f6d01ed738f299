// The summary of a run as text for stdout.
#pragma once

#include <cstdio>
#include <optional>
#include <string>
#include <string_view>

#include "harness/diagnosis/diagnose.hpp"
#include "harness/verify/run_result.hpp"

namespace attest {

// The capabilities of an output stream. The default is for a file or a CI log.
struct TerminalStyle {
  bool colour = false;
  int width = 0;  // columns, at most most_columns; 0: no line is broken
};

// Lines are broken at this width also on a wider terminal, because long lines are hard to read.
inline constexpr int most_columns = 100;

// Colours need a terminal, TERM set and not "dumb", and NO_COLOR unset or empty.
TerminalStyle terminal_style(std::FILE* stream);

// Whether to use colours, by that rule. The pointers are the values of NO_COLOR and TERM, null if
// not set.
bool wants_colour(bool is_terminal, const char* no_color, const char* term);

enum class Colour { none, bold, green, yellow, red };
std::string painted(std::string_view text, Colour colour, TerminalStyle style);

// Limits of the summary. The report files have all failures and errors.
inline constexpr std::size_t findings_shown = 4;
inline constexpr std::size_t errors_shown = 20;

// First the details: the port; the table of groups and rates, or of groups and profiles if there
// are several; the results that are counted apart (unsupported, skip, xfail) with their reasons;
// the tightest headroom (numeric level); the findings, in the order of the law. A finding is a
// verdict and the stage that deviates first, and is shown by one case. The end of a long text is
// what a terminal shows, so then comes what matters: errors, the names of the failed cases, the
// stages that differ first, the conformance statement, and last the probable mistakes and the
// verdict:
//
//     PASS 715 vectors passed, 0 failed (px4-v1.5.5, exact, 11 rates) in 1.2 s
//
// PASS: no vector failed, no error occurred, and at least one vector passed. NONE: no failure and
// no error, but no vector passed. FAIL: all other runs. `wall_s` is the time of the whole run.
// Lines are broken at the width of the terminal, except commands to copy. Ends with a newline.
//
// `verbose` shows every failing case, a table by rate for each profile, the accuracy, and the
// headroom also if a vector failed.
std::string render_summary(const RunResult& run, double wall_s, TerminalStyle style,
                           const std::optional<Diagnosis>& diagnosis = {}, bool verbose = false);

}  // namespace attest
