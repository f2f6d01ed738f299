#include "benchmarks/pairs.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace attest::bench {
namespace {

double quantile(std::vector<double> values, double q) {
  std::sort(values.begin(), values.end());
  const auto index = static_cast<std::size_t>(q * static_cast<double>(values.size() - 1) + 0.5);
  return values[index];
}

double median(const std::vector<double>& values) { return quantile(values, 0.5); }

std::string duration(double seconds) {
  if (seconds < 1e-6) return fmt::format("{:.1f} ns", seconds * 1e9);
  if (seconds < 1e-3) return fmt::format("{:.1f} us", seconds * 1e6);
  if (seconds < 1) return fmt::format("{:.1f} ms", seconds * 1e3);
  return fmt::format("{:.2f} s", seconds);
}

// Median and the middle half of the repetitions.
std::string spread(const std::vector<double>& values) {
  return fmt::format("{} ({} .. {})", duration(median(values)), duration(quantile(values, 0.25)),
                     duration(quantile(values, 0.75)));
}

}  // namespace

const std::vector<Pair>& pairs() {
  static const std::vector<Pair> list = {
      {"controller step", "step/reference", "step/by_hand", 1.15,
       "at most 1.15x the law written by hand in C"},
      {"trace CSV, read", "csv/read_csv", "csv/from_chars", 1 / 0.8,
       "at least 0.8x the speed of a bare from_chars loop"},
      {"suite, 2 jobs", "suite/2_jobs", "suite/1_job", 1 / 1.9, "at least 1.9x the speed of 1 job"},
  };
  return list;
}

bool PairReporter::ReportContext(const Context&) { return true; }

void PairReporter::ReportRuns(const std::vector<Run>& runs) {
  for (const Run& run : runs) {
    if (run.run_type != Run::RT_Iteration || run.error_occurred) continue;
    const std::string name = run.run_name.function_name;
    auto found = std::find_if(times_.begin(), times_.end(),
                              [&](const Times& times) { return times.name == name; });
    if (found == times_.end()) found = times_.insert(times_.end(), {name, {}});
    const double seconds =
        run.real_accumulated_time / static_cast<double>(std::max<std::int64_t>(run.iterations, 1));
    found->seconds.push_back(seconds);
    fmt::print(stderr, "{:<16} {}\n", name, duration(seconds));
  }
}

const PairReporter::Times* PairReporter::find(const std::string& name) const {
  const auto found = std::find_if(times_.begin(), times_.end(),
                                  [&](const Times& times) { return times.name == name; });
  return found == times_.end() ? nullptr : &*found;
}

std::string PairReporter::table(bool& met) const {
  std::string out =
      "| figure | measured: median (middle half) | floor | time ratio | claimed | |\n"
      "|---|---|---|---|---|---|\n";
  for (const Pair& pair : pairs()) {
    const Times* measured = find(pair.measured);
    const Times* floor = find(pair.floor);
    if (!measured || !floor) continue;  // filtered out by the user
    const double ratio = median(measured->seconds) / median(floor->seconds);
    const bool holds = ratio <= pair.bound;
    met = met && holds;
    out += fmt::format("| {} | {} | {} | {:.3f} | {:.3f}: {} | {} |\n", pair.what,
                       spread(measured->seconds), spread(floor->seconds), ratio, pair.bound,
                       pair.claim, holds ? "met" : "MISSED");
  }
  return out;
}

}  // namespace attest::bench
