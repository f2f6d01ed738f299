// One output signal of a failing vector as curves to plot, and the ticks of a long trace at which
// they are drawn.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "harness/compare/tolerance.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// One value per tick. `allowed` is empty if the level has no tolerances.
struct Curves {
  std::size_t channel = 0;  // index into channels()
  std::vector<float> got, want, allowed;
  std::size_t deviating = 0;   // ticks at which got is outside the tolerance
  std::size_t first_tick = 0;  // of those; REQUIRES: deviating > 0

  std::size_t size() const { return got.size(); }
};

// The float32 and flag outputs that both traces have, up to the end of the shorter one. `allowed`
// is a trace as allowed_deviations() makes it, or null.
std::vector<Curves> curves_of(const Trace& got, const Trace& want, const Trace* allowed);

// Keeps the curves that deviate and the curve of channel `first`. That one comes first, the others
// by the tick at which they begin to deviate. At most `most`.
std::vector<Curves> curves_to_plot(std::vector<Curves> curves, std::size_t first, std::size_t most);

// The ticks at which to draw series of equal length: all of them, or, of a series longer than
// `most`, approximately `most` or fewer. The series are divided into parts of equal length. The
// smallest and the largest value of each part are kept, and the first NaN, so that no spike is
// lost. The first tick and the last one are kept, too. REQUIRES: at least one series.
std::vector<std::size_t> extreme_ticks(std::span<const std::vector<float>> series,
                                       std::size_t most);

// Adds `marked` and the ticks before and after it to the ascending `kept`, as far as they are below
// `size`.
void keep_neighbours(std::size_t marked, std::size_t size, std::vector<std::size_t>& kept);

// The same as extreme_ticks() for got, want and their difference. The ticks around `marked` are
// kept, too.
std::vector<std::size_t> drawn_ticks(const Curves& curves, std::size_t marked, std::size_t most);

}  // namespace attest
