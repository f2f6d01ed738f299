// A trace as CSV against the least cost of it. Reading: the file in memory, std::from_chars on each
// cell, the values discarded. Writing: std::to_chars of each value into memory that is already
// allocated, and one write of all of it.
#include "harness/trace/csv.hpp"

#include <charconv>
#include <variant>
#include <vector>

#include <benchmark/benchmark.h>

#include "harness/core/file.hpp"

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

const Trace& trace() {
  static const Trace read = *read_csv(recording, TraceNeed::inputs_and_outputs);
  return read;
}

using Cell = std::variant<float, std::uint64_t>;

// The numbers that the writer writes, row by row; parameters have their first values throughout.
std::vector<Cell> cells_of(const Trace& from) {
  const CsvColumns columns = all_columns(from);
  std::vector<Cell> cells;
  for (const Sample& sample : from.samples) {
    for (std::size_t i = 0; i < columns.channels.size(); ++i) {
      if (!columns.channels[i]) continue;
      const Channel& channel = channels()[i];
      if (channel.type == ChannelType::f32) {
        cells.emplace_back(float_of(channel, sample));
      } else {
        cells.emplace_back(static_cast<std::uint64_t>(value_of(channel, sample)));
      }
    }
    for (std::size_t i = 0; i < columns.parameters.size(); ++i) {
      cells.emplace_back(from.parameters[i].value);
    }
  }
  return cells;
}

void bare_to_chars(benchmark::State& state) {
  const std::vector<Cell> cells = cells_of(trace());
  constexpr std::size_t longest = 21;
  std::vector<char> text(cells.size() * longest);
  for (auto _ : state) {
    char* at = text.data();
    for (const Cell& cell : cells) {
      at = std::visit([&](auto value) { return std::to_chars(at, at + longest, value).ptr; }, cell);
      *at++ = ',';
    }
    auto out = AtomicFile::open("/dev/null");
    benchmark::DoNotOptimize(out->write({text.data(), at}));
  }
}

void whole_writer(benchmark::State& state) {
  const Trace& from = trace();
  for (auto _ : state) {
    benchmark::DoNotOptimize(write_csv("/dev/null", from, all_columns(from)));
  }
}

BENCHMARK(bare_from_chars)->Name("csv/from_chars");
BENCHMARK(whole_reader)->Name("csv/read_csv");
BENCHMARK(bare_to_chars)->Name("csv/to_chars");
BENCHMARK(whole_writer)->Name("csv/write_csv");

}  // namespace
}  // namespace attest::bench
