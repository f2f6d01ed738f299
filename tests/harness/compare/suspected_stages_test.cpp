#include "harness/compare/suspected_stages.hpp"

#include <ostream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/compare/compare.hpp"
#include "harness/compare/events.hpp"
#include "harness/compare/gross.hpp"
#include "tests/harness/compare/sample_trace.hpp"

namespace attest {
namespace {

using testing::ElementsAre;

// ---- every pair of stages -----------------------------------------------------------------------

struct Pair {
  Module module;
  Stage earlier, later;
};

std::ostream& operator<<(std::ostream& out, const Pair& pair) {
  return out << info_of(pair.module).name << ": " << name_of(pair.earlier) << ", "
             << name_of(pair.later);
}

std::vector<std::size_t> floats_of(Module module, Stage stage) {
  std::vector<std::size_t> outputs = outputs_by_stage(channels_of(module, "out/"));
  std::erase_if(outputs, [stage](std::size_t i) {
    return channels()[i].stage != stage || channels()[i].type != ChannelType::f32;
  });
  return outputs;
}

// Each two stages of a module that have outputs.
std::vector<Pair> pairs() {
  std::vector<Pair> all;
  for (const ModuleInfo& info : modules()) {
    for (std::size_t a = 0; a < stage_count; ++a) {
      for (std::size_t b = a + 1; b < stage_count; ++b) {
        const Pair pair{info.module, static_cast<Stage>(a), static_cast<Stage>(b)};
        const bool both_have_outputs = !floats_of(pair.module, pair.earlier).empty() &&
                                       !floats_of(pair.module, pair.later).empty();
        if (both_have_outputs) all.push_back(pair);
      }
    }
  }
  return all;
}

// Five ticks in which every topic is published and every value is 0.1.
Trace published_trace(Module module) {
  Trace trace;
  trace.present = channels_of(module);
  trace.samples.resize(5);
  for (std::size_t tick = 0; tick < trace.samples.size(); ++tick) {
    Sample& sample = trace.samples[tick];
    sample.in.timestamp = 4000 * (tick + 1);
    if (module == Module::mc_att_control) {
      sample.in.control_state.q[0] = sample.in.vehicle_attitude_setpoint.q_d[0] = 1;
      sample.in.vehicle_control_mode.flag_control_attitude_enabled = 1;
    } else if (module == Module::attitude_unit) {
      sample.attitude_in.vehicle_attitude.q[0] = 1;
    }
    for (const std::size_t i : outputs_by_stage(trace.present)) {
      set_value(channels()[i], sample, channels()[i].type == ChannelType::f32 ? 0.1 : 1);
    }
  }
  return trace;
}

class StagePairs : public testing::TestWithParam<Pair> {
 protected:
  // Calls `check` with a trace in which one output of each stage is `value` at tick 2.
  template <typename Check>
  void for_each_two_outputs(double value, Check check) {
    const auto [module, earlier, later] = GetParam();
    const Trace want = published_trace(module);
    for (const std::size_t first : floats_of(module, earlier)) {
      for (const std::size_t second : floats_of(module, later)) {
        Trace got = want;
        set_value(channels()[first], got.samples[2], value);
        set_value(channels()[second], got.samples[2], value);
        check(got, want, first);
      }
    }
  }
};

TEST_P(StagePairs, OfDeviationsAtTheSameTickThatOfTheEarlierStageIsFirst) {
  for (const Level level : {Level::numeric, Level::exact}) {
    for_each_two_outputs(9, [level](const Trace& got, const Trace& want, std::size_t earlier) {
      const Comparison comparison = compare(got, want, Tolerances(level));
      ASSERT_TRUE(comparison.first);
      EXPECT_EQ(comparison.first->channel, earlier) << channels()[earlier].name;
      EXPECT_EQ(stage_of(*comparison.first), GetParam().earlier);
    });
  }
}

TEST_P(StagePairs, AtTheLevelEventsToo) {
  for_each_two_outputs(nan, [](const Trace& got, const Trace& want, std::size_t earlier) {
    EXPECT_EQ(first_non_finite_event(got, want)->channel, earlier);
    const Comparison comparison = compare(got, want, Tolerances(Level::events));
    if (!comparison.mismatch.empty()) return;  // a module without events
    EXPECT_EQ(stage_of(*comparison.first), GetParam().earlier);
  });
  for_each_two_outputs(9, [](const Trace& got, const Trace& want, std::size_t earlier) {
    EXPECT_EQ(first_gross_difference(got, want)->channel, earlier);
  });
}

TEST_P(StagePairs, OfValuesThatAreNotFiniteToo) {
  for_each_two_outputs(nan, [](const Trace& got, const Trace& want, std::size_t earlier) {
    EXPECT_EQ(first_non_finite(got, want)->channel, earlier);
  });
}

INSTANTIATE_TEST_SUITE_P(OfAllModules, StagePairs, testing::ValuesIn(pairs()));

TEST(Stages, AreComparedInAllModulesThatHaveSeveral) {
  std::vector<std::string> names;
  for (const Pair& pair : pairs()) names.push_back(testing::PrintToString(pair));
  EXPECT_THAT(
      names,
      ElementsAre("mc_att_control: attitude law, rate law",
                  "mc_att_control: attitude law, integrator",
                  "mc_att_control: attitude law, actuators", "mc_att_control: rate law, integrator",
                  "mc_att_control: rate law, actuators", "mc_att_control: integrator, actuators",
                  "attitude_unit: sticks, attitude law", "rate_unit: sticks, rate law",
                  "rate_unit: sticks, integrator", "rate_unit: sticks, actuators",
                  "rate_unit: rate law, integrator", "rate_unit: rate law, actuators",
                  "rate_unit: integrator, actuators", "rate_law: rate law, integrator"));
}

TEST(Events, AtTheSameTickTheEarlierStageIsFirst) {
  const Trace want = published_trace(Module::rate_unit);
  Trace got = want;
  const auto flag = [](const char* name) { return *find_channel(Module::rate_unit, name); };
  const std::size_t sticks = flag("out/vehicle_rates_setpoint.published");
  for (std::size_t tick = 0; tick < 5; ++tick) {
    set_value(channels()[flag("out/vehicle_torque_setpoint.published")], got.samples[tick], 0);
    set_value(channels()[sticks], got.samples[tick], 0);
  }
  EXPECT_EQ(first_event_difference(got, want)->channel, sticks);
}

// ---- stages that cannot be told apart -----------------------------------------------------------

constexpr const char* rates_sp = "out/vehicle_rates_setpoint.roll";
constexpr const char* control = "out/actuator_controls_0.control[1]";
constexpr const char* thrust = "out/actuator_controls_0.control[3]";
constexpr const char* pitch_integral = "out/mc_att_ctrl_status.pitch_rate_integ";

// The names of the stages of the first deviation if these outputs of the controller deviate.
std::vector<std::string_view> suspected(const Trace& want, std::vector<const char*> deviating) {
  Trace got = want;
  for (const char* const name : deviating) set(got, 2, name, 9);
  return names_of(stages_of(*compare(got, want, Tolerances()).first));
}

void unpublish(Trace& trace, const char* topic) {
  for (std::size_t tick = 0; tick < trace.samples.size(); ++tick) {
    set(trace, tick, std::string("out/") + topic + ".published", 0);
  }
}

TEST(SuspectedStages, OfTheOuterLoopOneStageIsSuspected) {
  const Trace want = sample_trace(4);
  EXPECT_THAT(suspected(want, {rates_sp}), ElementsAre("attitude law"));
  EXPECT_THAT(suspected(want, {pitch_integral, thrust, control, rates_sp}),
              ElementsAre("attitude law"));
}

TEST(SuspectedStages, TheRateLoopSharesValuesThatAreNoOutputs) {
  const Trace want = sample_trace(4);
  EXPECT_THAT(suspected(want, {control}), ElementsAre("rate law"));
  EXPECT_THAT(suspected(want, {pitch_integral}), ElementsAre("integrator"));
  EXPECT_THAT(suspected(want, {thrust}), ElementsAre("actuators"));
  EXPECT_THAT(suspected(want, {control, thrust}), ElementsAre("rate law", "actuators"));
  EXPECT_THAT(suspected(want, {pitch_integral, control}), ElementsAre("rate law", "integrator"));
}

TEST(SuspectedStages, TheBatteryMayScaleTheControls) {
  Trace want = sample_trace(4);
  for (const auto& [scale, scales] : {std::pair{0.0f, false}, {1.0f, false}, {1.1f, true}}) {
    for (Sample& sample : want.samples) sample.in.battery_status.scale = scale;
    EXPECT_EQ(suspected(want, {control}).size(), scales ? 2u : 1u) << scale;
    EXPECT_THAT(suspected(want, {pitch_integral}), ElementsAre("integrator"));
  }
}

TEST(SuspectedStages, InAcroTheSticksGiveTheRatesSetpoint) {
  Trace want = sample_trace(4);
  for (Sample& sample : want.samples) {
    sample.in.vehicle_control_mode = {};
    sample.in.vehicle_control_mode.flag_control_manual_enabled = 1;
  }
  EXPECT_THAT(suspected(want, {rates_sp, control}), ElementsAre("sticks"));
}

TEST(SuspectedStages, InRattitudeTheThrustShowsTheStage) {
  const auto with = [](float stick, float throttle, float thrust_sp) {
    Trace want = sample_trace(4);
    for (Sample& sample : want.samples) {
      sample.in.vehicle_control_mode.flag_control_rattitude_enabled = 1;
      sample.in.manual_control_setpoint.y = stick;
      sample.in.manual_control_setpoint.z = throttle;
      sample.in.vehicle_attitude_setpoint.thrust = thrust_sp;
      sample.out.vehicle_rates_setpoint.thrust = 0.5f;
    }
    return suspected(want, {rates_sp});
  };
  EXPECT_THAT(with(0, 0.5f, 0.5f), ElementsAre("attitude law"));  // no stick is beyond 0
  EXPECT_THAT(with(0.7f, 0.4f, 0.5f), ElementsAre("attitude law"));
  EXPECT_THAT(with(0.7f, 0.5f, 0.4f), ElementsAre("sticks"));
  EXPECT_THAT(with(0.7f, 0.5f, 0.5f), ElementsAre("sticks", "attitude law"));
}

TEST(SuspectedStages, AFlagDoesNotDependOnValuesThatAreNotPublished) {
  Trace want = sample_trace(4);
  for (const char* const topic : {"vehicle_rates_setpoint", "actuator_controls_0"}) {
    unpublish(want, topic);
  }
  EXPECT_THAT(suspected(want, {"out/actuator_controls_0.published"}), ElementsAre("actuators"));
}

TEST(SuspectedStages, AStageThatRunsAndPublishesNothingIsSuspectedToo) {
  Trace want = sample_trace(4);
  unpublish(want, "actuator_controls_0");  // as with the circuit breaker
  EXPECT_THAT(suspected(want, {pitch_integral}), ElementsAre("rate law", "integrator"));
  unpublish(want, "vehicle_rates_setpoint");  // as before the first vehicle_status
  EXPECT_THAT(suspected(want, {pitch_integral}),
              ElementsAre("attitude law", "rate law", "integrator"));
}

TEST(SuspectedStages, AStageThatDoesNotRunIsNotSuspected) {
  Trace want = sample_trace(4);
  for (Sample& sample : want.samples) sample.in.vehicle_control_mode = {};  // offboard rates
  unpublish(want, "vehicle_rates_setpoint");
  EXPECT_THAT(suspected(want, {control}), ElementsAre("rate law"));
}

TEST(SuspectedStages, AStageWhoseOutputsAreNotComparedIsSuspectedToo) {
  Trace got = published_trace(Module::attitude_unit);
  const Trace want = got;
  got.present &= ~channels_of(Module::attitude_unit, "out/vehicle_attitude_setpoint.");
  ChannelSet deviating;
  deviating.set(*find_channel(Module::attitude_unit, "out/vehicle_rates_setpoint.yaw"));
  const Sample& sample = want.samples[2];
  EXPECT_THAT(names_of(suspected_stages(deviating, got.present, sample)),
              ElementsAre("sticks", "attitude law"));
  EXPECT_THAT(names_of(suspected_stages(deviating, want.present, sample)),
              ElementsAre("attitude law"));
}

}  // namespace
}  // namespace attest
