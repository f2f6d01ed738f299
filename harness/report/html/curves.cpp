#include "harness/report/html/curves.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <iterator>
#include <numeric>

#include "harness/core/agreement.hpp"

namespace attest {
namespace {

// Without tolerance, by bits.
bool agrees(float got, float want, float allowed) {
  return allowed > 0 ? agree(got, want, allowed) : same_bits(got, want);
}

Curves curves_of(std::size_t index, const Trace& got, const Trace& want, const Trace* allowed) {
  const Channel& channel = channels()[index];
  const std::size_t ticks = std::min(got.samples.size(), want.samples.size());
  Curves curves;
  curves.channel = index;
  for (std::size_t tick = 0; tick < ticks; ++tick) {
    const auto value_in = [&](const Trace& trace) {
      return static_cast<float>(value_of(channel, trace.samples[tick]));
    };
    curves.got.push_back(value_in(got));
    curves.want.push_back(value_in(want));
    const float tolerance = allowed ? value_in(*allowed) : 0;
    if (allowed) curves.allowed.push_back(tolerance);
    if (agrees(curves.got.back(), curves.want.back(), tolerance)) continue;
    if (curves.deviating++ == 0) curves.first_tick = tick;
  }
  return curves;
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

std::vector<Curves> curves_of(const Trace& got, const Trace& want, const Trace* allowed) {
  const bool is_cut_off = allowed && allowed->samples.size() < want.samples.size();
  std::vector<Curves> all;
  for (std::size_t i = 0; i < channels().size(); ++i) {
    if (!channels()[i].is_output() || !got.present[i] || !want.present[i]) continue;
    all.push_back(curves_of(i, got, want, is_cut_off ? nullptr : allowed));
  }
  return all;
}

std::vector<Curves> curves_to_plot(std::vector<Curves> curves, std::size_t first,
                                   std::size_t most) {
  std::erase_if(curves, [&](const Curves& one) {
    return one.size() == 0 || (one.deviating == 0 && one.channel != first);
  });
  std::stable_sort(curves.begin(), curves.end(), [&](const Curves& a, const Curves& b) {
    if ((a.channel == first) != (b.channel == first)) return a.channel == first;
    return a.first_tick < b.first_tick;
  });
  if (curves.size() > most) curves.resize(most);
  return curves;
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

std::vector<std::size_t> drawn_ticks(const Curves& curves, std::size_t marked, std::size_t most) {
  std::array<std::vector<float>, 3> series{curves.got, curves.want, {}};
  std::transform(curves.got.begin(), curves.got.end(), curves.want.begin(),
                 std::back_inserter(series[2]), std::minus<>());
  std::vector<std::size_t> kept = extreme_ticks(series, most);
  keep_neighbours(marked, curves.size(), kept);
  return kept;
}

}  // namespace attest
