// The order of events in a flight of the cascade, with a plant and units that only record them.
#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/loop/case_timing.hpp"
#include "harness/loop/closed_loop.hpp"

namespace attest {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

using Notes = std::vector<std::string>;
using RateUnit = UnitOf<attest_rate_inputs, attest_rate_outputs>;
using AttitudeUnit = UnitOf<attest_attitude_inputs, attest_attitude_outputs>;

constexpr std::uint64_t start_us = 5'000'000;

double ms_of(std::uint64_t timestamp_us) {
  return static_cast<double>(timestamp_us - start_us) / 1e3;
}

// Its body rate about x is the time [s].
class RollingPlant final : public Plant {
 public:
  void reset(const PlantState& start) override { state_ = start; }
  void command(std::span<const double>) override {}
  void set_wind(const Vector3&) override {}
  void set_centre_of_mass(const Vector3&) override {}
  std::optional<Divergence> advance(Nanoseconds to) override {
    state_.rate_rad_s[0] = in_seconds(to);
    return std::nullopt;
  }
  const PlantState& state() const override { return state_; }

 private:
  PlantState state_;
};

class NotingRateUnit final : public RateUnit {
 public:
  explicit NotingRateUnit(Notes& notes) : notes_(notes) {}
  int set_parameter(const std::string& name, float) override {
    notes_.push_back("rate unit gets " + name);
    return ATTEST_OK;
  }
  int step(const attest_rate_inputs& in, attest_rate_outputs& out) override {
    std::string note = fmt::format("{:g} rate", ms_of(in.timestamp));
    if (in.updated & ATTEST_RATE_UPDATED_VEHICLE_RATES_SETPOINT) {
      note += fmt::format(" setpoint {:g}", in.vehicle_rates_setpoint.roll);
    }
    if (in.updated & ATTEST_RATE_UPDATED_CONTROL_ALLOCATOR_STATUS) note += " status";
    notes_.push_back(note);
    last = in;
    out.vehicle_torque_setpoint.xyz[0] = roll_torque;
    out.vehicle_torque_setpoint.published = 1;
    out.vehicle_thrust_setpoint.xyz[2] = -thrust;
    out.vehicle_thrust_setpoint.published = 1;
    return result;
  }
  float roll_torque = 0, thrust = 0.5f;
  int result = ATTEST_OK;
  attest_rate_inputs last{};

 private:
  Notes& notes_;
};

// Its setpoint of roll is the number of its step.
class NotingAttitudeUnit final : public AttitudeUnit {
 public:
  explicit NotingAttitudeUnit(Notes& notes) : notes_(notes) {}
  int set_parameter(const std::string& name, float) override {
    notes_.push_back("attitude unit gets " + name);
    return ATTEST_OK;
  }
  int step(const attest_attitude_inputs& in, attest_attitude_outputs& out) override {
    notes_.push_back(fmt::format("{:g} attitude", ms_of(in.timestamp)));
    last = in;
    out.vehicle_rates_setpoint.roll = static_cast<float>(++steps_);
    out.vehicle_rates_setpoint.published = published;
    return result;
  }
  std::uint8_t published = 1;
  int result = ATTEST_OK;
  attest_attitude_inputs last{};

 private:
  Notes& notes_;
  int steps_ = 0;
};

Vehicle rolling_quad() {
  Vehicle vehicle;
  vehicle.mass_kg = 1;
  vehicle.rotors = {
      {{0.1, 0.1, 0}, 1}, {{-0.1, -0.1, 0}, 1}, {{0.1, -0.1, 0}, -1}, {{-0.1, 0.1, 0}, -1}};
  vehicle.thrust_coefficient = gravity_m_s2 / 4 / (400.0 * 400.0);  // hovers at 400 rad/s
  vehicle.torque_over_thrust_m = 0.02;
  vehicle.rotor_max_rad_s = 800;
  vehicle.mixer = "R: 4x 10000 10000 10000 0";
  return vehicle;
}

Span in_s(double amount) { return {amount, Span::In::seconds}; }

TopicStimulus armed() {
  TopicStimulus topic{"vehicle_control_mode", ATTEST_RATE_UPDATED_VEHICLE_CONTROL_MODE, {}, {}, {}};
  topic.fields.push_back(
      {*find_channel(Module::rate_unit, "in/vehicle_control_mode.flag_armed"), Constant{1}});
  return topic;
}

class CascadeLoop : public testing::Test {
 protected:
  CascadeLoop() {
    case_.profile = "px4-v1.16.0";
    case_.module = Module::rate_unit;
    case_.duration = in_s(0.008);
    case_.topics = {armed()};
    case_.flight.emplace();
    case_.flight->saturation.rate = Rate::hz(100);
    case_.attitude_loop.emplace();
  }

