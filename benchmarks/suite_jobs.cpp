// The suite at one rate on the reference at the numeric level, from the case files to the verdicts,
// with one, two and (given four processors) four workers. Further runs have the port in the judge's
// process: the floor of the cost of separate processes. It is measured as CPU time. The vectors
// whose two threads run until their steps have overlapped are left out: they use two processors
// themselves, and how long they take depends on the system's timers.
#include <thread>

#include <benchmark/benchmark.h>

#include "harness/casefile/select.hpp"
#include "harness/plant/vehicle_models.hpp"
#include "harness/realtime/usage.hpp"
#include "harness/verify/case_job.hpp"

namespace attest::bench {
namespace {

Selection at_one_rate() {
  Selection of_one_thread;
  of_one_thread.rates = {LoopRate(Rate::hz(250))};
  of_one_thread.excludes = {"*on_two_threads"};
  return of_one_thread;
}

// A benchmark with manual time reports CPU time.
void suite(benchmark::State& state, int processes, bool isolated = true) {
  for (auto _ : state) {
    const Nanoseconds begin = cpu_time_of_all();
    const auto cases = select_cases({ATTEST_SOURCE_DIR "/cases"}, at_one_rate());
    VehicleModels vehicle_models(ATTEST_SOURCE_DIR "/models");
    HostOptions host;
    host.in_process = !isolated;
    const auto jobs =
        case_jobs(*cases, std::make_shared<const Goldens>(ATTEST_SOURCE_DIR "/golden"),
                  vehicle_models, {Level::numeric}, host);
    JobOptions<VectorResult> options;
    options.processes = processes;
    const auto outcome = run_jobs(*jobs, options);
    state.SetIterationTime(in_seconds(cpu_time_of_all() - begin));
    if (!outcome.errors.empty()) state.SkipWithError(outcome.errors[0].message.c_str());
  }
}

void one_job(benchmark::State& state) { suite(state, 1); }
void two_jobs(benchmark::State& state) { suite(state, 2); }
void port_isolated(benchmark::State& state) { suite(state, 1); }
void port_shared(benchmark::State& state) { suite(state, 1, false); }

void four_jobs(benchmark::State& state) {
  if (std::thread::hardware_concurrency() < 4) return state.SkipWithError("needs 4 processors");
  suite(state, 4);
}

BENCHMARK(one_job)->Name("suite/1_job")->UseRealTime()->Iterations(1);
BENCHMARK(two_jobs)->Name("suite/2_jobs")->UseRealTime()->Iterations(1);
BENCHMARK(four_jobs)->Name("suite/4_jobs")->UseRealTime()->Iterations(1);
BENCHMARK(port_isolated)->Name("suite/port_isolated")->UseManualTime()->Iterations(1);
BENCHMARK(port_shared)->Name("suite/port_shared")->UseManualTime()->Iterations(1);

}  // namespace
}  // namespace attest::bench
