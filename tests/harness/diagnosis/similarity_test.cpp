#include "harness/diagnosis/similarity.hpp"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/compare/compare.hpp"

namespace attest {
namespace {

using testing::ElementsAre;
using testing::Field;
using testing::SizeIs;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

Answer answer_of(const Sample& sample) {
  Trace trace;
  trace.samples.push_back(sample);
  return outputs_of(trace).at(0);
}

Answer rates(float roll, float pitch = 0, float yaw = 0) {
  Sample sample{};
  sample.out.vehicle_rates_setpoint.roll = roll;
  sample.out.vehicle_rates_setpoint.pitch = pitch;
  sample.out.vehicle_rates_setpoint.yaw = yaw;
  return answer_of(sample);
}

const Answer zero = rates(0);

bool are_same(const Answer& port, const Answer& law, Module module = Module::mc_att_control) {
  return distinct_similarity({port}, {law}, {}, module).deviating == 0;
}

// The similarity of one fault.
Similarity similarity_of_one(const Outputs& fault, const Outputs& port, const Outputs& law,
                             Module module = Module::mc_att_control) {
  const std::vector<Outputs> distinct{fault};
  return distinct_similarity(port, law, distinct, module).similarities.at(0);
}

std::vector<Channel> output_channels() {
  std::vector<Channel> outputs;
  for (const Channel& channel : channels()) {
    if (channel.is_output()) outputs.push_back(channel);
  }
  return outputs;
}

// A sample of zeros, with this value in one channel.
Sample sample_with(const Channel& channel, double value) {
  Sample sample{};
  sample.in.control_state.q[0] = 1;
  sample.in.vehicle_attitude_setpoint.q_d[0] = 1;
  set_value(channel, sample, value);
  return sample;
}

Answer answer_with(const Channel& channel, double value) {
  return answer_of(sample_with(channel, value));
}

// Whether the value passes at the numeric level.
bool passes(std::size_t channel, double got, double want) {
  Trace trace;
  trace.present[channel] = true;
  Trace other = trace;
  trace.samples.push_back(sample_with(channels()[channel], got));
  other.samples.push_back(sample_with(channels()[channel], want));
  return compare(trace, other, Tolerances()).agrees();
}

TEST(Similarity, APortThatAnswersAsTheLawDoesNotDeviate) {
  const Outputs law{rates(1), rates(2), rates(3)};
  const VectorSimilarity same = distinct_similarity(law, law, {});
  EXPECT_EQ(same.deviating, 0u);
  EXPECT_EQ(same.ticks, 3u);
  EXPECT_THAT(same.similarities, SizeIs(0));
}

TEST(Similarity, AVectorThatDeviatesInItsFirstTickFails) {
  EXPECT_NE(distinct_similarity({rates(1), zero, zero}, {zero, zero, zero}, {}).deviating, 0u);
}

TEST(Similarity, AVectorThatDeviatesInAnyOtherTickFails) {
  EXPECT_NE(distinct_similarity({zero, rates(1), zero}, {zero, zero, zero}, {}).deviating, 0u);
  EXPECT_NE(distinct_similarity({zero, zero, rates(1)}, {zero, zero, zero}, {}).deviating, 0u);
}

TEST(Similarity, NanIsTheSameAsNanOnly) {
  EXPECT_TRUE(are_same(rates(nan), rates(-nan)));
  EXPECT_FALSE(are_same(rates(nan), rates(1)));
  EXPECT_FALSE(are_same(rates(1), rates(nan)));
  EXPECT_FALSE(are_same(rates(nan), rates(infinity)));
}

TEST(Similarity, AnInfinityIsTheSameAsItself) {
  EXPECT_TRUE(are_same(rates(infinity, 1), rates(infinity, 1.00001f)));
  EXPECT_FALSE(are_same(rates(infinity), rates(-infinity)));
  EXPECT_FALSE(are_same(rates(infinity), rates(1)));
  EXPECT_FALSE(are_same(rates(1), rates(infinity)));
}

TEST(Similarity, AnyFlagButZeroIsTrue) {
  Sample sample{};
  sample.out.vehicle_rates_setpoint.published = 1;
  const Answer one = answer_of(sample);
  sample.out.vehicle_rates_setpoint.published = 4;
  EXPECT_TRUE(are_same(one, answer_of(sample)));
  EXPECT_FALSE(are_same(one, zero));
  EXPECT_FALSE(are_same(zero, one));
}

// The tolerance is 2e-4 rad/s, or 1e-5 of the value.
TEST(Similarity, ARateIsTheSameWithinItsTolerance) {
  for (const float sign : {1.0f, -1.0f}) {
    EXPECT_TRUE(are_same(rates(1 + sign * 1.9e-4f), rates(1)));
    EXPECT_FALSE(are_same(rates(1 + sign * 2.1e-4f), rates(1)));
    EXPECT_TRUE(are_same(rates(100 + sign * 0.9e-3f), rates(100)));
    EXPECT_FALSE(are_same(rates(100 + sign * 1.1e-3f), rates(100)));
    EXPECT_FALSE(are_same(rates(-100), rates(100)));
  }
}

TEST(Similarity, ValuesAreTheSameWhenTheNumericLevelWouldPassThem) {
  for (std::size_t i = 0; i < channels().size(); ++i) {
    const Channel& channel = channels()[i];
    if (!channel.is_output()) continue;
    const auto expect = [&](double got, double want) {
      EXPECT_EQ(are_same(answer_with(channel, got), answer_with(channel, want), channel.module),
                passes(i, got, want))
          << channel.name << ": " << got << " for " << want;
    };
    for (const double value : {0.0, 1.0, 2.0}) {
      for (const double want : {0.0, 1.0}) expect(value, want);
    }
    if (channel.type != ChannelType::f32) continue;
    const std::vector<double> values{-0.0,   0.0,    0.9e-6, 1.9e-5,   2.1e-5,    0.9e-4, 1.1e-4,
                                     1.9e-4, 2.2e-4, 1,      infinity, -infinity, nan};
    for (const double value : values) {
      for (const double want : values) expect(value, want);
    }
  }
}

TEST(Similarity, ATickMatchesWhereTheFaultAnswersAsThePort) {
  const Outputs law{zero, zero, zero, zero};
  const Outputs port{rates(1), rates(2), zero, rates(0, 4)};
  const Outputs fault{rates(1), rates(3), zero, rates(4)};
  EXPECT_EQ(similarity_of_one(fault, port, law).matched, 2u);
  EXPECT_EQ(similarity_of_one(port, port, law).matched, 4u);
  EXPECT_EQ(similarity_of_one(law, port, law).matched, 1u);
}

TEST(Similarity, AValueIsInBothWhereBothDeviateInTheSameWay) {
  // Roll in both; pitch of the port; yaw of the fault.
  const Similarity one = similarity_of_one({rates(1, 0, 3)}, {rates(1, 2, 0)}, {zero});
  EXPECT_EQ(one.matched, 0u);
  EXPECT_EQ(one.same, 1u);
  EXPECT_EQ(one.other, 1u);
}

TEST(Similarity, AnotherValueAtTheSamePlaceIsNotInBoth) {
  const Similarity one = similarity_of_one({rates(5)}, {rates(1)}, {zero});
  EXPECT_EQ(one.same, 0u);
  EXPECT_EQ(one.other, 1u);
}

TEST(Similarity, KnowsWhetherTheFaultDeviates) {
  const Similarity does = similarity_of_one({rates(1), zero}, {zero, zero}, {zero, zero});
  EXPECT_NE(does.deviating, 0u);
  EXPECT_EQ(does.deviating, does.parted);
  const Similarity not_it = similarity_of_one({zero, zero}, {rates(1), zero}, {zero, zero});
  EXPECT_EQ(not_it.deviating, 0u);
  EXPECT_NE(not_it.parted, 0u);
}

TEST(Similarity, OtherValuesAreNotInBothThoughTheyAreAsMany) {
  const Similarity one = similarity_of_one({rates(0, 0, 1)}, {rates(1)}, {zero});
  EXPECT_EQ(one.same, 0u);
  EXPECT_EQ(one.other, 1u);
}

TEST(Similarity, TheSameValueAtAnotherTickIsNotInBoth) {
  const Similarity one = similarity_of_one({zero, rates(1)}, {rates(1), zero}, {zero, zero});
  EXPECT_EQ(one.same, 0u);
  EXPECT_EQ(one.other, 1u);
}

TEST(Similarity, ValuesAreCountedAtEachTick) {
  const Outputs both{rates(1, 1, 1), rates(1), zero};
  const Similarity one = similarity_of_one(both, both, {zero, zero, zero});
  EXPECT_EQ(one.same, 4u);
  EXPECT_EQ(one.other, 0u);
}

TEST(Similarity, EveryOutputIsAValueOfItsOwn) {
  const auto outputs = output_channels();
  for (const Channel& of_port : outputs) {
    for (const Channel& of_fault : outputs) {
      if (of_port.module != of_fault.module) continue;
      const bool same = of_port.name == of_fault.name;
      const Similarity one =
          similarity_of_one({answer_with(of_fault, 1)}, {answer_with(of_port, 1)},
                            {answer_with(of_port, 0)}, of_port.module);
      EXPECT_EQ(one.same, same ? 1u : 0u) << of_port.name << ", " << of_fault.name;
      EXPECT_EQ(one.other, same ? 0u : 1u) << of_port.name << ", " << of_fault.name;
    }
  }
}

TEST(Similarity, AFaultThatDoesNotAnswerMatchesNothing) {
  const Similarity one = similarity_of_one({}, {zero, rates(1)}, {zero, zero});
  EXPECT_EQ(one.matched, 0u);
  EXPECT_EQ(one.same, 0u);
  EXPECT_EQ(one.parted, ~OutputMask());
  EXPECT_GT(one.misfit, 0);
}

TEST(Similarity, EachFaultIsLikeItsAnswers) {
  const Outputs law{zero, zero}, other{zero, rates(1)};
  const FaultAnswers faults{{law, other}, {1, 0, 1}};
  const VectorSimilarity all = similarity(other, law, faults);
  EXPECT_NE(all.deviating, 0u);
  EXPECT_EQ(all.ticks, 2u);
  EXPECT_THAT(all.similarities,
              ElementsAre(Field(&Similarity::matched, 2u), Field(&Similarity::matched, 1u),
                          Field(&Similarity::matched, 2u)));
  EXPECT_NE(all.explained(all.similarities[0]), 0u);
  EXPECT_EQ(all.explained(all.similarities[1]), 0u);
  EXPECT_EQ(all.contradicted(all.similarities[0]), 0u);
}

// An error of 2e-4 rad/s is the tolerance, and 1 bit; each further bit is twice as far.
TEST(Similarity, TheMisfitCountsHowNearAValueIs) {
  const auto misfit = [](float fault) {
    return similarity_of_one({rates(fault)}, {zero}, {zero}).misfit;
  };
  EXPECT_EQ(misfit(0), 0);
  EXPECT_NEAR(misfit(7 * 2e-4f), 3, 1e-3);
  EXPECT_EQ(misfit(1000), 10);
  EXPECT_EQ(misfit(nan), 10);
  const Similarity two = similarity_of_one({rates(1, 1)}, {zero}, {zero});
  EXPECT_DOUBLE_EQ(two.misfit, 20);
  EXPECT_DOUBLE_EQ(distinct_similarity({rates(1)}, {zero}, {}).misfit, 10);
}

TEST(Similarity, OutputsAreThoseOfEachTick) {
  Trace trace;
  trace.samples.resize(2);
  trace.samples[0].out.actuator_controls_0.control[3] = 0.5f;
  trace.samples[1].mixer_out.actuator_outputs.output[2] = 0.25f;
  trace.samples[1].battery_out.battery_status.scale = 1.25f;
  const Outputs outputs = outputs_of(trace);
  ASSERT_THAT(outputs, SizeIs(2));
  EXPECT_EQ(outputs[0].sample().out.actuator_controls_0.control[3], 0.5f);
  EXPECT_EQ(outputs[0].sample().battery_out.battery_status.scale, 0);
  EXPECT_EQ(outputs[1].sample().mixer_out.actuator_outputs.output[2], 0.25f);
  EXPECT_EQ(outputs[1].sample().battery_out.battery_status.scale, 1.25f);
}

}  // namespace
}  // namespace attest
