#include "harness/golden/expected_outputs.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/casefile/stimulus.hpp"
#include "harness/compare/compare.hpp"
#include "harness/compare/input_difference.hpp"
#include "harness/host/manifest.hpp"
#include "tests/harness/casefile/case_files.hpp"
#include "tests/harness/golden/blessed.hpp"

namespace attest {
namespace {

using testing::HasSubstr;

class ExpectedOutputsTest : public testing::Test {
 protected:
  ExpectedOutputsTest()
      : case_(
            case_of("rates_hz = [250]\nrates_why = \"one\"\n[control_state]\n"
                    "roll_rate = { signal = \"sine\", amplitude = 0.3, cycles = 2 }\n"
                    "q = { yaw_deg = { signal = \"ramp\", from = 0, to = 40, end_ticks = 9 } }\n")),
        answer_(answers_of_reference(case_)[0]),
        made_(made_by_reference(case_)) {}

  Result<ExpectedOutputs> expected() const {
    const Golden golden("golden.csv", {{}, {}, {}, {}, {}, {}, made_.inputs}, made_.traces);
    return expected_outputs(case_, Rate::hz(250), golden);
  }
  std::string error() const {
    const auto outputs = expected();
    EXPECT_FALSE(outputs);
    return outputs ? "" : outputs.error().to_string();
  }
  float& integral(std::size_t tick) {
    return made_.traces[0].outputs.samples[tick].out.mc_att_ctrl_status.roll_rate_integ;
  }

  Case case_;
  Trace answer_;
  MadeGolden made_;
};

TEST_F(ExpectedOutputsTest, AreThoseOfTheReference) {
  const auto outputs = expected();
  ASSERT_TRUE(outputs) << outputs.error().to_string();
  EXPECT_TRUE(outputs->is_exact);
  EXPECT_EQ(first_input_difference(outputs->trace, answer_), std::nullopt);
  EXPECT_TRUE(compare(outputs->trace, answer_, Tolerances(Level::exact)).agrees());
}

TEST_F(ExpectedOutputsTest, WithOtherBitsTheGoldenDecides) {
  integral(3) += 1e-7f;
  const auto outputs = expected();
  ASSERT_TRUE(outputs) << outputs.error().to_string();
  EXPECT_FALSE(outputs->is_exact);
  EXPECT_EQ(outputs->trace.samples[3].out.mc_att_ctrl_status.roll_rate_integ, integral(3));
}

TEST_F(ExpectedOutputsTest, AReferenceBeyondTheTolerancesIsAnError) {
  integral(3) += 1e-2f;
  EXPECT_THAT(error(), HasSubstr("golden.csv: at 250hz, tick 3, the reference of this build "
                                 "answers another out/mc_att_ctrl_status.roll_rate_integ"));
}

TEST_F(ExpectedOutputsTest, AGoldenWithoutATickOrAnOutputIsAnError) {
  const MadeGolden whole = made_;
  made_.traces[0].ticks.pop_back();
  made_.traces[0].outputs.samples.pop_back();
  EXPECT_THAT(error(), HasSubstr("at 250hz, has 9 ticks up to 8, but the case makes 10"));
  made_ = whole;
  made_.traces[0].ticks.back() += 1;
  EXPECT_THAT(error(), HasSubstr("has 10 ticks up to 10, but the case makes 10"));
  made_ = whole;
  made_.traces[0].outputs.present &= ~channels_named("out/vehicle_rates_setpoint.roll");
  EXPECT_THAT(error(), HasSubstr("has no out/vehicle_rates_setpoint.roll; bless it anew"));
}

// attest cannot compute them.
TEST_F(ExpectedOutputsTest, OfAPortAreTheGoldens) {
  made_.inputs["250hz"] = "of another case";
  EXPECT_THAT(error(), HasSubstr("at 250hz, the case has other inputs"));
  made_.inputs["250hz"] = sha256_of_inputs(stimulate(case_, Rate::hz(250)));
  integral(3) += 0.25f;
  const auto outputs = expected();
  ASSERT_TRUE(outputs) << outputs.error().to_string();
  EXPECT_TRUE(outputs->is_exact);
  EXPECT_EQ(outputs->trace.samples[3].out.mc_att_ctrl_status.roll_rate_integ, integral(3));
}

TEST_F(ExpectedOutputsTest, TheReferenceFillsInTheTicksThatALongGoldenLacks) {
  case_.duration = {1200, Span::In::ticks};
  made_ = made_by_reference(case_);
  EXPECT_LT(made_.traces[0].ticks.size(), 60u);
  const auto outputs = expected();
  ASSERT_TRUE(outputs) << outputs.error().to_string();
  EXPECT_TRUE(
      compare(outputs->trace, answers_of_reference(case_)[0], Tolerances(Level::exact)).agrees());
  integral(3) += 1e-2f;
  EXPECT_THAT(error(), HasSubstr("the reference of this build answers another"));
}

}  // namespace
}  // namespace attest
