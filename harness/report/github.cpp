#include "harness/report/github.hpp"

#include <algorithm>
#include <set>
#include <vector>

#include <fmt/format.h>

#include "harness/core/file.hpp"
#include "harness/report/conclusion.hpp"
#include "harness/report/document.hpp"
#include "harness/report/failure_text.hpp"
#include "harness/report/matrix.hpp"
#include "harness/report/terminal.hpp"
#include "harness/report/text.hpp"

namespace attest {
namespace {

// Percent-encodes %, CR, LF and the characters in `also` for a workflow command. GitHub decodes
// them.
std::string encoded(std::string_view text, std::string_view also = "") {
  std::string out;
  for (const char c : text) {
    const bool is_special =
        c == '%' || c == '\r' || c == '\n' || also.find(c) != std::string_view::npos;
    out += is_special ? fmt::format("%{:02X}", static_cast<unsigned char>(c)) : std::string(1, c);
  }
  return out;
}

// The value of a property, such as the title.
std::string property(std::string_view text) { return encoded(text, ":,"); }

// The first failing vector of each group, then the other ones.
std::vector<const VectorResult*> failures_by_group(const RunResult& run) {
  std::vector<const VectorResult*> first, others;
  std::set<std::string> groups;
  for (const VectorResult& result : run.results) {
    if (!fails_a_run(result.verdict)) continue;
    const bool is_first = groups.insert(result.profile + "/" + result.group).second;
    (is_first ? first : others).push_back(&result);
  }
  first.insert(first.end(), others.begin(), others.end());
  return first;
}

// Longer than any run of backticks in the text, so that the text cannot end the block.
std::string fence_of(const std::string& text) {
  std::size_t longest = 2, run = 0;
  for (const char c : text) {
    run = c == '`' ? run + 1 : 0;
    longest = std::max(longest, run);
  }
  return std::string(longest + 1, '`');
}

// A text in a cell of a table in Markdown. A name in it comes from a case file.
std::string cell_text(const std::string& text) {
  std::string out;
  for (const char c : one_line(text)) {
    if (std::string_view("|`<*\\[").find(c) != std::string_view::npos) out += '\\';
    out += c;
  }
  return out;
}

// The cells with a failure have a mark.
std::string markdown(const DocumentTable& table) {
  std::string out = cell_text(table.caption) + "\n\n|", line = "|---|";
  for (const std::string& name : table.header) out += fmt::format(" {} |", cell_text(name));
  for (std::size_t i = 1; i < table.header.size(); ++i) line += "---:|";
  out += "\n" + line + "\n";
  for (const std::vector<Cell>& row : table.rows) {
    out += "|";
    for (const Cell& cell : row) {
      const bool has_failed = cell.verdict && fails_a_run(*cell.verdict);
      out += fmt::format(" {}{} |", has_failed ? "\u274c " : "", cell_text(cell.text));
    }
    out += "\n";
  }
  return out + "\n";
}

}  // namespace

std::string github_annotations(const RunResult& run) {
  const auto failing = failures_by_group(run);
  std::string out;
  for (std::size_t i = 0; i < std::min(failing.size(), annotations_shown); ++i) {
    const VectorResult& result = *failing[i];
    out += fmt::format(
        "::error title={}::{}\n",
        property(fmt::format("{} {}", name_of(result.verdict), one_line(result.id()))),
        encoded(failure_headline(result) + "\nreproduce: " + reproduce_command(result, run)));
  }
  if (!run.errors.empty()) {
    out += fmt::format("::error title=attest::{}\n",
                       encoded(printable(run.errors.front().to_string())));
  }
  // This is a warning, because GitHub has a separate limit for warnings.
  if (failing.size() > annotations_shown) {
    out += fmt::format("::warning title=attest::{} not shown here; the job summary has more\n",
                       counted(failing.size() - annotations_shown, "more failing vector") +
                           (failing.size() - annotations_shown == 1 ? " is" : " are"));
  }
  return out;
}

std::string without_commands(const std::string& text) {
  return fmt::format("::stop-commands::{0}\n{1}::{0}::\n", sha256(text), text);
}

std::string github_summary(const RunResult& run, double wall_s,
                           const std::optional<Diagnosis>& diagnosis) {
  const std::string text = render_summary(run, wall_s, {}, diagnosis);
  const std::string fence = fence_of(text);
  std::string out = fmt::format("### attest: {}\n\n", capitals(name_of(conclusion_of(run))));
  for (const DocumentTable& table : matrices_of(run)) out += markdown(table);
  return out +
         fmt::format("<details><summary>the report</summary>\n\n{}text\n{}{}\n\n</details>\n\n",
                     fence, text, fence);
}

}  // namespace attest
