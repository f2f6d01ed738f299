// Which outputs of a log of the controller of v1.5.5 are judged.
#include <gmock/gmock.h>

#include "harness/host/in_process_host.hpp"
#include "harness/port/builtin.hpp"
#include "harness/port/port.hpp"
#include "harness/verify/evaluate_log.hpp"
#include "tests/harness/verify/logged_unit.hpp"

namespace attest {
namespace {

// What a controller logged. Up to a thrust of 0.2 its integrals stay 0.
LoggedUnit logged_controller(float thrust = 0.5f, const char* release = "px4-v1.5.5") {
  LoggedUnit log = log_of(Module::mc_att_control, "control_state");
  for (std::uint64_t tick = 0; tick < 100; ++tick) {
    Sample sample;
    sample.in.timestamp = 5000000 + 4000 * tick;
    sample.in.updated = tick == 0 ? 0xffu : 0u;
    sample.in.control_state.q[0] = 1;
    sample.in.control_state.roll_rate = 0.01f * static_cast<float>(tick);
    sample.in.control_state.yaw_rate = 0.02f * static_cast<float>(tick);
    sample.in.vehicle_attitude_setpoint.q_d[0] = 1;
    sample.in.vehicle_attitude_setpoint.thrust = thrust;
    sample.in.vehicle_control_mode = {1, 0, 1, 1, 0, 0};
    sample.in.actuator_armed.armed = 1;
    sample.in.vehicle_status.is_rotary_wing = 1;
    log.trace.samples.push_back(sample);
  }
  add_outputs(release, {"vehicle_rates_setpoint", "actuator_controls_0", "mc_att_ctrl_status"},
              log);
  return log;
}

TEST(EvaluateControllerLog, ALogOfTheControllerWithEveryStepIsBelieved) {
  LoggedUnit log = logged_controller();
  InProcessHost host(open_builtin());
  EXPECT_EQ(evaluate_log(log, "px4-v1.5.5", host, {})->result.verdict, Verdict::pass);
  for (Sample& sample : log.trace.samples) sample.out.actuator_controls_0.control[0] += 0.1f;
  EXPECT_EQ(evaluate_log(log, "px4-v1.5.5", host, {})->result.verdict, Verdict::fail);
  log.has_every_step = false;
  EXPECT_EQ(evaluate_log(log, "px4-v1.5.5", host, {})->result.verdict, Verdict::pass);
}

TEST(EvaluateControllerLog, ControlsWithoutDTermAreJudgedWhileTheIntegralsAreZero) {
  const auto judged = [](LoggedUnit log, const char* port = "builtin") {
    log.has_every_step = false;
    InProcessHost host(*open_port(port));
    return evaluate_log(log, "px4-v1.5.5", host, {}).value();
  };
  LoggedUnit log = logged_controller(0.1f);
  const LogResult found = judged(log);
  ASSERT_EQ(found.topics.size(), 4u);
  EXPECT_NE(found.topics[1].not_judged, "");
  EXPECT_EQ(found.topics[3].topic, "actuator_controls_0");
  EXPECT_EQ(found.topics[3].condition, "yaw and thrust, while the integrals are 0");
  EXPECT_EQ(found.topics[3].paired, 100u);
  EXPECT_EQ(judged(log, "fault:gyro-yaw-reversed").result.verdict, Verdict::fail);
  for (Sample& sample : log.trace.samples) sample.out.actuator_controls_0.control[0] += 0.1f;
  EXPECT_EQ(judged(log).topics[3].within, 100u) << "roll has a D term";
  log.trace.parameters = {{0, "MC_YAWRATE_D", 0.01f}};
  EXPECT_EQ(judged(log).topics.size(), 3u) << "each axis has a D term";
  EXPECT_EQ(judged(logged_controller(0.5f)).topics.size(), 3u) << "the integrals grow";
  LoggedUnit other = logged_controller(0.1f);
  for (Sample& sample : other.trace.samples) sample.out.actuator_controls_0.control[2] += 0.1f;
  EXPECT_EQ(judged(other).topics.size(), 3u) << "the reference does not agree with the log";
}

// Its feed-forward is of the change of the setpoint since the step before.
TEST(EvaluateControllerLog, AnAxisOfV134WithFeedForwardIsNotJudgedAlone) {
  LoggedUnit log = logged_controller(0.1f, "px4-v1.3.4");
  log.has_every_step = false;
  const auto judged = [&] {
    InProcessHost host(open_builtin());
    return evaluate_log(log, "px4-v1.3.4", host, {}).value();
  };
  ASSERT_EQ(judged().topics.size(), 4u);
  EXPECT_EQ(judged().topics[3].condition, "yaw and thrust, while the integrals are 0");
  log.trace.parameters = {{0, "MC_YAWRATE_FF", 0.1f}};
  EXPECT_EQ(judged().topics.size(), 3u);
}

}  // namespace
}  // namespace attest
