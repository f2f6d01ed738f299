#include "harness/loop/disturbances.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/loop/plant_task.hpp"

namespace attest {
namespace {

using testing::ElementsAre;

constexpr auto milliseconds = [](std::int64_t count) { return Nanoseconds(count * 1'000'000); };

class StillPlant final : public Plant {
 public:
  void reset(const PlantState& start) override { state_ = start; }
  void command(std::span<const double>) override {}
  void set_wind(const Vector3& velocity_m_s) override { wind = velocity_m_s; }
  void set_centre_of_mass(const Vector3& offset_m) override { centre_of_mass = offset_m; }
  std::optional<Divergence> advance(Nanoseconds) override { return std::nullopt; }
  const PlantState& state() const override { return state_; }

  Vector3 wind{}, centre_of_mass{};

 private:
  PlantState state_;
};

Vehicle with_arm_of_half_a_metre() {
  Vehicle vehicle;
  vehicle.mass_kg = 1;
  vehicle.thrust_coefficient = 1;
  vehicle.rotors.resize(4);
  vehicle.rotors[0].position_m = {0.3, -0.4, 0.1};
  return vehicle;
}

Signal ramp() { return Ramp{0, 10, {0, Span::In::seconds}, {1, Span::In::seconds}}; }

class DisturbancesTest : public testing::Test {
 protected:
  Disturbances made() const { return {flight_, vehicle_, {Rate::hz(250), milliseconds(1000)}}; }

  Flight flight_;
  Vehicle vehicle_ = with_arm_of_half_a_metre();
  StillPlant plant_;
};

TEST_F(DisturbancesTest, WindAndCentreOfMassKeepTheirAxes) {
  flight_.wind_m_s = {Constant{1}, Constant{2}, Constant{3}};
  flight_.centre_of_mass_of_arm = {Constant{0.2}, Constant{0.4}, Constant{-0.6}};
  made().apply(milliseconds(0), plant_);
  EXPECT_THAT(plant_.wind, ElementsAre(1, 2, 3));
  // Fractions of the arm of 0.5 m.
  EXPECT_THAT(plant_.centre_of_mass, ElementsAre(0.1, 0.2, -0.3));
}

TEST_F(DisturbancesTest, WhatStaysIsSetOnce) {
  flight_.wind_m_s[0] = Constant{3};
  EXPECT_THAT(made().times(), ElementsAre(milliseconds(0)));
}

TEST_F(DisturbancesTest, WhatVariesIsSet100TimesASecond) {
  flight_.wind_m_s[1] = ramp();
  Disturbances wind = made();
  ASSERT_EQ(wind.times().size(), 100u);
  EXPECT_EQ(wind.times()[50], milliseconds(500));
  wind.apply(milliseconds(500), plant_);
  EXPECT_THAT(plant_.wind, ElementsAre(0, 5, 0));

  flight_.wind_m_s[1] = Constant{0};
  flight_.centre_of_mass_of_arm[0] = ramp();
  EXPECT_EQ(made().times().size(), 100u);
}

TEST_F(DisturbancesTest, AMotorFailsAtItsTime) {
  flight_.motor_failure = MotorFailure{2, {0.005, Span::In::seconds}};
  Disturbances failure = made();
  EXPECT_THAT(failure.times(), ElementsAre(milliseconds(0), milliseconds(5)));
  failure.apply(milliseconds(0), plant_);
  EXPECT_FALSE(failure.failed_rotor());
  failure.apply(milliseconds(5), plant_);
  EXPECT_EQ(failure.failed_rotor(), 2u);
}

// NED: up is negative.
TEST_F(DisturbancesTest, AFlightStartsAboveTheGround) {
  Case the_case;
  the_case.duration = {1, Span::In::seconds};
  vehicle_.mixer = "R: 4x 10000 10000 10000 0";
  the_case.flight.emplace().start.height_m = 12;
  const PlantTask task(the_case, Rate::hz(250), vehicle_, plant_);
  EXPECT_THAT(plant_.state().position_m, ElementsAre(0, 0, -12));
}

}  // namespace
}  // namespace attest
