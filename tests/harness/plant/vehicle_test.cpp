#include "harness/plant/vehicle.hpp"

#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "controller/actuation/mixer.hpp"
#include "harness/plant/battery.hpp"
#include "harness/plant/vehicle_models.hpp"
#include "tests/harness/plant/test_vehicle.hpp"

namespace attest {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::filesystem::path models = std::filesystem::path(ATTEST_SOURCE_DIR) / "models";

class VehicleFile : public testing::Test {
 protected:
  VehicleFile() { test::write_vehicle(folder_.path(), {}); }

  std::string text(const char* file) const {
    std::ostringstream all;
    all << std::ifstream(folder_.path() / file).rdbuf();
    return all.str();
  }
  void replace(const char* file, const std::string& what, const std::string& with) const {
    std::string changed = text(file);
    const auto at = changed.find(what);
    ASSERT_NE(at, std::string::npos) << what;
    changed.replace(at, what.size(), with);
    std::ofstream(folder_.path() / file) << changed;
  }
  // The error of the TOML after `what` is replaced by `with`.
  std::string error(const std::string& what, const std::string& with) const {
    replace("brick.toml", what, with);
    const auto vehicle = read_vehicle(folder_.path() / "brick.toml");
    return vehicle ? "" : vehicle.error().to_string();
  }
  // The error of the model after `what` is replaced by `with`.
  std::string model_error(const std::string& what, const std::string& with) const {
    replace("brick.xml", what, with);
    const auto frame = VehicleModel::load(folder_.path(), "brick");
    return frame ? "" : frame.error().to_string();
  }

