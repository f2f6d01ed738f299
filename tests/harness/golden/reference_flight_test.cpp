#include "harness/golden/reference_flight.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/casefile/parse.hpp"
#include "harness/compare/compare.hpp"
#include "harness/loop/case_timing.hpp"
#include "harness/loop/flight.hpp"
#include "harness/plant/vehicle_models.hpp"
#include "harness/port/builtin.hpp"

namespace attest {
namespace {

const std::filesystem::path source = ATTEST_SOURCE_DIR;
const RunConfiguration at_50{Rate::hz(50), PlantConfiguration{"iris", PlantKind::ode}};

class ReferenceFlightTest : public testing::Test {
 protected:
  ReferenceFlightTest()
      : case_(*parse_case(source / "cases/px4-v1.5.5/flight/tilt_step_30.toml")),
        iris_(*VehicleModel::load(source / "models", "iris")) {
    case_.duration = {300, Span::In::ticks};
    case_.flight->metrics.clear();
  }

  Trace flown_by(Port& port) const {
    return fly(case_, at_50, *iris_, *port.create(case_.profile),
               case_timing(case_, at_50.rate.motor_unit))
        ->trace;
  }
  // The time until the outputs of float and double differ by more than the tolerance.
  double seconds_within(double tolerance) const {
    const Trace flown = flown_by(*open_builtin());
    const auto first =
        compare(flown_by(*open_builtin_in_double()), flown, tolerances_of(tolerance)).first;
    EXPECT_TRUE(first) << tolerance;
    const std::size_t tick = first ? first->tick : 0;
    return static_cast<double>(flown.samples[tick].in.timestamp - flown.samples[0].in.timestamp) *
           1e-6;
  }
  static Tolerances tolerances_of(double absolute) {
    Tolerances tolerances;
    tolerances.set("vehicle_rates_setpoint", any);
    for (const char* topic : topics) tolerances.set(topic, {absolute, 0});
    return tolerances;
  }

  // Without the rates setpoint, whose tolerance widens.
  static constexpr std::array topics{"actuator_controls_0", "mc_att_ctrl_status"};
  static constexpr Tolerance any{1e9, 0};
  Case case_;
  std::shared_ptr<const VehicleModel> iris_;
};

TEST_F(ReferenceFlightTest, TheHorizonIsWhereFloatAndDoubleDifferByATenthOfATolerance) {
  constexpr double tolerance = 1e-7;
  ASSERT_LT(seconds_within(tolerance / 10), seconds_within(tolerance));
  case_.tolerances = {{"vehicle_rates_setpoint", any}};
  for (const char* topic : topics) case_.tolerances.push_back({topic, {tolerance, 0}});
  const auto flight = reference_flight(case_, at_50, *iris_);
  ASSERT_TRUE(flight) << flight.error().to_string();
  EXPECT_DOUBLE_EQ(flight->horizon_s, seconds_within(tolerance / 10));
}

TEST_F(ReferenceFlightTest, MissesABoundWithAValueThatIsNoNumber) {
  Metric metric;
  metric.name = "settles";
  metric.window.from_s = 1000;  // no tick is that late
  case_.flight->metrics = {metric};
  const auto flight = reference_flight(case_, at_50, *iris_);
  ASSERT_FALSE(flight);
  EXPECT_THAT(flight.error().message, testing::HasSubstr("the reference misses the metric"));
}

}  // namespace
}  // namespace attest
