#include "harness/loop/land_detector.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace attest {
namespace {

constexpr LandDetected in_flight{false, false}, maybe_landed{true, false}, landed{true, true};

constexpr Nanoseconds milliseconds(std::int64_t count) { return Nanoseconds(count * 1'000'000); }

Case flight(bool on_floor) {
  Case result;
  result.duration = {2, Span::In::seconds};
  result.flight.emplace();
  result.flight->start.on_floor = on_floor;
  result.parameters = {{"MPC_THR_HOVER", Constant{0.6}}, {"MPC_MANTHR_MIN", Constant{0.08}}};
  return result;
}

class LandDetectorTest : public testing::Test {
 protected:
  LandDetected armed(std::int64_t ms, const PlantState& state, double thrust = 0) {
    return detector_.sample(milliseconds(ms), state, static_cast<float>(thrust), true);
  }
  LandDetected disarmed(std::int64_t ms, const PlantState& state, double thrust = 0) {
    return detector_.sample(milliseconds(ms), state, static_cast<float>(thrust), false);
  }
  // In flight at 0 s, landed at 2 s.
  void land() {
    detector_ = LandDetector(flight(false), Rate::hz(1000));
    for (std::int64_t ms = 0; ms <= 2000; ms += 20) armed(ms, standing_);
    ASSERT_EQ(armed(2000, standing_), landed);
  }
  // After land(), this sample gives `expected`.
  void expect_after_landing(const PlantState& state, double thrust, const LandDetected& expected) {
    land();
    EXPECT_EQ(armed(2020, state, thrust), expected);
  }
  // A vehicle that comes to rest like this has landed after one second, or never.
  bool lands(const PlantState& state, double thrust = 0) {
    detector_ = LandDetector(flight(false), Rate::hz(1000));
    for (std::int64_t ms = 0; ms < 1000; ms += 20) armed(ms, state, thrust);
    const LandDetected after_1_s = armed(1020, state, thrust);
    EXPECT_EQ(after_1_s.landed, armed(5000, state, thrust).landed);
    return after_1_s.landed;
  }

