#include "harness/report/html/plot_page.hpp"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

#include "harness/report/html/embedded.hpp"
#include "harness/report/html/page_parts.hpp"
#include "harness/report/html/plot_data.hpp"
#include "harness/report/text.hpp"

namespace attest {
namespace {

std::string_view outcome_of(Verdict verdict) {
  if (verdict == Verdict::pass) return "PASS";
  return fails_a_run(verdict) ? "FAIL" : "NONE";
}

void add_header(const PageConclusion& conclusion, data& page) {
  set_text(page, "outcome", outcome_of(conclusion.verdict));
  set_text(page, "conclusion_symbol", symbol_of(conclusion.verdict));
  set_text(page, "word", one_line(conclusion.word));
  set_text(page, "title", one_line(conclusion.title));
  set_text(page, "sentence", one_line(conclusion.sentence));
}

bool begins_with_number(const std::string& text) {
  const std::size_t sign = text.starts_with('-') || text.starts_with('+') ? 1 : 0;
  return text.size() > sign && std::isdigit(static_cast<unsigned char>(text[sign])) != 0;
}

bool is_numeric(const PageTable& table, std::size_t column) {
  return column > 0 && std::all_of(table.rows.begin(), table.rows.end(), [&](const auto& row) {
           return column >= row.size() || row[column].text.empty() || row[column].text == "-" ||
                  begins_with_number(row[column].text);
         });
}

data cell_to_data(const PageCell& cell, bool numeric) {
  data out;
  std::string classes = numeric ? "number" : "";
  if (cell.verdict) classes += fmt::format(" v-{}", name_of(*cell.verdict));
  set_text(out, "class", classes);
  if (cell.verdict) set_text(out, "symbol", symbol_of(*cell.verdict));
  set_text(out, "text", one_line(cell.text));
  set_text(out, "small", one_line(cell.small));
  return out;
}

data table_to_data(const PageTable& table) {
  std::vector<bool> numeric;
  data header(data::type::list), rows(data::type::list);
  for (std::size_t i = 0; i < table.header.size(); ++i) {
    numeric.push_back(is_numeric(table, i));
    header.push_back(cell_to_data(PageCell(table.header[i]), numeric.back()));
  }
  for (const std::vector<PageCell>& row : table.rows) {
    data cells(data::type::list), out;
    for (std::size_t i = 1; i < row.size(); ++i) {
      cells.push_back(cell_to_data(row[i], i < numeric.size() && numeric[i]));
    }
    out.set("head", cell_to_data(row.empty() ? PageCell() : row.front(), false));
    out.set("cells", cells);
    rows.push_back(out);
  }
  data out;
  set_text(out, "caption", one_line(table.caption));
  out.set("header", header);
  out.set("rows", rows);
  return out;
}

data fact_to_data(const PageFact& fact) {
  data out;
  set_text(out, "name", one_line(fact.name));
  set_text(out, "value", one_line(fact.value));
  return out;
}

data note_to_data(const PageNote& note) {
  data out;
  set_text(out, "class", note.is_error ? "error" : "note");
  set_text(out, "text", one_line(note.text));
  return out;
}

}  // namespace

std::string plot_page(const PlotPage& page) {
  data out;
  add_files(out, {{"replay_script", replay_script()}, {"plot_page_script", plot_page_script()}});
  add_header(page.conclusion, out);
  std::vector<PageFact> facts = page.facts;
  std::erase_if(facts, [](const PageFact& fact) { return fact.value.empty(); });
  out.set("notes", list_of(page.notes, note_to_data));
  out.set("facts", list_of(facts, fact_to_data));
  out.set("tables", list_of(page.tables, table_to_data));
  set_text(out, "layout", page.replay.empty() ? "plain" : "flight");
  out.set("has_replay", !page.replay.empty());
  out.set("has_plots", !page.groups.empty());
  set_text(out, "plots", plot_data_json(page));
  kainjow::mustache::mustache page_of{std::string(plot_page_template())};
  return page_of.render(out);
}

}  // namespace attest
