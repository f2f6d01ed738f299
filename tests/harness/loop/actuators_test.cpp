#include "harness/loop/actuators.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace attest {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::IsEmpty;

class ActuatorsTest : public testing::Test {
 protected:
  static Vehicle quad() {
    Vehicle vehicle;
    vehicle.rotors.resize(4);
    vehicle.rotor_max_rad_s = 800;
    vehicle.mixer = "R: 4x 10000 10000 10000 0";
    return vehicle;
  }
  static attest_outputs controls(float roll, float thrust) {
    attest_outputs out{};
    out.actuator_controls_0.control[0] = roll;
    out.actuator_controls_0.control[3] = thrust;
    out.actuator_controls_0.published = 1;
    return out;
  }

  void follow(const attest_outputs& out, bool armed) {
    Sample sample;
    sample.in.actuator_armed.armed = armed ? 1 : 0;
    sample.out = out;
    actuators_.follow(sample);
  }

  const Vehicle vehicle_ = quad();
  Actuators actuators_{vehicle_};
};

TEST_F(ActuatorsTest, SpeedIsLinearInTheCommandAndTheSupply) {
  follow(controls(0, 0.5f), true);
  EXPECT_THAT(actuators_.speeds(actuators_.commands(), 1, {}), ElementsAre(400, 400, 400, 400));
  EXPECT_THAT(actuators_.speeds(actuators_.commands(), 0.5, {}), ElementsAre(200, 200, 200, 200));
}

TEST_F(ActuatorsTest, TheFailedRotorIsAskedForNone) {
  follow(controls(0, 0.5f), true);
  EXPECT_THAT(actuators_.speeds(actuators_.commands(), 1, 2), ElementsAre(400, 400, 0, 400));
}

TEST_F(ActuatorsTest, WithoutArmingAllStopAndFlagsStay) {
  follow(controls(0.5f, 1), true);
  EXPECT_NE(actuators_.saturation().limits.upper_limit, 0);
  follow(controls(0, 0.5f), false);
  EXPECT_THAT(actuators_.speeds(actuators_.commands(), 1, {}), Each(0));
  EXPECT_NE(actuators_.saturation().limits.upper_limit, 0);
}

TEST_F(ActuatorsTest, WhatIsNotPublishedIsNotMixed) {
  follow(controls(0, 0.5f), true);
  attest_outputs silent = controls(0, 1);
  silent.actuator_controls_0.published = 0;
  follow(silent, true);
  EXPECT_THAT(actuators_.speeds(actuators_.commands(), 1, {}), Each(400));
}

TEST_F(ActuatorsTest, ACommandThatIsNoNumberHasNoSpeeds) {
  follow(controls(0, std::nanf("")), true);
  EXPECT_THAT(actuators_.speeds(actuators_.commands(), 1, {}), IsEmpty());
}

// The firmware sends the flags as bits of one mask.
TEST_F(ActuatorsTest, FlagsAreBits) {
  follow(controls(0.5f, 1), true);
  EXPECT_EQ(actuators_.saturation().limits.upper_limit, 2);
  EXPECT_EQ(actuators_.saturation().limits.lower_limit, 0);
  follow(controls(0.9f, 0.1f), true);
  EXPECT_EQ(actuators_.saturation().limits.lower_limit, 1);
}

// Yaw alone would stop two rotors: only the yaw flag is set.
TEST_F(ActuatorsTest, YawThatIsNotFittedHasAFlagOfItsOwn) {
  attest_outputs out = controls(0, 0.5f);
  out.actuator_controls_0.control[2] = 1;
  follow(out, true);
  EXPECT_EQ(actuators_.saturation().limits.yaw, 4);
  follow(controls(0.5f, 1), true);  // roll beyond the upper limit, without yaw
  EXPECT_EQ(actuators_.saturation().limits.upper_limit, 2);
  EXPECT_EQ(actuators_.saturation().limits.yaw, 0);
}

}  // namespace
}  // namespace attest
