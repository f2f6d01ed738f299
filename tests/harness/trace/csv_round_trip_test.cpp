#include <algorithm>
#include <bit>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include "harness/core/file.hpp"
#include "harness/trace/csv.hpp"
#include "tests/harness/core/temporary_directory.hpp"
#include "tests/harness/trace/sheet.hpp"

namespace attest {
namespace {

std::uint32_t arbitrary_bits() {
  // At the nominal size all 32 bits vary.
  return *rc::gen::resize(rc::kNominalSize, rc::gen::arbitrary<std::uint32_t>());
}

// Every kind of float, each of them often: any bits, both zeros, NaNs with payloads, infinities,
// denormals, the neighbours of their ends, short decimals.
float arbitrary_float() {
  const std::uint32_t bits = arbitrary_bits();
  switch (*rc::gen::inRange(0, 6)) {
    case 0:
      return std::bit_cast<float>(bits & 0x807fffffu);  // denormal or zero
    case 1:
      return std::bit_cast<float>(bits | 0x7f800000u);  // NaN or infinity
    case 2: {
      constexpr std::uint32_t ends[] = {0, 1, 0x7fffff, 0x800000, 0x7f7fffff, 0x7f800000};
      return std::bit_cast<float>(ends[bits % 6] | (bits & 0x80000000u));
    }
    case 3:
      return static_cast<float>(bits % 2000) / 100.0f - 10.0f;
    default:
      return std::bit_cast<float>(bits);
  }
}

void fill(Sample& sample) {
  for (const Channel& channel : channels()) {
    if (channel.module != Module::mc_att_control) continue;
    if (channel.type == ChannelType::f32) {
      set_value(channel, sample, static_cast<double>(arbitrary_float()));
    } else if (channel.type != ChannelType::u64) {
      const std::uint32_t limit = channel.type == ChannelType::u8 ? 256 : 2;
      set_value(channel, sample, arbitrary_bits() % limit);
    }
  }
}

// A trace as runs make them: parameters have values at tick 0, and change where the unit receives
// parameter_update.
Trace arbitrary_trace() {
  Trace trace;
  trace.present = channels_of(Module::mc_att_control);
  const std::vector<std::string> names = {"MC_ROLL_P", "MC_YAW_P", "VT_TYPE"};
  std::vector<float> values;
  for (const std::string& name : names) {
    values.push_back(arbitrary_float());
    trace.parameters.push_back({0, name, values.back()});
  }
  std::uint64_t timestamp = arbitrary_bits();
  const auto ticks = *rc::gen::inRange<std::size_t>(1, 6);
  for (std::size_t tick = 0; tick < ticks; ++tick) {
    Sample sample{};
    fill(sample);
    timestamp += 1 + arbitrary_bits() % 100000;
    sample.in.timestamp = timestamp;
    trace.samples.push_back(sample);
    if (tick == 0 || (sample.in.updated & ATTEST_UPDATED_PARAMETER_UPDATE) == 0) continue;
    const std::size_t changed = arbitrary_bits() % names.size();
    const auto value = static_cast<float>(tick) + 0.5f;  // never the previous value
    if (value != values[changed]) trace.parameters.push_back({tick, names[changed], value});
    values[changed] = value;
  }
  return trace;
}

bool same_change(const ParameterChange& a, const ParameterChange& b) {
  const bool both_nan = a.value != a.value && b.value != b.value;
  const bool same_bits =
      std::bit_cast<std::uint32_t>(a.value) == std::bit_cast<std::uint32_t>(b.value);
  return a.tick == b.tick && a.name == b.name && (both_nan || same_bits);
}

bool same_changes(const Trace& a, const Trace& b) {
  return std::equal(a.parameters.begin(), a.parameters.end(), b.parameters.begin(),
                    b.parameters.end(), same_change);
}

Trace written_and_read(const Trace& trace, const CsvColumns& columns,
                       const TemporaryDirectory& directory) {
  const std::filesystem::path path = directory.path() / "a.csv";
  RC_ASSERT(write_csv(path, trace, columns).has_value());
  auto read = read_csv(path, TraceNeed::inputs_and_outputs);
  RC_ASSERT(read.has_value());
  return *std::move(read);
}

RC_GTEST_PROP(CsvRoundTrip, KeepsEveryBit, ()) {
  const TemporaryDirectory directory;
  const Trace trace = arbitrary_trace();
  const Trace read = written_and_read(trace, all_columns(trace), directory);
  RC_ASSERT(same_samples(trace, read));
  RC_ASSERT(same_changes(trace, read));
  RC_ASSERT(read.present == trace.present);
}

TEST(CsvRoundTrip, WritesWhatWasReadOfARecordedTrace) {
  const TemporaryDirectory directory;
  const auto trace =
      read_csv(directory.write("recorded.csv", Sheet::recorded().text()), TraceNeed::inputs);
  ASSERT_TRUE(write_csv(directory.path() / "b.csv", *trace, all_columns(*trace)));
  const std::string text = read_file(directory.path() / "b.csv").value();
  const std::string recorded = Sheet::recorded().text();
  EXPECT_EQ(text.substr(0, text.find('\n')), recorded.substr(0, recorded.find('\n')));
  // Numbers may be shorter: the recorded ones are shortest in `in/` only.
  EXPECT_TRUE(same_samples(*trace, *read_csv(directory.path() / "b.csv", TraceNeed::inputs)));
}

}  // namespace
}  // namespace attest
