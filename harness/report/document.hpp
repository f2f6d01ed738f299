// A report as a document: a conclusion, notes, facts, tables and plots. A command fills it in once;
// render_text() makes the text for the terminal, and html_page() the page:
//
//     Document document;
//     document.head = {Conclusion::fail, "got.csv and want.csv", "3 of 28 differ"};
//     document.facts = {{"tolerance", "1e-4"}};
//     document.tables = {{"Signals", {"signal", "deviating", "worst [rad/s]"},
//                         {{"out/vehicle_rates_setpoint.roll", "17", "0.2"}}}};
//     Plot roll{"out/vehicle_rates_setpoint.roll", "rad/s"};
//     roll.series = {{"got.csv", got_s, got_values}, {"want.csv", want_s, want_values}};
//     roll.series[1].pattern = LinePattern::dashed;
//     document.groups = {{"Deviating signals", "time from the first sample [s]", {roll}}};
//     fmt::print("{}", render_text(document, terminal_style(stdout)));
//     write_file("page.html", html_page(document));
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "harness/core/ticks.hpp"
#include "harness/report/terminal.hpp"
#include "harness/verify/verdict.hpp"

namespace attest {

// The head of the document. The verdict gives the symbol and the colour of the page: pass, a
// failure, or neither. The word is the name of a Verdict or of a Conclusion.
struct DocumentHead {
  DocumentHead() : DocumentHead(Verdict::pass, {}) {}
  DocumentHead(Verdict verdict_, std::string title_, std::string sentence_ = {})
      : verdict(verdict_),
        word(name_of(verdict_)),
        title(std::move(title_)),
        sentence(std::move(sentence_)) {}
  DocumentHead(Conclusion conclusion, std::string title_, std::string sentence_ = {})
      : verdict(verdict_of(conclusion)),
        word(name_of(conclusion)),
        title(std::move(title_)),
        sentence(std::move(sentence_)) {}

  Verdict verdict;
  std::string_view word;
  std::string title;     // what was examined; also the title of the page
  std::string sentence;  // further particulars; may be empty
};

// A line below the head.
struct Note {
  std::string text;
  bool is_error = false;
  bool is_in_text = true;  // false for a note on the plots
};

// About the command; not in the text.
struct Fact {
  std::string name, value;
};

// A verdict gives the cell a symbol and a colour. `small` is a second line.
struct Cell {
  Cell(std::string text_ = {}) : text(std::move(text_)) {}  // NOLINT: a text is a cell
  Cell(const char* text_) : text(text_) {}                  // NOLINT
  Cell(std::string text_, std::optional<Verdict> verdict_, std::string small_ = {})
      : text(std::move(text_)), verdict(verdict_), small(std::move(small_)) {}
  // In a column [us]. Empty: "-". The text has the time as human_time().
  Cell(std::optional<Nanoseconds> time_, std::optional<Verdict> verdict_ = {});  // NOLINT
  Cell(Nanoseconds time_) : Cell(std::optional(time_)) {}                        // NOLINT