  FlightEnd fly(FlightTraces traces = {}) {
    notes_.clear();
    ClosedLoop loop(case_, rate_, flight_timing(case_, rate_), vehicle_, plant_,
                    {rate_unit_, &attitude_unit_});
    return loop.run(traces);
  }

  Case case_;
  LoopRate rate_{Rate::hz(250), Rate::hz(500)};
  Vehicle vehicle_ = rolling_quad();
  Notes notes_;
  RollingPlant plant_;
  NotingRateUnit rate_unit_{notes_};
  NotingAttitudeUnit attitude_unit_{notes_};
};

TEST_F(CascadeLoop, AtOneInstantTheRateUnitIsFirstAndSeesTheSetpointAtItsNextTick) {
  fly();
  EXPECT_THAT(notes_, ElementsAre("0 rate status", "0 attitude", "2 rate setpoint 1", "4 rate",
                                  "4 attitude", "6 rate setpoint 2"));
}

TEST_F(CascadeLoop, TheSetpointArrivesAfterItsDelay) {
  case_.attitude_loop->delay = in_s(0.003);
  fly();
  EXPECT_THAT(notes_, ElementsAre("0 rate status", "0 attitude", "2 rate", "4 rate setpoint 1",
                                  "4 attitude", "6 rate"));
}

TEST_F(CascadeLoop, ASetpointThatIsNotPublishedIsNotCarried) {
  attitude_unit_.published = 0;
  fly();
  EXPECT_THAT(notes_, ElementsAre("0 rate status", "0 attitude", "2 rate", "4 rate", "4 attitude",
                                  "6 rate"));
}

TEST_F(CascadeLoop, EachUnitHasItsOwnTicks) {
  case_.unit.drop_ticks = {1};
  case_.attitude_loop->unit.drop_ticks = {0};
  const FlightEnd end = fly();
  EXPECT_THAT(notes_, ElementsAre("0 rate status", "4 rate", "4 attitude", "6 rate setpoint 1"));
  EXPECT_EQ(end.ticks, 3u);
  EXPECT_EQ(end.attitude_ticks, 1u);
}

TEST_F(CascadeLoop, EachUnitHasATrace) {
  Trace rate, attitude;
  fly({&rate, &attitude});
  EXPECT_EQ(rate.samples.size(), 4u);
  EXPECT_EQ(rate.plant.size(), 4u);
  EXPECT_EQ(attitude.samples.size(), 2u);
  EXPECT_TRUE(attitude.plant.empty());
  EXPECT_EQ(attitude.samples[1].in.timestamp, start_us + 4000);
  EXPECT_EQ(attitude.samples[1].attitude_out.vehicle_rates_setpoint.roll, 2);
  EXPECT_EQ(rate.samples[3].rate_in.vehicle_rates_setpoint.roll, 2);
}

TEST_F(CascadeLoop, EachUnitGetsItsOwnParameters) {
  case_.parameters = {{"MC_ROLL_P", Constant{5}}, {"MC_ROLLRATE_P", Constant{0.1}}};
  fly();
  EXPECT_EQ(std::count(notes_.begin(), notes_.end(), "attitude unit gets MC_ROLL_P"), 1);
  EXPECT_EQ(std::count(notes_.begin(), notes_.end(), "rate unit gets MC_ROLLRATE_P"), 1);
  EXPECT_EQ(std::count(notes_.begin(), notes_.end(), "rate unit gets MC_ROLL_P"), 0);
}

// The estimator's delay applies to the attitude unit only; the rate unit reads the gyro itself. Its
// samples of 0, 2, 4 and 6 mrad/s pass the low-pass of 40 Hz at 500 Hz, which has b = 0.0461318, a1
// = -1.3073042 and a2 = 0.4918121 (models/README.md):
//
//     y1 = 2 b = 0.0922636    y2 = 8 b - a1 y1 = 0.489671    y3 = 16 b - a1 y2 - a2 y1 = 1.332881
TEST_F(CascadeLoop, TheEstimateIsOldAndTheGyroIsNot) {
  case_.flight->estimator.delay = in_s(0.003);
  fly();
  EXPECT_EQ(attitude_unit_.last.vehicle_attitude.timestamp, start_us + 4000);
  EXPECT_EQ(attitude_unit_.last.vehicle_attitude.timestamp_sample, start_us + 1000);
  EXPECT_EQ(rate_unit_.last.vehicle_angular_velocity.timestamp_sample, start_us + 6000);
  EXPECT_NEAR(rate_unit_.last.vehicle_angular_velocity.xyz[0], 0.001332881, 5e-8);
}

// The derivative of the same filtered rates, after the low-pass of 30 Hz. The weight of a new
// sample is w = 2 ms / (2 ms + 1 / (2 pi 30 Hz)) = 0.273778. In rad/s^2:
//
//     d1 = w 0.0922636 / 2 = 0.0126298                d2 = d1 + w (0.397407 / 2 - d1) = 0.0635727
//     d3 = d2 + w (0.843210 / 2 - d2) = 0.1615940
TEST_F(CascadeLoop, TheRateUnitGetsTheAngularAcceleration) {
  fly();
  EXPECT_NEAR(rate_unit_.last.vehicle_angular_velocity.xyz_derivative[0], 0.161594f, 2e-6f);
}

TEST_F(CascadeLoop, AResetTurnsTheEstimateAndIsCounted) {
  case_.flight->estimator.reset = EstimatorReset{in_s(0.004), {0, 0, 0, 1}};
  Trace rate, attitude;
  fly({&rate, &attitude});
  const auto& before = attitude.samples[0].attitude_in.vehicle_attitude;
  const auto& after = attitude.samples[1].attitude_in.vehicle_attitude;
  EXPECT_EQ(before.quat_reset_counter, 0);
  EXPECT_THAT(before.q, ElementsAre(1, 0, 0, 0));
  EXPECT_EQ(after.quat_reset_counter, 1);
  EXPECT_THAT(after.q, ElementsAre(0, 0, 0, 1));
  EXPECT_THAT(after.delta_q_reset, ElementsAre(0, 0, 0, 1));
}

TEST_F(CascadeLoop, TheAllocatorReportsTheTorqueThatItLacks) {
  rate_unit_.roll_torque = 3;
  case_.flight->saturation.rate = Rate::hz(500);
  Trace rate;
  fly({&rate, nullptr});
  EXPECT_EQ(rate.samples[0].rate_in.control_allocator_status.torque_setpoint_achieved, 1);
  EXPECT_EQ(rate.samples[1].rate_in.control_allocator_status.torque_setpoint_achieved, 0);
  EXPECT_GT(rate.samples[1].rate_in.control_allocator_status.unallocated_torque[0], 1);
  EXPECT_EQ(rate.plant[0].saturated, 1);
}

// MC_AIRMODE is a parameter of the attitude unit. Roll of 0.4 changes the speeds by 0.4 sqrt(1/2) =
// 0.2828. Without airmode thrust 0.1 leaves 0.2 for the rotors on one side, with it 0.5657.
TEST_F(CascadeLoop, TheAllocatorFollowsTheAirmodeInFlight) {
  rate_unit_.roll_torque = 0.4f;
  rate_unit_.thrust = 0.1f;
  case_.parameters = {{"MC_AIRMODE", Step{0, 1, in_s(0.004)}}};
  Trace rate;
  fly({&rate, nullptr});
  EXPECT_NEAR(rate.plant[1].motor[1], 2 * 0.2 - 1, 1e-6);
  EXPECT_NEAR(rate.plant[2].motor[1], 2 * 0.565685 - 1, 1e-6);
}

TEST_F(CascadeLoop, OnAFloorThePlantKnowsWhetherItHasLanded) {
  case_.flight->floor = true;
  Trace rate, attitude;
  fly({&rate, &attitude});
  const auto landed = ATTEST_RATE_UPDATED_VEHICLE_LAND_DETECTED;
  EXPECT_TRUE(rate.samples[0].in.updated & landed);
  EXPECT_FALSE(rate.samples[1].in.updated & landed);
  EXPECT_TRUE(attitude.samples[0].in.updated & ATTEST_ATTITUDE_UPDATED_VEHICLE_LAND_DETECTED);
}

TEST_F(CascadeLoop, AFaultNamesTheUnit) {
  attitude_unit_.result = ATTEST_FAILED;
  const FlightEnd of_attitude = fly();
  ASSERT_TRUE(of_attitude.fault);
  EXPECT_THAT(of_attitude.fault->what,
              StartsWith("attitude unit: step at tick 0 returned ATTEST_FAILED"));
  attitude_unit_.result = ATTEST_OK;
  rate_unit_.result = ATTEST_UNSUPPORTED;
  const FlightEnd of_rate = fly();
  ASSERT_TRUE(of_rate.fault);
  EXPECT_THAT(of_rate.fault->what, HasSubstr("rate unit: "));
}

TEST_F(CascadeLoop, MotorsThatAreNotArmedStop) {
  case_.topics.clear();
  Trace rate;
  fly({&rate, nullptr});
  EXPECT_EQ(rate.plant[3].motor[0], -1);
}

}  // namespace
}  // namespace attest
