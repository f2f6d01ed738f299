// A page with a conclusion, facts, tables and plots. `run --html` and `merge --html` have another
// page (html_report.hpp); the pages of all other commands are a PlotPage:
//
//     PlotPage page;
//     page.conclusion = {Verdict::fail, "differ", "got.csv and want.csv", "3 of 28 differ"};
//     page.facts = {{"tolerance", "1e-4"}};
//     page.tables = {{"Signals", {"signal", "deviating", "worst"},
//                     {{"out/vehicle_rates_setpoint.roll", "17", "0.2"}}}};
//     Plot roll{"out/vehicle_rates_setpoint.roll", "rad/s"};
//     roll.series = {{"got.csv", got_s, got_values}, {"want.csv", want_s, want_values}};
//     roll.series[1].pattern = LinePattern::dashed;
//     page.groups = {{"Deviating signals", "time from the first sample [s]", {roll}}};
//     write_file("page.html", plot_page(page));
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/report/html/replay.hpp"
#include "harness/verify/verdict.hpp"

namespace attest {

// The header of the page. The verdict gives the symbol and the colour: pass, a failure, or neither.
struct PageConclusion {
  Verdict verdict = Verdict::pass;
  std::string word;           // "pass", "differ"
  std::string title;          // what was examined; also the title of the page
  std::string sentence = {};  // further particulars; may be empty
};

// A paragraph below the header.
struct PageNote {
  std::string text;
  bool is_error = false;
};

struct PageFact {
  std::string name, value;
};

// A verdict gives the cell a symbol and a colour. `small` is a second line.
struct PageCell {
  PageCell(std::string text_ = {}) : text(std::move(text_)) {}  // NOLINT: a text is a cell
  PageCell(const char* text_) : text(text_) {}                  // NOLINT
  PageCell(std::string text_, std::optional<Verdict> verdict_, std::string small_ = {})
      : text(std::move(text_)), verdict(verdict_), small(std::move(small_)) {}

  std::string text;
  std::optional<Verdict> verdict;
  std::string small;
};

// The first cell of a row is its header. Another column is aligned to the right if each of its
// cells begins with a number, is empty or is "-". The table can be read without scripts.
struct PageTable {
  std::string caption;
  std::vector<std::string> header;
  std::vector<std::vector<PageCell>> rows = {};
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
};

struct Plot {
  std::string title;
  std::string unit = {};  // the unit of y; may be empty
  std::string note = {};  // small, next to the title; may be empty
  std::vector<PlotSeries> series = {};
  std::optional<PlotBand> band = {};
  std::vector<PlotMark> marks = {};
  PlotShape shape = PlotShape::line;
  bool logarithmic_x = false, logarithmic_y = false;  // values <= 0 are not drawn
};

// Plots over the same quantity x. All plots of a group have the same cursor and the same zoom in x.
struct PlotGroup {
  std::string title;    // may be empty
  std::string x_label;  // with its unit: "time from the first tick [s]"
  std::vector<Plot> plots;
};

struct PlotPage {
  PageConclusion conclusion;
  std::vector<PageNote> notes;
  std::vector<PageFact> facts;  // a fact without a value is left out
  std::vector<PageTable> tables;
  std::vector<PlotGroup> groups;
  std::vector<ReplayVehicle> replay;  // follows the cursor of the first group; empty: no animation
};

// Returns a page that needs no other file and no network. All texts are escaped, and control
// characters in them removed (one_line()). A content security policy admits only the scripts of the
// page. Long series are drawn at the samples of extreme_ticks(), at most about 2000 for each plot,
// so that no spike is lost. Deterministic.
std::string plot_page(const PlotPage& page);

}  // namespace attest
