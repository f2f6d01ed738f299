#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <kainjow/mustache.hpp>
#include <nlohmann/json.hpp>

#include "harness/core/embed.hpp"
#include "harness/core/file.hpp"
#include "harness/report/document.hpp"
#include "harness/report/html/plot_data.hpp"
#include "harness/report/text.hpp"

ATTEST_EMBED(page_template, ATTEST_PAGE_TEMPLATE);
ATTEST_EMBED(page_style, ATTEST_PAGE_STYLE);
ATTEST_EMBED(results_style, ATTEST_RESULTS_STYLE);
ATTEST_EMBED(results_script, ATTEST_RESULTS_SCRIPT);
ATTEST_EMBED(details_script, ATTEST_DETAILS_SCRIPT);
ATTEST_EMBED(vector_plots_script, ATTEST_VECTOR_PLOTS_SCRIPT);
ATTEST_EMBED(shared_script, ATTEST_SHARED_SCRIPT);
ATTEST_EMBED(plots_script, ATTEST_PLOTS_SCRIPT);
ATTEST_EMBED(replay_script, ATTEST_REPLAY_SCRIPT);
ATTEST_EMBED(dygraphs_script, ATTEST_DYGRAPHS_SCRIPT);
ATTEST_EMBED(dygraphs_style, ATTEST_DYGRAPHS_STYLE);
ATTEST_EMBED(dygraphs_synchronizer, ATTEST_DYGRAPHS_SYNCHRONIZER);
ATTEST_EMBED(dygraphs_licence, ATTEST_DYGRAPHS_LICENCE);

namespace attest {
namespace {

using Values = kainjow::mustache::data;

// Without the comment that names a source map: a browser's debugger would request that file.
std::string_view without_source_map(std::string_view text) {
  return text.substr(0, text.find("# sourceMappingURL=") - 2);
}

// Runs before the body is shown. The class `scripted` hides the table of all results, so that a
// browser does not lay it out; results.js replaces it by a list.
constexpr std::string_view boot_script = "document.documentElement.classList.add('scripted')";

// 'sha256-...' of a script, as a content security policy names it.
std::string policy_hash(std::string_view script) {
  const std::string hex = sha256(script);
  std::string bytes;
  for (std::size_t i = 0; i < hex.size(); i += 2) {
    bytes += static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16));
  }
  return fmt::format("'sha256-{}'", base64(bytes));
}

// Does not set an empty value, because mustache shows a section also for an empty text.
void set_text(Values& out, const char* name, std::string_view value) {
  if (!value.empty()) out.set(name, Values(std::string(value)));
}

Values values_of(std::initializer_list<std::pair<const char*, std::string>> texts) {
  Values out;
  for (const auto& [name, value] : texts) set_text(out, name, value);
  return out;
}

template <typename Items, typename ToData>
Values list_of(const Items& items, ToData to_data) {
  Values list(Values::type::list);
  for (const auto& item : items) list.push_back(to_data(item));
  return list;
}

// One character.
std::string_view symbol_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::pass:
      return "\u2713";  // check mark
    case Verdict::fail:
      return "\u2717";  // ballot x
    case Verdict::crash:
      return "\u2738";  // star
    case Verdict::timeout:
      return "\u25f7";  // clock face
    case Verdict::protocol:
      return "\u00a7";  // section sign
    case Verdict::non_finite:
      return "\u221e";  // infinity
    case Verdict::unsupported:
      return "\u2013";  // dash
    case Verdict::skip:
      return "\u25cb";  // circle
    case Verdict::xfail:
      return "\u25c7";  // white diamond
    case Verdict::xpass:
      return "\u25c6";  // black diamond
  }
  return "";
}

// The styles, the scripts in the order in which they run, and the hashes of the scripts for the
// content security policy. The first script is in the head, the last ones follow the data.
void add_files(bool is_of_run, Values& page) {
  std::vector<std::string_view> scripts = {without_source_map(ATTEST_EMBEDDED(dygraphs_script)),
                                           ATTEST_EMBEDDED(dygraphs_synchronizer),
                                           ATTEST_EMBEDDED(shared_script)};
  if (is_of_run)
    scripts.insert(scripts.end(),
                   {ATTEST_EMBEDDED(vector_plots_script), ATTEST_EMBEDDED(details_script),
                    ATTEST_EMBEDDED(results_script)});
  else
    scripts.insert(scripts.end(), {ATTEST_EMBEDDED(plots_script), ATTEST_EMBEDDED(replay_script)});
  std::string hashes = policy_hash(boot_script);
  for (const std::string_view script : scripts) hashes += " " + policy_hash(script);
  set_text(page, "boot", boot_script);
  set_text(page, "script_hashes", hashes);
  page.set("scripts", list_of(scripts, [](std::string_view script) {
             return Values("script", Values(std::string(script)));
           }));
  set_text(page, "style", ATTEST_EMBEDDED(page_style));
  set_text(page, "results_style", ATTEST_EMBEDDED(results_style));
  set_text(page, "dygraphs_style", without_source_map(ATTEST_EMBEDDED(dygraphs_style)));
  set_text(page, "dygraphs_licence", ATTEST_EMBEDDED(dygraphs_licence));
}

