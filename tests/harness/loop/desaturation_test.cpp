// What the control allocator does with torque that does not fit.
#include <cmath>
#include <limits>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/loop/control_allocator.hpp"
#include "tests/harness/loop/allocated.hpp"

namespace attest {
namespace {

using test::IsNear;
using test::quad_x;
using test::speeds_of;
using testing::Each;
using testing::ElementsAre;
using testing::Pointwise;

using Torque = std::array<float, 3>;
constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

// The numbers are computed by hand. With a = sqrt(1/2) the columns of this quad are
//
//     roll (-a, a, a, -a)    pitch (a, -a, a, -a)    yaw (1, 1, -1, -1)    thrust (1, 1, 1, 1)
//
// The torque that speeds give is the sum of column * speed, divided by 2 (roll, pitch) or 4 (yaw).
class Saturated : public testing::Test {
 protected:
  void allocate(const Torque& torque, float thrust, Airmode airmode = Airmode::off) {
    allocation_ = allocator_.allocate(torque, {0, 0, -thrust}, airmode);
  }
  void expect_speeds(const std::vector<double>& speeds) const {
    EXPECT_THAT(speeds_of(allocation_, quad_), Pointwise(IsNear(1e-6), speeds));
  }
  void expect_lack(const Torque& torque) const {
    EXPECT_THAT(allocation_.unallocated_torque, Pointwise(IsNear(1e-6f), torque));
    EXPECT_EQ(allocation_.torque_setpoint_achieved, torque == Torque{});
  }

