// One output signal of a failing vector as curves, and the ticks at which a long curve is drawn.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "harness/compare/tolerance.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// One value per tick. `allowed` (the tolerance) is empty if it is not known.
struct Curves {
  std::size_t channel = 0;  // index into channels()
  std::vector<float> got, want, allowed;
  std::size_t deviating = 0;   // number of ticks at which got is outside the tolerance
  std::size_t first_tick = 0;  // the first of these ticks; valid if deviating > 0

  std::size_t size() const { return got.size(); }
};

// The outputs that both traces have, up to the end of the shorter trace. `allowed` is a trace as
// allowed_deviations() makes it, or null. It is not used if it is shorter than `want`.
std::vector<Curves> curves_of(const Trace& got, const Trace& want, const Trace* allowed);

// Keeps the curves that deviate and the curve of channel `first`. The curve of `first` comes first,
// the others by the tick at which they begin to deviate. Returns at most `most` curves.
std::vector<Curves> curves_to_plot(std::vector<Curves> curves, std::size_t first, std::size_t most);

// The ticks at which to draw series of equal length: all of them, or, of a series longer than
// `most`, approximately `most` or fewer. The series are divided into parts of equal length. The
// ticks of the smallest and the largest value of each part are kept, and that of its first NaN, so
// that no spike is lost. The first and the last tick of the series are kept, too. REQUIRES: at
// least one series.
std::vector<std::size_t> extreme_ticks(std::span<const std::vector<float>> series,
                                       std::size_t most);

// Adds `marked`, the tick before it and the tick after it to the ascending `kept`. Ticks at or
// above `size` are not added.
void keep_neighbours(std::size_t marked, std::size_t size, std::vector<std::size_t>& kept);

// extreme_ticks() of got, want and their difference, with the neighbours of `marked`.
std::vector<std::size_t> drawn_ticks(const Curves& curves, std::size_t marked, std::size_t most);

}  // namespace attest
