#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "harness/report/flight_document.hpp"

namespace attest {
namespace {

using Lines = std::vector<PlotBound>;

// A metric, and the line of the flight in the plot that shows the measured value over time.
struct Drawn {
  const Metric& metric;
  const PlotSeries& line;

  double from() const { return std::max(metric.window.from_s, line.x.front()); }
  double to() const { return std::min(metric.window.to_s, line.x.back()); }
  std::string text(std::string_view what) const { return fmt::format("{}: {}", metric.name, what); }
};

// The largest value must be from `min` to `max`.
Lines largest_value(const Drawn& drawn) {
  Lines lines;
  const Metric& metric = drawn.metric;
  const auto add = [&](double level, const char* words, bool is_upper) {
    if (!std::isfinite(level)) return;
    lines.push_back({drawn.from(), drawn.to(), static_cast<float>(level),
                     drawn.text(fmt::format("{} {:g}", words, level)), is_upper});
  };
  add(metric.max, "at most", true);
  add(metric.min, "peak at least", false);
  return lines;
}

// As largest_value(), of a value with a sign.
Lines largest_size(const Drawn& drawn) {
  Lines lines = largest_value(drawn);
  for (const PlotBound& bound : largest_value(drawn)) {
    lines.push_back({bound.first, bound.last, -bound.level, "", !bound.is_upper});
  }
  return lines;
}

// At the latest time that the metric allows, the value must be in the band, and must stay there.
Lines settles(const Drawn& drawn) {
  const Metric& metric = drawn.metric;
  const double latest = metric.window.from_s + metric.max;
  return {{latest, drawn.to(), static_cast<float>(metric.band_deg),
           drawn.text(fmt::format("at most {:g} from {:g} s on", metric.band_deg, latest))}};
}

// The bound holds from the first tick in the band on.
Lines overshoots(const Drawn& drawn) {
  Lines lines = largest_value(drawn);
  const auto& x = drawn.line.x;
  std::size_t tick = 0;
  while (tick < x.size() && !(x[tick] >= drawn.from() &&
                              static_cast<double>(drawn.line.y[tick]) <= drawn.metric.band_deg)) {
    ++tick;
  }
  const double arrival = tick < x.size() ? x[tick] : drawn.to();
  for (PlotBound& bound : lines) bound.first = arrival;
  return lines;
}

// The altitude at the end of the window, from the altitude at its beginning.
Lines sinks(const Drawn& drawn) {
  const auto& x = drawn.line.x;
  const auto begin = std::ranges::lower_bound(x, drawn.from());
  const double start =
      static_cast<double>(drawn.line.y[static_cast<std::size_t>(begin - x.begin())]);
  Lines lines = largest_value(drawn);
  for (PlotBound& bound : lines) {
    const double sink = static_cast<double>(bound.level);
    bound.level = static_cast<float>(start - sink);
    bound.text = drawn.text(
        fmt::format("sink at {} {:g} in the end", bound.is_upper ? "most" : "least", sink));
    bound.is_upper = !bound.is_upper;
  }
  return lines;
}

// The plot and the line that show what a measure measures, and how bounds are drawn there. A mean
// bounds no single value, so its bounds are in the table of metrics only.
struct Drawing {
  Measure measure;
  FlightPlot plot;
  std::size_t line;
  Lines (*lines)(const Drawn&);
};
constexpr std::array<Drawing, 8> drawings = {{
    {Measure::settling_time_s, FlightPlot::attitude_error, 0, settles},
    {Measure::overshoot_deg, FlightPlot::attitude_error, 0, overshoots},
    {Measure::rms_attitude_error_deg, FlightPlot::attitude_error, 0, nullptr},
    {Measure::rms_rate_error_rad_s, FlightPlot::body_rates, 0, nullptr},
    {Measure::peak_rate_rad_s, FlightPlot::rate_length, 0, largest_value},
    {Measure::saturation_duty, FlightPlot::saturation, 0, nullptr},
    {Measure::peak_integral, FlightPlot::integrals, 0, largest_size},
    {Measure::sink_m, FlightPlot::position, 2, sinks},
}};

const Drawing& drawing_of(Measure measure) { return drawings[static_cast<std::size_t>(measure)]; }

}  // namespace

FlightPlot plot_of(Measure measure) { return drawing_of(measure).plot; }

std::vector<PlotBound> lines_of_bounds(const Metric& metric, const Plot& plot) {
  const Drawing& drawing = drawing_of(metric.measure);
  // A ratio of two windows is no level.
  if (drawing.lines == nullptr || metric.versus || drawing.line >= plot.series.size()) return {};
  const Drawn drawn{metric, plot.series[drawing.line]};
  if (drawn.from() > drawn.to()) return {};  // the flight ended before the window
  Lines lines = drawing.lines(drawn);
  std::erase_if(lines, [](const PlotBound& bound) {
    return !(bound.first < bound.last) || !std::isfinite(bound.level);
  });
  return lines;
}

}  // namespace attest
