// Traces in CSV, of the modules and of mixers as recorded. A trace that is read, written and
// read again has the same bits. Reading it tick by tick gives the same samples as reading the
// whole.
#include "harness/trace/csv.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <vector>

#include "tests/fuzz/fuzz.hpp"

namespace attest::fuzz {
namespace {

bool same(const Sample& a, const Sample& b, const ChannelSet& present) {
  for (std::size_t i = 0; i < channels().size(); ++i) {
    if (!present[i]) continue;
    const double left = value_of(channels()[i], a), right = value_of(channels()[i], b);
    if (std::bit_cast<std::uint64_t>(left) != std::bit_cast<std::uint64_t>(right)) return false;
  }
  return a.in.timestamp == b.in.timestamp;
}

bool same(const ParameterChange& a, const ParameterChange& b) {
  return a.tick == b.tick && a.name == b.name &&
         std::bit_cast<std::uint32_t>(a.value) == std::bit_cast<std::uint32_t>(b.value);
}

void require_same(const Trace& a, const Trace& b) {
  require(a.present == b.present, "the same channels");
  require(a.samples.size() == b.samples.size(), "the same number of ticks");
  for (std::size_t i = 0; i < a.samples.size(); ++i) {
    require(same(a.samples[i], b.samples[i], a.present), "the same sample");
  }
  require(std::equal(a.parameters.begin(), a.parameters.end(), b.parameters.begin(),
                     b.parameters.end(), [](const auto& x, const auto& y) { return same(x, y); }),
          "the same parameters");
}

void require_written(const Trace& trace, TraceNeed need) {
  const auto copy = folder() / "copy.csv";
  const auto written = write_csv(copy, trace, all_columns(trace));
  require(written.has_value(), "a trace that is read can be written");
  const auto again = read_csv(copy, need);
  require(again.has_value(), "a trace that is written can be read");
  require_same(trace, *again);
}

void require_streamed(const std::filesystem::path& file, const Trace& trace, TraceNeed need) {
  const auto reader = open_csv(file, need);
  require(reader.has_value(), "a trace that is read as a whole can be read tick by tick");
  Trace streamed;
  const auto ticks = for_each_part(**reader, 1, [&](const Trace& part, std::size_t tick, bool) {
    streamed.present = part.present;
    streamed.samples.insert(streamed.samples.end(), part.samples.begin(), part.samples.end());
    for (ParameterChange change : part.parameters) {
      change.tick = tick;
      streamed.parameters.push_back(change);
    }
    return true;
  });
  require(ticks.has_value(), "every tick can be read");
  require_same(trace, streamed);
}

}  // namespace
}  // namespace attest::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace attest;
  const auto file = fuzz::write("trace.csv", fuzz::text_of(data, size));
  // One need an input, because an error about an unknown column is slow: it suggests a name.
  constexpr std::array needs{TraceNeed::outputs, TraceNeed::inputs, TraceNeed::inputs_and_outputs};
  const TraceNeed need = needs[size % needs.size()];
  const auto trace = read_csv(file, need);
  if (!trace) {
    fuzz::require_readable(trace.error(), file);
    return 0;
  }
  fuzz::require_written(*trace, need);
  fuzz::require_streamed(file, *trace, need);
  return 0;
}
