#include "harness/trace/channels.hpp"

#include <array>
#include <cstring>

namespace attest {
namespace {

constexpr Channel number(std::string_view name, Quantity quantity, Module module, Stage stage,
                         std::size_t offset) {
  return {name, ChannelType::f32, quantity, module, stage, offset, 0};
}

constexpr Channel flag(std::string_view name, Module module, Stage stage, std::size_t offset) {
  return {name, ChannelType::u8, Quantity::flag, module, stage, offset, 0};
}

constexpr Channel updated(std::string_view name, int mask) {
  return {name,
          ChannelType::bit,
          Quantity::flag,
          Module::mc_att_control,
          Stage::input,
          offsetof(Sample, in.updated),
          static_cast<std::uint32_t>(mask)};
}

// The name is made from the member: "in/" #member at offsetof(Sample, in.member).
#define IN(member, quantity)                                                      \
  number("in/" #member, Quantity::quantity, Module::mc_att_control, Stage::input, \
         offsetof(Sample, in.member))
#define FLAG(member) \
  flag("in/" #member, Module::mc_att_control, Stage::input, offsetof(Sample, in.member))
#define OUT(member, quantity, stage)                                               \
  number("out/" #member, Quantity::quantity, Module::mc_att_control, Stage::stage, \
         offsetof(Sample, out.member))
#define PUBLISHED(topic, stage)                                          \
  flag("out/" #topic ".published", Module::mc_att_control, Stage::stage, \
       offsetof(Sample, out.topic.published))

#define MIXER_IN(member, quantity)                                       \
  number("in/" #member, Quantity::quantity, Module::mixer, Stage::input, \
         offsetof(Sample, mixer_in.member))
#define MIXER_OUT(rotor)                                                                          \
  number("out/actuator_outputs.output[" #rotor "]", Quantity::motor, Module::mixer, Stage::mixer, \
         offsetof(Sample, mixer_out.actuator_outputs.output) + sizeof(float) * rotor)
#define MIXER_FLAG(member) \
  flag("out/" #member, Module::mixer, Stage::mixer, offsetof(Sample, mixer_out.member))

#define BATTERY_IN(member, quantity)                                              \
  number("in/" #member, Quantity::quantity, Module::battery_status, Stage::input, \
         offsetof(Sample, battery_in.member))

constexpr std::array<Channel, max_channels> table = {{
    {"timestamp", ChannelType::u64, Quantity::time, Module::mc_att_control, Stage::input,
     offsetof(Sample, in.timestamp), 0},
    IN(control_state.q[0], quaternion),
    IN(control_state.q[1], quaternion),
    IN(control_state.q[2], quaternion),
    IN(control_state.q[3], quaternion),
    IN(control_state.roll_rate, rate),
    IN(control_state.pitch_rate, rate),
    IN(control_state.yaw_rate, rate),
    IN(vehicle_attitude_setpoint.q_d[0], quaternion),
    IN(vehicle_attitude_setpoint.q_d[1], quaternion),
    IN(vehicle_attitude_setpoint.q_d[2], quaternion),
    IN(vehicle_attitude_setpoint.q_d[3], quaternion),
    IN(vehicle_attitude_setpoint.thrust, thrust),
    IN(vehicle_attitude_setpoint.yaw_sp_move_rate, rate),
    FLAG(vehicle_attitude_setpoint.disable_mc_yaw_control),
    IN(vehicle_attitude_setpoint.landing_gear, control),
    IN(vehicle_rates_setpoint.roll, rate),
    IN(vehicle_rates_setpoint.pitch, rate),
    IN(vehicle_rates_setpoint.yaw, rate),
    IN(vehicle_rates_setpoint.thrust, thrust),
    IN(manual_control_setpoint.x, stick),
    IN(manual_control_setpoint.y, stick),
    IN(manual_control_setpoint.z, stick),
    IN(manual_control_setpoint.r, stick),
    FLAG(vehicle_control_mode.flag_control_manual_enabled),
    FLAG(vehicle_control_mode.flag_control_auto_enabled),
    FLAG(vehicle_control_mode.flag_control_rates_enabled),
    FLAG(vehicle_control_mode.flag_control_attitude_enabled),
    FLAG(vehicle_control_mode.flag_control_rattitude_enabled),
    FLAG(vehicle_control_mode.flag_control_velocity_enabled),
    FLAG(actuator_armed.armed),
    FLAG(vehicle_status.is_rotary_wing),
    FLAG(vehicle_status.is_vtol),
    FLAG(multirotor_motor_limits.lower_limit),
    FLAG(multirotor_motor_limits.upper_limit),
    FLAG(multirotor_motor_limits.yaw),
    IN(battery_status.scale, scale),
    updated("in/updated.vehicle_attitude_setpoint", ATTEST_UPDATED_VEHICLE_ATTITUDE_SETPOINT),
    updated("in/updated.vehicle_rates_setpoint", ATTEST_UPDATED_VEHICLE_RATES_SETPOINT),
    updated("in/updated.manual_control_setpoint", ATTEST_UPDATED_MANUAL_CONTROL_SETPOINT),
    updated("in/updated.vehicle_control_mode", ATTEST_UPDATED_VEHICLE_CONTROL_MODE),
    updated("in/updated.actuator_armed", ATTEST_UPDATED_ACTUATOR_ARMED),
    updated("in/updated.vehicle_status", ATTEST_UPDATED_VEHICLE_STATUS),
    updated("in/updated.multirotor_motor_limits", ATTEST_UPDATED_MULTIROTOR_MOTOR_LIMITS),
    updated("in/updated.battery_status", ATTEST_UPDATED_BATTERY_STATUS),
    updated("in/updated.parameter_update", ATTEST_UPDATED_PARAMETER_UPDATE),
    PUBLISHED(vehicle_rates_setpoint, attitude_law),
    OUT(vehicle_rates_setpoint.roll, rate, attitude_law),
    OUT(vehicle_rates_setpoint.pitch, rate, attitude_law),
    OUT(vehicle_rates_setpoint.yaw, rate, attitude_law),
    OUT(vehicle_rates_setpoint.thrust, thrust, attitude_law),
    PUBLISHED(actuator_controls_0, rate_law),
    OUT(actuator_controls_0.control[0], control, rate_law),
    OUT(actuator_controls_0.control[1], control, rate_law),
    OUT(actuator_controls_0.control[2], control, rate_law),
    OUT(actuator_controls_0.control[3], control, rate_law),
    OUT(actuator_controls_0.control[4], control, rate_law),
    OUT(actuator_controls_0.control[5], control, rate_law),
    OUT(actuator_controls_0.control[6], control, rate_law),
    OUT(actuator_controls_0.control[7], control, rate_law),
    PUBLISHED(mc_att_ctrl_status, integrator),
    OUT(mc_att_ctrl_status.roll_rate_integ, integral, integrator),
    OUT(mc_att_ctrl_status.pitch_rate_integ, integral, integrator),
    OUT(mc_att_ctrl_status.yaw_rate_integ, integral, integrator),
    MIXER_IN(actuator_controls_0.control[0], control),
    MIXER_IN(actuator_controls_0.control[1], control),
    MIXER_IN(actuator_controls_0.control[2], control),
    MIXER_IN(actuator_controls_0.control[3], thrust),
    MIXER_IN(mixer.delta_out_max, motor),
    MIXER_OUT(0),
    MIXER_OUT(1),
    MIXER_OUT(2),
    MIXER_OUT(3),
    MIXER_OUT(4),
    MIXER_OUT(5),
    MIXER_OUT(6),
    MIXER_OUT(7),
    MIXER_FLAG(multirotor_motor_limits.lower_limit),
    MIXER_FLAG(multirotor_motor_limits.upper_limit),
    MIXER_FLAG(multirotor_motor_limits.yaw),
    BATTERY_IN(battery.voltage_v, voltage),
    BATTERY_IN(battery.current_a, current),
    BATTERY_IN(battery.throttle, thrust),
    flag("in/battery.armed", Module::battery_status, Stage::input,
         offsetof(Sample, battery_in.battery.armed)),
    number("out/battery_status.scale", Quantity::scale, Module::battery_status,
           Stage::battery_status, offsetof(Sample, battery_out.battery_status.scale)),
}};

#undef IN
#undef FLAG
#undef OUT
#undef PUBLISHED
#undef MIXER_IN
#undef MIXER_OUT
#undef MIXER_FLAG
#undef BATTERY_IN

constexpr std::string_view updated_prefix = "in/updated.";

constexpr std::array<std::string_view, 9> make_updated_topics() {
  std::array<std::string_view, 9> topics;
  std::size_t count = 0;
  for (const Channel& channel : table) {
    if (channel.type != ChannelType::bit) continue;
    topics[count++] = channel.name.substr(updated_prefix.size());
  }
  return topics;
}

constexpr std::array<std::string_view, 9> topics = make_updated_topics();

template <typename T>
T load(const Sample& sample, std::size_t offset) {
  T value;
  std::memcpy(&value, reinterpret_cast<const char*>(&sample) + offset, sizeof value);
  return value;
}

template <typename T>
void store(Sample& sample, std::size_t offset, T value) {
  std::memcpy(reinterpret_cast<char*>(&sample) + offset, &value, sizeof value);
}

}  // namespace

std::span<const Channel> channels() { return table; }

std::optional<std::size_t> find_channel(std::string_view name) {
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (table[i].name == name) return i;
  }
  return std::nullopt;
}

std::optional<std::string_view> parameter_of(std::string_view column) {
  if (!column.starts_with(parameter_prefix)) return std::nullopt;
  column.remove_prefix(parameter_prefix.size());
  if (column.empty()) return std::nullopt;
  return column;
}

ChannelSet channels_of(Module module, std::string_view prefix) {
  ChannelSet set;
  for (std::size_t i = 0; i < table.size(); ++i) {
    const bool is_of_module = i == 0 || table[i].module == module;
    set[i] = is_of_module && table[i].name.starts_with(prefix);
  }
  return set;
}

Module module_of(const ChannelSet& channels) {
  for (std::size_t i = 1; i < table.size(); ++i) {
    if (channels[i]) return table[i].module;
  }
  return Module::mc_att_control;
}

std::span<const std::string_view> updated_topics() { return topics; }

std::string_view unit_of(Quantity quantity) {
  switch (quantity) {
    case Quantity::time:
      return "us";
    case Quantity::rate:
      return "rad/s";
    case Quantity::voltage:
      return "V";
    case Quantity::current:
      return "A";
    default:
      return "";
  }
}

std::string_view name_of(Stage stage) {
  switch (stage) {
    case Stage::input:
      return "input";
    case Stage::attitude_law:
      return "attitude law";
    case Stage::rate_law:
      return "rate law";
    case Stage::integrator:
      return "integrator";
    case Stage::mixer:
      return "mixer";
    case Stage::battery_status:
      return "battery status";
  }
  return "";
}

double value_of(const Channel& channel, const Sample& sample) {
  switch (channel.type) {
    case ChannelType::u64:
      return static_cast<double>(load<std::uint64_t>(sample, channel.offset));
    case ChannelType::f32:
      return static_cast<double>(load<float>(sample, channel.offset));
    case ChannelType::u8:
      return load<std::uint8_t>(sample, channel.offset);
    case ChannelType::bit:
      return (load<std::uint32_t>(sample, channel.offset) & channel.bit) != 0 ? 1 : 0;
  }
  return 0;
}

void set_value(const Channel& channel, Sample& sample, double value) {
  switch (channel.type) {
    case ChannelType::u64:
      return store(sample, channel.offset, static_cast<std::uint64_t>(value));
    case ChannelType::f32:
      return store(sample, channel.offset, static_cast<float>(value));
    case ChannelType::u8:
      return store(sample, channel.offset, static_cast<std::uint8_t>(value));
    case ChannelType::bit: {
      const auto word = load<std::uint32_t>(sample, channel.offset);
      const std::uint32_t cleared = word & ~channel.bit;
      return store(sample, channel.offset, value != 0 ? cleared | channel.bit : cleared);
    }
  }
}

float float_of(const Channel& channel, const Sample& sample) {
  return load<float>(sample, channel.offset);
}

}  // namespace attest
