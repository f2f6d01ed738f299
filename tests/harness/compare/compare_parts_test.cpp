// Comparing traces part by part gives the same result as comparing whole traces.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/compare/compare.hpp"
#include "harness/core/file.hpp"
#include "harness/trace/csv.hpp"
#include "tests/harness/compare/sample_trace.hpp"
#include "tests/harness/core/temporary_directory.hpp"

namespace attest {
namespace {

using testing::HasSubstr;

class ComparePartsTest : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const Trace& trace) const {
    const auto path = directory_.path() / name;
    EXPECT_TRUE(write_csv(path, trace, all_columns(trace)));
    return path;
  }

  Result<Comparison> compared_parts(const std::filesystem::path& got,
                                    const std::filesystem::path& want) const {
    return compare(**open_csv(got, TraceNeed::outputs), **open_csv(want, TraceNeed::outputs),
                   tolerances_);
  }

  Result<Comparison> compared(const Trace& got, const Trace& want) const {
    const auto a = write("got.csv", got), b = write("want.csv", want);
    const auto whole =
        compare(*read_csv(a, TraceNeed::outputs), *read_csv(b, TraceNeed::outputs), tolerances_);
    auto parts = compared_parts(a, b);
    if (!parts) return parts;
    EXPECT_EQ(parts->ticks, whole.ticks);
    EXPECT_EQ(parts->deviating_ticks, whole.deviating_ticks);
    EXPECT_EQ(parts->mismatch, whole.mismatch);
    EXPECT_EQ(parts->first.has_value(), whole.first.has_value());
    return parts;
  }

  Tolerances tolerances_{Level::numeric};
  TemporaryDirectory directory_;
};

TEST_F(ComparePartsTest, SayWhatTracesSay) {
  const Trace want = sample_trace(50);
  EXPECT_TRUE(compared(want, want)->agrees());
  Trace got = want;
  got.samples[17].out.vehicle_rates_setpoint.pitch += 1;
  const auto off = compared(got, want);
  ASSERT_TRUE(off->first);
  EXPECT_EQ(off->first->tick, 17u);
}

TEST_F(ComparePartsTest, OfDifferentLengthDiffer) {
  const Trace want = sample_trace(50);
  Trace got = want;
  got.samples.resize(20);
  EXPECT_EQ(compared(got, want)->mismatch, "20 ticks, expected 50");
  EXPECT_EQ(compared(want, got)->mismatch, "50 ticks, expected 20");
}

TEST_F(ComparePartsTest, ATimestampThatIsAnotherEndsIt) {
  const Trace want = sample_trace(50);
  Trace got = want;
  got.samples[3].out.vehicle_rates_setpoint.pitch += 1;
  got.samples[40].in.timestamp += 1;
  const auto other = compared(got, want);
  EXPECT_THAT(other->mismatch, HasSubstr("tick 40 is at"));
  EXPECT_FALSE(other->first);
}

TEST_F(ComparePartsTest, TellTheFirstInputThatDiffers) {
  Trace want = sample_trace(300);  // three parts
  want.parameters = {{0, "MC_ROLL_P", 6.5}, {250, "MC_ROLL_P", 7}};
  set(want, 250, "in/updated.parameter_update", 1);
  EXPECT_FALSE(compared(want, want)->inputs);
  Trace got = want;
  got.parameters = {};  // a trace need not record its parameters
  EXPECT_FALSE(compared(got, want)->inputs);
  got.parameters = {{0, "MC_ROLL_P", 6.5}};
  const auto parameter = compared(got, want)->inputs;
  ASSERT_TRUE(parameter);
  EXPECT_EQ(parameter->tick, 250u);
  EXPECT_EQ(text_of(*parameter, "a", "b"), "in/parameter.MC_ROLL_P is 6.5 in a and 7 in b");
  set(got, 203, "in/manual_control_setpoint.x", 0.25);
  const auto input = compared(got, want)->inputs;
  ASSERT_TRUE(input);
  EXPECT_EQ(input->tick, 203u);
  EXPECT_EQ(input->column, "in/manual_control_setpoint.x");
}

TEST_F(ComparePartsTest, AMistakeBehindTheShorterTraceIsReported) {
  const auto a = write("got.csv", sample_trace(2)), b = write("want.csv", sample_trace(5));
  std::string text = *read_file(b);
  text.replace(text.rfind(',') + 1, std::string::npos, "x\n");
  ASSERT_TRUE(write_file(b, text));
  const auto result = compared_parts(a, b);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().line, 6);
}

}  // namespace
}  // namespace attest
