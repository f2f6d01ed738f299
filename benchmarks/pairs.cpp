#include "benchmarks/pairs.hpp"

#include <algorithm>
#include <functional>
#include <limits>

#include <fmt/format.h>

namespace attest::bench {
namespace {

constexpr double no_bound = std::numeric_limits<double>::infinity();

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

// The median and the quartiles of the turns, as times or as speeds.
std::string spread(const std::vector<double>& seconds, const std::string& speed) {
  const double middle = median(seconds);
  const double low = quantile(seconds, 0.25), high = quantile(seconds, 0.75);
  if (speed.empty()) {
    return fmt::format("{} ({} .. {})", duration(middle), duration(low), duration(high));
  }
  return fmt::format("{:.1f} {} ({:.1f} .. {:.1f})", 1 / middle, speed, 1 / high, 1 / low);
}

// Applies `of` to the two times of each turn.
template <typename Of>
std::vector<double> by_turn(const std::vector<double>& measured, const std::vector<double>& floor,
                            Of of) {
  std::vector<double> out;
  for (std::size_t i = 0; i < std::min(measured.size(), floor.size()); ++i) {
    out.push_back(of(measured[i], floor[i]));
  }
  return out;
}

// Benchmarks that run one after the other: a figure, its floor, and a second figure of that floor.
struct Group {
  std::string floor;
  std::vector<std::string> names;
};

std::vector<Group> groups(const std::string& filter) {
  std::vector<Group> out;
  for (const Pair& pair : pairs()) {
    if ((pair.measured + " " + pair.floor).find(filter) == std::string::npos) continue;
    if (out.empty() || out.back().floor != pair.floor) {
      out.push_back({pair.floor, {pair.measured, pair.floor}});
    } else {
      out.back().names.push_back(pair.measured);
    }
  }
  return out;
}

// Few turns for the suite, for sweeps, logs and hunts: their runs take long.
int turns(const std::string& floor) {
  if (floor.starts_with("suite/")) return 5;
  for (const char* one : {"sweep/", "log/", "hunt/"}) {
    if (floor.starts_with(one)) return 11;
  }
  return 101;
}

}  // namespace

bool Pair::is_met(const std::vector<double>& measured_s, const std::vector<double>& floor_s) const {
  if (bound > 0) return median(by_turn(measured_s, floor_s, std::divides{})) <= bound;
  if (at_most_s > 0) return median(measured_s) <= at_most_s;
  return median(by_turn(measured_s, floor_s, std::minus{})) <= beyond_s;
}

bool run_alternating(const std::string& filter, PairReporter& reporter) {
  auto wanted = groups(filter);
  for (Group& group : wanted) {
    const int count = turns(group.floor);
    for (int turn = 0; turn < count; ++turn) {
      for (const std::string& name : group.names) {
        benchmark::RunSpecifiedBenchmarks(&reporter, "^" + name + "(/.*)?$");
      }
      // Alternate the order, so that a machine that slows down steadily favours neither.
      std::reverse(group.names.begin(), group.names.end());
    }
  }
  return !wanted.empty();
}

// They are measured in this order. Isolation is the first, because a fork costs more when other
// benchmarks have left memory in this process.
const std::vector<Pair>& pairs() {
  constexpr const char* unbounded = "no bound: the C library's is not correctly rounded";
  static const std::vector<Pair> list = {
      {"suite at 250 Hz, CPU time, port in a process of its own", "suite/port_isolated",
       "suite/port_shared", 1.30, "at most 1.30x the port in the judge's process"},
      {"controller step", "step/reference", "step/by_hand", 1.15,
       "at most 1.15x the law written by hand in C"},
      {"step of the attitude unit", "cascade/attitude", "cascade/attitude_by_hand", 1.0,
       "at most 1.0x the law written by hand in C"},
      {"step of the rate unit", "cascade/rate", "cascade/rate_by_hand", 1.0,
       "at most 1.0x the law written by hand in C"},
      {"controller step, with attest's elementary functions", "elementary/controller_own",
       "elementary/controller_host", 1.15, "at most 1.15x the C library's functions"},
      {"step of the attitude unit, the same", "elementary/attitude_own", "elementary/attitude_host",
       1.15, "at most 1.15x the C library's functions"},
      {"sin", "elementary/sin_own", "elementary/sin_host", no_bound, unbounded},
      {"cos", "elementary/cos_own", "elementary/cos_host", no_bound, unbounded},
      {"tan", "elementary/tan_own", "elementary/tan_host", no_bound, unbounded},
      {"asin", "elementary/asin_own", "elementary/asin_host", no_bound, unbounded},
      {"acos", "elementary/acos_own", "elementary/acos_host", no_bound, unbounded},
      {"exp", "elementary/exp_own", "elementary/exp_host", no_bound, unbounded},
      {"atan2", "elementary/atan2_own", "elementary/atan2_host", no_bound, unbounded},
      // A poll() for each answer is 10% of a bare exchange. It finds out that a program has ended
      // although its children keep its pipe open, which read() cannot.
      {"step of a program, on one CPU", "program/step", "program/bare_pipe", 1.30,
       "at most 1.30x a bare pipe, of which poll() is 0.10"},
      {"trace of a program, in one batch", "program/trace_in_batch", "program/trace_in_steps",
       1 / 20.0, "at least 20x the speed of single steps"},
      {"step of a program in shared memory, on two CPUs: 99.9th percentile", "program/shared_p999",
       "program/memory_p999", 0, "at most 3 us", 0, 3e-6},
      {"trace CSV, read, with all checks", "csv/read_csv", "csv/from_chars", 1.40,
       "at most 1.40x a bare from_chars loop"},
      {"trace CSV, write", "csv/write_csv", "csv/to_chars", 1 / 0.8,
       "at least 0.8x the speed of a bare to_chars loop"},
      {"ULog of 34 MB, read", "ulog/read", "ulog/blocks", 5,
       "at most 5x the time of copying the file in blocks"},
      {"log of PX4's default profile, replayed, CPU time", "log/default", "log/default_read", 0,
       "at least 300 MB/s", 0, 1 / 300.0, "MB/s"},
      {"log with every step, replayed, CPU time", "log/every_step", "log/every_step_read", 70,
       "at most 70x one reading of its messages", 0, 0, "MB/s"},
      {"traces compared, all bits equal", "compare/compare", "compare/memcmp", 3,
       "at most 3x memcmp"},
      // Also makes the inputs, measures the margins, and exchanges the traces with the port.
      {"step of a hunt of a library, one job", "hunt/hunt", "hunt/steps", 0,
       "at least 300000 steps/s", 0, 1 / 300e3, "steps/s"},
      {"flight, 250 Hz, MuJoCo at 1 kHz", "flight/250hz", "mj_step/250hz", 1.06,
       "at most 1.06x the bare steps"},
      {"the same, trace kept", "flight/250hz_trace", "mj_step/250hz", 1.08,
       "at most 1.08x the bare steps"},
      {"flight, 1 kHz, MuJoCo at 1 kHz", "flight/1000hz", "mj_step/1000hz", 1.25,
       "at most 1.25x the bare steps"},
      {"flight of the cascade, 250 Hz and 1 kHz, MuJoCo at 1 kHz", "flight/cascade",
       "mj_step/cascade", 1.25, "at most 1.25x the bare steps"},
      {"flight of a sweep, one job", "sweep/reference", "sweep/mj_step", 1.10,
       "at most 1.10x the bare steps", 0, 0, "flights/s"},
      // Each flight has a process of the port of its own, so that no flight depends on another.
      {"flight of a sweep with a port, one job", "sweep/with_port", "sweep/mj_step", 1.30,
       "at most 1.30x the bare steps", 0, 0, "flights/s"},
      {"flight of a sweep, 2 jobs", "sweep/two_jobs", "sweep/mj_step_two", 1.10,
       "at most 1.10x the bare steps by 2 threads", 0, 0, "flights/s"},
      {"ode plant, 1 s at 1 kHz", "ode/plant", "ode/erkstep", 1.10, "at most 1.10x bare ERKStep"},
      {"plant made and reset", "plant/set_up", "mujoco/set_up", 0,
       "within 100 us of MuJoCo's own time", 100e-6},
      {"suite at 250 Hz, 4 jobs", "suite/4_jobs", "suite/1_job", 1 / 3.4,
       "at least 3.4x the speed of 1 job"},
      {"suite at 250 Hz, 2 jobs", "suite/2_jobs", "suite/1_job", 1 / 1.9,
       "at least 1.9x the speed of 1 job"},
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
    fmt::print(stderr, "{:<20} {}\n", name, duration(seconds));
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
    const auto ratios = by_turn(measured->seconds, floor->seconds, std::divides{});
    const bool holds = pair.is_met(measured->seconds, floor->seconds);
    met = met && holds;
    const bool is_ratio = pair.bound > 0 && pair.bound < no_bound;
    const std::string bound = is_ratio ? fmt::format("{:.3f}: ", pair.bound) : "";
    out += fmt::format("| {} | {} | {} | {:.3f} ({:.3f} .. {:.3f}) | {}{} | {} |\n", pair.what,
                       spread(measured->seconds, pair.speed), spread(floor->seconds, pair.speed),
                       median(ratios), quantile(ratios, 0.25), quantile(ratios, 0.75), bound,
                       pair.claim, holds ? "met" : "MISSED");
  }
  return out;
}

}  // namespace attest::bench
