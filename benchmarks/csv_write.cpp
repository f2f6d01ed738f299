// Writing a trace against the least cost of writing: std::to_chars of each value into memory that
// is already allocated, and one write of all of it.
#include <charconv>
#include <variant>
#include <vector>

#include <benchmark/benchmark.h>

#include "harness/core/file.hpp"
#include "harness/trace/csv.hpp"

namespace attest::bench {
namespace {

constexpr const char* written = ATTEST_SOURCE_DIR "/golden/recorded/px4-v1.5.5/extremes_250hz.csv";

const Trace& trace() {
  static const Trace read = *read_csv(written, TraceNeed::inputs_and_outputs);
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

BENCHMARK(bare_to_chars)->Name("csv/to_chars");
BENCHMARK(whole_writer)->Name("csv/write_csv");

}  // namespace
}  // namespace attest::bench
