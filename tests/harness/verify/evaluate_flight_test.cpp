// Flights of the reference, which a test then changes.
#include <cmath>
#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/casefile/parse.hpp"
#include "harness/host/in_process_host.hpp"
#include "harness/loop/case_timing.hpp"
#include "harness/plant/vehicle_models.hpp"
#include "harness/port/builtin.hpp"
#include "harness/verify/evaluate.hpp"

namespace attest {
namespace {

using testing::HasSubstr;

const std::filesystem::path source = ATTEST_SOURCE_DIR;
const RunConfiguration at_50{Rate::hz(50), PlantConfiguration{"iris", PlantKind::ode}};

class ChangedFlight final : public PortHost {
 public:
  using Change = std::function<void(Trace&)>;

  ChangedFlight(const Course& course, Change change)
      : reference_(open_builtin(), {}, course), change_(std::move(change)) {
    declarations_.name = "changed";
  }

  const Declarations& declarations() const override { return declarations_; }
  Result<Flown> fly(const FlightPlan& plan) override {
    auto flown = reference_.fly(plan);
    if (flown) change_(flown->trace);
    return flown;
  }
  Result<LiveFlight> fly_live(const LivePlan&, const LiveWatch&) override {
    return fail("no live flights");
  }
  std::optional<PortFault> drive(const ModuleUnderTest&, Trace&) override { return std::nullopt; }
  Result<StepTimes> time_steps(const ModuleUnderTest&, const Trace&, bool) override {
    return fail("no times");
  }
  bool supports(const std::string&) override { return true; }

  Declarations declarations_;

 private:
  InProcessHost reference_;
  Change change_;
};

// Tilts by 30 deg. The metric is the largest body rate, of at least 2 rad/s. Its tolerance is 5%,
// which is more here than the least tolerance of 0.1 rad/s.
class EvaluateFlight : public testing::Test {
 protected:
  EvaluateFlight()
      : case_(*parse_case(source / "cases/px4-v1.5.5/flight/tilt_step_30.toml")),
        iris_(*VehicleModel::load(source / "models", "iris")) {
    case_.duration = {100, Span::In::ticks};
    metric_.name = "turns";
    metric_.measure = Measure::peak_rate_rad_s;
  }

  VectorResult result_of(const ChangedFlight::Change& change, std::optional<int> bits = {}) {
    case_.flight->metrics = {metric_};
    ChangedFlight host({&case_, iris_.get()}, change);
    host.declarations_.fraction_bits = bits;
    auto result = evaluate_timed_flight(
        case_, at_50, *iris_, case_timing(case_, at_50.rate.motor_unit), host, {.level = level_});
    EXPECT_TRUE(result) << result.error().to_string();
    return result ? *std::move(result) : VectorResult{};
  }
  // With body rates larger by that factor from a tick on.
  VectorResult with_rates(float factor, std::size_t from = 0) {
    return result_of([=](Trace& flown) {
      for (std::size_t tick = from; tick < flown.plant.size(); ++tick) {
        for (float& rate : flown.plant[tick].rate_rad_s) rate *= factor;
      }
    });
  }
  double reference() { return with_rates(1).metrics.at(0).value; }

