#include "harness/loop/land_detector.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace attest {
namespace {

constexpr LandDetected in_flight{false, false}, maybe_landed{true, false}, landed{true, true};

constexpr Nanoseconds milliseconds(std::int64_t count) { return Nanoseconds(count * 1'000'000); }

class LandDetectorTest : public testing::Test {
 protected:
  // The iris stands at 0.4 arm.
  static PlantState at_height(double above_feet_of_arm) {
    PlantState state;
    state.position_m[2] = -(0.4 + above_feet_of_arm) * iris().arm_m();
    return state;
  }
  static const Vehicle& iris() {
    static const Vehicle vehicle = *read_vehicle(ATTEST_SOURCE_DIR "/models/iris.toml");
    return vehicle;
  }
  static float thrust(double of_hover) {
    return static_cast<float>(of_hover * iris().hover_thrust());
  }
  LandDetected armed(std::int64_t ms, const PlantState& state, double thrust_of_hover = 0.1) {
    return detector_.sample(milliseconds(ms), state, thrust(thrust_of_hover), true);
  }
  // In flight at 0 ms, at rest from 100 ms on, landed from 650 ms on.
  void land() {
    armed(0, at_height(5));
    armed(100, standing_);
    ASSERT_EQ(armed(650, standing_), landed);
  }
  // The sample ends the rest, and the hysteresis starts again.
  void expect_end_of_rest(const PlantState& state, double thrust_of_hover = 0.1) {
    land();
    EXPECT_EQ(armed(660, state, thrust_of_hover), in_flight);
    EXPECT_EQ(armed(670, standing_), in_flight);
    EXPECT_EQ(armed(670 + 549, standing_), maybe_landed);
    EXPECT_EQ(armed(670 + 550, standing_), landed);
  }
  void expect_rest(const PlantState& state, double thrust_of_hover = 0.1) {
    land();
    EXPECT_EQ(armed(660, state, thrust_of_hover), landed);
  }

