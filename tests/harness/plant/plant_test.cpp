// Properties of every plant.
#include "harness/plant/plant.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/core/file.hpp"
#include "tests/controller/allocation_count.hpp"
#include "tests/harness/core/temporary_directory.hpp"
#include "tests/harness/plant/test_vehicle.hpp"

namespace attest {
namespace {

using testing::AnyOf;
using testing::HasSubstr;

Nanoseconds ms(double milliseconds) { return Nanoseconds(std::llround(milliseconds * 1e6)); }

class EveryPlant : public testing::TestWithParam<PlantKind> {
 protected:
  std::unique_ptr<Plant> plant(const VehicleModel& frame, const PlantOptions& options = {}) const {
    auto made = frame.make_plant(GetParam(), options);
    if (!made) throw std::runtime_error(made.error().to_string());
    return std::move(*made);
  }

  static PlantState hovering(const Vehicle& vehicle) {
    PlantState state;
    std::fill_n(state.rotor_rad_s.begin(), vehicle.rotors.size(), vehicle.hover_rotor_rad_s());
    return state;
  }

  // The state after 50 ms with rotor i at `factors[i]` times hover.
  PlantState after(const std::vector<double>& factors) const {
    const auto frame = test::vehicle_model("iris");
    const auto flown = plant(*frame);
    flown->reset(hovering(frame->vehicle()));
    std::vector<double> command;
    for (const double factor : factors) {
      command.push_back(factor * frame->vehicle().hover_rotor_rad_s());
    }
    flown->command(command);
    flown->advance(ms(50));
    return flown->state();
  }
};

INSTANTIATE_TEST_SUITE_P(Kinds, EveryPlant, testing::ValuesIn(plant_kinds),
                         [](const auto& kind) { return std::string(name_of(kind.param)); });

TEST_P(EveryPlant, EveryVehicleHoversAtItsHoverThrust) {
  for (const char* name : {"crazyflie2", "heavy_quad", "hexa", "hummingbird", "iris"}) {
    const auto frame = test::vehicle_model(std::string(name));
    const auto flown = plant(*frame);
    flown->reset(hovering(frame->vehicle()));
    ASSERT_FALSE(flown->advance(ms(1000)));
    EXPECT_NEAR(flown->state().position_m[2], 0, 1e-9) << name;
    EXPECT_NEAR(flown->state().attitude.w, 1, 1e-9) << name;
    EXPECT_NEAR(flown->state().hover_seconds_used, 1, 1e-9) << name;
  }
}

// Rotors of the Iris: front right and rear left turn counter-clockwise, front left and rear right
// clockwise.
TEST_P(EveryPlant, FasterRotorsOnTheLeftRollRight) {
  EXPECT_GT(after({1, 1.05, 1.05, 1}).rate_rad_s[0], 0.1);
}

TEST_P(EveryPlant, FasterRotorsInFrontPitchUp) {
  EXPECT_GT(after({1.05, 1, 1.05, 1}).rate_rad_s[1], 0.1);
}

TEST_P(EveryPlant, FasterCounterClockwiseRotorsYawClockwise) {
  EXPECT_GT(after({1.05, 1.05, 1, 1}).rate_rad_s[2], 0.02);
}

TEST_P(EveryPlant, MoreThrustClimbs) {
  EXPECT_LT(after({1.1, 1.1, 1.1, 1.1}).velocity_m_s[2], -0.05);
}

TEST_P(EveryPlant, ATiltedVehicleFliesWhereItsThrustPoints) {
  const auto frame = test::vehicle_model("iris");
  const auto flown = plant(*frame);
  PlantState start = hovering(frame->vehicle());
  start.attitude = {std::cos(0.1), 0, -std::sin(0.1), 0};  // nose down
  flown->reset(start);
  flown->advance(ms(100));
  EXPECT_GT(flown->state().velocity_m_s[0], 0.1);         // north
  start.attitude = {std::cos(0.1), std::sin(0.1), 0, 0};  // roll right
  flown->reset(start);
  flown->advance(ms(100));
  EXPECT_GT(flown->state().velocity_m_s[1], 0.1);  // east
}

TEST_P(EveryPlant, WindCarriesAVehicleThatHasDrag) {
  const auto frame = test::vehicle_model("iris");
  const auto flown = plant(*frame);
  flown->reset(hovering(frame->vehicle()));
  flown->set_wind({5, -3, 0});
  flown->advance(ms(500));
  const double part = 1 - std::exp(-0.56 / 1.5 * 0.5);  // of the wind, after half a second
  EXPECT_NEAR(flown->state().velocity_m_s[0], 5 * part, 0.01);
  EXPECT_NEAR(flown->state().velocity_m_s[1], -3 * part, 0.01);
}

TEST_P(EveryPlant, AShiftedLoadDoesNotMoveTheCentreOfMassByItself) {
  const auto frame = test::vehicle_model("iris");
  const auto flown = plant(*frame);
  PlantState start = hovering(frame->vehicle());
  start.position_m = {1, 2, 3};
  start.velocity_m_s = {0.5, -0.5, 0.1};
  start.rate_rad_s = {1, 2, -1};
  start.attitude = {0.8, 0.6, 0, 0};
  flown->reset(start);
  flown->set_centre_of_mass({0.05, -0.02, 0.03});
  flown->advance(Nanoseconds(1));
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(flown->state().position_m[i], start.position_m[i], 1e-8);
    EXPECT_NEAR(flown->state().velocity_m_s[i], start.velocity_m_s[i], 1e-7);
    EXPECT_NEAR(flown->state().rate_rad_s[i], start.rate_rad_s[i], 1e-6);
  }
  flown->reset(hovering(frame->vehicle()));
  flown->set_centre_of_mass({0, 0.02, 0});  // to the right: rolls right
  flown->advance(ms(50));
  EXPECT_GT(flown->state().rate_rad_s[0], 0.1);
}

// A fall of the offset body about its centre of mass is the same in both plants.
TEST(Plants, AgreeOnAShiftedLoadInWind) {
  const auto frame = test::vehicle_model("iris");
  std::vector<PlantState> states;
  for (const PlantKind kind : plant_kinds) {
    const auto plant = frame->make_plant(kind, {});
    PlantState start;
    start.rate_rad_s = {2, -1, 3};
    std::fill_n(start.rotor_rad_s.begin(), 4, 700);
    (*plant)->reset(start);
    (*plant)->set_wind({3, 2, -1});
    (*plant)->set_centre_of_mass({0.03, 0.02, -0.01});
    (*plant)->command(std::vector<double>{750, 720, 700, 690});
    (*plant)->advance(ms(300));
    (*plant)->set_centre_of_mass({0, 0, 0});
    (*plant)->advance(ms(600));
    states.push_back((*plant)->state());
  }
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(states[0].position_m[i], states[1].position_m[i], 1e-5);
    EXPECT_NEAR(states[0].velocity_m_s[i], states[1].velocity_m_s[i], 1e-4);
    EXPECT_NEAR(states[0].rate_rad_s[i], states[1].rate_rad_s[i], 1e-6);
  }
  EXPECT_NEAR(states[0].hover_seconds_used, states[1].hover_seconds_used, 1e-5);
}