  Case case_;
  std::shared_ptr<const VehicleModel> iris_;
  Metric metric_;
  Level level_ = Level::numeric;
};

TEST_F(EvaluateFlight, AMetricMayBeOffByTheLargerOfItsTolerances) {
  ASSERT_GT(reference(), 2);
  EXPECT_EQ(with_rates(1.04f).verdict, Verdict::pass);
  EXPECT_EQ(with_rates(0.96f).verdict, Verdict::pass);
  const VectorResult off = with_rates(1.06f);
  EXPECT_EQ(off.verdict, Verdict::fail);
  EXPECT_THAT(off.reason, HasSubstr("metric turns: peak_rate_rad_s is"));
  EXPECT_EQ(with_rates(0.94f).verdict, Verdict::fail);
}

// A ratio of a few tenths, for which a tolerance of 0.1 would be wide.
TEST_F(EvaluateFlight, ARatioMayBeOffByAShareOfItself) {
  case_.duration = {150, Span::In::ticks};
  metric_.window.from_s = 2;
  metric_.versus = Window{};
  ASSERT_LT(reference(), 0.9);
  ASSERT_GT(reference(), 0.001);
  EXPECT_EQ(with_rates(1.04f, 100).verdict, Verdict::pass);
  EXPECT_EQ(with_rates(1.06f, 100).verdict, Verdict::fail);
}

TEST_F(EvaluateFlight, AtRecordedTimesABoundThatTheReferenceKeepsBindsAPort) {
  const double value = reference();
  metric_.max = 1.02 * value;
  EXPECT_EQ(with_rates(1.04f).verdict, Verdict::fail);
  metric_.max = 0.5 * value;
  EXPECT_EQ(with_rates(1.04f).verdict, Verdict::pass);
  metric_.max = 1e9;
  metric_.min = 0.98 * value;
  EXPECT_EQ(with_rates(0.96f).verdict, Verdict::fail);
  metric_.min = 2 * value;
  EXPECT_EQ(with_rates(0.96f).verdict, Verdict::pass);
}

TEST_F(EvaluateFlight, AMissedMetricDoesNotHideThatAnOutputIsNoNumber) {
  const VectorResult result = result_of([](Trace& flown) {
    flown.samples[40].out.vehicle_rates_setpoint.roll = std::numeric_limits<float>::quiet_NaN();
    for (PlantSample& sample : flown.plant) sample.rate_rad_s = {9, 9, 9};
  });
  EXPECT_EQ(result.verdict, Verdict::non_finite);
  EXPECT_THAT(result.reason, HasSubstr("metric turns"));
}

// From 30 bits on the golden's rows apply, as they do for floats. The test changes the port's
// input; the port's outputs are right for that input.
TEST_F(EvaluateFlight, APortInFixedPointIsHeldToTheGoldenFrom30BitsOn) {
  const auto other_rate = [](Trace& flown) {
    flown.samples[10].in.control_state.roll_rate += 0.01f;
    InProcessHost law(open_builtin());
    EXPECT_FALSE(law.drive({"px4-v1.5.5"}, flown));
  };
  EXPECT_EQ(result_of(other_rate).verdict, Verdict::fail);
  EXPECT_EQ(result_of(other_rate, 30).verdict, Verdict::fail);
  EXPECT_EQ(result_of(other_rate, 29).verdict, Verdict::pass);
}

TEST_F(EvaluateFlight, ATraceOfAnotherFlightIsAFaultOfThePort) {
  const VectorResult result = result_of([](Trace& flown) { ++flown.samples[95].in.timestamp; });
  EXPECT_EQ(result.verdict, Verdict::protocol);
  EXPECT_THAT(result.reason, HasSubstr("timestamp at tick 95"));
}

class FlightOfALackingPort : public EvaluateFlight {
 protected:
  VectorResult result_of(const std::string& word, const ChangedFlight::Change& change) {
    case_.flight->metrics = {metric_};
    ChangedFlight host({&case_, iris_.get()}, change);
    host.declarations_.lacks = *Lacks::parse(std::vector{word});
    const auto timing = case_timing(case_, at_50.rate.motor_unit);
    auto result = evaluate_timed_flight(case_, at_50, *iris_, timing, host);
    EXPECT_TRUE(result) << result.error().to_string();
    return result ? *std::move(result) : VectorResult{};
  }
};

// What the port's process sends cannot excuse it.
TEST_F(FlightOfALackingPort, UsesTheFeaturesOfTheReferencesFlight) {
  const auto forged = [](Trace& flown) {
    flown.samples[60].in.vehicle_attitude_setpoint.disable_mc_yaw_control = 1;
  };
  EXPECT_EQ(result_of("weathervane", forged).verdict, Verdict::protocol);
}

TEST_F(FlightOfALackingPort, IsNotFlownIfItUsesTheFeature) {
  const VectorResult flown = result_of("rate_feed_forward", [](Trace&) {});
  EXPECT_EQ(flown.verdict, Verdict::pass) << flown.reason;
  case_.parameters.push_back({"MC_ROLLRATE_FF", Constant{0.1}});
  const VectorResult result = result_of("rate_feed_forward", [](Trace&) { FAIL(); });
  EXPECT_EQ(result.verdict, Verdict::unsupported);
  EXPECT_EQ(result.reason, "the port declares that it lacks rate_feed_forward");
  EXPECT_TRUE(result.has_after_all.empty());
}

TEST_F(FlightOfALackingPort, IsNotFlownWithoutAnOutputThatItNeeds) {
  const VectorResult result = result_of("actuator_controls_0", [](Trace&) { FAIL(); });
  EXPECT_EQ(result.verdict, Verdict::unsupported);
  EXPECT_THAT(result.reason, HasSubstr("which a flight needs"));
}

TEST_F(FlightOfALackingPort, NeedsNoIntegrals) {
  metric_.measure = Measure::peak_integral;
  const auto without = [](Trace& flown) {
    for (Sample& sample : flown.samples) sample.out.mc_att_ctrl_status = {};
  };
  EXPECT_EQ(result_of("mc_att_ctrl_status", without).verdict, Verdict::pass);
  EXPECT_EQ(result_of("tpa", without).verdict, Verdict::fail);
}

TEST_F(EvaluateFlight, OneBitDeviatesOnlyAtTheLevelExact) {
  const auto result_at = [this](Level level) {
    level_ = level;
    return result_of([](Trace& flown) {
      float& roll = flown.samples[40].out.vehicle_rates_setpoint.roll;
      roll = std::nextafter(roll, 10.0f);
    });
  };
  for (const Level level : {Level::numeric, Level::events}) {
    const VectorResult result = result_at(level);
    EXPECT_EQ(result.verdict, Verdict::pass);
    EXPECT_EQ(result.compared, Level::numeric);
  }
  const VectorResult exact = result_at(Level::exact);
  EXPECT_EQ(exact.verdict, Verdict::fail);
  EXPECT_EQ(exact.compared, Level::exact);
  ASSERT_TRUE(exact.first);
  EXPECT_EQ(exact.first->tick, 40u);
}

// Beyond the horizon, where the golden's rows do not apply: for a port with 22 bits that is every
// tick.
TEST_F(EvaluateFlight, AWrongAnswerIsFoundAtAnyTick) {
  const VectorResult result = result_of(
      [](Trace& flown) { flown.samples[95].out.vehicle_rates_setpoint.roll += 0.1f; }, 22);
  EXPECT_EQ(result.verdict, Verdict::fail);
  ASSERT_TRUE(result.first);
  EXPECT_EQ(result.first->tick, 95u);
}

}  // namespace
}  // namespace attest
