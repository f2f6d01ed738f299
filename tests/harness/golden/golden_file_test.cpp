#include "harness/golden/golden_file.hpp"

#include <limits>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace attest {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

GoldenTrace a_trace(const std::string& configuration, std::vector<float> rolls) {
  GoldenTrace trace{{configuration}, {}, {}};
  trace.outputs.present =
      channels_named("out/vehicle_rates_setpoint.roll") & channels_of(Module::mc_att_control);
  for (std::size_t tick = 0; tick < rolls.size(); ++tick) {
    trace.ticks.push_back(tick);
    Sample sample;
    sample.out.vehicle_rates_setpoint.roll = rolls[tick];
    trace.outputs.samples.push_back(sample);
  }
  return trace;
}

std::vector<float> rolls_of(const GoldenTrace& trace) {
  std::vector<float> rolls;
  for (const Sample& sample : trace.outputs.samples) {
    rolls.push_back(sample.out.vehicle_rates_setpoint.roll);
  }
  return rolls;
}

class GoldenFile : public testing::Test {
 protected:
  static Result<std::vector<GoldenTrace>> parsed(const std::string& text) {
    return parse_golden(text, "golden.csv", Module::mc_att_control);
  }
  static std::string error(const std::string& text) {
    const auto traces = parsed(text);
    EXPECT_FALSE(traces);
    return traces ? "" : traces.error().to_string();
  }
};

constexpr const char* header = "configurations,tick,out/vehicle_rates_setpoint.roll\n";

TEST_F(GoldenFile, AnEmptyCellHasTheValueAboveAndEqualTracesAreOne) {
  const std::string text =
      golden_text({a_trace("50hz", {1, 1, -0.0f}), a_trace("100hz", {2}),
                   a_trace("250hz", {1, 1, -0.0f}), a_trace("333hz", {1, 1, 0.0f})});
  EXPECT_EQ(text,
            std::string(header) + "50hz 250hz,0,1\n,1,\n,2,-0\n100hz,0,2\n333hz,0,1\n,1,\n,2,0\n");
  const auto traces = parsed(text);
  ASSERT_TRUE(traces) << traces.error().to_string();
  ASSERT_EQ(traces->size(), 3u);
  EXPECT_THAT((*traces)[0].configurations, ElementsAre("50hz", "250hz"));
  EXPECT_THAT(rolls_of((*traces)[0]), ElementsAre(1, 1, -0.0f));
  EXPECT_TRUE(std::signbit(rolls_of((*traces)[0])[2]));
  EXPECT_THAT(rolls_of((*traces)[1]), ElementsAre(2));
  EXPECT_THAT((*traces)[2].ticks, ElementsAre(0u, 1u, 2u));
}

// Each float must come back with its bits; every NaN is the same.
TEST_F(GoldenFile, ReadsBackTheBitsOfAnyValues) {
  std::mt19937 random(7);
  const std::vector<float> special{0.0f,
                                   -0.0f,
                                   1e-45f,
                                   -std::numeric_limits<float>::max(),
                                   std::numeric_limits<float>::infinity(),
                                   NAN};
  std::vector<GoldenTrace> made;
  for (const char* name : {"50hz", "100hz", "250hz"}) {
    std::vector<float> rolls;
    for (int i = 0; i < 500; ++i) {
      const auto bits = static_cast<std::uint32_t>(random());
      const bool repeats = i > 0 && bits % 3 == 0;
      const float any = bits % 5 == 0 ? special[bits % special.size()] : std::bit_cast<float>(bits);
      rolls.push_back(repeats ? rolls.back() : any);
    }
    made.push_back(a_trace(name, rolls));
  }
  const auto read = parsed(golden_text(made));
  ASSERT_TRUE(read) << read.error().to_string();
  ASSERT_EQ(read->size(), made.size());
  const std::size_t roll = made[0].outputs.present._Find_first();
  for (std::size_t i = 0; i < made.size(); ++i) {
    ASSERT_EQ((*read)[i].ticks, made[i].ticks);
    for (std::size_t k = 0; k < made[i].ticks.size(); ++k) {
      EXPECT_TRUE(
          same_bits(channels()[roll], (*read)[i].outputs.samples[k], made[i].outputs.samples[k]));
    }
  }
}

TEST_F(GoldenFile, AFlightHasTimesAHorizonAndMetrics) {
  GoldenTrace trace = a_trace("250hz-iris-ode", {1, 2});
  trace.ticks = {3, 40};
  trace.outputs.present.set(timestamp_channel);
  trace.outputs.samples[0].in.timestamp = 5'000'000;
  trace.outputs.samples[1].in.timestamp = 5'160'000;
  trace.horizon_s = 0.1;
  trace.metrics = {{"settles", std::numeric_limits<double>::infinity()}, {"sinks", 1.0 / 3}};
  GoldenTrace same = trace;
  same.configurations = {"250hz-iris-mujoco"};
  const auto read = parsed(golden_text({trace, same}));
  ASSERT_TRUE(read) << read.error().to_string();
  ASSERT_EQ(read->size(), 2u) << "each flight has its own horizon";
  const GoldenTrace& first = read->front();
  EXPECT_THAT(first.ticks, ElementsAre(3u, 40u));
  EXPECT_EQ(first.outputs.samples[1].in.timestamp, 5'160'000u);
  EXPECT_EQ(first.horizon_s, 0.1);
  EXPECT_EQ(first.metrics, trace.metrics);
}

TEST_F(GoldenFile, WhatIsNoGoldenIsAnErrorWithItsPlace) {
  const std::string h = header;
  EXPECT_THAT(error("tick,out/vehicle_rates_setpoint.roll\n0,1\n"), HasSubstr("golden.csv:1"));
  EXPECT_THAT(error("configurations,tick\n50hz,0\n"), HasSubstr("then outputs follow"));
  EXPECT_THAT(error("configurations,tick,in/control_state.roll_rate\n50hz,0,1\n"),
              HasSubstr("golden.csv:1:21: `in/control_state.roll_rate` is no column of a golden"));
  EXPECT_THAT(error(h), HasSubstr("golden.csv:2: no rows"));
  EXPECT_THAT(error(h + ",0,1\n"), HasSubstr("golden.csv:2:1: the first row names no"));
  EXPECT_THAT(error(h + "50hz,0,\n"), HasSubstr("golden.csv:2:8: an empty cell is not a number"));
  EXPECT_THAT(error(h + "50hz,0,1\n,1,x\n"), HasSubstr("golden.csv:3:4: `x` is not a number"));
  EXPECT_THAT(error("configurations,tick,out/vehicle_rates_setpoint.published,"
                    "out/vehicle_rates_setpoint.roll\n50hz,0,1,1\n,1,,1e999\n"),
              HasSubstr("golden.csv:3:5: `1e999` is too large"));
  EXPECT_THAT(error(h + "50hz,0,1\n,0,\n"), HasSubstr("golden.csv:3:2: tick 0 is not after"));
  EXPECT_THAT(error(h + "50hz,0,1\n50hz,0,1\n"), HasSubstr("golden.csv:3:1: 50hz has two traces"));
}

}  // namespace
}  // namespace attest
