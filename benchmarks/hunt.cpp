// A hunt of a library with the attitude unit and the rate unit, by one worker: its steps a second
// of CPU time, each of them a step of the port and one of the reference. The floor is these two
// steps alone, in this process.
#include <array>
#include <cstdio>
#include <ctime>
#include <string>

#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include "harness/diagnosis/hunt_generator.hpp"
#include "harness/diagnosis/hunt_trace.hpp"
#include "harness/golden/reference.hpp"
#include "harness/host/in_process_host.hpp"

namespace attest::bench {
namespace {

constexpr const char* port = "lib:" ATTEST_BENCHMARK_CASCADE_PORT;

// Of processes that have ended.
double cpu_of_children_s() {
  rusage usage{};
  ::getrusage(RUSAGE_CHILDREN, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

double cpu_s() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

// The number of steps; 0: attest failed.
std::size_t hunted_steps() {
  const std::string command =
      std::string(ATTEST_BENCHMARK_ATTEST) + " hunt --steps 500000 --jobs 1 --port " + port;
  std::FILE* const output = ::popen((command + " 2>/dev/null").c_str(), "r");
  if (output == nullptr) return 0;
  std::size_t steps = 0;
  std::array<char, 4096> line;
  while (std::fgets(line.data(), line.size(), output) != nullptr) {
    std::sscanf(line.data(), "PASS 0 findings in %*u trials and %zu steps", &steps);
  }
  return ::pclose(output) == 0 ? steps : 0;
}

void whole_hunt(benchmark::State& state) {
  for (auto _ : state) {
    const double begin = cpu_of_children_s();
    const std::size_t steps = hunted_steps();
    if (steps == 0) return state.SkipWithError("the hunt failed");
    state.SetIterationTime((cpu_of_children_s() - begin) / static_cast<double>(steps));
  }
}

struct Trial {
  ModuleUnderTest subject;
  Trace trace;
};

std::vector<Trial> trials() {
  std::vector<Trial> made;
  for (std::uint64_t number = 0; made.size() < 400; ++number) {
    HuntTarget target;
    target.subject = {"px4-v1.16.0", number % 2 == 0 ? Module::attitude_unit : Module::rate_unit};
    const HuntInputs inputs = make_trial(target, 1, number, {});
    if (inputs.steps() < 1000) made.push_back({inputs.subject, *whole_trace_of(inputs)});
  }
  return made;
}

void bare_steps(benchmark::State& state) {
  static const std::vector<Trial> all = trials();
  InProcessHost law(*open_port(port));
  const auto reference = open_reference();
  for (auto _ : state) {
    std::size_t steps = 0;
    double passed_s = 0;
    for (const auto& [subject, trace] : all) {
      Trace of_port = trace, of_reference = trace;
      const double begin = cpu_s();
      if (law.drive(subject, of_port) || reference->drive(subject, of_reference)) {
        return state.SkipWithError("a step failed");
      }
      passed_s += cpu_s() - begin;
      steps += trace.samples.size();
    }
    state.SetIterationTime(passed_s / static_cast<double>(steps));
  }
}

BENCHMARK(whole_hunt)->Name("hunt/hunt")->UseManualTime()->Iterations(1);
BENCHMARK(bare_steps)->Name("hunt/steps")->UseManualTime()->Iterations(1);

}  // namespace
}  // namespace attest::bench
