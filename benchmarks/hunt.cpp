// A hunt of a library with the attitude unit and the rate unit, by one worker: its steps a second
// of CPU time, each of them a step of the port and one of the reference. The floor is these two
// steps alone, in this process.
#include <cstdio>
#include <string>

#include <benchmark/benchmark.h>

#include "harness/diagnosis/hunt_generator.hpp"
#include "harness/diagnosis/hunt_trace.hpp"
#include "harness/golden/reference.hpp"
#include "harness/host/in_process_host.hpp"
#include "harness/process/program.hpp"
#include "harness/realtime/usage.hpp"

namespace attest::bench {
namespace {

constexpr const char* port = "lib:" ATTEST_BENCHMARK_CASCADE_PORT;

// The number of steps; 0: attest failed.
std::size_t hunted_steps() {
  const auto text = output_of(
      {ATTEST_BENCHMARK_ATTEST, "hunt", "--steps", "500000", "--jobs", "1", "--port", port}, {60});
  std::size_t steps = 0;
  const auto place = text ? text->find("PASS 0 findings in ") : std::string::npos;
  if (place != std::string::npos) {
    std::sscanf(text->c_str() + place, "PASS 0 findings in %*u trials and %zu steps", &steps);
  }
  return steps;
}

void whole_hunt(benchmark::State& state) {
  for (auto _ : state) {
    const Nanoseconds begin = cpu_time_of_all();
    const std::size_t steps = hunted_steps();
    if (steps == 0) return state.SkipWithError("the hunt failed");
    state.SetIterationTime(in_seconds(cpu_time_of_all() - begin) / static_cast<double>(steps));
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
      const Nanoseconds begin = thread_cpu_time();
      if (law.drive(subject, of_port) || reference->drive(subject, of_reference)) {
        return state.SkipWithError("a step failed");
      }
      passed_s += in_seconds(thread_cpu_time() - begin);
      steps += trace.samples.size();
    }
    state.SetIterationTime(passed_s / static_cast<double>(steps));
  }
}

BENCHMARK(whole_hunt)->Name("hunt/hunt")->UseManualTime()->Iterations(1);
BENCHMARK(bare_steps)->Name("hunt/steps")->UseManualTime()->Iterations(1);

}  // namespace
}  // namespace attest::bench
