// The summary of a run for people, on stdout.
#pragma once

#include <cstdio>
#include <optional>
#include <string>
#include <string_view>

#include "harness/diagnosis/diagnose.hpp"
#include "harness/verify/run_result.hpp"

namespace attest {

// What the stream can show. The default is what a file or a CI log gets.
struct TerminalStyle {
  bool colour = false;
  int width = 0;  // in columns; 0: unlimited, no line is broken
};

// The one place that decides: colours only on a terminal, and not when NO_COLOR is set to anything
// but the empty string, nor when TERM is unset or "dumb".
TerminalStyle terminal_style(std::FILE* stream);

// The decision itself. The pointers are values of environment variables and may be null.
bool wants_colour(bool is_terminal, const char* no_color, const char* term);

enum class Colour { none, bold, green, yellow, red };
std::string painted(std::string_view text, Colour colour, TerminalStyle style);

// At most so many failing cases and errors are told; the files tell all.
inline constexpr std::size_t failures_told = 20;
inline constexpr std::size_t errors_told = 20;

// Pure. In order: who was tested; the table of groups and rates; the failures, a case that fails
// alike at several rates told once; what is counted apart (unsupported, skip, xfail) with its
// reasons; the tightest headroom (numeric level); errors; what is conformant; and one last line:
//
//     PASS 715 of 715 cases conform (px4-v1.5.5, exact, 11 rates) in 1.2 s
//
// PASS says that nothing failed, there was no error and something was compared; where nothing was,
// the word is NONE. `wall_s` is the time of the whole run. Ends with a
// newline.
std::string render_summary(const RunResult& run, double wall_s, TerminalStyle style,
                           const std::optional<Diagnosis>& diagnosis = {});

}  // namespace attest
