#include "harness/report/terminal.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <set>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "harness/core/suite_files.hpp"
#include "harness/report/accuracy.hpp"
#include "harness/report/conclusion.hpp"
#include "harness/report/document.hpp"
#include "harness/report/failure_text.hpp"
#include "harness/report/matrix.hpp"
#include "harness/report/statement.hpp"
#include "harness/report/text.hpp"

namespace attest {
namespace {

std::string header(const RunResult& run) {
  std::string out = fmt::format("{} {} ({}) at the {} level, attest {}\n", one_line(run.port_name),
                                one_line(run.port_version), one_line(run.port), name_of(run.level),
                                run.attest_version);
  if (run.fixed_step) {
    out += fmt::format(
        "fixed step of {} Hz: cases begin one period after zero, and their goldens "
        "are shifted by the reference\n",
        run.fixed_step->to_string());
  }
  return out;
}

// The vectors of `group` after the first one: their rates, or the number of flights.
std::string others(const Together& group) {
  if (group.front()->plant_configuration) return "in " + counted(group.size() - 1, "more flight");
  std::vector<std::string> rates;
  for (const VectorResult* result : group) rates.push_back(result->rate.to_string());
  rates.erase(rates.begin());
  return fmt::format("at {} Hz", fmt::join(rates, ", "));
}

std::string failure(const Together& group, const RunResult& run, TerminalStyle style) {
  const VectorResult& shown = *group.front();
  const std::string text = failure_text(shown, run);
  const std::size_t line = text.find('\n');
  std::string out = painted(text.substr(0, line), Colour::red, style) + text.substr(line) + "\n";
  if (group.size() > 1) {
    out += fmt::format("  also {}: --filter {}\n", others(group),
                       shell_quoted(one_line(shown.case_id()) + "@*"));
  }
  return out;
}

// Failures without a deviation come first, because a crash hides what else is wrong. The others
// follow in the order of the law. What passed unexpectedly is last.
int order_of(const VectorResult& result) {
  if (result.verdict == Verdict::xpass) return 1 + static_cast<int>(stage_count);
  return result.first ? 1 + static_cast<int>(stage_of(*result.first)) : 0;
}

// Failing vectors of one case that have one verdict.
std::vector<Together> failing_cases(const Together& vectors) {
  std::vector<Together> cases;
  for (const VectorResult* result : vectors) {
    const auto known = std::ranges::find_if(cases, [&](const Together& one) {
      return one.front()->verdict == result->verdict && one.front()->case_id() == result->case_id();
    });
    if (known == cases.end())
      cases.push_back({result});
    else
      known->push_back(result);
  }
  return cases;
}

// "12 in attitude, 3 in modes"
std::string by_group(const std::vector<Together>& cases) {
  std::vector<std::pair<std::string, std::size_t>> counts;
  for (const Together& one : cases) {
    const std::string group = one_line(one.front()->group);
    auto known = std::ranges::find(counts, group, &std::pair<std::string, std::size_t>::first);
    if (known == counts.end()) known = counts.emplace(counts.end(), group, 0);
    ++known->second;
  }
  std::vector<std::string> parts;
  for (const auto& [group, count] : counts) parts.push_back(fmt::format("{} in {}", count, group));
  return fmt::format("{}", fmt::join(parts, ", "));
}

// Failures with one verdict and one first stage, or one reason: the case that tells most, and where
// the others are.
std::string finding(const Together& vectors, const RunResult& run, TerminalStyle style,
                    const std::string& specific_case) {
  std::vector<Together> cases = failing_cases(vectors);
  const auto shown = std::ranges::find_if(
      cases, [&](const Together& one) { return one.front()->case_id() == specific_case; });
  if (shown != cases.end()) std::iter_swap(cases.begin(), shown);
  std::string out = failure(cases.front(), run, style);
  cases.erase(cases.begin());
  if (cases.empty()) return out + "\n";
  return out +
         fmt::format("  {}, too: {}\n\n", counted(cases.size(), "other case"), by_group(cases));
}

std::string failures(const RunResult& run, TerminalStyle style, const std::string& specific_case,
                     bool verbose) {
  std::vector<Together> findings = grouped(
      run, [](const VectorResult& result) { return fails_a_run(result.verdict); },
      [](const VectorResult& a, const VectorResult& b) {
        return a.verdict == b.verdict && order_of(a) == order_of(b) &&
               (a.first || a.reason == b.reason);
      });
  std::ranges::stable_sort(findings, {},
                           [](const Together& one) { return order_of(*one.front()); });
  std::string out;
  if (verbose) {
    for (const Together& vectors : findings) {
      for (const Together& one : failing_cases(vectors)) out += failure(one, run, style) + "\n";
    }
    return out;
  }
  for (std::size_t i = 0; i < std::min(findings.size(), findings_shown); ++i) {
    out += finding(findings[i], run, style, specific_case);
  }
  return out;
}

// How to read the files of the cases, if they are in an archive.
std::string archive_note(const RunResult& run) {
  if (run.case_files.empty()) return {};
  const auto archive = archive_of(run.case_files.begin()->second);
  if (archive.empty()) return {};
  return fmt::format("the files of the cases are in {}; to copy them: attest list --extract DIR\n",
                     archive.string());
}

std::string_view plural_of(Quantity quantity) {
  constexpr std::pair<Quantity, std::string_view> names[] = {
      {Quantity::rate, "rates"},         {Quantity::control, "controls"},
      {Quantity::integral, "integrals"}, {Quantity::thrust, "thrust"},
      {Quantity::motor, "motors"},       {Quantity::scale, "scale"}};
  for (const auto& [known, name] : names) {
    if (known == quantity) return name;
  }
  return "others";
}

Quantity quantity_of(const VectorResult& result) {
  return channels()[result.tightest->channel].quantity;
}

// A result stores its tightest channel only. So a quantity is listed only if a channel of it is the
// tightest of some vector. The first line is the tightest of all vectors.
std::string headroom(const RunResult& run) {
  if (run.level != Level::numeric || run.count(Verdict::pass) == 0) return {};
  const auto groups = grouped(
      run,
      [](const VectorResult& result) {
        return result.verdict == Verdict::pass && result.tightest &&
               std::isfinite(result.tightest->ratio);
      },
      [](const VectorResult& a, const VectorResult& b) {
        return quantity_of(a) == quantity_of(b);
      });
  if (groups.empty()) return "tightest headroom: every value that passed agrees to the bit\n\n";
  const auto tighter = [](const VectorResult* a, const VectorResult* b) {
    return a->tightest->ratio < b->tightest->ratio;
  };
  Together tightest;
  for (const Together& group : groups) {
    tightest.push_back(*std::min_element(group.begin(), group.end(), tighter));
  }
  std::stable_sort(tightest.begin(), tightest.end(), tighter);
  std::string out =
      "tightest headroom (tolerance / difference), by quantity, where it is the tightest of a "
      "vector:\n";
  for (const VectorResult* result : tightest) {
    const Headroom& headroom = *result->tightest;
    out += fmt::format("  {:<9}  {:.1f}x on {} in {} at tick {}\n", plural_of(quantity_of(*result)),
                       headroom.ratio, channels()[headroom.channel].name, one_line(result->id()),
                       headroom.tick);
  }
  return out + "\n";
}

// Equal errors are shown once with their number: a missing golden, for example, is an error at
// every rate.
std::string errors(const RunResult& run, TerminalStyle style) {
  std::vector<std::pair<std::string, std::size_t>> distinct;
  for (const Error& error : run.errors) {
    const std::string text = printable(error.to_string());
    const auto same = std::find_if(distinct.begin(), distinct.end(),
                                   [&text](const auto& known) { return known.first == text; });
    if (same == distinct.end())
      distinct.emplace_back(text, 1);
    else
      ++same->second;
  }
  std::string out;
  for (std::size_t i = 0; i < std::min(distinct.size(), errors_shown); ++i) {
    const auto& [text, times] = distinct[i];
    out += fmt::format("{} {}{}\n", painted("error:", Colour::red, style), text,
                       times > 1 ? fmt::format(" ({} times)", times) : "");
  }
  if (distinct.size() > errors_shown) {
    out += fmt::format("and {}; see --json or --junit\n",
                       counted(distinct.size() - errors_shown, "other error"));
  }
  return out.empty() ? out : out + "\n";
}

// The rows of groups without a failure; the last row, with the sums, stays.
void leave_out_passing_groups(DocumentTable& table) {
  const auto passes = [](const std::vector<Cell>& row) {
    return !fails_a_run(*row.back().verdict);
  };
  const auto sums = std::prev(table.rows.end());
  const auto left_out = std::remove_if(table.rows.begin(), sums, passes);
  if (left_out == sums) return;
  table.caption += "; groups without a failure are left out";
  table.rows.erase(left_out, sums);
}

std::string matrices(const RunResult& run, TerminalStyle style, bool verbose) {
  std::string out;
  std::vector<DocumentTable> tables = matrices_of(run);
  if (tables.size() > 1 && !verbose) tables = {matrix_by_profile(run)};
  if (run.failed() && !verbose) {
    for (DocumentTable& table : tables) leave_out_passing_groups(table);
  }
  for (DocumentTable& table : tables) {
    for (std::vector<Cell>& row : table.rows) {
      for (Cell& cell : row) cell.small.clear();
    }
    out += render_text(table, style) + "\n";
  }
  const bool is_plain = run.count(Verdict::pass) == run.results.size() && run.not_run.empty();
  return is_plain
             ? out
             : out + fmt::format("n/m: n of m vectors passed; +k: k counted apart{}\n\n",
                                 run.not_run.empty() ? "" : "; *: stopped before all were run");
}

std::string accuracy(const RunResult& run, TerminalStyle style) {
  const auto table = accuracy_of(run);
  return table ? render_text(*table, style) + "\n" : "";
}

// "12 of 48 cases failed, such as px4-v1.5.5/tpa/by_pitch, ...". A case of several profiles is
// named in one of them.
std::string failed_cases(const RunResult& run) {
  constexpr std::size_t most_named = 8;
  std::set<std::string> all, failed, names;
  std::vector<std::string> named;
  for (const VectorResult& result : run.results) {
    all.insert(result.case_id());
    if (!fails_a_run(result.verdict)) continue;
    failed.insert(result.case_id());
    if (!names.insert(result.group + "/" + result.name).second) continue;
    if (named.size() < most_named) named.push_back(one_line(result.case_id()));
  }
  if (failed.empty()) return "";
  return fmt::format("{} of {} failed{} {}", failed.size(), counted(all.size(), "case"),
                     named.size() < failed.size() ? ", such as" : ":", fmt::join(named, ", ")) +
         "\n  --verbose shows all of them, --html FILE with plots; --json FILE and --junit FILE "
         "have "
         "all\n";
}

std::string verdict_line(const RunResult& run, double wall_s, TerminalStyle style) {
  const Conclusion conclusion = conclusion_of(run);
  const Colour colour = colour_of(verdict_of(conclusion));
  return fmt::format("{} {}\n", painted(capitals(name_of(conclusion)), colour, style),
                     conclusion_text(run, fmt::format(" in {:.1f} s", wall_s)));
}

// One line for a single claim; else a line for each claim, and one with suite, port and date.
std::string conformance(const RunResult& run) {
  const auto [claims, subject] = statement_of(run);
  if (claims.size() == 1) return fmt::format("conformance: {}\n", conformance_statement(run));
  return fmt::format("conformance:\n  {}\n  {}\n", fmt::join(claims, "\n  "), subject);
}

}  // namespace

bool wants_colour(bool is_terminal, const char* no_color, const char* term) {
  const bool refused = no_color != nullptr && *no_color != '\0';
  return is_terminal && !refused && term != nullptr && std::string_view(term) != "dumb";
}

TerminalStyle terminal_style(std::FILE* stream) {
  const bool is_terminal = isatty(fileno(stream)) != 0;
  TerminalStyle style;
  style.colour = wants_colour(is_terminal, std::getenv("NO_COLOR"), std::getenv("TERM"));
  winsize size{};
  if (is_terminal && ioctl(fileno(stream), TIOCGWINSZ, &size) == 0 && size.ws_col > 0) {
    style.width = std::min<int>(size.ws_col, most_columns);
  }
  return style;
}

std::string painted(std::string_view text, Colour colour, TerminalStyle style) {
  if (!style.colour || colour == Colour::none) return std::string(text);
  constexpr std::array codes{"0", "1", "32", "33", "31"};
  return fmt::format("\x1b[{}m{}\x1b[0m", codes[static_cast<std::size_t>(colour)], text);
}

std::string render_summary(const RunResult& run, double wall_s, TerminalStyle style,
                           const std::optional<Diagnosis>& diagnosis, bool verbose) {
  std::string out = header(run) + "\n";
  out += matrices(run, style, verbose);
  out += counted_apart_text(run);
  if (verbose) out += accuracy(run, style);
  if (verbose || !run.failed()) out += headroom(run);
  out += failures(run, style, diagnosis ? diagnosis->specific_case : "", verbose);
  if (run.failed()) out += archive_note(run);
  out += errors(run, style);
  out += failed_cases(run);
  if (const std::string stages = first_stages(run); !stages.empty()) out += stages + "\n";
  if (diagnosis && !diagnosis->explains_all()) out += specific_case_text(*diagnosis);
  out += conformance(run);
  if (const std::string lacks = needless_lacks_text(run); !lacks.empty()) out += lacks + "\n";
  if (diagnosis) out += mistakes_text(*diagnosis);
  return broken_at(style.width, out + verdict_line(run, wall_s, style));
}

}  // namespace attest