  const Vehicle quad_ = quad_x(0.2, 0.2);
  const ControlAllocator allocator_{quad_};
  Allocation allocation_;
};

TEST_F(Saturated, ThrustIsLoweredForRoll) {
  allocate({0.4f, 0, 0}, 0.9f);
  const double least = 1 - 0.8 * std::sqrt(0.5);
  expect_speeds({least, 1, 1, least});
  expect_lack({});
}

TEST_F(Saturated, ThrustIsNotRaisedForRoll) {
  allocate({1, 0, 0}, 0.3f);
  expect_speeds({0, 0.6, 0.6, 0});
  expect_lack({1 - 0.3f * std::sqrt(2.0f), 0, 0});
  allocate({-0.5f, 0, 0.5f}, 0);
  expect_speeds({0, 0, 0, 0});
  expect_lack({-0.5f, 0, 0.5f});
}

// Both limits at once: the largest roll that fits has the rotors at stopped and at full.
TEST_F(Saturated, RollThatDoesNotFitIsShrunk) {
  allocate({1, 0, 0}, 0.9f);
  expect_speeds({0, 1, 1, 0});
  expect_lack({1 - std::sqrt(0.5f), 0, 0});
}

// Speeds 0.2 + (1.2 a, -1.2 a, -0.4 a, 0.4 a) = (1.0485, -0.6485, -0.0828, 0.4828).
//
// 1. Thrust would have to rise: it stays.
// 2. Roll: rotor 0 needs 0.0686, rotor 1 0.6485 / a = 0.9172, rotor 2 0.1172. The largest gives
//    (0.4, 0, 0.5657, -0.1657). Rotor 3 then needs -0.2343. Half of it gives (0.4828, -0.0828,
//    0.4828, -0.0828): roll is -0.8 + 0.9172 - 0.1172 = 0.
// 3. Pitch: rotors 1 and 3 need -0.0828 / a = -0.1172. That gives (0.4, 0, 0.4, 0): pitch is
// 0.2828.
TEST_F(Saturated, RollIsReducedBeforePitch) {
  allocate({-0.8f, 0.4f, 0}, 0.2f);
  expect_speeds({0.4, 0, 0.4, 0});
  expect_lack({-0.8f, 0.4f - 0.2828427f, 0});
}

TEST_F(Saturated, ThrustIsLoweredForYawByUpTo15Percent) {
  allocate({0, 0, 0.1f}, 0.95f);
  expect_speeds({1, 1, 0.8, 0.8});
  expect_lack({});
  allocate({0, 0, -0.4f}, 0.95f);
  expect_speeds({0.6, 0.6, 1, 1});
  expect_lack({0, 0, -0.2f});
}

TEST_F(Saturated, ThrustIsNotRaisedForYaw) {
  allocate({0, 0, 0.3f}, 0.1f);
  expect_speeds({0.2, 0.2, 0, 0});
  expect_lack({0, 0, 0.2f});
}

TEST_F(Saturated, RollIsKeptBeforeYaw) {
  allocate({0.6f, 0, 0.6f}, 0.5f);
  const double turn = 0.6 * std::sqrt(0.5);
  const double room = 0.5 - turn;
  expect_speeds({0.5 - turn + room, 0.5 + turn + room, 0.5 + turn - room, 0.5 - turn - room});
  expect_lack({0, 0, static_cast<float>(0.6 - room)});
}

// Roll of 0.4 / a at thrust 0.6 is (0.2, 1, 1, 0.2), yaw makes it (0.6, 1.4, 0.6, -0.2). Rotor 1
// needs -0.25 back to 1.15, rotor 3 -0.2: yaw becomes 0.15, speeds (0.35, 1.15, 0.85, 0.05). Thrust
// falls by 0.15, and rotor 3 is at -0.1. Half of it is given back: (0.25, 1.05, 0.75, -0.05). Cut
// off at the limits this gives roll (-0.25 + 1 + 0.75) a / 2 = 0.75 a and yaw 0.5 / 4.
TEST_F(Saturated, YawCostsRollWhereLoweredThrustStopsARotor) {
  allocate({0.4f * std::sqrt(2.0f), 0, 0.4f}, 0.6f);
  expect_speeds({0.25, 1, 0.75, 0});
  expect_lack({0.05f * std::sqrt(0.5f), 0, 0.275f});
}

// The firmware compares the length of the missing torque with 1e-3. At thrust 0 all is missing.
TEST_F(Saturated, ATorqueErrorBelowOneThousandthCountsAsAchieved) {
  allocate({0.0007f, 0.0007f, 0}, 0);  // length 0.00099
  EXPECT_TRUE(allocation_.torque_setpoint_achieved);
  EXPECT_THAT(allocation_.unallocated_torque, ElementsAre(0.0007f, 0.0007f, 0));
  allocate({0.0008f, 0.0008f, 0}, 0);  // length 0.00113
  EXPECT_FALSE(allocation_.torque_setpoint_achieved);
}

TEST_F(Saturated, AirmodeOfRollAndPitchRaisesTheThrustForThem) {
  const float turn = 0.4f * std::sqrt(0.5f);
  allocate({0.4f, 0, 0}, 0.1f, Airmode::roll_pitch);
  expect_speeds({0, 2 * turn, 2 * turn, 0});
  expect_lack({});
  allocate({0.4f, 0, 0}, 0.1f);
  expect_lack({0.4f - 0.1f * std::sqrt(2.0f), 0, 0});
}

// Speeds 0.3 + (-a, a, a, -a) are (-0.407, 1.007, 1.007, -0.407). Thrust rises by 0.407 - 0.007 =
// 0.4, and falls by half of 0.4: (-0.207, 1.207, 1.207, -0.207), cut off at the limits.
TEST_F(Saturated, AirmodeHalvesWhatIsBeyondBothLimits) {
  allocate({1, 0, 0}, 0.3f, Airmode::roll_pitch);
  expect_speeds({0, 1, 1, 0});
  expect_lack({1 - std::sqrt(0.5f), 0, 0});
}

TEST_F(Saturated, OnlyTheAirmodeOfYawRaisesTheThrustForYaw) {
  allocate({0, 0, 0.3f}, 0.1f, Airmode::roll_pitch);
  expect_speeds({0.2, 0.2, 0, 0});
  expect_lack({0, 0, 0.2f});
  allocate({0, 0, 0.3f}, 0.1f, Airmode::roll_pitch_yaw);
  expect_speeds({0.6, 0.6, 0, 0});
  expect_lack({});
}

// Roll and yaw of 0.6 each at thrust 0.5: (0.676, 1.524, 0.324, -0.524). Thrust stays, because both
// limits are exceeded equally. Yaw is reduced by 0.524.
TEST_F(Saturated, TheAirmodeOfYawKeepsRollBeforeYaw) {
  allocate({0.6f, 0, 0.6f}, 0.5f, Airmode::roll_pitch_yaw);
  const double turn = 0.6 * std::sqrt(0.5), yaw = 0.5 - turn;
  expect_speeds({0.5 - turn + yaw, 1, 0.5 + turn - yaw, 0});
  expect_lack({0, 0, static_cast<float>(0.6 - yaw)});
}

TEST(Airmode, IsOffForOtherValuesOfTheParameter) {
  EXPECT_EQ(airmode_of(0), Airmode::off);
  EXPECT_EQ(airmode_of(1), Airmode::roll_pitch);
  EXPECT_EQ(airmode_of(2), Airmode::roll_pitch_yaw);
  for (const double other : {-1.0, 0.5, 3.0, std::nan("")}) {
    EXPECT_EQ(airmode_of(other), Airmode::off);
  }
}

TEST_F(Saturated, ThrustAboveFullIsFull) {
  allocate({}, 1.5f);
  expect_speeds({1, 1, 1, 1});
  expect_lack({});
}

TEST_F(Saturated, ThrustDownwardsOrSidewaysGivesNone) {
  allocation_ = allocator_.allocate({}, {not_a_number, 0.5f, 0.5f});
  expect_speeds({0, 0, 0, 0});
  expect_lack({});
}

TEST_F(Saturated, OutputsWithoutARotorAreStopped) {
  allocate({}, 1);
  EXPECT_THAT(allocation_.commands, ElementsAre(1, 1, 1, 1, -1, -1, -1, -1));
}

TEST_F(Saturated, ASetpointThatIsNotFiniteHasNoCommands) {
  const float infinite = std::numeric_limits<float>::infinity();
  const auto expect_nan = [&] {
    for (std::size_t i = 0; i < 4; ++i) EXPECT_TRUE(std::isnan(allocation_.commands[i]));
    EXPECT_EQ(allocation_.commands[4], -1);
    EXPECT_FALSE(allocation_.torque_setpoint_achieved);
  };
  allocate({0.1f, 0, -infinite}, 0.5f);
  expect_nan();
  EXPECT_THAT(allocation_.unallocated_torque, ElementsAre(0.1f, 0, -infinite));
  allocate({0, not_a_number, 0}, 0.5f);
  expect_nan();
  allocate({0.1f, 0, 0}, not_a_number);
  expect_nan();
  EXPECT_THAT(allocation_.unallocated_torque, ElementsAre(0.1f, 0, 0));
}

TEST_F(Saturated, TheLargestSetpointsHaveCommands) {
  const float huge = std::numeric_limits<float>::max();
  for (const Airmode airmode : {Airmode::off, Airmode::roll_pitch, Airmode::roll_pitch_yaw}) {
    allocate({huge, huge, -huge}, 0.5f, airmode);
    EXPECT_THAT(speeds_of(allocation_, quad_),
                Each(testing::AllOf(testing::Ge(0), testing::Le(1))));
    EXPECT_FALSE(allocation_.torque_setpoint_achieved);
    EXPECT_THAT(allocation_.unallocated_torque, ElementsAre(huge, huge, -huge));
  }
}

}  // namespace
}  // namespace attest
