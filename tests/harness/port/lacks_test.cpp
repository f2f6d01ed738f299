#include "harness/port/lacks.hpp"

#include <functional>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/casefile/baseline.hpp"

namespace attest {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

Lacks parsed(const std::vector<std::string>& words) {
  const auto lacks = Lacks::parse(words);
  if (!lacks) throw std::invalid_argument(lacks.error().message);
  return *lacks;
}

TEST(Lacks, AreFeaturesOutputsAndConstants) {
  const Lacks lacks = parsed({"sticks", "rate_ctrl_status", "MC_YAW_FF=0.25"});
  EXPECT_THAT(names_of(lacks.features), ElementsAre("sticks"));
  EXPECT_EQ(lacks.outputs & channels_of(Module::rate_unit, "out/"),
            channels_of(Module::rate_unit, "out/rate_ctrl_status."));
  EXPECT_TRUE((lacks.outputs & channels_of(Module::attitude_unit, "out/")).none());
  ASSERT_NE(lacks.constant("MC_YAW_FF"), nullptr);
  for (const int result : {ATTEST_OK, ATTEST_UNSUPPORTED, ATTEST_INVALID}) {
    const auto ask = [&] { return result; };
    EXPECT_EQ(lacks.constant("MC_YAW_FF")->answer_to(0.25f, ask), ATTEST_OK);
    EXPECT_EQ(lacks.constant("MC_YAW_FF")->answer_to(0.5f, ask),
              result == ATTEST_OK ? ATTEST_OK : ATTEST_UNSUPPORTED);
  }
  EXPECT_EQ(lacks.constant("MC_YAW_P"), nullptr);
}

TEST(Lacks, NameOutputsByTopicSignalAndPattern) {
  const auto names = [](const char* word) { return names_of(parsed({word}).outputs); };
  EXPECT_THAT(names("actuator_controls_0.control[7]"),
              ElementsAre("out/actuator_controls_0.control[7]"));
  EXPECT_EQ(names("out/actuator_controls_0.control[7]"), names("actuator_controls_0.control[7]"));
  EXPECT_THAT(names("actuator_controls_0.control*"), testing::SizeIs(8));
  EXPECT_THAT(names("*_status"), Contains("out/rate_ctrl_status.published"));
  EXPECT_THAT(names("*_status"), Not(Contains("out/actuator_controls_0.published")));
}

TEST(Lacks, OtherWordsAreErrorsWithTheNearestOne) {
  const auto error = [](std::vector<std::string> words) {
    const auto lacks = Lacks::parse(words);
    return lacks ? "" : lacks.error().message;
  };
  EXPECT_THAT(error({"stiks"}), HasSubstr("did you mean `sticks`?"));
  EXPECT_THAT(error({"rate_ctrl_statu"}), HasSubstr("did you mean `rate_ctrl_status`?"));
  EXPECT_THAT(error({"MC_YAW_FFF=1"}), HasSubstr("did you mean `MC_YAW_FF`?"));
  EXPECT_THAT(error({"MC_YAW_FF"}), HasSubstr("write the value of a constant parameter"));
  EXPECT_THAT(error({"MC_YAW_FF=high"}), HasSubstr("a finite number"));
  EXPECT_THAT(error({"MC_YAW_FF=0.5", "MC_YAW_FF=0.6"}), HasSubstr("contradicts MC_YAW_FF=0.5"));
  EXPECT_THAT(error({""}), HasSubstr("is no feature and no output"));
  EXPECT_THAT(error({std::string(201, '*')}), HasSubstr("longer than 200 bytes"));
  EXPECT_THAT(error(std::vector<std::string>(1001, "sticks")), HasSubstr("more than 1000 words"));
  // A pattern of a hostile port takes no long time.
  std::string stars;
  for (int i = 0; i < 60; ++i) stars += "*c";
  EXPECT_THAT(error({stars + "!"}), HasSubstr("is no feature and no output"));
}

// Two ticks of the module with the inputs of the baseline.
Trace baseline_of(Module module) {
  Trace trace;
  trace.present = channels_of(module);
  trace.samples.assign(2, baseline_sample(module));
  for (Sample& sample : trace.samples) {
    if (info_of(module).is_unit()) sample.in.updated = ~0u;  // a law has another input there
  }
  return trace;
}

TEST(Features, AreNotUsedByTheBaseline) {
  for (const auto& [module, profile] : {std::pair{Module::attitude_unit, "px4-v1.16.0"},
                                        std::pair{Module::rate_unit, "px4-v1.16.0"},
                                        std::pair{Module::mc_att_control, "px4-v1.5.5"},
                                        std::pair{Module::attitude_law, "px4-v1.16.0"},
                                        std::pair{Module::rate_law, "px4-v1.5.5"}}) {
    EXPECT_THAT(names_of(features_of(baseline_of(module), profile)), IsEmpty()) << name_of(module);
  }
}

struct Use {
  Module module;
  const char* feature;
  std::function<void(Sample&)> of_last_tick;
};
const Use uses[] = {
    {Module::mc_att_control, "acro",
     [](Sample& s) { s.in.vehicle_control_mode.flag_control_attitude_enabled = 0; }},
    {Module::mc_att_control, "acro",
     [](Sample& s) {
       s.in.vehicle_control_mode.flag_control_rattitude_enabled = 1;
       s.in.manual_control_setpoint.x = 1.5f;
     }},
    {Module::mc_att_control, "offboard_rates",
     [](Sample& s) {
       s.in.vehicle_control_mode.flag_control_attitude_enabled = 0;
       s.in.vehicle_control_mode.flag_control_manual_enabled = 0;
     }},
    {Module::mc_att_control, "mode_changes",
     [](Sample& s) { s.in.vehicle_control_mode.flag_control_auto_enabled = 1; }},
    {Module::mc_att_control, "vtol", [](Sample& s) { s.in.vehicle_status.is_vtol = 1; }},
    {Module::attitude_unit, "autotune",
     [](Sample& s) { s.attitude_in.autotune_attitude_control_status.state = 3; }},
    {Module::attitude_law, "weathervane", [](Sample& s) { s.attitude_law.in.law.weathervane = 1; }},
    {Module::rate_law, "tpa",
     [](Sample& s) {
       s.rate_law.in.rate_gains.tpa_slope = 1;
       s.rate_law.in.rate_gains.tpa_break = 0.2f;
     }},
    {Module::mc_att_control, "saturation", [](Sample& s) { s.in.multirotor_motor_limits.yaw = 4; }},
    {Module::mc_att_control, "yaw_feed_forward",
     [](Sample& s) { s.in.vehicle_attitude_setpoint.yaw_sp_move_rate = -1; }},
    {Module::attitude_unit, "sticks",
     [](Sample& s) {
       auto& mode = s.attitude_in.vehicle_control_mode;
       mode = {};
       mode.flag_control_manual_enabled = mode.flag_control_attitude_enabled = 1;
     }},
    {Module::attitude_unit, "estimator_reset",
     [](Sample& s) { s.attitude_in.vehicle_attitude.quat_reset_counter = 1; }},
    {Module::rate_unit, "saturation",
     [](Sample& s) {
       s.rate_in.control_allocator_status = {{0, 0, -0.1f}, 0};
     }},
    {Module::rate_unit, "landing",
     [](Sample& s) { s.rate_in.vehicle_land_detected.maybe_landed = 1; }},
    {Module::rate_unit, "arming", [](Sample& s) { s.rate_in.vehicle_control_mode.flag_armed = 0; }},
    {Module::rate_unit, "non_finite",
     [](Sample& s) {
       s.rate_in.vehicle_rates_setpoint.yaw = std::numeric_limits<float>::quiet_NaN();
     }},
    {Module::rate_law, "rate_feed_forward", [](Sample& s) { s.rate_law.in.rate_gains.ff[1] = 1; }},
};

TEST(Features, AreUsedIfOneTickUsesThem) {
  for (const auto& [module, feature, of_last_tick] : uses) {
    Trace trace = baseline_of(module);
    of_last_tick(trace.samples.back());
    const bool is_old = module == Module::mc_att_control;
    EXPECT_THAT(names_of(features_of(trace, is_old ? "px4-v1.5.5" : "px4-v1.16.0")),
                Contains(feature));
  }
}

TEST(Features, GoByTheParametersInForce) {
  Trace trace = baseline_of(Module::rate_unit);
  for (Sample& sample : trace.samples) sample.rate_in.battery_status.scale = 1.1f;
  EXPECT_THAT(names_of(features_of(trace, "px4-v1.16.0")), IsEmpty());
  trace.parameters = {{1, "MC_BAT_SCALE_EN", 1}};
  EXPECT_THAT(names_of(features_of(trace, "px4-v1.16.0")),
              ElementsAre("battery", "parameter_changes"));
}

// Its first sample says whether the vehicle is on the ground; the unit takes it as landed before.
TEST(Features, AVehicleOfWhichNothingIsKnownIsLanded) {
  Trace trace = baseline_of(Module::rate_unit);
  for (Sample& sample : trace.samples) sample.rate_in.updated = 0;
  EXPECT_THAT(names_of(features_of(trace, "px4-v1.16.0")), ElementsAre("landing"));
}

}  // namespace
}  // namespace attest
