#include "harness/verify/judge.hpp"

#include <gtest/gtest.h>

#include "harness/verify/fixed_step.hpp"
#include "tests/harness/casefile/case_files.hpp"

namespace attest {
namespace {

constexpr const char* roll = "out/vehicle_rates_setpoint.roll";

// Its rates are 1, 2, 3, ... at its ticks.
Trace counting(std::size_t ticks, float factor = 1) {
  Trace trace;
  trace.samples.resize(ticks);
  for (std::size_t i = 0; i < ticks; ++i) {
    trace.samples[i].in.timestamp = 4000 * (i + 1);
    trace.samples[i].out.vehicle_rates_setpoint.roll = factor * static_cast<float>(i + 1);
  }
  return trace;
}

TEST(LeaveOutFrom, TheTicksBeforeAreAsTheyWereAnswered) {
  Trace answered = counting(4, -1);
  leave_out_from(2, counting(4), answered);
  std::vector<float> rates;
  for (const Sample& sample : answered.samples) {
    rates.push_back(sample.out.vehicle_rates_setpoint.roll);
  }
  EXPECT_EQ(rates, (std::vector<float>{-1, -2, 3, 4}));
}

TEST(LeavesValuesToJudge, AFlagAloneIsNoValueAndATopicThatIsNeverPublishedHasNone) {
  Trace want = counting(4);
  want.present = channels_of(Module::mc_att_control);
  const ChannelSet outputs = channels_of(Module::mc_att_control, "out/");
  const ChannelSet rates = channels_of(Module::mc_att_control, "out/vehicle_rates_setpoint.");
  const ChannelSet flag = channels_named("out/vehicle_rates_setpoint.published");
  EXPECT_TRUE(leaves_values_to_judge({}, want));
  EXPECT_FALSE(leaves_values_to_judge(outputs, want));
  EXPECT_FALSE(leaves_values_to_judge(outputs & ~flag, want));
  EXPECT_TRUE(leaves_values_to_judge(outputs & ~rates, want));
  EXPECT_FALSE(leaves_values_to_judge((outputs & ~rates) | flag, want));
  want.samples[2].out.vehicle_rates_setpoint.published = 1;
  EXPECT_TRUE(leaves_values_to_judge((outputs & ~rates) | flag, want));
}

TEST(HasOtherSteps, ARecordingOfAFixedStepBeginsOnePeriodAfterZero) {
  Declarations port;
  port.fixed_step = Rate::hz(250);
  VectorResult result;
  Trace recorded = counting(3);
  EXPECT_FALSE(has_other_steps(port, recorded, Module::mc_att_control, result));
  for (Sample& sample : recorded.samples) sample.in.timestamp -= 4000;
  EXPECT_TRUE(has_other_steps(port, recorded, Module::mc_att_control, result));
  EXPECT_EQ(result.verdict, Verdict::unsupported);
}

TEST(HasOtherSteps, SamplesOfARateUnitAreTakenAtItsSteps) {
  Declarations port;
  port.fixed_step = Rate::hz(250);
  VectorResult result;
  Trace recorded = counting(3);
  for (Sample& sample : recorded.samples) {
    sample.rate_in.vehicle_angular_velocity.timestamp_sample = sample.rate_in.timestamp;
  }
  EXPECT_FALSE(has_other_steps(port, recorded, Module::rate_unit, result));
  recorded.samples[2].rate_in.vehicle_angular_velocity.timestamp_sample -= 1;
  EXPECT_TRUE(has_other_steps(port, recorded, Module::rate_unit, result));
  EXPECT_FALSE(has_other_steps(port, recorded, Module::mixer, result));
}

}  // namespace
}  // namespace attest
