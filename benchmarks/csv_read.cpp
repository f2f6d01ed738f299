// Reading a trace against the least cost of reading: the file in memory, std::from_chars on each
// cell, the values discarded.
#include <charconv>

#include <benchmark/benchmark.h>

#include "harness/core/file.hpp"
#include "harness/trace/csv.hpp"

namespace attest::bench {
namespace {

constexpr const char* recording =
    ATTEST_SOURCE_DIR "/golden/recorded/px4-v1.5.5/extremes_250hz.csv";

void bare_from_chars(benchmark::State& state) {
  for (auto _ : state) {
    const std::string text = *read_file(recording);
    const char* cell = text.data() + text.find('\n') + 1;
    const char* const end = text.data() + text.size();
    while (cell < end) {
      float value = 0;
      cell = std::from_chars(cell, end, value).ptr + 1;  // past the comma or newline
      benchmark::DoNotOptimize(value);
    }
  }
}

void whole_reader(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(read_csv(recording, TraceNeed::inputs_and_outputs));
}

BENCHMARK(bare_from_chars)->Name("csv/from_chars");
BENCHMARK(whole_reader)->Name("csv/read_csv");

}  // namespace
}  // namespace attest::bench
