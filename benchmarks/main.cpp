// Prints the table of ratios (ci/bench). Google Benchmark's options apply, such as
// --benchmark_filter=step and --benchmark_min_time=0.5.
#include <ctime>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "benchmarks/memory.hpp"
#include "benchmarks/pairs.hpp"
#include "benchmarks/shards.hpp"
#include "harness/core/version.hpp"

namespace {

// "model name : AMD EPYC ..." of the first processor.
std::string cpu_model() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (line.starts_with("model name")) return line.substr(line.find(": ") + 2);
  }
  return "unknown CPU";
}

std::string today() { return fmt::format("{:%Y-%m-%d}", fmt::gmtime(std::time(nullptr))); }

}  // namespace

int main(int argc, char** argv) {
  // Short, so that a turn of a pair ends before the speed of the machine drifts.
  std::string short_runs = "--benchmark_min_time=0.02";
  std::vector<char*> arguments{argv[0], short_runs.data()};
  for (int i = 1; i < argc; ++i) arguments.push_back(argv[i]);
  int count = static_cast<int>(arguments.size());
  benchmark::Initialize(&count, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 2;

  bool met = true;
  const std::string filter = benchmark::GetBenchmarkFilter();
  // First, while this process has not allocated much memory itself.
  const bool of_memory = filter.empty() || filter == "memory";
  const std::string memory = of_memory ? "\n" + attest::bench::memory_table(met) : "";
  const bool of_shards = filter.empty() || filter == "shards";
  const std::string shards = of_shards ? "\n" + attest::bench::shards_table(met) : "";
  attest::bench::PairReporter reporter;
  if (!attest::bench::run_alternating(filter, reporter) && !of_memory && !of_shards) {
    fmt::print(stderr, "--benchmark_filter={}: no benchmark of that name\n", filter);
    return 2;
  }
  fmt::print("attest {}, {}, {}, {} processors, {}\n\n{}", attest::version, attest::compiler(),
             cpu_model(), std::thread::hardware_concurrency(), today(), reporter.table(met));
  fmt::print("{}{}", memory, shards);
  return met ? 0 : 1;
}
