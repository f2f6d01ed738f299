#include "harness/loop/control_allocator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "controller/actuation/mixer.hpp"
#include "harness/core/random.hpp"

namespace attest {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::Pointwise;

using Torque = std::array<float, 3>;
constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

MATCHER_P(IsNear, bound, "") {
  const auto& [actual, expected] = arg;
  return std::abs(actual - expected) <= bound;
}

Vehicle quad_x(double x_m, double y_m) {
  Vehicle vehicle;
  vehicle.torque_over_thrust_m = 0.06;
  vehicle.rotors = {
      {{x_m, y_m, 0}, 1}, {{-x_m, -y_m, 0}, 1}, {{x_m, -y_m, 0}, -1}, {{-x_m, y_m, 0}, -1}};
  return vehicle;
}

Vehicle of_file(const std::string& name) {
  return *read_vehicle(ATTEST_SOURCE_DIR "/models/" + name + ".toml");
}

std::vector<double> speeds_of(const Allocation& allocation, const Vehicle& vehicle) {
  std::vector<double> speeds;
  for (std::size_t i = 0; i < vehicle.rotors.size(); ++i) {
    speeds.push_back((static_cast<double>(allocation.commands[i]) + 1) / 2);
  }
  return speeds;
}

std::vector<double> speeds_for(const Vehicle& vehicle, const Torque& torque, float thrust) {
  return speeds_of(ControlAllocator(vehicle).allocate(torque, {0, 0, -thrust}), vehicle);
}

// Speed of each rotor for one unit of torque about an axis.
std::vector<double> column(const Vehicle& vehicle, std::size_t axis) {
  Torque torque{};
  torque[axis] = 0.125f;
  std::vector<double> speeds = speeds_for(vehicle, torque, 0.5f);
  for (double& speed : speeds) speed = (speed - 0.5) / 0.125;
  return speeds;
}

// The vehicle's torque in metres times the thrust of a rotor at full speed.
Vector3 true_torque(const Vehicle& vehicle, const std::vector<double>& speeds) {
  Vector3 torque{};
  for (std::size_t i = 0; i < speeds.size(); ++i) {
    const VehicleRotor& rotor = vehicle.rotors[i];
    torque[0] -= rotor.position_m[1] * speeds[i];
    torque[1] += rotor.position_m[0] * speeds[i];
    torque[2] += vehicle.torque_over_thrust_m * rotor.turns * speeds[i];
  }
  return torque;
}

// ---- the matrix ---------------------------------------------------------------------------------

TEST(ControlAllocator, ASymmetricQuadHasEntriesOfOneOverRootTwo) {
  const Vehicle quad = quad_x(0.2, 0.2);
  const double a = std::sqrt(0.5);
  EXPECT_THAT(column(quad, 0), Pointwise(IsNear(1e-6), std::vector{-a, a, a, -a}));
  EXPECT_THAT(column(quad, 1), Pointwise(IsNear(1e-6), std::vector{a, -a, a, -a}));
  EXPECT_THAT(column(quad, 2), Pointwise(IsNear(1e-6), std::vector{1., 1., -1., -1.}));
  EXPECT_THAT(speeds_for(quad, {}, 0.25f), Each(0.25));
}

// The hubs are farther from the roll axis, so that the same torque takes less speed about it.
TEST(ControlAllocator, RollAndPitchHaveOneScale) {
  const Vehicle quad = quad_x(0.13, 0.2);
  const double a = std::sqrt(0.5), b = a * 0.13 / 0.2;
  EXPECT_THAT(column(quad, 0), Pointwise(IsNear(1e-6), std::vector{-b, b, b, -b}));
  EXPECT_THAT(column(quad, 1), Pointwise(IsNear(1e-6), std::vector{a, -a, a, -a}));
}

// Pitch has four entries, roll six, and both columns have the same norm.
TEST(ControlAllocator, TheHexaIsScaledByPitch) {
  const Vehicle hexa = of_file("hexa");
  const double a = std::sqrt(0.5), b = std::sqrt(2.0 / 3);
  EXPECT_THAT(column(hexa, 0),
              Pointwise(IsNear(1e-5), std::vector{-b, b, b / 2, -b / 2, -b / 2, b / 2}));
  EXPECT_THAT(column(hexa, 1), Pointwise(IsNear(1e-5), std::vector{0., 0., a, -a, a, -a}));
  EXPECT_THAT(column(hexa, 2), Pointwise(IsNear(1e-5), std::vector{-1., 1., -1., 1., 1., -1.}));
}

// The hubs of the iris are at 0.22 m in front and at 0.2 m behind.
TEST(ControlAllocator, TorqueAboutOneAxisGivesNoneAboutTheOthers) {
  const Vehicle iris = of_file("iris");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Vector3 torque = true_torque(iris, column(iris, axis));
    for (std::size_t k = 0; k < 3; ++k) {
      if (k == axis) {
        EXPECT_GT(torque[k], 0.1) << axis;
      } else {
        EXPECT_NEAR(torque[k], 0, 1e-6) << axis << k;
      }
    }
  }
}

