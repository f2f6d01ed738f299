#include "harness/report/html/plots.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <iterator>
#include <map>
#include <optional>
#include <utility>

#include <nlohmann/json.hpp>

#include "harness/core/agreement.hpp"
#include "harness/report/failure_text.hpp"
#include "harness/report/html/plot_data.hpp"
#include "harness/trace/csv.hpp"
#include "harness/verify/saved_traces.hpp"

namespace attest {
namespace {

using nlohmann::json;

constexpr std::size_t most_signals = 8;    // of a vector
constexpr std::size_t most_points = 1200;  // of a curve (approximate); a plot has about 600 pixels

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

struct Traces {
  Trace got, want;
  std::optional<Trace> allowed;
};

std::optional<Traces> read_traces(const TraceFiles& files) {
  auto got = read_csv(files.got, TraceNeed::outputs);
  auto want = read_csv(files.want, TraceNeed::outputs);
  if (!got || !want) return std::nullopt;
  Traces traces{*std::move(got), *std::move(want), std::nullopt};
  if (auto allowed = read_csv(files.tolerance, TraceNeed::outputs)) {
    traces.allowed = *std::move(allowed);
  }
  return traces;
}

bool has(const Deviation& first, const Trace& got) {
  if (first.tick >= got.samples.size()) return false;
  const double value = value_of(channels()[first.channel], got.samples[first.tick]);
  return same_bits(static_cast<float>(value), static_cast<float>(first.got));
}

json allowed_to_json(const std::vector<float>& allowed) {
  const bool is_constant = std::all_of(allowed.begin(), allowed.end(),
                                       [&](float value) { return value == allowed.front(); });
  if (is_constant) return allowed.front();
  return base64(allowed);
}

json signal_to_json(const Curves& curves, const Trace& got, std::size_t marked) {
  const std::vector<std::size_t> ticks = drawn_ticks(curves, marked, most_points);
  const auto at_ticks = [&](const std::vector<float>& values) {
    std::vector<float> out;
    for (const std::size_t tick : ticks) out.push_back(values[tick]);
    return out;
  };
  std::vector<float> numbers, times;
  const std::uint64_t begin_us = got.samples.front().in.timestamp;
  for (const std::size_t tick : ticks) {
    numbers.push_back(static_cast<float>(tick));
    const std::uint64_t elapsed_us = got.samples[tick].in.timestamp - begin_us;
    times.push_back(static_cast<float>(1e-6 * static_cast<double>(elapsed_us)));
  }
  const Channel& channel = channels()[curves.channel];
  json out = {{"name", channel_with_unit(channel)},
              {"stage", name_of(channel.stage)},
              {"deviating", curves.deviating},
              {"tick", base64(numbers)},
              {"time", base64(times)},
              {"got", base64(at_ticks(curves.got))},
              {"want", base64(at_ticks(curves.want))}};
  if (curves.deviating > 0) out["first_tick"] = curves.first_tick;
  if (!curves.allowed.empty()) out["allowed"] = allowed_to_json(at_ticks(curves.allowed));
  return out;
}

json vector_to_json(const Traces& traces, const Deviation& first) {
  const std::vector<Curves> all =
      curves_of(traces.got, traces.want, traces.allowed ? &*traces.allowed : nullptr);
  const auto deviating = static_cast<std::size_t>(std::count_if(
      all.begin(), all.end(), [](const Curves& curves) { return curves.deviating > 0; }));
  json signals = json::array();
  for (const Curves& curves : curves_to_plot(all, first.channel, most_signals)) {
    signals.push_back(signal_to_json(curves, traces.got, first.tick));
  }
  return {{"ticks", traces.got.samples.size()},
          {"repeated", has(first, traces.got)},
          {"hidden", deviating - std::min(deviating, signals.size())},
          {"signals", std::move(signals)}};
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

std::vector<std::size_t> drawn_ticks(const Curves& curves, std::size_t marked, std::size_t most) {
  std::array<std::vector<float>, 3> series{curves.got, curves.want, {}};
  std::transform(curves.got.begin(), curves.got.end(), curves.want.begin(),
                 std::back_inserter(series[2]), std::minus<>());
  std::vector<std::size_t> kept = extreme_ticks(series, most);
  keep_neighbours(marked, curves.size(), kept);
  return kept;
}

std::vector<const VectorResult*> vectors_to_plot(const RunResult& run, const std::string& named,
                                                 std::size_t most) {
  using Candidate = std::pair<std::size_t, const VectorResult*>;  // rates of its group before it
  std::map<std::pair<std::string, std::string>, std::vector<LoopRate>> seen;
  std::vector<Candidate> candidates;
  bool has_named = false;
  for (const VectorResult& result : run.results) {
    if (!fails_a_run(result.verdict) || !result.first) continue;
    if (!has_named && result.case_id() == named) {
      candidates.emplace(candidates.begin(), 0, &result);
      has_named = true;
      continue;
    }
    std::vector<LoopRate>& rates = seen[{result.profile, result.group}];
    if (std::find(rates.begin(), rates.end(), result.rate) != rates.end()) continue;
    candidates.emplace_back(rates.size(), &result);
    rates.push_back(result.rate);
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.first < b.first; });
  if (candidates.size() > most) candidates.resize(most);
  std::vector<const VectorResult*> chosen;
  for (const Candidate& candidate : candidates) chosen.push_back(candidate.second);
  std::sort(chosen.begin(), chosen.end());  // by their place in the results
  return chosen;
}

std::string plots_json(const RunResult& run, const std::filesystem::path& folder,
                       std::size_t most_bytes, const std::string& named) {
  if (folder.empty()) return "{}";
  std::string out = "{";
  for (const VectorResult* result : vectors_to_plot(run, named)) {
    const auto traces =
        read_traces(trace_files(folder, *result, channels()[result->first->channel].module));
    if (!traces || traces->got.samples.empty()) continue;
    const std::string entry = script_json(json(result->id())) + ":" +
                              script_json(vector_to_json(*traces, *result->first));
    constexpr std::size_t punctuation = 3;  // a comma, a newline, the brace at the end
    if (out.size() + entry.size() + punctuation > most_bytes) continue;
    if (out.size() > 1) out += ",\n";
    out += entry;
  }
  return out + "}";
}

}  // namespace attest
