// Prints the table of ratios (ci/bench). Google Benchmark's options apply, such as
// --benchmark_filter=step and --benchmark_repetitions=21.
#include <string>
#include <vector>

#include <fmt/format.h>

#include "benchmarks/pairs.hpp"
#include "harness/core/version.hpp"

int main(int argc, char** argv) {
  // In turn and in random order, so that a drifting machine slows both of a pair.
  std::vector<std::string> defaults = {"--benchmark_enable_random_interleaving=true",
                                       "--benchmark_repetitions=15", "--benchmark_min_time=0.05"};
  std::vector<char*> arguments{argv[0]};
  for (std::string& text : defaults) arguments.push_back(text.data());
  for (int i = 1; i < argc; ++i) arguments.push_back(argv[i]);
  int count = static_cast<int>(arguments.size());
  benchmark::Initialize(&count, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 2;

  attest::bench::PairReporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  bool met = true;
  const std::string table = reporter.table(met);
  fmt::print("attest {}, {}\n\n{}", attest::version, attest::compiler(), table);
  return met ? 0 : 1;
}