  TemporaryDirectory folder_;
};

TEST(Models, EachIsTheVehicleOfItsToml) {
  EXPECT_THAT(vehicle_names(models),
              ElementsAre("crazyflie2", "heavy_quad", "hexa", "hummingbird", "iris"));
  for (const std::string& name : vehicle_names(models)) {
    const auto frame = VehicleModel::load(models, name);  // compares all numbers
    ASSERT_TRUE(frame) << frame.error().to_string();
    const Vehicle& vehicle = (*frame)->vehicle();
    EXPECT_GT(vehicle.hover_thrust(), 0.3) << name;
    EXPECT_LT(vehicle.hover_thrust(), 0.9) << name;
    EXPECT_GE(vehicle.parameters.size(), 10u) << name;
    EXPECT_EQ(actuation::parse_mixer(vehicle.mixer)->rotors.size(), vehicle.rotors.size());
  }
}

TEST(Models, TheIrisHoversWherePx4Does) {
  const auto iris = read_vehicle(models / "iris.toml");
  ASSERT_TRUE(iris);
  EXPECT_NEAR(iris->hover_rotor_rad_s(), 793.5, 0.1);  // sqrt(1.5 * 9.80665 / 4 / 5.84e-6)
  EXPECT_NEAR(iris->arm_m(), 0.2555, 1e-4);
}

class OtherMjcf : public VehicleFile {
 protected:
  // Writes heavy.toml: brick.toml with other numbers and the MuJoCo model of `mjcf_of`.
  void write_heavy(const std::string& mjcf_of) const {
    std::string toml = text("brick.toml");
    toml.replace(toml.find("mass_kg = 1"), 11, "mass_kg = 1.25");
    toml.replace(toml.find("[0.01, 0.015"), 12, "[0.011, 0.016");
    toml.replace(toml.find("0.1414, 0.1414"), 14, "0.15, 0.1414");
    std::ofstream(folder_.path() / "heavy.toml") << "mjcf_of = '" << mjcf_of << "'\n" << toml;
  }
  // The state after 0.1 s with unequal rotors on MuJoCo.
  PlantState flown(const std::string& name) const {
    const auto model = VehicleModel::load(folder_.path(), name);
    if (!model) throw std::runtime_error(model.error().to_string());
    const auto plant = *(*model)->make_plant(PlantKind::mujoco, {});
    plant->reset({});
    plant->command(std::vector<double>{400, 420, 440, 460});
    plant->advance(std::chrono::milliseconds(100));
    return plant->state();
  }
};

TEST_F(OtherMjcf, FliesAsIfItsOwnMjcfHadItsNumbers) {
  write_heavy("brick");
  const PlantState with_others = flown("heavy");
  replace("heavy.toml", "mjcf_of = 'brick'\n", "");
  std::ofstream(folder_.path() / "heavy.xml") << text("brick.xml");
  replace("heavy.xml", "mass=\"1\"", "mass=\"1.25\"");
  replace("heavy.xml", "diaginertia=\"0.01 0.015", "diaginertia=\"0.011 0.016");
  replace("heavy.xml", "pos=\"0.1414 -0.1414 0\"", "pos=\"0.15 -0.1414 0\"");
  const PlantState own = flown("heavy");
  EXPECT_EQ(with_others.position_m, own.position_m);
  EXPECT_EQ(with_others.rate_rad_s, own.rate_rad_s);
  EXPECT_NE(with_others.rate_rad_s, flown("brick").rate_rad_s);
}

TEST_F(OtherMjcf, MustBeOfAVehicleThatHasOne) {
  write_heavy("heavy");
  EXPECT_THAT(VehicleModel::load(folder_.path(), "heavy").error().to_string(),
              HasSubstr("heavy.toml: `mjcf_of` names this vehicle itself"));
  write_heavy("brik");
  EXPECT_THAT(VehicleModel::load(folder_.path(), "heavy").error().to_string(),
              HasSubstr("unknown vehicle `brik`; did you mean `brick`?"));
  write_heavy("brick");
  std::ofstream(folder_.path() / "third.toml") << "mjcf_of = 'heavy'\n" << text("brick.toml");
  EXPECT_THAT(VehicleModel::load(folder_.path(), "third").error().to_string(),
              HasSubstr("which has no MJCF of its own; name brick"));
}

TEST_F(VehicleFile, ImpossibleNumbersAreNamedWithTheirLine) {
  EXPECT_THAT(error("mass_kg = 1", "mass_kg = -1"), HasSubstr("brick.toml:2:1: must be positive"));
}

TEST_F(VehicleFile, NumbersThatAreNotFiniteAreRefused) {
  EXPECT_THAT(error("[0.01, 0.015, 0.02]", "[inf, inf, inf]"), HasSubstr("brick.toml:3:1: "));
  EXPECT_THAT(error("[inf, inf, inf]", "[0.01, 0.015, 0.02]"), "");
  EXPECT_THAT(error("position_m = [0.1414, 0.1414, 0]", "position_m = [0.1414, 0.1414, nan]"),
              HasSubstr("needs three finite numbers"));
}

TEST_F(VehicleFile, ABatteryHasASmallNumberOfCells) {
  EXPECT_THAT(error("cells = 3", "cells = 0"), HasSubstr("must be from 1 to 100"));
  EXPECT_THAT(error("cells = 0", "cells = 4294967299"), HasSubstr("must be from 1 to 100"));
}

TEST_F(VehicleFile, AnInertiaOfNoBodyIsRefused) {
  EXPECT_THAT(error("[0.01, 0.015, 0.02]", "[0.01, 0.015, 0.03]"),
              HasSubstr("brick.toml:3:1: is impossible"));
}

TEST_F(VehicleFile, AMisspeltKeyIsRefused) {
  EXPECT_THAT(error("thrust_coefficient", "thrust_coeficient"),
              HasSubstr("brick.toml:4:1: unknown key `thrust_coeficient`; did you mean"));
}

TEST_F(VehicleFile, RotorsInAnotherOrderThanTheMixersAreRefused) {
  EXPECT_THAT(
      error("r2 = { position_m = [0.1414, -0.1414, 0]", "r2 = { position_m = [0.1, 0.1, 0]"),
      HasSubstr("the mixer `R: 4x 10000 10000 10000 0` has output 2 on another side (y)"));
}

TEST_F(VehicleFile, ARotorThatTurnsTheOtherWayIsRefused) {
  EXPECT_THAT(error("turns = \"ccw\"", "turns = \"cw\""), HasSubstr("output 0 turning the other"));
}

TEST_F(VehicleFile, ARotorIsNearTheBody) {
  EXPECT_THAT(error("position_m = [0.", "position_m = [1e300, 0.1, 0.0], x = [0."),
              HasSubstr("must be at most 100 m from the centre of mass"));
}

TEST_F(VehicleFile, AMixerOfAnotherVehicleIsRefused) {
  EXPECT_THAT(error("R: 4x", "R: 6x"), HasSubstr("has 6 rotors, the vehicle 4"));
}

TEST_F(VehicleFile, AVehicleThatCannotHoverIsRefused) {
  EXPECT_THAT(error("rotor_max_rad_s = 4000.0", "rotor_max_rad_s = 400"),
              HasSubstr("cannot lift the vehicle: it hovers at 495 rad/s"));
}

TEST_F(VehicleFile, AModelThatDiffersIsRefusedNamingBothValues) {
  EXPECT_THAT(model_error("mass=\"1\"", "mass=\"1.5\""),
              HasSubstr("brick.xml: the mass [kg] is 1.5, in brick.toml it is 1"));
  EXPECT_THAT(model_error("mass=\"1.5\" diaginertia=\"0.01", "mass=\"1\" diaginertia=\"0.011"),
              HasSubstr("the inertia [kg m2] along x (FRD) is 0.011"));
}

TEST_F(VehicleFile, EveryNumberOfARotorIsCompared) {
  EXPECT_THAT(model_error("pos=\"0.1414 -0.1414 0\"", "pos=\"0.1414 -0.15 0\""),
              HasSubstr("the place [m] of rotor 0 along y (FRD) is 0.15"));
  EXPECT_THAT(model_error("pos=\"0.1414 -0.15 0\"", "pos=\"0.1414 -0.1414 0\""), "");
  EXPECT_THAT(model_error("gear=\"0 0 1 0 0 -0.02\"", "gear=\"0 0 1 0 0 0.02\""),
              HasSubstr("the torque gear [m] of rotor 0 along z (FRD) is -0.02"));
  EXPECT_THAT(model_error("gear=\"0 0 1 0 0 0.02\"", "gear=\"0 0 1 0 0 -0.02\""), "");
  EXPECT_THAT(model_error("gainprm=\"1e-05\"", "gainprm=\"2e-05\""),
              HasSubstr("the thrust coefficient of rotor 0 is 2e-05"));
  EXPECT_THAT(model_error("gainprm=\"2e-05\"", "gainprm=\"1e-05\""), "");
  EXPECT_THAT(model_error("dynprm=\"0.02 0.05\"", "dynprm=\"0.02 0.06\""),
              HasSubstr("the time constant down [s] of rotor 0 is 0.06"));
}

TEST_F(VehicleFile, AModelOfAnotherKindSaysWhatItNeeds) {
  EXPECT_THAT(model_error("integrator=\"RK4\"", "integrator=\"Euler\""),
              HasSubstr("needs <option integrator=\"RK4\"/>"));
}

TEST_F(VehicleFile, BrokenXmlIsNamedWithItsLine) {
  EXPECT_THAT(model_error("<inertial", "<inertail"),
              HasSubstr("brick.xml:1: MuJoCo: XML Error: Schema violation"));
}

TEST(VehicleModels, LoadsAVehicleOnceAndNamesTheNearestOfAnUnknownOne) {
  VehicleModels vehicle_models(models);
  const auto first = vehicle_models.get("iris");
  ASSERT_TRUE(first);
  EXPECT_EQ(*vehicle_models.get("iris"), *first);
  const auto unknown = vehicle_models.get("irsi");
  ASSERT_FALSE(unknown);
  EXPECT_THAT(unknown.error().message, HasSubstr("unknown vehicle `irsi`; did you mean `iris`?"));
}

// 3S pack: 12.6 V, 3 V less when empty, 0.1 ohm, 2 Ah; 10 A in hover.
const BatteryPack pack{3, 12.6, 3, 0.1, 2, 2, 10};

TEST(Battery, FullItGivesHoverItsFullSpeed) {
  const Battery battery(pack, 1);
  EXPECT_DOUBLE_EQ(battery.supply_ratio(), 1);
  EXPECT_DOUBLE_EQ(battery.voltage_V(), 11.6);
}

TEST(Battery, FallsWithTheChargeThatHoverUses) {
  Battery battery(pack, 1);
  battery.update(Nanoseconds(360'000'000'000), 360, 1);  // 10 A for 0.1 h: half of 2 Ah
  EXPECT_NEAR(battery.charge(), 0.5, 1e-12);
  EXPECT_NEAR(battery.voltage_V(), 12.6 - 1.5 - 1, 1e-12);
  EXPECT_NEAR(battery.supply_ratio(), 10.1 / 11.6, 1e-12);
}

TEST(Battery, TheCurrentFollowsThePowerThroughItsFilter) {
  Battery battery(pack, 1);
  battery.update(Nanoseconds(2'000'000'000), 0, 2);  // one time constant towards 20 A
  EXPECT_NEAR(battery.current_A(), 20 - 10 * std::exp(-1), 1e-12);
}

TEST(Battery, IsEmptyAtZero) {
  Battery battery(pack, 0.1);
  battery.update(Nanoseconds(1), 1e6, 100);
  EXPECT_EQ(battery.charge(), 0);
  EXPECT_GE(battery.voltage_V(), 0);
}

TEST(Vehicle, PowerGoesWithTheCubeOfTheSpeed) {
  Vehicle vehicle;
  vehicle.mass_kg = 1;
  vehicle.rotors.resize(2);
  vehicle.thrust_coefficient = gravity_m_s2 / 2 / (400.0 * 400.0);  // hovers at 400 rad/s
  const std::array hover{400.0, 400.0}, faster{800.0, 400.0};
  EXPECT_DOUBLE_EQ(vehicle.power_ratio(hover), 1);
  EXPECT_DOUBLE_EQ(vehicle.power_ratio(faster), (8 + 1) / 2.0);
}

}  // namespace
}  // namespace attest
