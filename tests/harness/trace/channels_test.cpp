#include "harness/trace/channels.hpp"

#include <cmath>
#include <cstdint>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/harness/trace/sheet.hpp"

namespace attest {
namespace {

using testing::ElementsAre;

// Of the first module that has one of that name.
const Channel& channel(std::string_view name) {
  const ChannelSet named = channels_named(name);
  if (named.none()) throw std::invalid_argument(std::string(name));
  return channels()[named._Find_first()];
}

std::vector<Channel> channels_in(Module module) {
  const ChannelSet set = channels_of(module);
  std::vector<Channel> own;
  for (std::size_t i = 0; i < channels().size(); ++i) {
    if (set[i]) own.push_back(channels()[i]);
  }
  return own;
}

TEST(Channels, AreTheColumnsOfTheRecordedFilesInTheirOrder) {
  // Those files leave out three controls that are always zero.
  const std::string text = Sheet::recorded().text();
  std::string names;
  for (const Channel& c : channels()) {
    if (c.module != Module::mc_att_control) continue;
    const std::string_view name = c.name;
    const bool left_out = name.ends_with("control[4]") || name.ends_with("control[5]") ||
                          name.ends_with("control[6]");
    if (!left_out) names.append(name).append(",");
  }
  names.pop_back();
  EXPECT_EQ(names, text.substr(0, text.find('\n')));
  EXPECT_EQ(channels().size(), 289u);
}

// How many bytes of the module's structs belong to a channel. No byte may belong to two.
std::size_t bytes_with_a_channel(Module module) {
  std::multiset<std::size_t> bytes;
  for (const Channel& c : channels_in(module)) {
    if (c.type == ChannelType::bit || c.module != module) continue;
    const std::size_t size = c.type == ChannelType::u64 ? 8 : c.type == ChannelType::f32 ? 4 : 1;
    for (std::size_t i = 0; i < size; ++i) bytes.insert(c.offset + i);
  }
  const std::set<std::size_t> distinct(bytes.begin(), bytes.end());
  EXPECT_EQ(distinct.size(), bytes.size()) << name_of(module);
  return distinct.size();
}

TEST(Channels, CoverEveryByteOfTheAbiOnce) {
  // All but padding: a member without a channel would be neither recorded nor compared.
  // 120 bytes of inputs and 72 of outputs, less `updated` (4) and the paddings: 3 after
  // disable_mc_yaw_control, and 3 after each `published`.
  EXPECT_EQ(bytes_with_a_channel(Module::mc_att_control), 192u - 4u - 4u * 3u);
  EXPECT_EQ(bytes_with_a_channel(Module::mixer), 56u - 1u);
  EXPECT_EQ(bytes_with_a_channel(Module::battery_status), 20u - 3u);  // 3 after `armed`
  // 192 + 64, less the first 16 (timestamp, updated, reserved) and the paddings: 7 after
  // quat_reset_counter, 3 after is_vtol_tailsitter, 3 after `state`, 3 after
  // heading_good_for_control, 3 after `valid`, 2 at the end; 3 after each `published`.
  EXPECT_EQ(bytes_with_a_channel(Module::attitude_unit), 256u - 16u - 21u - 2u * 3u);
  // 120 + 76, less the first 16, 3 after each of torque_setpoint_achieved and `connected`, 1 at the
  // end, and 3 after each `published`.
  EXPECT_EQ(bytes_with_a_channel(Module::rate_unit), 196u - 16u - 7u - 4u * 3u);
  // 104 + 12, less 4 after yaw_sp_move_rate and 7 after `weathervane`.
  EXPECT_EQ(bytes_with_a_channel(Module::attitude_law), 116u - 4u - 7u);
  // 152 + 24, less 2 after `reset` and 3 at the end of the inputs.
  EXPECT_EQ(bytes_with_a_channel(Module::rate_law), 176u - 2u - 3u);
}

TEST(Channels, OfAModuleHaveDistinctNames) {
  for (const ModuleInfo& info : modules()) {
    std::set<std::string_view> names;
    for (const Channel& c : channels_in(info.module)) {
      EXPECT_TRUE(names.insert(c.name).second) << c.name;
    }
  }
}

TEST(Channels, OfTheSameNameHaveTheSameType) {
  for (const Channel& c : channels()) EXPECT_EQ(channel(c.name).type, c.type) << c.name;
}

TEST(Channels, AreFoundByName) {
  for (const ModuleInfo& info : modules()) EXPECT_EQ(find_channel(info.module, "timestamp"), 0u);
  EXPECT_FALSE(find_channel(Module::rate_unit, "in/vehicle_attitude.q[0]"));
  EXPECT_TRUE(find_channel(Module::attitude_unit, "in/vehicle_attitude.q[0]"));
  EXPECT_EQ(channel("in/control_state.q[3]").name, "in/control_state.q[3]");
  EXPECT_FALSE(find_channel(Module::mc_att_control, "in/control_state.q[4]"));
  EXPECT_FALSE(find_channel(Module::mc_att_control, "control_state.q[3]"));
  EXPECT_EQ(channel("out/actuator_outputs.output[7]").module, Module::mixer);
  EXPECT_FALSE(find_channel(Module::mc_att_control, "in/parameter.MC_ROLL_P"));
  EXPECT_FALSE(find_channel(Module::mc_att_control, ""));
}

TEST(Channels, AreTheirMembers) {
  Sample sample{};
  sample.in.timestamp = 5;
  sample.in.control_state.q[2] = 0.25f;
  sample.in.vehicle_status.is_vtol = 7;
  sample.in.updated = ATTEST_UPDATED_BATTERY_STATUS;
  sample.out.actuator_controls_0.control[7] = -1.5f;
  sample.out.mc_att_ctrl_status.published = 1;
  EXPECT_EQ(value_of(channel("timestamp"), sample), 5);
  EXPECT_EQ(value_of(channel("in/control_state.q[2]"), sample), 0.25);
  EXPECT_EQ(float_of(channel("in/control_state.q[2]"), sample), 0.25f);
  EXPECT_EQ(value_of(channel("in/vehicle_status.is_vtol"), sample), 7);
  EXPECT_EQ(value_of(channel("in/updated.battery_status"), sample), 1);
  EXPECT_EQ(value_of(channel("in/updated.vehicle_status"), sample), 0);
  EXPECT_EQ(value_of(channel("out/actuator_controls_0.control[7]"), sample), -1.5);
  EXPECT_EQ(value_of(channel("out/mc_att_ctrl_status.published"), sample), 1);
}

TEST(Channels, ReadBackWhatWasSetAndNothingElseChanges) {
  for (const ModuleInfo& info : modules()) {
    const std::vector<Channel> own = channels_in(info.module);
    for (std::size_t i = 0; i < own.size(); ++i) {
      Sample sample{};
      set_value(own[i], sample, 1);
      for (std::size_t j = 0; j < own.size(); ++j) {
        EXPECT_EQ(value_of(own[j], sample), i == j ? 1 : 0) << own[j].name;
      }
      set_value(own[i], sample, 0);
      EXPECT_EQ(value_of(own[i], sample), 0);
    }
  }
}

TEST(Channels, KeepNumbersThatAreNone) {
  Sample sample{};
  const Channel& scale = channel("in/battery_status.scale");
  set_value(scale, sample, std::nan(""));
  EXPECT_TRUE(std::isnan(value_of(scale, sample)));
  set_value(scale, sample, -0.0);
  EXPECT_TRUE(std::signbit(value_of(scale, sample)));
}

TEST(Channels, AreComparedToTheBit) {
  Sample a{}, b{};
  const Channel& time = channel("timestamp");
  constexpr std::uint64_t beyond_double = (std::uint64_t{1} << 53) + 1;
  set_integer(time, a, beyond_double);
  set_integer(time, b, beyond_double - 1);
  EXPECT_FALSE(same_bits(time, a, b));
  set_integer(time, b, beyond_double);
  EXPECT_TRUE(same_bits(time, a, b));
  const Channel& scale = channel("in/battery_status.scale");
  set_value(scale, a, 0.0);
  set_value(scale, b, -0.0);
  EXPECT_FALSE(same_bits(scale, a, b));
}

TEST(Channels, AreCopiedToTheBit) {
  Sample from{}, to{};
  set_integer(channel("timestamp"), from, (std::uint64_t{1} << 53) + 1);
  set_value(channel("in/battery_status.scale"), from, -0.0);
  for (const char* name : {"timestamp", "in/battery_status.scale"}) {
    copy_value(channel(name), from, to);
    EXPECT_TRUE(same_bits(channel(name), from, to)) << name;
  }
}

TEST(Channels, HaveTheStageThatWritesThem) {
  EXPECT_EQ(channel("in/vehicle_rates_setpoint.roll").stage, Stage::input);
  EXPECT_EQ(channel("out/vehicle_rates_setpoint.roll").stage, Stage::attitude_law);
  EXPECT_EQ(channel("out/actuator_controls_0.control[0]").stage, Stage::rate_law);
  EXPECT_EQ(channel("out/mc_att_ctrl_status.yaw_rate_integ").stage, Stage::integrator);
  EXPECT_EQ(channel("out/actuator_controls_0.control[3]").stage, Stage::actuators);
  for (const Channel& c : channels()) EXPECT_EQ(c.is_output(), c.name.starts_with("out/"));
  EXPECT_EQ(name_of(Stage::attitude_law), "attitude law");
  for (std::size_t i = 0; i < stage_count; ++i) {
    EXPECT_EQ(stage_named(name_of(static_cast<Stage>(i))), static_cast<Stage>(i));
  }
  EXPECT_FALSE(stage_named("torsion"));
}

TEST(Channels, HaveUnits) {
  EXPECT_EQ(unit_of(channel("timestamp").quantity), "us");
  EXPECT_EQ(unit_of(channel("out/vehicle_rates_setpoint.yaw").quantity), "rad/s");
  EXPECT_EQ(unit_of(channel("out/vehicle_rates_setpoint.thrust").quantity), "");
  EXPECT_EQ(channel("out/vehicle_rates_setpoint.published").quantity, Quantity::flag);
}

TEST(Channels, AreOfOnePart) {
  for (const ModuleInfo& info : modules()) {
    EXPECT_EQ(module_of(channels_of(info.module)), info.module) << info.name;
    EXPECT_TRUE(channels_of(info.module)[0]) << info.name;
  }
}

TEST(Channels, AreChosenByPrefix) {
  EXPECT_EQ(channels_of(Module::mc_att_control).count(), 64u);
  EXPECT_EQ(channels_of(Module::mixer).count(), 17u);
  EXPECT_EQ(channels_of(Module::battery_status).count(), 6u);
  EXPECT_EQ(channels_of(Module::attitude_unit).count(), 71u);
  EXPECT_EQ(channels_of(Module::rate_unit).count(), 58u);
  EXPECT_EQ(channels_of(Module::mc_att_control, "in/").count(), 45u);
  EXPECT_EQ(channels_of(Module::mc_att_control, "out/").count(), 18u);
  EXPECT_EQ(channels_of(Module::mc_att_control, "in/updated.").count(), 9u);
}

TEST(Channels, NameTheTopicsOfTheFreshnessBitsInBitOrder) {
  EXPECT_THAT(
      updated_topics(Module::mc_att_control),
      ElementsAre("vehicle_attitude_setpoint", "vehicle_rates_setpoint", "manual_control_setpoint",
                  "vehicle_control_mode", "actuator_armed", "vehicle_status",
                  "multirotor_motor_limits", "battery_status", "parameter_update"));
  for (std::size_t i = 0; i < updated_topics(Module::mc_att_control).size(); ++i) {
    EXPECT_EQ(channel("in/updated." + std::string(updated_topics(Module::mc_att_control)[i])).bit,
              1u << i);
  }
}

TEST(Channels, ParameterColumnsHaveAPrefix) {
  EXPECT_EQ(parameter_of("in/parameter.MC_ROLL_P"), "MC_ROLL_P");
  EXPECT_FALSE(parameter_of("in/parameter."));
  EXPECT_FALSE(parameter_of("in/battery_status.scale"));
  EXPECT_FALSE(parameter_of("MC_ROLL_P"));
}

TEST(Channels, OutputsHaveTheQuantityOfTheirTopic) {
  for (const Channel& c : channels()) {
    if (!c.is_output() || c.type != ChannelType::f32) continue;
    if (c.module == Module::attitude_unit) continue;  // its thrust may be made of the sticks
    const bool is_thrust = c.name.starts_with("out/vehicle_rates_setpoint.thrust");
    if (c.name.starts_with("out/vehicle_rates_setpoint.")) {
      EXPECT_EQ(c.quantity, is_thrust ? Quantity::thrust : Quantity::rate) << c.name;
    }
    if (c.name.starts_with("out/actuator_controls_0.")) {
      EXPECT_EQ(c.quantity, Quantity::control) << c.name;
    }
    if (c.name.starts_with("out/mc_att_ctrl_status.")) {
      EXPECT_EQ(c.quantity, Quantity::integral) << c.name;
    }
  }
}

TEST(SampleOutputs, OfAllModulesAreClearedAndCopied) {
  for (const ModuleInfo& info : modules()) {
    const std::vector<Channel> own = channels_in(info.module);
    Sample full{}, other{};
    for (const Channel& c : own) set_value(c, full, 1);
    other.copy_outputs(full);
    for (const Channel& c : own) EXPECT_EQ(value_of(c, other), c.is_output() ? 1 : 0) << c.name;
    full.clear_outputs();
    for (const Channel& c : own) EXPECT_EQ(value_of(c, full), c.is_output() ? 0 : 1) << c.name;
  }
}

}  // namespace
}  // namespace attest