void add_head(const DocumentHead& head, Values& page) {
  set_text(page, "outcome", name_of(conclusion_of(head.verdict)));
  set_text(page, "conclusion_symbol", symbol_of(head.verdict));
  set_text(page, "word", head.word);
  set_text(page, "title", one_line(head.title));
  set_text(page, "sentence", one_line(head.sentence));
}

Values cell_to_data(const Cell& cell, bool numeric) {
  Values out;
  std::string classes = numeric ? "number" : "";
  if (cell.verdict) {
    classes += fmt::format("{}v-{}", numeric ? " " : "", name_of(*cell.verdict));
    set_text(out, "verdict", name_of(*cell.verdict));
    set_text(out, "symbol", symbol_of(*cell.verdict));
  }
  set_text(out, "class", classes);
  set_text(out, "text", one_line(cell.text));
  set_text(out, "small", one_line(cell.small));
  set_text(out, "link", cell.link);
  return out;
}

Values line_to_data(const Cell& line) { return cell_to_data(line, false); }

// Keeps the spaces that indent and align the line.
Values line_below_to_data(const Cell& line) {
  Values out = line_to_data(line);
  std::string text = printable(line.text);
  std::ranges::replace(text, '\n', ' ');
  set_text(out, "text", text);
  return out;
}

Values table_to_data(const DocumentTable& table) {
  std::vector<bool> numeric;
  Values header(Values::type::list), rows(Values::type::list);
  for (std::size_t i = 0; i < table.header.size(); ++i) {
    numeric.push_back(is_numeric(table, i));
    header.push_back(cell_to_data(Cell(table.header[i]), numeric.back()));
  }
  for (const std::vector<Cell>& row : table.rows) {
    Values cells(Values::type::list), out;
    for (std::size_t i = 1; i < row.size(); ++i) {
      cells.push_back(cell_to_data(row[i], i < numeric.size() && numeric[i]));
    }
    out.set("head", cell_to_data(row.empty() ? Cell() : row.front(), false));
    out.set("cells", cells);
    rows.push_back(out);
  }
  Values out;
  set_text(out, "caption", one_line(table.caption));
  set_text(out, "id", table.id);
  out.set("header", header);
  out.set("rows", rows);
  out.set("has_columns", !table.header.empty());
  out.set("below", list_of(table.below, line_below_to_data));
  return out;
}

Values fact_to_data(const Fact& fact) {
  return values_of({{"name", one_line(fact.name)}, {"value", one_line(fact.value)}});
}

Values note_to_data(const Note& note) {
  return values_of({{"class", note.is_error ? "error" : "note"}, {"text", one_line(note.text)}});
}

Values section_to_data(const Section& section) {
  Values out = values_of(
      {{"heading", one_line(section.heading)}, {"class", section.is_marked ? "marked" : ""}});
  out.set("lines", list_of(section.lines, line_to_data));
  return out;
}

// Only the cell with the verdict has a class, because there are many rows.
Values result_to_data(const std::vector<Cell>& row) {
  return Values("cells", list_of(row, line_to_data));
}

// The legend; results.js reads it.
Values verdicts() {
  Values list(Values::type::list);
  for (int i = 0; i < verdict_count; ++i) {
    const auto verdict = static_cast<Verdict>(i);
    Values entry = line_to_data({std::string(name_of(verdict)), verdict});
    entry.set("fails", fails_a_run(verdict));
    list.push_back(entry);
  }
  return list;
}

}  // namespace

std::string html_page(const Document& document) {
  Values out;
  const bool is_of_run = document.results.has_value();
  add_files(is_of_run, out);
  add_head(document.head, out);
  std::vector<Fact> facts = document.facts;
  std::erase_if(facts, [](const Fact& fact) { return fact.value.empty(); });
  out.set("notes", list_of(document.notes, note_to_data));
  out.set("has_sections", !document.sections.empty());
  out.set("sections", list_of(document.sections, section_to_data));
  out.set("facts", list_of(facts, fact_to_data));
  out.set("tables", list_of(document.tables, table_to_data));
  set_text(out, "table_class", is_of_run ? "matrix" : "figures");
  set_text(out, "layout", is_of_run ? "columns" : document.replay.empty() ? "plain" : "flight");
  out.set("has_replay", !document.replay.empty());
  out.set("has_plots", !document.groups.empty());
  out.set("is_of_run", is_of_run);
  if (is_of_run) {
    out.set("verdicts", verdicts());
    out.set("results", list_of(*document.results, result_to_data));
    set_text(out, "whys", script_json(nlohmann::json(document.whys)));
    set_text(out, "first_case", document.first_case);
  } else {
    set_text(out, "plots", plot_data_json(document));
  }
  kainjow::mustache::mustache page_of{std::string(ATTEST_EMBEDDED(page_template))};
  return page_of.render(out);
}

}  // namespace attest
