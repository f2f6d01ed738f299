// Which outputs of a log are judged, and by what.
#include "harness/verify/evaluate_log.hpp"

#include <cmath>

#include <gmock/gmock.h>

#include "harness/host/in_process_host.hpp"
#include "harness/port/builtin.hpp"
#include "harness/port/port.hpp"
#include "tests/harness/verify/logged_unit.hpp"

namespace attest {
namespace {

using testing::HasSubstr;

constexpr const char* law_of_log = "px4-v1.16.0";

// What a rate unit of 1 kHz logged in 0.4 s.
LoggedUnit logged_rate_unit() {
  LoggedUnit log = log_of(Module::rate_unit, "vehicle_angular_velocity");
  for (std::uint64_t tick = 0; tick < 400; ++tick) {
    Sample sample;
    const float time_s = 1e-3f * static_cast<float>(tick);
    sample.in.timestamp = 5000000 + 1000 * tick;
    attest_rate_inputs& in = sample.rate_in;
    in.vehicle_angular_velocity.timestamp_sample = sample.in.timestamp;
    in.vehicle_angular_velocity.xyz[0] = std::sin(20 * time_s);
    in.vehicle_rates_setpoint.roll = 0.5f;
    in.vehicle_control_mode = {1, 0, 1, 1};
    in.vehicle_status.is_rotary_wing = 1;
    if (tick == 0) sample.in.updated = 0xff;
    log.trace.samples.push_back(sample);
  }
  add_outputs(law_of_log,
              {"vehicle_torque_setpoint", "vehicle_thrust_setpoint", "rate_ctrl_status",
               "vehicle_rates_setpoint"},
              log);
  return log;
}

// The log lacks what was before its first sample.
void add_integral(LoggedUnit& log) {
  for (Sample& sample : log.trace.samples) {
    sample.rate_out.rate_ctrl_status.rollspeed_integ += 0.1f;
    sample.rate_out.vehicle_torque_setpoint.xyz[0] += 0.1f;
  }
}

LogResult result_of(const LoggedUnit& log, const char* port = "builtin") {
  InProcessHost host(*open_port(port));
  return evaluate_log(log, law_of_log, host, {}).value();
}

TEST(EvaluateLog, ARightUnitAgreesAndAWrongOneDoesNot) {
  const LoggedUnit log = logged_rate_unit();
  EXPECT_EQ(result_of(log).result.verdict, Verdict::pass);
  EXPECT_EQ(result_of(log, "fault:cascade-i-missing").result.verdict, Verdict::fail);
}

TEST(EvaluateLog, PartsOfAnySizeGiveTheSameResult) {
  LoggedUnit log = logged_rate_unit();
  log.trace.parameters = {{0, "MC_ROLLRATE_P", 0.15f}, {201, "MC_ROLLRATE_P", 0.18f}};
  for (std::size_t tick = 0; tick < 50; ++tick) log.setpoints[tick].known = Known::nothing;
  for (const char* port : {"builtin", "fault:cascade-i-missing"}) {
    const auto in_parts_of = [&](std::size_t most) {
      InProcessHost host(*open_port(port));
      return evaluate_log(log, law_of_log, host, {}, {{0, "MC_PITCHRATE_P", 0.1f}}, most).value();
    };
    const LogResult whole = in_parts_of(1000);
    EXPECT_EQ(whole.topics.front().left_out, 50u);
    for (const std::size_t most : {1U, 7U, 400U}) {
      const LogResult parts = in_parts_of(most);
      EXPECT_EQ(parts.result.verdict, whole.result.verdict);
      EXPECT_EQ(parts.result.reason, whole.result.reason);
      EXPECT_EQ(parts.result.ticks, whole.result.ticks);
      EXPECT_EQ(parts.got.samples.size(), whole.got.samples.size());
      ASSERT_EQ(parts.topics.size(), whole.topics.size());
      EXPECT_EQ(parts.topics.front().largest, whole.topics.front().largest);
      EXPECT_EQ(parts.topics.front().within, whole.topics.front().within);
    }
  }
}

TEST(EvaluateLog, AParameterOfThePortIsNotThatOfTheFlight) {
  LoggedUnit log = logged_rate_unit();
  const auto verdict_with = [&](const ParameterChange& change) {
    InProcessHost host(open_builtin());
    return evaluate_log(log, law_of_log, host, {}, {change})->result.verdict;
  };
  const ParameterChange flown{0, "MC_ROLLRATE_P", 0.15f}, other{0, "MC_ROLLRATE_P", 0.2f};
  log.trace.parameters = {flown};
  EXPECT_EQ(verdict_with(flown), Verdict::pass);
  EXPECT_EQ(verdict_with(other), Verdict::fail);
  // The log does not say with which value the unit flew.
  log.trace.parameters.clear();
  EXPECT_EQ(verdict_with(flown), Verdict::pass);
  EXPECT_EQ(verdict_with(other), Verdict::skip);
}

TEST(EvaluateLog, AnotherLogJudgesOnlyWhereTheReferenceAgreesWithIt) {
  LoggedUnit log = logged_rate_unit();
  EXPECT_EQ(result_of(log).result.verdict, Verdict::pass);
  EXPECT_EQ(result_of(log, "fault:cascade-i-missing").result.verdict, Verdict::fail);
  add_integral(log);
  const LogResult found = result_of(log);
  EXPECT_EQ(found.result.verdict, Verdict::skip);
  EXPECT_THAT(found.result.reason,
              HasSubstr("only 0.0% of the reference's vehicle_torque_setpoint are within 0.0001 of "
                        "the log: the log lacks samples"));
  // Not even the thrust, which agrees.
  EXPECT_EQ(found.topics[1].topic, "vehicle_thrust_setpoint");
  EXPECT_TRUE(found.topics[1].agrees({}));
  EXPECT_NE(found.topics[1].not_judged, "");
  log.begins_in_flight = true;
  EXPECT_THAT(result_of(log).result.reason, HasSubstr("the log begins in flight"));
}

// A port that takes any name of a profile for its own.
class OfAnyProfile final : public PortHost {
 public:
  const Declarations& declarations() const override { return host_.declarations(); }
  std::optional<PortFault> drive(const ModuleUnderTest& subject, Trace& trace) override {
    return host_.drive({law_of_log, subject.module}, trace);
  }
  Result<Flown> fly(const FlightPlan& plan) override { return host_.fly(plan); }
  Result<LiveFlight> fly_live(const LivePlan&, const LiveWatch&) override {
    return fail("no live flights");
  }
  Result<StepTimes> time_steps(const ModuleUnderTest& wanted, const Trace& inputs,
                               bool with_stack) override {
    return host_.time_steps(wanted, inputs, with_stack);
  }
  bool supports(const std::string& /*wanted*/) override { return true; }

