#include "harness/core/loop_rate.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace attest {
namespace {

using testing::HasSubstr;

TEST(LoopRate, IsOneRateOrAPair) {
  const auto one = LoopRate::parse("1000/3");
  ASSERT_TRUE(one);
  EXPECT_EQ(*one, LoopRate(Rate::hz(1000, 3)));
  EXPECT_EQ(one->to_string(), "1000/3");
  EXPECT_EQ(one->label(), "1000_3hz");
  const auto pair = LoopRate::parse("125/2:1000");
  ASSERT_TRUE(pair);
  EXPECT_EQ(*pair->attitude_unit, Rate::hz(125, 2));
  EXPECT_EQ(pair->motor_unit, Rate::hz(1000));
  EXPECT_EQ(pair->to_string(), "125/2:1000");
  EXPECT_EQ(pair->label(), "125_2-1000hz");
}

TEST(LoopRate, BothUnitsMayRunAtOneRate) { EXPECT_TRUE(LoopRate::parse("250:250")); }

TEST(LoopRate, TheRateUnitIsNotTheSlowerOne) {
  const auto pair = LoopRate::parse("1000:250");
  ASSERT_FALSE(pair);
  EXPECT_THAT(pair.error().message,
              HasSubstr("the rate unit at 250 Hz is slower than the attitude unit at 1000 Hz"));
}

TEST(LoopRate, WhatIsNoRateIsRefused) {
  for (const char* text : {"", ":", "250:", ":250", "250:1000:8000", "250;1000", "0:250"}) {
    EXPECT_FALSE(LoopRate::parse(text)) << text;
  }
}

TEST(LoopRate, IsOrderedByTheRateOfTheUnitThatCommandsTheMotors) {
  const LoopRate slow(Rate::hz(250), Rate::hz(400)), fast(Rate::hz(50), Rate::hz(1000));
  EXPECT_LT(slow, fast);
  EXPECT_LT(LoopRate(Rate::hz(1000)), fast);
  EXPECT_LT(LoopRate(Rate::hz(100), Rate::hz(400)), slow);
}

}  // namespace
}  // namespace attest
