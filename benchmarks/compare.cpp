// Comparing two traces that agree to the bit, against memcmp of their samples. For such traces the
// comparison only has to go through the samples.
#include "harness/compare/compare.hpp"

#include <cstring>

#include <benchmark/benchmark.h>

namespace attest::bench {
namespace {

constexpr std::size_t trace_ticks = 100'000;

Trace made() {
  Trace trace;
  trace.present = channels_of(Module::mc_att_control);
  trace.samples.resize(trace_ticks);
  for (std::size_t i = 0; i < trace_ticks; ++i) {
    Sample& sample = trace.samples[i];
    sample.in.timestamp = 5'000'000 + 4000 * i;
    sample.out.vehicle_rates_setpoint.roll = static_cast<float>(i % 1000) * 0.001f;
  }
  return trace;
}

const Trace& one() {
  static const Trace trace = made();
  return trace;
}
const Trace& other() {
  static const Trace trace = made();
  return trace;
}

void bare_memcmp(benchmark::State& state) {
  one(), other();
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        std::memcmp(one().samples.data(), other().samples.data(), trace_ticks * sizeof(Sample)));
  }
}

void comparison(benchmark::State& state) {
  one(), other();
  const Tolerances tolerances(Level::numeric);
  for (auto _ : state) benchmark::DoNotOptimize(compare(one(), other(), tolerances));
}

BENCHMARK(bare_memcmp)->Name("compare/memcmp");
BENCHMARK(comparison)->Name("compare/compare");

}  // namespace
}  // namespace attest::bench