TEST_P(EveryPlant, TheSameCallsGiveTheSameBits) {
  const auto frame = test::vehicle_model("hexa");
  const auto fly = [&](Plant& flown) {
    flown.reset(hovering(frame->vehicle()));
    flown.command(std::vector<double>{500, 520, 540, 560, 530, 510});
    for (const double time : {0.3, 1.0, 2.5, 3.003003, 40.0}) flown.advance(ms(time));
    return flown.state();
  };
  const auto one = plant(*frame), two = plant(*frame);
  const PlantState first = fly(*one);
  one->command(std::vector<double>(6, 700));  // what came before must not matter
  one->advance(ms(200));
  for (const PlantState& again : {fly(*one), fly(*two)}) {
    EXPECT_EQ(first.position_m, again.position_m);
    EXPECT_EQ(first.rate_rad_s, again.rate_rad_s);
    EXPECT_EQ(first.attitude, again.attitude);
  }
}

TEST_P(EveryPlant, ADivergedPlantSaysWhenAndStays) {
  test::Numbers numbers;
  numbers.rate_bound_rad_s = 10;
  const auto frame = test::vehicle_model(numbers);
  const auto flown = plant(*frame);
  flown->reset({});
  flown->command(std::vector<double>{0, 2000, 2000, 0});
  std::optional<Divergence> lost;
  for (int i = 1; i <= 100 && !lost; ++i) lost = flown->advance(ms(i));
  ASSERT_TRUE(lost);
  EXPECT_THAT(lost->what, HasSubstr("the body rate is 1"));
  EXPECT_THAT(lost->what, HasSubstr("rad/s, beyond 10"));
  EXPECT_GT(lost->at, ms(1));
  EXPECT_LT(lost->at, ms(100));
  EXPECT_EQ(flown->advance(ms(200))->at, lost->at);
  flown->reset({});
  EXPECT_FALSE(flown->advance(ms(1)));
}