 private:
  InProcessHost host_{open_builtin()};
};

TEST(EvaluateLog, ALogOfAnotherLawIsBelieved) {
  LoggedUnit log = logged_rate_unit();
  OfAnyProfile host;
  EXPECT_EQ(evaluate_log(log, "our-law", host, {})->result.verdict, Verdict::pass);
  add_integral(log);
  EXPECT_EQ(evaluate_log(log, "our-law", host, {})->result.verdict, Verdict::fail);
}

TEST(EvaluateLog, ASparseLogDoesNotJudge) {
  LoggedUnit log = logged_rate_unit();
  log.has_every_step = false;
  log.not_judged = "too sparse";
  const LogResult found = result_of(log, "fault:cascade-i-missing");
  EXPECT_EQ(found.result.verdict, Verdict::skip);
  EXPECT_THAT(found.result.reason, HasSubstr("too sparse; no single step has all its inputs"));
}

// The log has every sixteenth step of a rate unit of 800 Hz, and the setpoints of these steps.
LoggedUnit sparse_log() {
  LoggedUnit every_step = log_of(Module::rate_unit, "vehicle_angular_velocity");
  for (std::uint64_t tick = 0; tick < 1600; ++tick) {
    Sample sample;
    const float time_s = 1.25e-3F * static_cast<float>(tick);
    attest_rate_inputs& in = sample.rate_in;
    in.timestamp = 5'000'000 + 1'250 * tick;
    in.updated = tick == 0 ? 0xff : ATTEST_RATE_UPDATED_VEHICLE_RATES_SETPOINT;
    in.vehicle_angular_velocity.timestamp_sample = in.timestamp - 300;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      in.vehicle_angular_velocity.xyz[axis] = std::sin((20 + static_cast<float>(axis)) * time_s);
    }
    in.vehicle_rates_setpoint = {0.5F, -0.25F, 0.125F, {0, 0, -0.5F - 0.1F * time_s}};
    in.vehicle_control_mode = {1, 0, 1, 1};
    in.vehicle_status.is_rotary_wing = 1;
    every_step.trace.samples.push_back(sample);
  }
  InProcessHost reference(open_builtin());
  EXPECT_FALSE(reference.drive({law_of_log, Module::rate_unit}, every_step.trace));
  LoggedUnit log = log_of(Module::rate_unit, "vehicle_angular_velocity");
  for (std::size_t tick = 16; tick < 1600; tick += 16) {
    log.trace.samples.push_back(every_step.trace.samples[tick]);
    log.setpoints.push_back({Known::all, every_step.trace.samples[tick].in.timestamp - 1000});
  }
  log.trace.samples.front().in.updated = 0xff;
  const std::size_t ticks = log.trace.samples.size();
  for (const char* topic : {"vehicle_torque_setpoint", "vehicle_thrust_setpoint",
                            "rate_ctrl_status", "vehicle_rates_setpoint"}) {
    log.outputs.push_back({topic, ticks, ticks, 0});
  }
  log.not_judged = "too sparse";
  log.period_us = 1250;
  return log;
}

TEST(EvaluateLog, ASparseLogJudgesItsSingleSteps) {
  const LoggedUnit log = sparse_log();
  const LogResult right = result_of(log);
  EXPECT_EQ(right.result.verdict, Verdict::pass) << right.result.reason;
  ASSERT_TRUE(right.single_steps);
  EXPECT_EQ(right.single_steps->with_given_setpoint, 99u);
  ASSERT_EQ(right.topics.size(), 2u);
  EXPECT_EQ(right.topics[0].topic, "vehicle_torque_setpoint");
  EXPECT_EQ(right.topics[0].condition, "setpoint younger than 1.1 ms");
  EXPECT_EQ(right.topics[0].paired, 99u);
  EXPECT_LT(right.topics[0].largest, 1e-6);  // with the integral that the step used
  // A single step does not show what the integral does.
  for (const char* fault : {"i-missing", "integral-on-the-ground", "disarmed-keeps-integral"}) {
    const std::string port = std::string("fault:cascade-") + fault;
    EXPECT_EQ(result_of(log, port.c_str()).result.verdict, Verdict::pass) << fault;
  }
  EXPECT_EQ(result_of(log, "fault:cascade-rate-in-degrees").result.verdict, Verdict::fail);
}

TEST(EvaluateLog, TheWorstSingleStepHasItsTime) {
  const LoggedUnit log = sparse_log();
  const LogResult wrong = result_of(log, "fault:cascade-rate-in-degrees");
  ASSERT_TRUE(wrong.topics[0].worst);
  EXPECT_EQ(wrong.topics[0].worst->timestamp_us,
            log.trace.samples[wrong.topics[0].worst->tick].in.timestamp);
}

TEST(EvaluateLog, TheReasonOfAPortsFaultStays) {
  InProcessHost host(open_builtin());
  const LogResult found = evaluate_log(sparse_log(), "our-law", host, {}).value();
  EXPECT_NE(found.result.verdict, Verdict::pass);
  EXPECT_THAT(found.result.reason, testing::Not(HasSubstr("no single step")));
  EXPECT_FALSE(found.single_steps);
}

TEST(EvaluateLog, TheReferenceShowsUpToWhichAgeSetpointsWereInUse) {
  LoggedUnit log = sparse_log();
  for (std::size_t tick = 0; tick < log.trace.samples.size(); tick += 2) {
    log.setpoints[tick].time_us -= 7000;  // with the same thrust as the setpoint in use
    log.trace.samples[tick].rate_in.vehicle_rates_setpoint.roll += 0.1F;
  }
  const LogResult right = result_of(log);
  EXPECT_EQ(right.result.verdict, Verdict::pass) << right.result.reason;
  EXPECT_EQ(right.single_steps->oldest_us, 1100u);
  EXPECT_EQ(right.single_steps->with_given_setpoint, 49u);
  EXPECT_EQ(right.single_steps->left_out.back().outputs, 50u);
  EXPECT_EQ(right.result.ticks, 49u);
}

TEST(EvaluateLog, WithoutThePeriodTheIntegralIsThatAfterTheStep) {
  LoggedUnit log = sparse_log();
  log.period_us = 0;
  EXPECT_GT(result_of(log).topics[0].largest, 1e-4);
}

TEST(EvaluateLog, SingleStepsOfAnotherLawDoNotJudge) {
  LoggedUnit log = sparse_log();
  for (Sample& sample : log.trace.samples) {
    for (float& torque : sample.rate_out.vehicle_torque_setpoint.xyz) torque *= 1.5F;
  }
  const LogResult found = result_of(log);
  EXPECT_EQ(found.result.verdict, Verdict::skip);
  EXPECT_THAT(found.result.reason, HasSubstr("another law flew, or a modified one"));
}

TEST(EvaluateLog, AFewSingleStepsDoNotJudge) {
  LoggedUnit log = sparse_log();
  log.trace.samples.resize(19);
  log.setpoints.resize(19);
  const LogResult found = result_of(log, "fault:cascade-rate-in-degrees");
  EXPECT_EQ(found.result.verdict, Verdict::skip);
  EXPECT_EQ(found.result.reason,
            "the log has all inputs of only 19 steps, and at least 20 are needed");
}

TEST(EvaluateLog, TicksThatTheLogDoesNotExplainAreLeftOut) {
  LoggedUnit log = logged_rate_unit();
  for (std::size_t tick = 0; tick < 100; ++tick) {
    log.setpoints[tick].known = Known::nothing;
    log.trace.samples[tick].rate_out.vehicle_thrust_setpoint.xyz[2] = 0.5f;
  }
  const LogResult found = result_of(log);
  EXPECT_EQ(found.result.verdict, Verdict::pass);
  EXPECT_EQ(found.topics[1].left_out, 100u);
  EXPECT_EQ(found.topics[1].paired, 300u);
}

TEST(EvaluateLog, AUnitThatTheLogDoesNotHaveIsSkipped) {
  LoggedUnit log;
  log.module = Module::rate_unit;
  log.trace.source = "flight.ulg";
  log.not_judged = "the log has no sample of the topic vehicle_angular_velocity";
  const LogResult found = result_of(log);
  EXPECT_EQ(found.result.verdict, Verdict::skip);
  EXPECT_EQ(found.result.reason, log.not_judged);
}

}  // namespace
}  // namespace attest