  std::string text;
  std::optional<Verdict> verdict;
  std::string small;
  std::string link = {};  // DocumentTable::id of a table of the page
  std::optional<Nanoseconds> time;
};

Cell agreement_cell(bool agrees);

// A heading and lines; on the page next to other sections.
struct Section {
  std::string heading;
  std::vector<Cell> lines;
  bool is_marked = false;  // stands out; its second line is in larger type
};

// The first cell of a row is its header. Another column is aligned to the right if each of its
// cells begins with a number, is empty, "-" or "inf". A name in the header may end with a unit, as
// in "rate [Hz]"; the text has the unit in the cells.
struct DocumentTable {
  std::string caption;
  std::vector<std::string> header;
  std::vector<std::vector<Cell>> rows = {};
  std::vector<Cell> below = {};  // lines below the table, such as commands
  // 0: only the lines below the table are in the text.
  std::size_t rows_in_text = std::numeric_limits<std::size_t>::max();
  std::string id = {};  // for links to it; may be empty
};

enum class LinePattern { solid, dashed, dotted };

// Values over x, in the order of increasing x. A NaN is a gap in the line. Each series may have x
// values of its own. All values are written as float32, so use times from the beginning of a trace,
// in seconds. REQUIRES: x and y have equal sizes.
struct PlotSeries {
  std::string name;
  std::vector<double> x;
  std::vector<float> y;
  LinePattern pattern = LinePattern::solid;
  std::optional<int> colour = {};  // index in the palette, 5: dark; absent: the index of the series
};

// An area between two lines, behind the series: a tolerance. REQUIRES: x, low and high have equal
// sizes.
struct PlotBand {
  std::string name;
  std::vector<double> x;
  std::vector<float> low, high;
};

enum class PlotShape {
  line,
  steps,    // a value holds until the next x
  bars,     // filled down to the axis; the last x ends the last bar, and its y is not drawn
  points,   // a symbol for each series
  scatter,  // as points, but dots for the first series; the y axis need not include 0
};

// A vertical line with a text: the first deviation, a budget.
struct PlotMark {
  double x = 0;
  std::string text;
  bool is_quiet = false;  // an event, such as a gust; not a finding
};

// A horizontal line with a text, from x `first` to x `last`: a bound of the values there.
struct PlotBound {
  double first = 0, last = 0;
  float level = 0;
  std::string text;      // may be empty
  bool is_upper = true;  // the bound forbids the values above it
  bool is_missed = false;
};

struct Plot {
  std::string title;
  std::string unit = {};  // the unit of y; may be empty
  std::string note = {};  // small, next to the title; may be empty
  std::vector<PlotSeries> series = {};
  std::optional<PlotBand> band = {};
  std::vector<PlotMark> marks = {};
  std::vector<PlotBound> bounds = {};
  PlotShape shape = PlotShape::line;
  bool logarithmic_x = false, logarithmic_y = false;  // values <= 0 are not drawn
  // The y axis shows at least this much, so that noise does not look like a signal. 0: no limit.
  double least_span = 0;
};

// Plots over the same quantity x. All plots of a group have the same cursor and the same zoom in x.
struct PlotGroup {
  std::string title;    // may be empty
  std::string x_label;  // with its unit: "time from the first tick [s]"
  std::vector<Plot> plots;
};

// w, x, y, z over time. The quaternions rotate from the body (forward, right, down) to the world
// (north, east, down).
using Quaternions = std::array<std::vector<float>, 4>;

// One of the vehicles of the animation of a flight. REQUIRES: all sizes are equal, and at least 1.
struct ReplayVehicle {
  std::string name;          // may be empty for a single vehicle
  std::vector<float> times;  // [s] from the first tick
  Quaternions attitude;
  Quaternions setpoint;  // zeros: no setpoint at that time
};

struct Document {
  DocumentHead head;
  std::vector<Note> notes = {};
  std::vector<Section> sections = {};
  std::vector<Fact> facts = {};  // a fact without a value is left out
  std::vector<DocumentTable> tables = {};
  std::vector<PlotGroup> groups = {};
  std::vector<ReplayVehicle> replay = {};  // follows the cursor of the first group; may be empty
  // Of a run: a row for each vector, with the columns of page.mustache. The page has a list of them
  // that can be searched. Its tables select rows of this list, and html_report() adds the plots.
  std::optional<std::vector<std::vector<Cell>>> results = {};
  std::map<std::string, std::string> whys = {};  // "profile/group/name" -> what the case tests
  std::string first_case = {};  // "profile/group/name" of the case to open first; may be empty
};

// "8.13 us", "1.02 ms", "312 ns".
std::string human_time(Nanoseconds time);

// The head, the notes and the tables. Ends with a newline. A table wider than `style` allows is
// broken into several blocks of columns.
std::string render_text(const Document& document, TerminalStyle style);
std::string render_text(const DocumentHead& head, TerminalStyle style);  // "title\nPASS sentence\n"
std::string render_text(const DocumentTable& table, TerminalStyle style);

// The bounds of a metric, for a PlotBand of a plot with these series. An infinite bound is drawn at
// the outermost value of the series, or at the other bound if that is farther out.
std::pair<float, float> drawn_bounds(double min, double max, const std::vector<PlotSeries>& series);

Colour colour_of(Verdict verdict);

// Whether a column of a table has numbers.
bool is_numeric(const DocumentTable& table, std::size_t column);

// Returns a page that needs no other file and no network. All texts are escaped, and control
// characters in them removed (one_line()). A content security policy admits only the scripts of the
// page. The tables can be read without scripts. Long series are drawn at the samples of
// extreme_ticks(), at most about 2000 for each plot, so that no spike is lost. Deterministic.
std::string html_page(const Document& document);

}  // namespace attest
