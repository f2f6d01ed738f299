#include "harness/report/document.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "harness/report/text.hpp"

namespace attest {
namespace {

bool begins_with_number(const std::string& text) {
  const std::size_t sign = text.starts_with('-') || text.starts_with('+') ? 1 : 0;
  return text.substr(sign) == "inf" ||
         (text.size() > sign && std::isdigit(static_cast<unsigned char>(text[sign])) != 0);
}

// A column as text. The first text is that of the header.
struct TextColumn {
  std::vector<std::string> texts;
  bool is_numeric = false;
  std::size_t width = 0;
};

std::string cell_text(const Cell& cell, std::string_view unit) {
  std::string out = cell.time ? human_time(*cell.time) : one_line(cell.text);
  if (!cell.time && !unit.empty() && begins_with_number(out)) out += fmt::format(" {}", unit);
  return cell.small.empty() ? out : fmt::format("{} ({})", out, one_line(cell.small));
}

std::size_t rows_in_text(const DocumentTable& table) {
  return std::min(table.rows.size(), table.rows_in_text);
}

TextColumn column_of(const DocumentTable& table, std::size_t column) {
  std::string_view name = table.header[column], unit;
  if (const std::size_t at = name.find(" ["); name.ends_with(']') && at != name.npos) {
    unit = name.substr(at + 2, name.size() - at - 3);
    name = name.substr(0, at);
  }
  TextColumn out{{std::string(name)}, is_numeric(table, column), name.size()};
  for (std::size_t i = 0; i < rows_in_text(table); ++i) {
    const std::vector<Cell>& row = table.rows[i];
    out.texts.push_back(column < row.size() ? cell_text(row[column], unit) : "");
    out.width = std::max(out.width, out.texts.back().size());
  }
  return out;
}

// Returns `end`: the columns [begin, end) fit next to the first one. At least one column is taken.
std::size_t last_that_fits(const std::vector<TextColumn>& columns, std::size_t begin,
                           std::size_t limit) {
  std::size_t used = columns.front().width, end = begin;
  while (end < columns.size()) {
    used += 2 + columns[end].width;
    if (end > begin && limit > 0 && used > limit) break;
    ++end;
  }
  return end;
}

// The padding is added apart from the coloured text, because a field width would count the escape
// codes.
std::string padded(const TextColumn& column, std::size_t row, Colour colour, TerminalStyle style) {
  const std::string& text = column.texts[row];
  const std::string space(column.width - text.size(), ' ');
  const std::string shown = painted(text, text.empty() ? Colour::none : colour, style);
  return column.is_numeric ? space + shown : shown + space;
}

// The columns [begin, end) next to the first one.
std::string block(const DocumentTable& table, const std::vector<TextColumn>& columns,
                  std::size_t begin, std::size_t end, TerminalStyle style) {
  std::string out;
  for (std::size_t row = 0; row <= rows_in_text(table); ++row) {
    std::string line = table.caption.empty() ? "" : "  ";
    for (std::size_t i = 0; i < end; i = i == 0 ? begin : i + 1) {
      const bool has_cell = row > 0 && i < table.rows[row - 1].size();
      const auto verdict = has_cell ? table.rows[row - 1][i].verdict : std::nullopt;
      const Colour colour = row == 0 ? Colour::bold : verdict ? colour_of(*verdict) : Colour::none;
      line += (i > 0 ? "  " : "") + padded(columns[i], row, colour, style);
    }
    out += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return out;
}

}  // namespace

Colour colour_of(Verdict verdict) {
  if (verdict == Verdict::pass) return Colour::green;
  return fails_a_run(verdict) ? Colour::red : Colour::yellow;
}

Cell::Cell(std::optional<Nanoseconds> time_, std::optional<Verdict> verdict_)
    : text(time_ ? fmt::format("{:.4g}", in_microseconds(*time_)) : "-"),
      verdict(verdict_),
      time(time_) {}

Cell agreement_cell(bool agrees) {
  return {std::string(name_of(agrees ? RowVerdict::agrees : RowVerdict::differs)),
          agrees ? Verdict::pass : Verdict::fail};
}

std::string human_time(Nanoseconds time) {
  const auto ns = static_cast<double>(time.count());
  if (ns < 1e3) return fmt::format("{:g} ns", ns);
  if (ns < 1e6) return fmt::format("{:.3g} us", ns / 1e3);
  if (ns < 1e9) return fmt::format("{:.3g} ms", ns / 1e6);
  return fmt::format("{:.3g} s", ns / 1e9);
}

std::pair<float, float> drawn_bounds(double min, double max,
                                     const std::vector<PlotSeries>& series) {
  double lowest = std::numeric_limits<double>::max(), highest = -lowest;
  for (const PlotSeries& one : series) {
    for (const float y : one.y) {
      if (!std::isfinite(y)) continue;
      lowest = std::min(lowest, static_cast<double>(y));
      highest = std::max(highest, static_cast<double>(y));
    }
  }
  const double low = std::isinf(min) ? std::min(lowest, max) : min;
  const double high = std::isinf(max) ? std::max(highest, low) : max;
  return {static_cast<float>(low), static_cast<float>(high)};
}

bool is_numeric(const DocumentTable& table, std::size_t column) {
  return column > 0 && std::all_of(table.rows.begin(), table.rows.end(), [&](const auto& row) {
           return column >= row.size() || row[column].text.empty() || row[column].text == "-" ||
                  begins_with_number(row[column].text);
         });
}

std::string render_text(const DocumentTable& table, TerminalStyle style) {
  std::string out;
  const bool has_rows = rows_in_text(table) > 0;
  const bool has_caption = !table.caption.empty() && table.rows_in_text > 0;
  if (has_caption) out += one_line(table.caption) + "\n";
  std::vector<TextColumn> columns;
  for (std::size_t i = 0; i < table.header.size(); ++i) columns.push_back(column_of(table, i));
  const int indent = table.caption.empty() ? 0 : 2;
  const auto limit = static_cast<std::size_t>(std::max(style.width - indent, 0));
  for (std::size_t begin = 1; begin < columns.size() && has_rows;) {
    const std::size_t end = last_that_fits(columns, begin, limit);
    if (begin > 1) out += "\n";
    out += block(table, columns, begin, end, style);
    begin = end;
  }
  for (const Cell& line : table.below) {
    const Colour colour = line.verdict ? colour_of(*line.verdict) : Colour::none;
    out += fmt::format("  {}\n", painted(printable(line.text), colour, style));
  }
  return out;
}

std::string render_text(const DocumentHead& head, TerminalStyle style) {
  return fmt::format("{}\n{}{}{}\n", one_line(head.title),
                     painted(capitals(head.word), colour_of(head.verdict), style),
                     head.sentence.empty() ? "" : " ", one_line(head.sentence));
}

std::string render_text(const Document& document, TerminalStyle style) {
  std::string out = render_text(document.head, style);
  for (const Note& note : document.notes) {
    if (note.is_in_text) out += one_line(note.text) + "\n";
  }
  for (const DocumentTable& table : document.tables) {
    if (const std::string text = render_text(table, style); !text.empty()) out += "\n" + text;
  }
  return out;
}

}  // namespace attest
