// The order of events in the loop, with a plant and a unit that only record them.
#include "harness/loop/closed_loop.hpp"

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/loop/case_timing.hpp"

namespace attest {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

using Notes = std::vector<std::string>;

std::string in_ms(Nanoseconds time) {
  return fmt::format("{:g}", static_cast<double>(time.count()) / 1e6);
}

// Its body rate about x is the time [ms], and its rotors follow a command at once.
class NotingPlant final : public Plant {
 public:
  explicit NotingPlant(Notes& notes) : notes_(notes) {}

  void reset(const PlantState& start) override { state_ = start; }
  void command(std::span<const double> speeds) override {
    notes_.push_back(fmt::format("{} hold {:g}", in_ms(now_), speeds[0]));
    for (std::size_t i = 0; i < speeds.size(); ++i) state_.rotor_rad_s[i] = speeds[i];
  }
  void set_wind(const Vector3& wind) override {
    notes_.push_back(fmt::format("{} wind {:g}", in_ms(now_), wind[0]));
  }
  void set_centre_of_mass(const Vector3&) override {}
  std::optional<Divergence> advance(Nanoseconds to) override {
    now_ = to;
    state_.rate_rad_s[0] = static_cast<double>(to.count()) / 1e6;
    if (to >= lost_at) return Divergence{to, "lost"};
    return std::nullopt;
  }
  const PlantState& state() const override { return state_; }

  Nanoseconds lost_at = Nanoseconds::max();

 private:
  Notes& notes_;
  PlantState state_;
  Nanoseconds now_{0};
};

class NotingUnit final : public UnitOf<attest_inputs, attest_outputs> {
 public:
  explicit NotingUnit(Notes& notes) : notes_(notes) {}

  int set_parameter(const std::string&, float) override { return ATTEST_OK; }
  int set_timestamp_sample(std::uint64_t timestamp_sample_us) override {
    timestamps_sample.push_back(timestamp_sample_us - 5'000'000);
    return ATTEST_OK;
  }
  int step(const attest_inputs& in, attest_outputs& out) override {
    const double time = static_cast<double>(in.timestamp - 5'000'000) / 1e3;
    std::string note = fmt::format("{:g} unit sees {:g}", time, in.control_state.roll_rate);
    if (in.updated & ATTEST_UPDATED_MULTIROTOR_MOTOR_LIMITS) {
      note += fmt::format(" limits {}", in.multirotor_motor_limits.upper_limit);
    }
    if (in.updated & ATTEST_UPDATED_BATTERY_STATUS) note += " battery";
    notes_.push_back(note);
    out.actuator_controls_0.control[0] = roll;
    out.actuator_controls_0.control[3] = thrust;
    out.actuator_controls_0.published = 1;
    return result;
  }

  float roll = 0, thrust = 0.5f;
  int result = ATTEST_OK;
  std::vector<std::uint64_t> timestamps_sample;  // [us] since the beginning

 private:
  Notes& notes_;
};

Vehicle quad() {
  Vehicle vehicle;
  vehicle.mass_kg = 1;
  vehicle.rotors.resize(4);
  vehicle.thrust_coefficient = gravity_m_s2 / 4 / (400.0 * 400.0);  // hovers at 400 rad/s
  vehicle.rotor_max_rad_s = 800;
  vehicle.mixer = "R: 4x 10000 10000 10000 0";
  vehicle.battery = {3, 12, 3, 0.1, 1, 1, 10};
  return vehicle;
}

TopicStimulus armed(bool value) {
  TopicStimulus topic{"actuator_armed", ATTEST_UPDATED_ACTUATOR_ARMED, {}, {}, {}};
  topic.fields.push_back({*find_channel(Module::mc_att_control, "in/actuator_armed.armed"),
                          Constant{value ? 1.0 : 0.0}});
  return topic;
}

Span seconds(double amount) { return {amount, Span::In::seconds}; }

class ClosedLoopTest : public testing::Test {
 protected:
  ClosedLoopTest() {
    case_.duration = seconds(0.012);
    case_.topics = {armed(true)};
    case_.flight.emplace();
    case_.flight->saturation.rate = Rate::hz(250);
  }

  FlightEnd fly(Trace* trace = nullptr, const Rate& rate = Rate::hz(250)) {
    notes_.clear();
    ClosedLoop loop(case_, rate, timing_.value_or(case_timing(case_, rate)), vehicle_, plant_,
                    unit_);
    return loop.run(trace);
  }

