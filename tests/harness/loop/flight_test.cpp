#include "harness/loop/flight.hpp"

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
    return fly(failure, at_50, *iris, *unit, case_timing(failure, at_50.rate.unit));
  };
  EXPECT_TRUE(flown(3));
  const auto none = flown(4);
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message,
              testing::HasSubstr("names rotor 4, but iris has rotors 0 to 3"));
}

}  // namespace
}  // namespace attest
