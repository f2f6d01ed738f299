// The whole suite on the reference, numeric level, from reading the case files to the verdicts,
// with one, two and, where there are as many processors, four worker processes.
#include <thread>

#include <benchmark/benchmark.h>

#include "harness/suite/select.hpp"
#include "harness/suite/worker.hpp"

namespace attest::bench {
namespace {

void suite(benchmark::State& state, int jobs) {
  for (auto _ : state) {
    const auto cases = select_cases(ATTEST_SOURCE_DIR "/cases", {});
    Fleet fleet(ATTEST_SOURCE_DIR "/models");
    const auto batches = make_batches(*cases, ATTEST_SOURCE_DIR "/golden", fleet, Level::numeric);
    WorkerOptions options;
    options.port = "builtin";
    options.jobs = jobs;
    const WorkerOutcome outcome = run_batches(*batches, options);
    if (!outcome.errors.empty()) state.SkipWithError(outcome.errors[0].message.c_str());
  }
}

void one_job(benchmark::State& state) { suite(state, 1); }
void two_jobs(benchmark::State& state) { suite(state, 2); }

void four_jobs(benchmark::State& state) {
  if (std::thread::hardware_concurrency() < 4) return state.SkipWithError("needs 4 processors");
  suite(state, 4);
}

BENCHMARK(one_job)->Name("suite/1_job")->UseRealTime()->Iterations(1);
BENCHMARK(two_jobs)->Name("suite/2_jobs")->UseRealTime()->Iterations(1);
BENCHMARK(four_jobs)->Name("suite/4_jobs")->UseRealTime()->Iterations(1);

}  // namespace
}  // namespace attest::bench