  Case case_;
  std::optional<LoopTiming> timing_;
  Vehicle vehicle_ = quad();
  Notes notes_;
  NotingPlant plant_{notes_};
  NotingUnit unit_{notes_};
};

TEST_F(ClosedLoopTest, TheUnitIsGivenTheTimeOfItsSample) {
  fly();
  EXPECT_THAT(unit_.timestamps_sample, ElementsAre(0, 4000, 8000));
  // The first sample arrives at 6 ms: until then the unit sees the initial state.
  case_.flight->estimator.delay = seconds(0.006);
  unit_.timestamps_sample.clear();
  fly();
  EXPECT_THAT(unit_.timestamps_sample, ElementsAre(0, 0, 2000));
  // An estimator that is slower than the loop repeats a sample.
  case_.flight->estimator.delay = seconds(0);
  case_.flight->estimator.drift = -0.25;
  unit_.timestamps_sample.clear();
  fly();
  EXPECT_THAT(unit_.timestamps_sample, ElementsAre(0, 0, 5333));
}

// The estimator's clock is faster by a quarter: it samples every 3.2 ms, and publishes 1 ms later.
TEST_F(ClosedLoopTest, AUnitThatTheEstimatorTriggersRunsWhenASampleArrives) {
  case_.unit.on_estimate = true;
  case_.flight->estimator.delay = seconds(0.001);
  case_.flight->estimator.drift = 0.25;
  case_.flight->saturation.rate = Rate::hz(1);
  fly();
  EXPECT_THAT(unit_.timestamps_sample, ElementsAre(0, 3200, 6400, 9600));
  std::erase_if(notes_,
                [](const std::string& note) { return note.find("sees") == std::string::npos; });
  EXPECT_THAT(notes_, ElementsAre("1 unit sees 0 limits 0", "4.2 unit sees 3.2",
                                  "7.4 unit sees 6.4", "10.6 unit sees 9.6"));
}

TEST_F(ClosedLoopTest, AtOneInstantTheSensorComesBeforeTheUnitAndTheMotorsAfter) {
  unit_.thrust = 1;  // with roll on top of it, the mixer reaches the upper limit
  unit_.roll = 0.2f;
  case_.flight->wind_m_s[0] = Step{0, 3, seconds(0.0)};
  case_.flight->battery.emplace().timing.rate = Rate::hz(125);
  case_.flight->saturation.rate = Rate::hz(125);
  fly();
  EXPECT_THAT(notes_,
              ElementsAre("0 wind 3", "0 unit sees 0 limits 0 battery", StartsWith("0 hold"),
                          "4 unit sees 4", StartsWith("4 hold"), "8 unit sees 8 limits 2 battery"));
}

TEST_F(ClosedLoopTest, ItEndsWithTheLastTick) {
  Trace trace;
  const FlightEnd end = fly(&trace);
  EXPECT_EQ(end.ticks, 3u);
  EXPECT_FALSE(end.fault);
  EXPECT_FALSE(end.divergence);
  EXPECT_EQ(trace.samples.size(), 3u);
  EXPECT_EQ(trace.plant.size(), 3u);
  EXPECT_EQ(trace.plant[2].rate_rad_s[0], 8);
  EXPECT_EQ(trace.plant[2].motor[0], 0);  // half thrust
}

TEST_F(ClosedLoopTest, ALateEstimateIsOneOfThePast) {
  case_.flight->estimator.delay = seconds(0.003);
  fly();
  EXPECT_THAT(notes_, ElementsAre("0 unit sees 0 limits 0", "0 hold 400", "4 unit sees 1 limits 0",
                                  "4 hold 400", "8 unit sees 5 limits 0"));
}

TEST_F(ClosedLoopTest, ADelayedCommandReachesTheMotorsLater) {
  case_.flight->actuator_delay = seconds(0.001);
  fly();
  EXPECT_THAT(notes_, ElementsAre("0 unit sees 0 limits 0", "1 hold 400", "4 unit sees 4 limits 0",
                                  "5 hold 400", "8 unit sees 8 limits 0"));
}

TEST_F(ClosedLoopTest, MotorLimitsAreStale) {
  unit_.thrust = 1;
  unit_.roll = 0.2f;
  case_.flight->saturation.rate = Rate::hz(250);
  case_.flight->saturation.phase = seconds(0.002);
  case_.flight->saturation.delay = seconds(0.004);
  case_.duration = seconds(0.020);
  fly();
  Notes limits;
  for (const std::string& note : notes_) {
    if (note.find("limits") != std::string::npos) limits.push_back(note);
  }
  // Taken at 2 ms, after the mixer's first run, and arrived at 6 ms.
  EXPECT_THAT(limits, ElementsAre("8 unit sees 8 limits 2", "12 unit sees 12 limits 2",
                                  "16 unit sees 16 limits 2"));
}

TEST_F(ClosedLoopTest, DisarmedMotorsStop) {
  case_.topics = {armed(false)};
  fly();
  EXPECT_EQ(notes_.at(1), "0 hold 0");
}

TEST_F(ClosedLoopTest, AFailedMotorStopsAtItsTime) {
  case_.flight->motor_failure = MotorFailure{0, seconds(0.005)};
  fly();
  EXPECT_THAT(notes_, ElementsAre("0 unit sees 0 limits 0", "0 hold 400", "4 unit sees 4 limits 0",
                                  "4 hold 400", "5 hold 0", "8 unit sees 8 limits 0"));
}

TEST_F(ClosedLoopTest, JitteredAndDroppedTicksAreFlownAsTheyCome) {
  case_.unit.drop_ticks = {1};
  fly();
  EXPECT_THAT(notes_,
              ElementsAre("0 unit sees 0 limits 0", "0 hold 400", "8 unit sees 8 limits 0"));
}

TEST_F(ClosedLoopTest, ATimingIsFlownAsItWas) {
  const auto ms = [](std::int64_t count) { return Nanoseconds(count * 1'000'000); };
  // The second tick sees the first sample again and runs late, and the next command overtakes its
  // own. The third sample is taken before the second tick begins.
  timing_ = LoopTiming{{ms(0), ms(1), ms(2)}, {ms(0), ms(6), {}}, {ms(5), ms(7), ms(9)}};
  case_.duration = seconds(0.020);
  case_.flight->saturation.phase = seconds(1);
  fly();
  EXPECT_THAT(notes_, ElementsAre("1 unit sees 0", "2 hold 400", "6 unit sees 0", "7 unit sees 5"));
}

TEST_F(ClosedLoopTest, AnEstimatorOnItsOwnClockGivesItsLastSample) {
  case_.flight->estimator.drift = 1.0 / 3;  // every 3 ms; the unit runs every 4 ms
  case_.flight->saturation.phase = seconds(1);
  case_.duration = seconds(0.016);
  fly();
  EXPECT_THAT(notes_, ElementsAre("0 unit sees 0", "0 hold 400", "4 unit sees 3", "4 hold 400",
                                  "8 unit sees 6", "8 hold 400", "12 unit sees 12"));
}

TEST_F(ClosedLoopTest, AFaultOfThePortEndsTheFlight) {
  unit_.result = ATTEST_FAILED;
  Trace trace;
  const FlightEnd end = fly(&trace);
  ASSERT_TRUE(end.fault);
  EXPECT_EQ(end.fault->tick, 0u);
  EXPECT_THAT(trace.samples, IsEmpty());
}

TEST_F(ClosedLoopTest, ALostVehicleEndsTheFlight) {
  plant_.lost_at = Nanoseconds(8'000'000);
  Trace trace;
  const FlightEnd end = fly(&trace);
  ASSERT_TRUE(end.divergence);
  EXPECT_EQ(end.divergence->at, Nanoseconds(8'000'000));
  EXPECT_EQ(trace.samples.size(), 2u);
}

TEST_F(ClosedLoopTest, ACommandThatIsNoNumberIsNotFlown) {
  unit_.thrust = std::numeric_limits<float>::quiet_NaN();
  const FlightEnd end = fly();
  ASSERT_TRUE(end.divergence);
  EXPECT_THAT(end.divergence->what, HasSubstr("not a number"));
  for (const std::string& note : notes_) EXPECT_THAT(note, testing::Not(HasSubstr("nan")));
}

TEST_F(ClosedLoopTest, TheBatteryScalesTheRotors) {
  case_.flight->battery.emplace().charge = 0.5;
  fly();
  const double full = 12 - 0.1 * 10;
  EXPECT_EQ(notes_.at(1), fmt::format("0 hold {:g}", 400 * (full - 1.5) / full));
}

TEST(TaskTimes, APhaseInTicksIsInThoseOfTheUnit) {
  TaskTiming timing;
  timing.rate = Rate::hz(100);
  timing.phase = {2, Span::In::ticks};
  const auto times = task_times(timing, {Rate::hz(250), Nanoseconds(30'000'000)});
  ASSERT_FALSE(times.empty());
  EXPECT_EQ(times[0], Nanoseconds(8'000'000));
}

// The sample of 8 ms arrives after the end of the flight, so it starts no step.
TEST_F(ClosedLoopTest, ATriggeredUnitDoesNotRunAtTheEnd) {
  case_.unit.on_estimate = true;
  case_.flight->estimator.delay = seconds(0.004);
  fly();
  EXPECT_THAT(unit_.timestamps_sample, ElementsAre(0, 4000));
}

// The voltage does not depend on the rotors' current. What remains is the sag that the estimate
// expects from the throttle.
TEST_F(ClosedLoopTest, TheBatteryTaskTakesTheThrottle) {
  vehicle_.battery = {3, 12, 0, 0, 1, 1, 10};
  const auto scale_at_end = [&] {
    Trace trace;
    case_.flight->battery.emplace().timing.rate = Rate::hz(250);
    case_.duration = seconds(2);
    fly(&trace);
    return trace.samples.back().in.battery_status.scale;
  };
  unit_.thrust = 0;
  const float idle = scale_at_end();
  unit_.thrust = 1;
  EXPECT_NE(scale_at_end(), idle);
}

}  // namespace
}  // namespace attest
