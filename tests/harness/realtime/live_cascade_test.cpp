// The messages between the two units of the cascade, on a clock whose lateness the test gives.
#include <functional>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/realtime/live_unit.hpp"
#include "tests/harness/realtime/flights.hpp"
#include "tests/harness/realtime/scripted_clock.hpp"
#include "tests/harness/times.hpp"

namespace attest {
namespace {

using testing::ElementsAre;
using testing::Optional;

// A rate unit whose steps take 10 us, and which keeps its inputs.
class KeepingRateUnit final : public UnitOf<attest_rate_inputs, attest_rate_outputs> {
 public:
  explicit KeepingRateUnit(ScriptedClock& clock) : clock_(clock) {}
  int set_parameter(const std::string&, float) override { return ATTEST_OK; }
  int step(const attest_rate_inputs& in, attest_rate_outputs&) override {
    inputs.push_back(in);
    clock_.pass(us(10));
    return ATTEST_OK;
  }

  std::vector<attest_rate_inputs> inputs;

 private:
  ScriptedClock& clock_;
};

// An attitude unit that publishes the number of its step as the roll rate, from its second on.
class CountingAttitudeUnit final : public UnitOf<attest_attitude_inputs, attest_attitude_outputs> {
 public:
  explicit CountingAttitudeUnit(ScriptedClock& clock) : clock_(clock) {}
  int set_parameter(const std::string&, float) override { return ATTEST_OK; }
  int step(const attest_attitude_inputs&, attest_attitude_outputs& out) override {
    before_step();
    clock_.pass(us(20));
    out.vehicle_rates_setpoint.published = steps > 0 ? 1 : 0;
    out.vehicle_rates_setpoint.roll = static_cast<float>(steps++);
    return ATTEST_OK;
  }

  std::function<void()> before_step = [] {};
  int steps = 0;

 private:
  ScriptedClock& clock_;
};

// The rate unit at 1 kHz and the attitude unit at 500 Hz, for 8 ms.
class LiveCascadeTest : public testing::Test {
 protected:
  LiveUnitRecord run(Module module, Unit& unit) {
    const Case scripted = case_.of_module(module);
    UnitTask task(scripted, rate_.motor_unit, vehicle_, unit, {});
    LiveUnit live(scripted, rate_, task, clock_, links_, 8);
    live.run();
    return live.take_record();
  }

  // The attitude unit sends it at its tick, made at that time.
  void send_before(Nanoseconds release, std::size_t tick, Nanoseconds made) {
    sent_.push_back({release, {tick, made, {}}});
    clock_.before_waiting = [this](Nanoseconds due) {
      for (const auto& [when, setpoint] : sent_) {
        if (when == due) links_.rates_setpoints.write(setpoint);
      }
    };
  }

  Case case_ = test::cascade_case(0.008);
  LoopRate rate_{Rate::hz(500), Rate::hz(1000)};
  Vehicle vehicle_ = test::quad_vehicle();
  ScriptedClock clock_;
  Links links_;
  KeepingRateUnit rate_unit_{clock_};
  CountingAttitudeUnit attitude_unit_{clock_};
  std::vector<std::pair<Nanoseconds, LiveRatesSetpoint>> sent_;
};

TEST_F(LiveCascadeTest, ASetpointIsReceivedAtTheNextTickOfTheRateUnit) {
  send_before(ms(1), 0, us(300));
  send_before(ms(5), 2, us(4300));
  const LiveUnitRecord record = run(Module::rate_unit, rate_unit_);
  EXPECT_EQ(record.ticks.size(), 8u);
  EXPECT_THAT(record.setpoints_received,
              ElementsAre(Optional(ms(1)), std::nullopt, Optional(ms(5)), std::nullopt));
  for (std::size_t i = 0; i < 8; ++i) {
    const bool received =
        (rate_unit_.inputs[i].updated & ATTEST_RATE_UPDATED_VEHICLE_RATES_SETPOINT) != 0;
    EXPECT_EQ(received, i == 1 || i == 5) << i;
  }
}

TEST_F(LiveCascadeTest, ASetpointArrivesAfterTheDelayOfTheCase) {
  case_.attitude_loop->delay = {0.0025, Span::In::seconds};
  send_before(ms(1), 0, us(300));
  send_before(ms(3), 1, us(2300));
  EXPECT_THAT(run(Module::rate_unit, rate_unit_).setpoints_received,
              ElementsAre(Optional(ms(3)), Optional(ms(5)), std::nullopt, std::nullopt));
}

TEST_F(LiveCascadeTest, OfTwoSetpointsThatArrivedTheLastIsReceived) {
  case_.attitude_loop->delay = {0.0025, Span::In::seconds};
  clock_.latency = [](Nanoseconds due) { return due == ms(3) ? us(2200) : ns(0); };
  send_before(ms(1), 0, us(300));
  send_before(ms(3), 1, us(2300));
  EXPECT_THAT(run(Module::rate_unit, rate_unit_).setpoints_received,
              ElementsAre(std::nullopt, Optional(us(5200)), std::nullopt, std::nullopt));
}

TEST_F(LiveCascadeTest, TheAttitudeUnitSendsWhatItPublishes) {
  std::vector<LiveRatesSetpoint> sent;
  attitude_unit_.before_step = [&] {
    if (const auto* setpoint = links_.rates_setpoints.read()) sent.push_back(*setpoint);
  };
  const LiveUnitRecord record = run(Module::attitude_unit, attitude_unit_);
  EXPECT_EQ(record.ticks.size(), 4u);  // at its own rate
  EXPECT_EQ(record.ticks[3].deadline - record.ticks[3].release, ms(2));
  EXPECT_TRUE(record.setpoints_received.empty());
  ASSERT_EQ(sent.size(), 2u);
  EXPECT_EQ(sent[0].tick, 1u);
  EXPECT_EQ(sent[0].made, us(2020));
  EXPECT_FLOAT_EQ(sent[0].value.roll, 1);
  EXPECT_EQ(sent[1].tick, 2u);
}

TEST_F(LiveCascadeTest, TheAttitudeUnitLeavesTheMessagesOfTheRateUnit) {
  links_.batteries.write({ms(0), 1.5f});
  run(Module::attitude_unit, attitude_unit_);
  EXPECT_NE(links_.batteries.read(), nullptr);
  EXPECT_EQ(links_.commands.read(), nullptr);
}

TEST_F(LiveCascadeTest, EachUnitReadsItsOwnStates) {
  links_.attitude_unit.states.write({us(7), {}});
  EXPECT_EQ(run(Module::rate_unit, rate_unit_).ticks[0].sampled, Nanoseconds(-1));
  links_.stop = false;
  links_.flying = 1;
  EXPECT_EQ(run(Module::attitude_unit, attitude_unit_).ticks[0].sampled, us(7));
}

TEST_F(LiveCascadeTest, ThatItHasLandedIsReceivedOnce) {
  links_.unit.landed.write({true, true});
  run(Module::rate_unit, rate_unit_);
  EXPECT_EQ(rate_unit_.inputs[0].vehicle_land_detected.landed, 1);
  for (std::size_t i = 0; i < 8; ++i) {
    const bool received =
        (rate_unit_.inputs[i].updated & ATTEST_RATE_UPDATED_VEHICLE_LAND_DETECTED) != 0;
    EXPECT_EQ(received, i == 0) << i;
  }
}

}  // namespace
}  // namespace attest
