#include "harness/report/html/plot_data.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <numeric>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include "harness/core/json_text.hpp"
#include "harness/report/text.hpp"

namespace attest {
namespace {

using nlohmann::json;

constexpr std::size_t most_plot_points = 2000;  // of a plot, which is about 1000 pixels wide

// All values of a plot that share the same x values, and the ticks at which they are drawn. So
// signals with equal x values are drawn at the same ticks, and the page has these x values once.
struct Grid {
  const std::vector<double>* x;
  std::vector<std::vector<float>> values;
  std::vector<std::size_t> ticks;
};

class Grids {
 public:
  // Returns the number of the grid.
  std::size_t add(const std::vector<double>& x, const std::vector<float>& values) {
    const auto same =
        std::find_if(grids_.begin(), grids_.end(), [&](const Grid& grid) { return *grid.x == x; });
    const auto number = static_cast<std::size_t>(same - grids_.begin());
    if (same == grids_.end()) grids_.push_back({&x, {}, {}});
    grids_[number].values.push_back(values);
    return number;
  }

  void choose_ticks(const std::vector<PlotMark>& marks) {
    for (Grid& grid : grids_) {
      grid.ticks = extreme_ticks(grid.values, most_plot_points / grids_.size());
      for (const PlotMark& mark : marks) {
        const auto at = std::lower_bound(grid.x->begin(), grid.x->end(), mark.x);
        keep_neighbours(static_cast<std::size_t>(at - grid.x->begin()), grid.x->size(), grid.ticks);
      }
    }
  }

  std::string drawn(std::size_t grid, const std::vector<float>& values) const {
    std::vector<float> out;
    for (const std::size_t tick : grids_[grid].ticks) out.push_back(values[tick]);
    return base64(out);
  }

  json x_to_json() const {
    json out = json::array();
    for (std::size_t i = 0; i < grids_.size(); ++i) {
      out.push_back(drawn(i, {grids_[i].x->begin(), grids_[i].x->end()}));
    }
    return out;
  }

 private:
  std::vector<Grid> grids_;
};

std::string_view name_of(LinePattern pattern) {
  constexpr std::array<std::string_view, 3> names = {"solid", "dashed", "dotted"};
  return names[static_cast<std::size_t>(pattern)];
}

std::string_view name_of(PlotShape shape) {
  constexpr std::array<std::string_view, 5> names = {"line", "steps", "bars", "points", "scatter"};
  return names[static_cast<std::size_t>(shape)];
}

json series_to_json(const Plot& plot, const std::vector<std::size_t>& numbers, const Grids& grids) {
  json out = json::array();
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    const PlotSeries& series = plot.series[i];
    out.push_back({{"name", one_line(series.name)},
                   {"grid", numbers[i]},
                   {"y", grids.drawn(numbers[i], series.y)},
                   {"pattern", name_of(series.pattern)},
                   {"colour", series.colour.value_or(static_cast<int>(i))}});
  }
  return out;
}

json plot_to_json(const Plot& plot) {
  Grids grids;
  std::vector<std::size_t> numbers;
  for (const PlotSeries& series : plot.series) numbers.push_back(grids.add(series.x, series.y));
  std::size_t of_band = 0;
  if (plot.band) {
    of_band = grids.add(plot.band->x, plot.band->low);
    grids.add(plot.band->x, plot.band->high);
  }
  grids.choose_ticks(plot.marks);
  json marks = json::array();
  for (const PlotMark& mark : plot.marks) {
    marks.push_back({{"x", mark.x}, {"text", one_line(mark.text)}, {"quiet", mark.is_quiet}});
  }
  json bounds = json::array();
  for (const PlotBound& bound : plot.bounds) {
    bounds.push_back({{"first", bound.first},
                      {"last", bound.last},
                      {"level", bound.level},
                      {"text", one_line(bound.text)},
                      {"upper", bound.is_upper},
                      {"missed", bound.is_missed}});
  }
  json out = {
      {"title", one_line(plot.title)},       {"unit", one_line(plot.unit)},
      {"note", one_line(plot.note)},         {"shape", name_of(plot.shape)},
      {"logarithmic_x", plot.logarithmic_x}, {"logarithmic_y", plot.logarithmic_y},
      {"least_span", plot.least_span},       {"marks", std::move(marks)},
      {"grids", grids.x_to_json()},          {"series", series_to_json(plot, numbers, grids)},
      {"bounds", std::move(bounds)}};
  if (plot.band) {
    out["band"] = {{"name", one_line(plot.band->name)},
                   {"grid", of_band},
                   {"low", grids.drawn(of_band, plot.band->low)},
                   {"high", grids.drawn(of_band, plot.band->high)}};
  }
  return out;
}

json vehicle_to_json(const ReplayVehicle& vehicle) {
  json out = {{"name", one_line(vehicle.name)}, {"time", base64(vehicle.times)}};
  for (std::size_t i = 0; i < vehicle.attitude.size(); ++i) {
    out["attitude"].push_back(base64(vehicle.attitude[i]));
    out["setpoint"].push_back(base64(vehicle.setpoint[i]));
  }
  return out;
}

// The ticks of [begin, end) where the value is smallest, largest and first NaN.
void keep_extremes(std::size_t begin, std::size_t end, const std::vector<float>& values,
                   std::vector<std::size_t>& kept) {
  std::size_t low = end, high = end, nan = end;
  for (std::size_t tick = begin; tick < end; ++tick) {
    const float value = values[tick];
    if (std::isnan(value)) {
      if (nan == end) nan = tick;
      continue;
    }
    if (low == end || value < values[low]) low = tick;
    if (high == end || value > values[high]) high = tick;
  }
  for (const std::size_t tick : {low, high, nan}) {
    if (tick != end) kept.push_back(tick);
  }
}

}  // namespace

