#include "harness/loop/control_allocator.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "controller/actuation/mixer.hpp"
#include "harness/core/random.hpp"
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

Vehicle of_file(const std::string& name) {
  return *read_vehicle(ATTEST_SOURCE_DIR "/models/" + name + ".toml");
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
              ElementsAre(-0x1.fb5e64p-1f, 1, -1, 0x1.e4ba14p-1f, -1, -1, -1, -1));
  EXPECT_THAT(saturated.unallocated_torque,
              ElementsAre(0x1.c6c4a6p-1f, -0x1.002a38p-8f, 0x1.f7a4e2p-2f));
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
    const auto airmode = static_cast<Airmode>(i % 3);
    const Allocation allocation = allocator_.allocate(setpoint, {0, 0, -thrust()}, airmode);
    const std::vector<double> speeds = speeds_of(allocation, vehicle_);
    EXPECT_THAT(speeds, Each(testing::AllOf(testing::Ge(0), testing::Le(1))));
    const Vector3 given = true_torque(vehicle_, speeds);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(allocation.unallocated_torque[axis], setpoint[axis] - given[axis] / one[axis],
                  5e-6);
    }
    const auto [x, y, z] = allocation.unallocated_torque;
    EXPECT_EQ(allocation.torque_setpoint_achieved, std::hypot(x, y, z) < 1e-3f);
    achieved += allocation.torque_setpoint_achieved;
  }
  EXPECT_GT(achieved, setpoints / 5);
  EXPECT_LT(achieved, setpoints * 4 / 5);
}

INSTANTIATE_TEST_SUITE_P(Models, OfVehicle,
                         testing::Values("iris", "hummingbird", "crazyflie2", "heavy_quad",
                                         "hexa"));

}  // namespace
}  // namespace attest