  const PlantState standing_{};
  LandDetector detector_{flight(false), Rate::hz(1000)};
};

PlantState moving(const Vector3& velocity_m_s, const Vector3& rate_rad_s = {}) {
  PlantState state;
  state.velocity_m_s = velocity_m_s;
  state.rate_rad_s = rate_rad_s;
  return state;
}

// Each stage takes 333.3 ms. With samples every 20 ms the first is reached at 340 ms. The second
// one begins then and is reached at 680 ms, the third at 1020 ms.
TEST_F(LandDetectorTest, LandsInThreeStagesOfAThirdOfASecond) {
  for (std::int64_t ms = 0; ms <= 1100; ms += 20) {
    const LandDetected expected = ms < 680 ? in_flight : ms < 1020 ? maybe_landed : landed;
    EXPECT_EQ(armed(ms, standing_), expected) << ms;
  }
}

TEST_F(LandDetectorTest, AStageThatIsLostTakesTheLaterOnesWithIt) {
  land();
  EXPECT_EQ(armed(2020, moving({0, 0, 1})), in_flight);
  for (std::int64_t ms = 2040; ms <= 3100; ms += 20) {
    const LandDetected expected = ms < 2720 ? in_flight : ms < 3060 ? maybe_landed : landed;
    EXPECT_EQ(armed(ms, standing_), expected) << ms;
  }
}

TEST_F(LandDetectorTest, AStartOnTheFloorIsLanded) {
  EXPECT_EQ(armed(0, standing_), in_flight);
  detector_ = LandDetector(flight(true), Rate::hz(1000));
  EXPECT_EQ(armed(0, standing_), landed);
  EXPECT_EQ(armed(20, standing_, 0.5), in_flight);
}

// The defaults of LNDMC_Z_VEL_MAX and LNDMC_XY_VEL_MAX: 0.25 and 1.5 m/s. 1.5 = length of
// (0.9, 1.2).
TEST_F(LandDetectorTest, VerticalAndHorizontalSpeedEndTheContact) {
  EXPECT_TRUE(lands(moving({0.9, 1.19, 0})));
  EXPECT_FALSE(lands(moving({0.9, -1.21, 0})));
  EXPECT_TRUE(lands(moving({0, 0, 0.24})));
  EXPECT_FALSE(lands(moving({0, 0, -0.26})));
  expect_after_landing(moving({1.51, 0, 0}), 0, in_flight);
}

// 20 deg/s are 0.349 rad/s: the length of (0.2, 0.286). The limit of a landed vehicle is 2.5 times
// that, 0.873 rad/s: the length of (0.5, 0.715).
TEST_F(LandDetectorTest, RotationAboutXAndYIsLimitedAndMoreOfItWhenLanded) {
  EXPECT_TRUE(lands(moving({}, {0.2, -0.284, 9})));
  EXPECT_FALSE(lands(moving({}, {0.2, 0.288, 0})));
  expect_after_landing(moving({}, {0.5, 0.713, 9}), 0, landed);
  expect_after_landing(moving({}, {-0.5, 0.718, 0}), 0, in_flight);
}

// Contact needs a thrust of at most 0.12 + 0.3 (0.6 - 0.12) = 0.264, maybe_landed of at most
// MPC_MANTHR_MIN + 0.01 = 0.09. Above 0.264 the stage of contact begins anew.
TEST_F(LandDetectorTest, ThrustEndsContactAndMaybeLanded) {
  EXPECT_TRUE(lands(standing_, 0.089));
  EXPECT_FALSE(lands(standing_, 0.091));
  const auto landed_again_680_ms_after = [&](double thrust) {
    land();
    EXPECT_EQ(armed(2020, standing_, thrust), in_flight);
    for (std::int64_t ms = 2040; ms < 2720; ms += 20) armed(ms, standing_);
    return armed(2720, standing_).landed;
  };
  EXPECT_TRUE(landed_again_680_ms_after(0.263));
  EXPECT_FALSE(landed_again_680_ms_after(0.265));
}

TEST_F(LandDetectorTest, TheLimitsOfThrustAreThoseOfTheParametersAtThatTime) {
  Case changing = flight(true);
  changing.parameters = {{"MPC_MANTHR_MIN", Step{0.08, 0.2, {1, Span::In::seconds}}}};
  detector_ = LandDetector(changing, Rate::hz(1000));
  EXPECT_EQ(armed(1000, standing_, 0.209), landed);
  detector_ = LandDetector(changing, Rate::hz(1000));
  EXPECT_EQ(armed(980, standing_, 0.209), in_flight);
}

// So the three stages begin together.
TEST_F(LandDetectorTest, DisarmedAllConditionsHold) {
  const PlantState falling = moving({9, 9, 9}, {9, 9, 9});
  for (std::int64_t ms = 0; ms < 340; ms += 20) EXPECT_EQ(disarmed(ms, falling, 1), in_flight);
  EXPECT_EQ(disarmed(340, falling, 1), landed);
  EXPECT_EQ(armed(360, standing_), landed);  // arming alone does not end it
  EXPECT_EQ(armed(380, standing_, 0.5), in_flight);
}

TEST_F(LandDetectorTest, NumbersThatAreNotFiniteEndTheContact) {
  const double nan = std::nan("");
  expect_after_landing(standing_, nan, in_flight);
  expect_after_landing(moving({nan, 0, 0}), 0, in_flight);
  expect_after_landing(moving({0, 0, nan}), 0, in_flight);
  expect_after_landing(moving({}, {nan, 0, 0}), 0, in_flight);
}

// The feet of the models are where height_on_floor_m() has them. A vehicle with other feet fails
// here.
class OfModel : public testing::TestWithParam<const char*> {};

TEST_P(OfModel, LandsAfterAFallToTheFloor) {
  const auto model = *VehicleModel::load(ATTEST_SOURCE_DIR "/models", GetParam());
  const Vehicle& vehicle = model->vehicle();
  const auto plant = *model->make_plant(PlantKind::mujoco, {Rate::hz(1000), true});
  const double standing_m = height_on_floor_m(vehicle);
  EXPECT_NEAR(standing_m, 0.4 * vehicle.arm_m(), 1e-12);
  PlantState start;
  start.position_m[2] = -standing_m - 0.1;  // falls for 0.14 s
  plant->reset(start);
  LandDetector detector(flight(false), Rate::hz(1000));
  LandDetected detected;
  for (std::int64_t ms = 0; ms <= 2000; ++ms) {
    ASSERT_FALSE(plant->advance(milliseconds(ms)));
    detected = detector.sample(milliseconds(ms), plant->state(), 0, true);
    if (ms < 1100) {
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
