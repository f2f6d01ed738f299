// The plots of failing vectors: their outputs as curves, and as JSON for the script of the page.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "harness/trace/trace.hpp"
#include "harness/verify/run_result.hpp"

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

// extreme_ticks() of got, want and their difference, with the neighbours of `marked`.
std::vector<std::size_t> drawn_ticks(const Curves& curves, std::size_t marked, std::size_t most);

inline constexpr std::size_t most_plotted_vectors = 100;

// The failing vectors that the page plots, in the order of the results: of each group, the first
// failing vector at each rate. If these are more than `most`, the first rates of every group are
// taken before the further ones. A vector without a first deviation (a crash, a metric of a flight)
// is left out. `named`: the case that the report names; its first failing vector is taken before
// all others.
std::vector<const VectorResult*> vectors_to_plot(const RunResult& run,
                                                 const std::string& named = {},
                                                 std::size_t most = most_plotted_vectors);

// Reads the traces of vectors_to_plot() in `folder` (saved_traces.hpp). A vector without traces in
// `folder` is left out, and so is a vector that would make the text longer than `most_bytes`. The
// keys are the ids of the vectors. `<` is escaped, so that the text can be the content of a
// <script>:
//
//     {"px4-v1.5.5/tpa/each_axis@250hz":
//      {"ticks": 5000, "repeated": true, "hidden": 0, "signals": [{
//       "name": "out/vehicle_rates_setpoint.roll [rad/s]", "stage": "attitude law",
//       "deviating": 48, "first_tick": 17,
//       "tick": "...", "time": "...", "got": "...", "want": "...", "allowed": "..."}]}}
//
// The texts "..." are base64 of float32; time is in seconds from the first tick. `allowed` is a
// number if it is constant, and absent if the tolerances are not known. `repeated` is false if the
// traces do not have the first deviation of the result: then the port gave other outputs when it
// ran again for its traces. `hidden` is the number of deviating signals that are not plotted.
std::string plots_json(const RunResult& run, const std::filesystem::path& folder,
                       std::size_t most_bytes, const std::string& named = {});

}  // namespace attest
