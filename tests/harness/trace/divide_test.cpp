#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/trace/provenance.hpp"

namespace attest {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

// Two ticks with three channels; all other channels are not present.
Trace trace_of(float scale_0, float scale_1, std::uint8_t armed = 1) {
  Trace trace;
  for (const float scale : {scale_0, scale_1}) {
    Sample sample{};
    sample.in.timestamp = 4000 * (trace.samples.size() + 1);
    sample.in.battery_status.scale = scale;
    sample.in.actuator_armed.armed = armed;
    trace.samples.push_back(sample);
  }
  for (const char* name : {"timestamp", "in/battery_status.scale", "in/actuator_armed.armed"}) {
    trace.present.set(*find_channel(Module::mc_att_control, name));
  }
  return trace;
}

ChannelSet set_of(std::initializer_list<const char*> names) {
  ChannelSet set;
  for (const char* name : names) set.set(*find_channel(Module::mc_att_control, name));
  return set;
}

TEST(Divide, MakesConstantsOfWhatNeverChanges) {
  const Division division = divide({trace_of(0.5f, 0.5f)});
  EXPECT_EQ(division.columns.channels, set_of({"timestamp"}));
  EXPECT_THAT(division.constants, ElementsAre(Pair("in/actuator_armed.armed", 1),
                                              Pair("in/battery_status.scale", 0.5)));
}

TEST(Divide, KeepsColumnsOfWhatChanges) {
  const Division division = divide({trace_of(0.5f, 0.25f)});
  EXPECT_EQ(division.columns.channels, set_of({"timestamp", "in/battery_status.scale"}));
  EXPECT_THAT(division.constants, ElementsAre(Pair("in/actuator_armed.armed", 1)));
}

TEST(Divide, AConstantIsTheSameInAllTraces) {
  const Division division = divide({trace_of(0.5f, 0.5f, 1), trace_of(0.75f, 0.75f, 1)});
  EXPECT_EQ(division.columns.channels, set_of({"timestamp", "in/battery_status.scale"}));
  EXPECT_THAT(division.constants, ElementsAre(Pair("in/actuator_armed.armed", 1)));
}

TEST(Divide, TimestampIsNeverAConstant) {
  Trace trace = trace_of(1, 1);
  trace.samples.pop_back();
  EXPECT_TRUE(divide({trace}).columns.channels[0]);
}

TEST(Divide, ComparesByBitsExceptForNaN) {
  EXPECT_EQ(divide({trace_of(0.0f, -0.0f)}).constants.count("in/battery_status.scale"), 0u);
  const Division division = divide({trace_of(NAN, -NAN)});
  EXPECT_TRUE(std::isnan(division.constants.at("in/battery_status.scale")));
}

TEST(Divide, SplitsParameters) {
  Trace a = trace_of(1, 1);
  a.parameters = {{0, "SAME", 1}, {0, "CHANGES", 1}, {0, "DIFFERS", 1}, {1, "CHANGES", 2}};
  Trace b = trace_of(1, 1);
  b.parameters = {{0, "SAME", 1}, {0, "CHANGES", 1}, {0, "DIFFERS", 2}};
  const Division division = divide({a, b});
  EXPECT_THAT(division.columns.parameters, ElementsAre("CHANGES", "DIFFERS"));
  EXPECT_EQ(division.constants.at("in/parameter.SAME"), 1);
  EXPECT_EQ(division.constants.count("in/parameter.CHANGES"), 0u);
}

TEST(Divide, KeyframesHaveNoParameters) {
  Trace whole = trace_of(1, 1);
  whole.parameters = {{0, "SAME", 1}, {0, "CHANGES", 1}, {1, "CHANGES", 2}};
  const Division division = divide({whole, trace_of(1, 1)});
  EXPECT_THAT(division.columns.parameters, ElementsAre("CHANGES"));
  EXPECT_EQ(division.constants.at("in/parameter.SAME"), 1);
}

TEST(Divide, AParameterSetLaterIsNoConstant) {
  Trace trace = trace_of(1, 1);
  trace.parameters = {{1, "LATE", 1}};
  EXPECT_THAT(divide({trace}).columns.parameters, ElementsAre("LATE"));
}

TEST(Divide, AParameterSetAgainToTheSameValueIsAConstant) {
  Trace trace = trace_of(1, 1);
  trace.parameters = {{0, "P", 0.1f}, {1, "P", 0.1f}};
  const Division division = divide({trace});
  EXPECT_THAT(division.columns.parameters, IsEmpty());
  EXPECT_EQ(static_cast<float>(division.constants.at("in/parameter.P")), 0.1f);
}

}  // namespace
}  // namespace attest