TEST_P(EveryPlant, AStateThatIsNoNumberIsDiverged) {
  const auto frame = test::vehicle_model("iris");
  const auto flown = plant(*frame);
  PlantState start;
  start.velocity_m_s[0] = std::nan("");
  flown->reset(start);
  const auto lost = flown->advance(ms(10));
  ASSERT_TRUE(lost);
  // MuJoCo checks its state before a step, so its error comes first.
  EXPECT_THAT(lost->what, AnyOf(HasSubstr("not finite"), HasSubstr("MuJoCo: Nan")));
}

TEST_P(EveryPlant, AStepDoesNotAllocate) {
  const auto frame = test::vehicle_model("iris");
  const auto flown = plant(*frame);
  flown->reset(hovering(frame->vehicle()));
  const std::vector<double> command{800, 790, 810, 795};
  flown->command(command);
  flown->advance(ms(5));
  const std::size_t before = test::allocation_count();
  for (int i = 6; i < 100; ++i) {
    flown->command(command);
    flown->set_wind({1, 2, 3});
    flown->advance(ms(i));
  }
  EXPECT_EQ(test::allocation_count(), before);
}

TEST(Floor, HoldsAVehicleThatRestsOnIt) {
  for (const char* name : {"crazyflie2", "heavy_quad", "hexa", "hummingbird", "iris"}) {
    const auto frame = test::vehicle_model(std::string(name));
    const auto plant = frame->make_plant(PlantKind::mujoco, {Rate::hz(1000), true});
    ASSERT_TRUE(plant);
    PlantState start;
    start.position_m[2] = -0.5;
    (*plant)->reset(start);
    ASSERT_FALSE((*plant)->advance(ms(3000)));
    EXPECT_LT((*plant)->state().position_m[2], 0) << name;
    EXPECT_GT((*plant)->state().position_m[2], -0.3) << name;
    EXPECT_NEAR((*plant)->state().velocity_m_s[2], 0, 1e-3) << name;
    EXPECT_GT((*plant)->state().attitude.w, 0.99) << name;
  }
}

// Without a floor MuJoCo computes no geoms, with one it computes all of them.
TEST(Floor, ChangesNoBitsFarAboveIt) {
  const auto frame = test::vehicle_model("iris");
  PlantState start;
  start.position_m[2] = -1000;
  start.attitude = {0.9, 0.3, -0.1, 0.3};
  start.rate_rad_s = {1, -2, 0.5};
  std::vector<PlantState> ends;
  for (const bool floor : {false, true}) {
    const auto plant = *frame->make_plant(PlantKind::mujoco, {Rate::hz(1000), floor});
    plant->reset(start);
    plant->command(std::vector<double>{800, 790, 810, 795});
    plant->set_centre_of_mass({0.01, -0.02, 0.005});
    ASSERT_FALSE(plant->advance(ms(500)));
    ends.push_back(plant->state());
  }
  EXPECT_EQ(std::memcmp(&ends[0], &ends[1], sizeof ends[0]), 0);
}

TEST(Floor, OfTheModelItselfIsKept) {
  const TemporaryDirectory folder;
  test::write_vehicle(folder.path(), {});
  std::string xml = *read_file(folder.path() / "brick.xml");
  const auto replace = [&](const std::string& old, const std::string& by) {
    ASSERT_NE(xml.find(old), std::string::npos);
    xml.replace(xml.find(old), old.size(), by);
  };
  replace("<flag constraint=\"disable\" contact=\"disable\"/>", "");
  replace("njmax=\"1\" nconmax=\"1\"", "njmax=\"50\" nconmax=\"10\"");
  replace("<worldbody>", "<worldbody><geom type=\"plane\" size=\"0 0 1\"/>");
  replace("<inertial", "<geom type=\"box\" size=\"0.1 0.1 0.05\"/><inertial");
  folder.write("brick.xml", xml);
  const auto frame = VehicleModel::load(folder.path(), "brick");
  ASSERT_TRUE(frame) << frame.error().to_string();
  const auto plant = *(*frame)->make_plant(PlantKind::mujoco, {});
  PlantState start;
  start.position_m[2] = -0.5;
  plant->reset(start);
  ASSERT_FALSE(plant->advance(ms(1000)));
  EXPECT_NEAR(plant->state().position_m[2], -0.05, 0.01);
}

TEST(Floor, IsNotThereUnlessAskedFor) {
  const auto frame = test::vehicle_model("iris");
  const auto plant = frame->make_plant(PlantKind::mujoco, {});
  (*plant)->reset({});
  (*plant)->advance(ms(1000));
  EXPECT_NEAR((*plant)->state().position_m[2], gravity_m_s2 / 2, 0.01);
  const auto ode = frame->make_plant(PlantKind::ode, {Rate::hz(1000), true});
  ASSERT_FALSE(ode);
  EXPECT_THAT(ode.error().message, HasSubstr("no floor"));
}

}  // namespace
}  // namespace attest
