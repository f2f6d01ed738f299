// The result of a run for GitHub Actions.
#pragma once

#include <optional>
#include <string>

#include "harness/diagnosis/diagnose.hpp"
#include "harness/verify/run_result.hpp"

namespace attest {

// GitHub shows ten errors and ten warnings of a step, and drops the others.
inline constexpr std::size_t annotations_shown = 10;

// Workflow commands, one a line: an error for each of at most annotations_shown failing vectors, an
// error for the first of RunResult::errors, and a warning with the number of the other failing
// vectors. The first failing vector of each group comes before all others. Empty without failure
// and error.
std::string github_annotations(const RunResult& run);

// `text` between two lines that keep GitHub from running workflow commands in `text`: a port may
// have a name such as "::stop-commands::x". Both lines contain the hash of the text, so that no
// line of the text can be the closing one.
std::string without_commands(const std::string& text);

// The job summary, in Markdown: a heading, tables of groups and rates, and render_summary() as
// preformatted text, folded.
std::string github_summary(const RunResult& run, double wall_s,
                           const std::optional<Diagnosis>& diagnosis);

}  // namespace attest
