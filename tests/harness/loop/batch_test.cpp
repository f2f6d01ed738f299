// Units that take several steps at once, as programs do.
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/loop/open_loop.hpp"
#include "tests/harness/loop/numbered_trace.hpp"

namespace attest {
namespace {

using testing::ElementsAre;

using Kind = PortFault::Kind;

// Takes at most three steps in a batch. Its output is the sum of the one before and the time.
class FakeProgram final : public UnitOf<attest_inputs, attest_outputs> {
 public:
  int set_parameter(const std::string& name, float value) override {
    calls.push_back(fmt::format("{}={}", name, value));
    return ATTEST_OK;
  }
  int step(const attest_inputs&, attest_outputs&) override { return ATTEST_FAILED; }
  std::size_t max_batch() const override { return 3; }
  Batched batch(std::span<Sample> samples,
                std::span<const std::uint64_t> timestamp_samples_us) override {
    const std::uint64_t first = samples.front().in.timestamp, last = timestamp_samples_us.back();
    calls.push_back(fmt::format("batch {}..{}", first, last));
    if (ends_at && last >= *ends_at) {
      throw PortBroke(PortBroke::How::ended, "the program exited with status 3");
    }
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const std::uint64_t now = samples[i].in.timestamp;
      if (fails_at && now == *fails_at) return {i, ATTEST_FAILED};
      if (i > 0) samples[i].copy_outputs(samples[i - 1]);
      samples[i].out.vehicle_rates_setpoint.roll += static_cast<float>(now);
    }
    return {samples.size(), ATTEST_OK};
  }

  std::vector<std::string> calls;
  std::optional<std::uint64_t> fails_at, ends_at;
};

std::vector<float> rolls(const Trace& trace) {
  std::vector<float> found;
  for (const Sample& sample : trace.samples)
    found.push_back(sample.out.vehicle_rates_setpoint.roll);
  return found;
}

TEST(DriveInBatches, EndsABatchWhereAParameterChanges) {
  FakeProgram unit;
  Trace trace = trace_of(6);
  trace.parameters = {{0, "A", 1}, {4, "A", 2}};
  EXPECT_FALSE(drive(unit, trace));
  EXPECT_THAT(unit.calls, ElementsAre("A=1", "batch 0..2", "batch 3..3", "A=2", "batch 4..5"));
}

TEST(DriveInBatches, GivesEachStepTheOutputsOfTheOneBefore) {
  FakeProgram unit;
  Trace trace = trace_of(5);
  EXPECT_FALSE(drive(unit, trace));
  EXPECT_THAT(rolls(trace), ElementsAre(0, 1, 3, 6, 10));
}

TEST(DriveInBatches, KeepsTheOutputsBeforeTheStepThatFailed) {
  FakeProgram unit;
  unit.fails_at = 4;
  Trace trace = trace_of(6);
  const auto fault = drive(unit, trace);
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->kind, Kind::failed);
  EXPECT_EQ(fault->tick, 4u);
  EXPECT_EQ(fault->what, "step at tick 4 returned ATTEST_FAILED");
  EXPECT_THAT(rolls(trace), ElementsAre(0, 1, 3, 6, 0, 0));
}

TEST(DriveInBatches, TheEndOfAProgramIsACrashAtTheBatch) {
  FakeProgram unit;
  unit.ends_at = 5;
  Trace trace = trace_of(6);
  const auto fault = drive(unit, trace);
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->kind, Kind::crash);
  EXPECT_EQ(fault->tick, 3u);
  EXPECT_EQ(fault->what, "at tick 3 or later: the program exited with status 3");
}

}  // namespace
}  // namespace attest
