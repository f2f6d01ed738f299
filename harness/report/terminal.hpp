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

// Limits of the summary; failures_shown applies without --verbose. The report files have all
// failures and errors.
inline constexpr std::size_t failures_shown = 20;
inline constexpr std::size_t errors_shown = 20;

// The failures that the summary shows.
enum class Failures {
  first_of_each_group,  // the first case of each group and verdict, at most failures_shown
  all,
};

// First the conclusion: the port, the verdict line, the diagnosis, the stages that differ first,
// the conformance statement, errors. Then the details: the table of groups and rates; the failures,
// one block for the vectors of a case with the same verdict; the results that are counted apart
// (unsupported, skip, xfail) with their reasons; the tightest headroom (numeric level). The last
// line repeats the verdict line, because the beginning of a long text is not visible on a terminal:
//
//     PASS 715 of 715 vectors conform (px4-v1.5.5, exact, 11 rates) in 1.2 s
//
// PASS: no vector failed, no error occurred, and at least one vector passed. NONE: no failure and
// no error, but no vector passed. FAIL: all other runs. `wall_s` is the time of the whole run.
// Lines are broken at the width of the terminal, except commands to copy. Ends with a newline.
std::string render_summary(const RunResult& run, double wall_s, TerminalStyle style,
                           const std::optional<Diagnosis>& diagnosis = {},
                           Failures shown = Failures::first_of_each_group);

}  // namespace attest