  const PlantState standing_ = at_height(0);
  LandDetector detector_{iris(), true};
};

TEST_F(LandDetectorTest, LandsInTwoSteps) {
  EXPECT_EQ(armed(0, at_height(5)), in_flight);
  EXPECT_EQ(armed(100, standing_), in_flight);
  EXPECT_EQ(armed(349, standing_), in_flight);
  EXPECT_EQ(armed(350, standing_), maybe_landed);
  EXPECT_EQ(armed(649, standing_), maybe_landed);
  EXPECT_EQ(armed(650, standing_), landed);
}

TEST_F(LandDetectorTest, AStartAtRestIsLanded) {
  EXPECT_EQ(armed(0, standing_), landed);
  EXPECT_EQ(armed(1, standing_), landed);
}

TEST_F(LandDetectorTest, ThrustEndsTheRest) {
  expect_end_of_rest(standing_, 0.31);
  detector_ = LandDetector(iris(), true);
  expect_rest(standing_, 0.29);
}

TEST_F(LandDetectorTest, ThrustThatIsNotANumberEndsTheRest) {
  expect_end_of_rest(standing_, std::nan(""));
}

TEST_F(LandDetectorTest, HeightEndsTheRest) {
  expect_end_of_rest(at_height(0.11));
  detector_ = LandDetector(iris(), true);
  expect_rest(at_height(0.09));
}

TEST_F(LandDetectorTest, VerticalSpeedEndsTheRest) {
  PlantState state = standing_;
  state.velocity_m_s = {5, 5, 0.24};
  expect_rest(state);
  detector_ = LandDetector(iris(), true);
  state.velocity_m_s = {0, 0, -0.26};
  expect_end_of_rest(state);
}

TEST_F(LandDetectorTest, BodyRateEndsTheRest) {
  PlantState state = standing_;
  state.rate_rad_s = {0.2, -0.2, 0.2};
  expect_rest(state);
  detector_ = LandDetector(iris(), true);
  state.rate_rad_s = {0.21, 0.21, -0.21};
  expect_end_of_rest(state);
}

// Rolled by 90 deg, the feet on the right are 0.132 m below the centre of mass, and their radius is
// 0.05 arm.
TEST_F(LandDetectorTest, TheLowestFootCounts) {
  PlantState state;
  state.attitude = {std::sqrt(0.5), std::sqrt(0.5), 0, 0};
  const double arm = iris().arm_m();
  state.position_m[2] = -(0.6 * 0.22 + 0.05 * arm + 0.09 * arm);
  expect_rest(state);
  detector_ = LandDetector(iris(), true);
  state.position_m[2] -= 0.02 * arm;
  expect_end_of_rest(state);
}

// Pitched up by 90 deg, the rear feet are 0.6 of 0.13 m below the centre of mass.
TEST_F(LandDetectorTest, TheLowestFootCountsInPitch) {
  PlantState state;
  state.attitude = {std::sqrt(0.5), 0, std::sqrt(0.5), 0};
  const double arm = iris().arm_m();
  state.position_m[2] = -(0.6 * 0.13 + 0.05 * arm + 0.09 * arm);
  expect_rest(state);
  detector_ = LandDetector(iris(), true);
  state.position_m[2] -= 0.02 * arm;
  expect_end_of_rest(state);
}

TEST_F(LandDetectorTest, DisarmedOnTheFloorIsLandedAtOnce) {
  const auto disarmed = [&](std::int64_t ms, PlantState state) {
    state.velocity_m_s[2] = 1;
    state.rate_rad_s[0] = 1;
    return detector_.sample(milliseconds(ms), state, 0.9f, false);
  };
  EXPECT_EQ(armed(0, at_height(5)), in_flight);
  EXPECT_EQ(disarmed(10, at_height(0.11)), in_flight);
  EXPECT_EQ(disarmed(20, at_height(0.09)), landed);
  EXPECT_EQ(armed(30, standing_), landed);  // arming alone does not end the rest
  EXPECT_EQ(armed(40, standing_, 0.5), in_flight);
}

TEST_F(LandDetectorTest, WithoutAFloorAVehicleNeverLands) {
  detector_ = LandDetector(iris(), false);
  for (const bool is_armed : {true, false}) {
    EXPECT_EQ(detector_.sample(milliseconds(0), standing_, 0, is_armed), in_flight);
    EXPECT_EQ(detector_.sample(milliseconds(900), standing_, 0, is_armed), in_flight);
  }
}

TEST_F(LandDetectorTest, AStateThatIsNotFiniteIsNotAtRest) {
  PlantState state = standing_;
  state.position_m[2] = std::nan("");
  expect_end_of_rest(state);
}

// The feet of the models are where the detector has them. A vehicle with other feet fails here.
class OfModel : public testing::TestWithParam<const char*> {};

TEST_P(OfModel, LandsAfterAFallToTheFloor) {
  const auto model = *VehicleModel::load(ATTEST_SOURCE_DIR "/models", GetParam());
  const Vehicle& vehicle = model->vehicle();
  const auto plant = *model->make_plant(PlantKind::mujoco, {Rate::hz(1000), true});
  const double standing_m = 0.4 * vehicle.arm_m();
  PlantState start;
  start.position_m[2] = -standing_m - 0.1;  // falls for 0.14 s
  plant->reset(start);
  LandDetector detector(vehicle, true);
  EXPECT_EQ(detector.sample(Nanoseconds(0), plant->state(), 0, true), in_flight);
  LandDetected detected;
  for (std::int64_t ms = 1; ms <= 1500; ++ms) {
    ASSERT_FALSE(plant->advance(milliseconds(ms)));
    detected = detector.sample(milliseconds(ms), plant->state(), 0, true);
    if (ms < 600) {
      EXPECT_NE(detected, landed) << ms;
    }
  }
  EXPECT_EQ(detected, landed);
  EXPECT_NEAR(-plant->state().position_m[2], standing_m, 0.02 * vehicle.arm_m());
}

INSTANTIATE_TEST_SUITE_P(Models, OfModel,
                         testing::Values("iris", "hummingbird", "crazyflie2", "heavy_quad",
                                         "hexa"));

}  // namespace
}  // namespace attest
