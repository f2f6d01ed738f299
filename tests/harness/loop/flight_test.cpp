#include "harness/loop/flight.hpp"

#include <memory>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/casefile/parse.hpp"
#include "harness/loop/case_timing.hpp"
#include "harness/plant/vehicle_models.hpp"
#include "harness/port/builtin.hpp"

namespace attest {
namespace {

const std::filesystem::path source_folder = ATTEST_SOURCE_DIR;

// The last rotor of a quad is number 3.
TEST(Fly, AMotorThatTheVehicleDoesNotHaveCannotFail) {
  Case failure = *parse_case(source_folder / "cases/px4-v1.5.5/flight/motor_failure.toml");
  failure.duration = {4, Span::In::ticks};
  const auto iris = *VehicleModel::load(source_folder / "models", "iris");
  const RunConfiguration at_50{Rate::hz(50), PlantConfiguration{"iris", PlantKind::ode}};
  const auto flown = [&](std::size_t rotor) {
    failure.flight->motor_failure->rotor = rotor;
    const auto unit = open_builtin()->create(failure.profile);
    return fly(failure, at_50, *iris, *unit, case_timing(failure, at_50.rate.motor_unit));
  };
  EXPECT_TRUE(flown(3));
  const auto none = flown(4);
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message,
              testing::HasSubstr("names rotor 4, but iris has rotors 0 to 3"));
}

// Counts itself among the living units of its port.
class CountedUnit final : public Unit {
 public:
  explicit CountedUnit(int& living) : living_(++living) {}
  CountedUnit(const CountedUnit&) = delete;
  CountedUnit& operator=(const CountedUnit&) = delete;
  ~CountedUnit() override { --living_; }
  int set_parameter(const std::string&, float) override { return ATTEST_OK; }
  int step_structs(const void*, void*) override { return ATTEST_OK; }

 private:
  int& living_;
};

// Declares both units of the cascade, and makes those in `made`, at most `at_once` of them.
class CountingCascade final : public Port {
 public:
  CountingCascade(ModuleSet made, int at_once) : made_(made), at_once_(at_once) {}
  std::string name() const override { return "cascade"; }
  std::string version() const override { return "1"; }
  ModuleSet modules() const override {
    return only(Module::attitude_unit) | only(Module::rate_unit);
  }
  std::unique_ptr<Unit> create_unit(Module module, const std::string&,
                                    const std::string&) override {
    if (!contains(made_, module) || living >= at_once_) return nullptr;
    return std::make_unique<CountedUnit>(living);
  }
  int living = 0;

 private:
  ModuleSet made_;
  int at_once_;
};

// How many of the units that fly the cascade are the port's, or the fault.
tl::expected<int, PortFault> flown_by(ModuleSet made, int at_once) {
  const Case hover = *parse_case(source_folder / "cases/px4-v1.16.0/flight/hover.toml");
  CountingCascade port(made, at_once);
  const auto units = units_for(hover, port);
  if (!units) return tl::unexpected(units.error());
  EXPECT_TRUE(units->unit && units->attitude_unit);
  return port.living;
}

TEST(UnitsFor, AUnitThatThePortDoesNotMakeIsTheOthers) {
  const ModuleSet attitude = only(Module::attitude_unit), rate = only(Module::rate_unit);
  EXPECT_EQ(flown_by(attitude | rate, 2), 2);
  EXPECT_EQ(flown_by(attitude, 2), 1);
  EXPECT_EQ(flown_by(rate, 2), 1);
  EXPECT_EQ(flown_by(rate, 1), 1);
  ASSERT_FALSE(flown_by({}, 2));
  EXPECT_EQ(flown_by({}, 2).error().kind, PortFault::Kind::profile);
}

TEST(UnitsFor, APortThatMakesOneUnitAtATimeDoesNotFlyWithHalfOfItself) {
  const auto flown = flown_by(only(Module::attitude_unit) | only(Module::rate_unit), 1);
  ASSERT_FALSE(flown);
  EXPECT_EQ(flown.error().kind, PortFault::Kind::unsupported);
  EXPECT_THAT(flown.error().what,
              testing::HasSubstr("makes no attitude unit while it has a rate unit"));
}

// The profile is supported, but there is no unit to fly.
class LawsOnly final : public Port {
 public:
  std::string name() const override { return "laws"; }
  std::string version() const override { return "1"; }
  ModuleSet modules() const override { return only(Module::rate_law); }
  std::unique_ptr<Unit> create_unit(Module module, const std::string&,
                                    const std::string&) override {
    if (module != Module::rate_law) return nullptr;
    return std::make_unique<CountedUnit>(living_);
  }

 private:
  int living_ = 0;
};

TEST(UnitsFor, FlightsOfAPortOfTheLawsAloneAreUnsupported) {
  LawsOnly port;
  const auto units =
      units_for(*parse_case(source_folder / "cases/px4-v1.16.0/flight/hover.toml"), port);
  ASSERT_FALSE(units);
  EXPECT_EQ(units.error().kind, PortFault::Kind::module);
  EXPECT_THAT(units.error().what, testing::HasSubstr("has no module rate_unit"));
}

}  // namespace
}  // namespace attest
