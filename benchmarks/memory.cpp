#include "benchmarks/memory.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include "harness/casefile/select.hpp"
#include "harness/compare/compare.hpp"
#include "harness/golden/recorded.hpp"
#include "harness/trace/csv.hpp"
#include "harness/verify/case_job.hpp"
#include "harness/verify/evaluate.hpp"

namespace attest::bench {
namespace {

constexpr int suite_processes = 2;
// A worker has the goldens of one case in memory, of all its profiles and rates: up to 70 MB.
constexpr double bound_mb = 250;

// Proportional set size (PSS) of a process, in kB: its private memory and its share of the shared
// memory. Workers share all memory from before the fork.
long proportional_kb(const std::string& process) {
  std::ifstream rollup("/proc/" + process + "/smaps_rollup");
  for (std::string line; std::getline(rollup, line);) {
    if (line.starts_with("Pss:")) return std::strtol(line.c_str() + 4, nullptr, 10);
  }
  return 0;  // it has ended
}

// Of a process and all its descendants.
long with_children_kb(const std::string& process) {
  long sum = proportional_kb(process);
  std::ifstream children(fmt::format("/proc/{}/task/{}/children", process, process));
  for (std::string child; children >> child;) sum += with_children_kb(child);
  return sum;
}

// Of `work` in a separate process, with all its workers, sampled each millisecond.
double peak_mb(const std::function<void()>& work) {
  const pid_t process = ::fork();
  if (process == 0) {
    work();
    ::_exit(EXIT_SUCCESS);
  }
  long peak = 0;
  while (::waitpid(process, nullptr, WNOHANG) == 0) {
    peak = std::max(peak, with_children_kb(fmt::to_string(process)));
    ::usleep(1'000);  // the shortest work takes 50 ms
  }
  return static_cast<double>(peak) / 1024;
}

void whole_suite() {
  const auto cases = select_cases({ATTEST_SOURCE_DIR "/cases"}, {});
  VehicleModels vehicle_models(ATTEST_SOURCE_DIR "/models");
  const auto suite_jobs =
      case_jobs(*cases, std::make_shared<const Goldens>(ATTEST_SOURCE_DIR "/golden"),
                vehicle_models, {Level::numeric}, HostOptions());
  JobOptions<VectorResult> options;
  options.processes = suite_processes;
  run_jobs(*suite_jobs, options);
}

// Of a mixer, whose traces have few columns.
void write_long_trace(const std::filesystem::path& path, std::size_t ticks) {
  Trace trace;
  trace.present = channels_of(Module::mixer);
  trace.samples.resize(ticks);
  for (std::size_t i = 0; i < ticks; ++i) {
    trace.samples[i].in.timestamp = 5'000'000 + 125 * i;
    const float value = static_cast<float>(i % 1000) * 1e-3f;
    trace.samples[i].mixer_in.actuator_controls_0.control[0] = value;
    trace.samples[i].mixer_out.actuator_outputs.output[0] = value;
  }
  write_csv(path, trace, all_columns(trace));
}

void compare_with_itself(const std::filesystem::path& path) {
  const auto got = open_csv(path, TraceNeed::outputs), want = open_csv(path, TraceNeed::outputs);
  (void)compare(**got, **want, Tolerances(Level::numeric));
}

void replay(const std::filesystem::path& path) {
  const auto host = start_host(HostOptions());
  auto trace = RecordedParts::open(path, "px4-v1.5.5", "R: 8x 10000 10000 10000 0");
  (void)evaluate_parts(*trace, trace->subject(), **host, Tolerances(Level::numeric));
}

// Of `work` with the file of a trace of `ticks` ticks.
double peak_mb(std::size_t ticks, void (*work)(const std::filesystem::path&)) {
  std::string folder = (std::filesystem::temp_directory_path() / "attest-XXXXXX").string();
  if (::mkdtemp(folder.data()) == nullptr) return 0;
  const auto path = std::filesystem::path(folder) / "long.csv";
  peak_mb([&] { write_long_trace(path, ticks); });  // in its own process, so it is not counted
  const double peak = peak_mb([&] { work(path); });
  std::filesystem::remove_all(folder);
  return peak;
}

// The row of `work`, whose memory must not grow with the trace.
std::string constant_row(const std::string& what, void (*work)(const std::filesystem::path&),
                         bool& met) {
  constexpr std::size_t few = 100'000, many = 1'000'000;
  constexpr double same = 1.1;
  const double of_few = peak_mb(few, work), of_many = peak_mb(many, work);
  const bool constant = of_few > 0 && of_many <= same * of_few;
  met = met && constant;
  return fmt::format("| {}, {} and {} ticks | {:.2f} and {:.2f} MB | the same | {} |\n", what, few,
                     many, of_few, of_many, constant ? "met" : "MISSED");
}

}  // namespace

std::string memory_table(bool& met) {
  const double suite = peak_mb(whole_suite);
  const bool holds = suite > 0 && suite <= bound_mb;
  met = met && holds;
  return fmt::format(
             "| memory | peak | claimed | |\n"
             "|---|---|---|---|\n"
             "| whole suite, {} jobs, all processes together | {:.0f} MB | at most {:g} MB | {} "
             "|\n",
             suite_processes, suite, bound_mb, holds ? "met" : "MISSED") +
         constant_row("two files compared", compare_with_itself, met) +
         constant_row("a trace replayed, with the port's process", replay, met);
}

}  // namespace attest::bench