std::string base64(std::string_view bytes) {
  constexpr std::string_view digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const bool exists = k < count;
      group = (group << 8) | (exists ? static_cast<std::uint8_t>(bytes[i + k]) : 0u);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      out += k <= count ? digits[(group >> (18 - 6 * k)) & 63u] : '=';
    }
  }
  return out;
}

std::string base64(std::span<const float> numbers) {
  std::string bytes;
  bytes.reserve(4 * numbers.size());
  for (const float number : numbers) {
    const auto bits = std::bit_cast<std::uint32_t>(number);
    for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>((bits >> shift) & 255u);
  }
  return base64(bytes);
}

std::string script_json(const nlohmann::json& value) {
  std::string out;
  for (const char c : text_of(value)) out += c == '<' ? "\\u003c" : std::string(1, c);
  return out;
}

std::vector<std::size_t> extreme_ticks(std::span<const std::vector<float>> series,
                                       std::size_t most) {
  const std::size_t size = series.front().size();
  std::vector<std::size_t> kept;
  if (size <= most) {
    kept.resize(size);
    std::iota(kept.begin(), kept.end(), std::size_t{0});
    return kept;
  }
  constexpr std::size_t kept_of_each = 3;  // smallest, largest, NaN
  const std::size_t parts = std::max<std::size_t>(1, most / (kept_of_each * series.size()));
  for (std::size_t part = 0; part < parts; ++part) {
    for (const std::vector<float>& values : series) {
      keep_extremes(part * size / parts, (part + 1) * size / parts, values, kept);
    }
  }
  kept.insert(kept.end(), {0, size - 1});
  std::sort(kept.begin(), kept.end());
  kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
  return kept;
}

void keep_neighbours(std::size_t marked, std::size_t size, std::vector<std::size_t>& kept) {
  for (std::size_t tick = marked > 0 ? marked - 1 : 0; tick <= marked + 1 && tick < size; ++tick) {
    const auto place = std::lower_bound(kept.begin(), kept.end(), tick);
    if (place == kept.end() || *place != tick) kept.insert(place, tick);
  }
}

std::string plot_data_json(const Document& page) {
  json groups = json::array(), replay = json::array();
  for (const PlotGroup& group : page.groups) {
    json plots = json::array();
    std::transform(group.plots.begin(), group.plots.end(), std::back_inserter(plots), plot_to_json);
    groups.push_back({{"title", one_line(group.title)},
                      {"x_label", one_line(group.x_label)},
                      {"plots", std::move(plots)}});
  }
  std::transform(page.replay.begin(), page.replay.end(), std::back_inserter(replay),
                 vehicle_to_json);
  return script_json({{"groups", std::move(groups)}, {"replay", std::move(replay)}});
}

}  // namespace attest