TEST(ControlAllocator, IsTheMixerOnASymmetricQuadWithoutSaturation) {
  const ControlAllocator allocator(quad_x(0.2, 0.2));
  actuation::Mixer mixer(actuation::parse_mixer("R: 4x 10000 10000 10000 0").value());
  Random random(1);
  const auto up_to = [&](double bound) {
    return static_cast<float>(random.uniform(-bound, bound));
  };
  for (int i = 0; i < 1000; ++i) {
    const Torque torque{up_to(0.1), up_to(0.1), up_to(0.1)};
    const float thrust = 0.5f + up_to(0.2);
    actuation::Saturation saturation{};
    const auto mixed = mixer.mix({torque[0], torque[1], torque[2], thrust}, 0, saturation);
    const Allocation allocation = allocator.allocate(torque, {0, 0, -thrust});
    for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(allocation.commands[k], mixed[k], 1e-6);
  }
}

// A flight's golden is compared to the bit, so that the bits must not depend on the compiler.
TEST(ControlAllocator, GivesTheSameBitsWithEveryCompiler) {
  const ControlAllocator iris(of_file("iris")), hexa(of_file("hexa"));
  const Torque torque{0.11f, -0.07f, 0.05f};
  EXPECT_THAT(
      iris.allocate(torque, {0, 0, -0.6f}).commands,
      ElementsAre(0x1.87a17cp-4f, 0x1.fb2eeep-2f, 0x1.b3cd9p-4f, 0x1.a4a23ep-4f, -1, -1, -1, -1));
  EXPECT_THAT(hexa.allocate(torque, {0, 0, -0.9f}).commands,
              ElementsAre(0x1.c351f8p-2f, 1, 0x1.38edfap-1f, 0x1.a8bb02p-1f, 0x1.435c12p-1f,
                          0x1.9e4ceap-1f, -1, -1));
  const Allocation saturated = iris.allocate({0.9f, -0.7f, 0.5f}, {0, 0, -0.6f});
  EXPECT_THAT(saturated.commands,
              ElementsAre(-1, 1, -0x1.d1746p-4f, 0x1.d1746p-4f, -1, -1, -1, -1));
  EXPECT_THAT(saturated.unallocated_torque, ElementsAre(0x1.9339f8p-2f, -0x1.399edep-2f, 0.5f));
}

// ---- saturation ---------------------------------------------------------------------------------

class Saturated : public testing::Test {
 protected:
  void allocate(const Torque& torque, float thrust) {
    allocation_ = allocator_.allocate(torque, {0, 0, -thrust});
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

TEST_F(Saturated, RollAndPitchKeepTheirProportion) {
  allocate({-0.8f, 0.4f, 0}, 0.2f);
  const float part = 0.2f / (1.2f * std::sqrt(0.5f));
  expect_lack({-0.8f * (1 - part), 0.4f * (1 - part), 0});
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

// The largest finite setpoints neither overflow nor lose the sign.
TEST_F(Saturated, HugeTorqueIsShrunkToWhatFits) {
  const float huge = std::numeric_limits<float>::max();
  allocate({huge, huge, -huge}, 0.5f);
  expect_speeds({0.2, 0.2, 1, 0});
  EXPECT_FALSE(allocation_.torque_setpoint_achieved);
  EXPECT_THAT(allocation_.unallocated_torque, ElementsAre(huge, huge, -huge));
}

// ---- properties of random setpoints -------------------------------------------------------------

class OfVehicle : public testing::TestWithParam<const char*> {
 protected:
  static constexpr int setpoints = 5000;

  // Small ones are achieved, large ones saturate about every axis.
  Torque torque() {
    const double size = std::pow(10, random_.uniform(-3, 0.5));
    Torque result{};
    for (float& component : result) component = static_cast<float>(random_.uniform(-size, size));
    return result;
  }
  float thrust() { return static_cast<float>(random_.uniform(0, 1.2)); }

  Random random_{2};
  const Vehicle vehicle_ = of_file(GetParam());
  const ControlAllocator allocator_{vehicle_};
};

TEST_P(OfVehicle, UnallocatedTorqueIsWhatTheRotorsDoNotGive) {
  Vector3 one{};  // true torque for one unit of torque setpoint
  for (std::size_t axis = 0; axis < 3; ++axis) {
    one[axis] = true_torque(vehicle_, column(vehicle_, axis))[axis];
  }
  int achieved = 0;
  for (int i = 0; i < setpoints; ++i) {
    const Torque setpoint = torque();
    const Allocation allocation = allocator_.allocate(setpoint, {0, 0, -thrust()});
    const std::vector<double> speeds = speeds_of(allocation, vehicle_);
    EXPECT_THAT(speeds, Each(testing::AllOf(testing::Ge(0), testing::Le(1))));
    const Vector3 given = true_torque(vehicle_, speeds);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float lacking = allocation.unallocated_torque[axis];
      EXPECT_NEAR(lacking, setpoint[axis] - given[axis] / one[axis], 5e-6);
      EXPECT_GE(lacking * setpoint[axis], 0);
      EXPECT_LE(std::abs(lacking), std::abs(setpoint[axis]) + 1e-6f);
    }
    EXPECT_EQ(allocation.torque_setpoint_achieved, allocation.unallocated_torque == Torque{});
    achieved += allocation.torque_setpoint_achieved;
  }
  EXPECT_GT(achieved, setpoints / 5);
  EXPECT_LT(achieved, setpoints * 4 / 5);
}

TEST_P(OfVehicle, YawTakesNothingFromRollAndPitchAndAtMost15PercentOfThrust) {
  const auto thrust_of = [&](const Allocation& allocation) {
    double sum = 0;
    for (const double speed : speeds_of(allocation, vehicle_)) sum += speed;
    return sum / static_cast<double>(vehicle_.rotors.size());
  };
  for (int i = 0; i < setpoints; ++i) {
    const Torque setpoint = torque();
    const std::array<float, 3> up{0, 0, -thrust()};
    const Allocation with = allocator_.allocate(setpoint, up);
    const Allocation without = allocator_.allocate({setpoint[0], setpoint[1], 0}, up);
    EXPECT_NEAR(with.unallocated_torque[0], without.unallocated_torque[0], 2e-6);
    EXPECT_NEAR(with.unallocated_torque[1], without.unallocated_torque[1], 2e-6);
    EXPECT_LE(thrust_of(with), thrust_of(without) + 1e-6);
    EXPECT_GE(thrust_of(with), thrust_of(without) - 0.15 - 1e-6);
    EXPECT_LE(thrust_of(without), -up[2] + 1e-6f);
    EXPECT_EQ(without.unallocated_torque[2], 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Models, OfVehicle,
                         testing::Values("iris", "hummingbird", "crazyflie2", "heavy_quad",
                                         "hexa"));

}  // namespace
}  // namespace attest
