// The only table of signals (its rows: channel_table.cpp). CSV columns, case keys and report lines
// all take their names from it. A channel is a member of Sample (or one bit of it), found by its
// offset, so the table always agrees with the ABI structs.
//
// Channels of two modules may have the same name, because a topic may go to both. So a name
// identifies a channel only within a module. Units share memory in Sample (module.hpp), so only the
// channels of a sample's own module have a meaning.
//
// Names are `in/<topic>.<field>` and `out/<topic>.<field>`; `in/updated.<topic>` are the bits of
// `updated`, a member of the units' inputs. `timestamp` has no prefix. Parameters are not channels:
// they are the columns `in/parameter.<NAME>` (trace.hpp).
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "harness/trace/module.hpp"

namespace attest {

enum class ChannelType : std::uint8_t { u64, f32, u8, bit };

// The kind of value in a channel. It determines the tolerance (compare/tolerance.hpp) and the unit.
enum class Quantity : std::uint8_t {
  time,                  // us
  duration,              // s
  flag,                  // 0 false, anything else true
  count,                 // 0..255: a counter or a state
  quaternion,            // dimensionless
  angle,                 // rad
  rate,                  // rad/s
  angular_acceleration,  // rad/s^2
  thrust,                // 0..1; -1..1 where it is a vector
  stick,                 // -1..1
  control,               // dimensionless: actuator control, torque or thrust
  integral,              // dimensionless, of the rate law
  scale,                 // dimensionless
  motor,                 // -1 stopped .. 1 full
  voltage,               // V
  current,               // A
};

struct Channel {
  std::string_view name;  // with its prefix
  ChannelType type;
  Quantity quantity;
  Module module;  // timestamp belongs to all modules, although it has mc_att_control here
  Stage stage;
  std::size_t offset;  // of the member in Sample [bytes]
  std::uint32_t bit;   // for ChannelType::bit, its mask in `updated`; 0 for other types

  bool is_output() const { return stage != Stage::input; }
  // "vehicle_status" and "armed" of "in/vehicle_status.armed". The bit "in/updated.vehicle_status"
  // has the same topic, and the field "updated". `timestamp` has its name as both.
  std::string_view topic() const;
  std::string_view field() const;
  bool is_published_flag() const { return is_output() && field() == "published"; }
};

// All channels in column order: timestamp, then for each module its inputs, its in/updated bits and
// its outputs.
std::span<const Channel> channels();
inline constexpr std::size_t timestamp_channel = 0;  // index into channels()
inline constexpr std::size_t max_channels = 320;     // there are at most so many
using ChannelSet = std::bitset<max_channels>;        // by index into channels()

// Index into channels(); empty when the module has no such name.
std::optional<std::size_t> find_channel(Module module, std::string_view name);

inline constexpr std::string_view parameter_prefix = "in/parameter.";
// "MC_ROLL_P" for "in/parameter.MC_ROLL_P"; empty for other names.
std::optional<std::string_view> parameter_of(std::string_view column);

// The channels of a module whose name begins with `prefix`, for example "out/". Without a prefix:
// all channels of the module, and timestamp.
ChannelSet channels_of(Module module, std::string_view prefix = "");

// The module of the first of these channels, without timestamp; mc_att_control if there is none.
Module module_of(const ChannelSet& channels);

// The outputs of a set, by stage, and within a stage in column order.
std::vector<std::size_t> outputs_by_stage(const ChannelSet& set);

// The channels of that name, one for each module that has it. There is only one timestamp.
ChannelSet channels_named(std::string_view name);
// The names of the channels of a set, each once.
std::vector<std::string_view> names_of(const ChannelSet& set);

// The module that has the most of these names, for example of a file's columns. At a tie, the first
// module; mc_att_control if no module has any.
Module module_with(std::span<const std::string> names);

// The index of in/updated.<topic>. REQUIRES: the module has this bit.
std::size_t updated_channel(Module module, std::string_view topic);
// The topics that have a bit in `updated`, in column order: "vehicle_attitude_setpoint", ...
std::vector<std::string_view> updated_topics(Module module);

std::string_view unit_of(Quantity quantity);  // "rad/s"; empty for dimensionless
std::string_view name_of(Stage stage);        // "attitude law"
std::optional<Stage> stage_named(std::string_view name);
std::vector<std::string_view> names_of(const StageSet& stages);

// The bytes of a member. REQUIRES: T has its type.
template <typename T>
T value_at(const Sample& sample, std::size_t offset) {
  T value;
  std::memcpy(&value, reinterpret_cast<const char*>(&sample) + offset, sizeof value);
  return value;
}

// Reads a member as double: exact for f32, u8 and bit; for u64 up to 2^53 (285 years of us).
inline double value_of(const Channel& channel, const Sample& sample) {
  switch (channel.type) {
    case ChannelType::u64:
      return static_cast<double>(value_at<std::uint64_t>(sample, channel.offset));
    case ChannelType::f32:
      return static_cast<double>(value_at<float>(sample, channel.offset));
    case ChannelType::u8:
      return value_at<std::uint8_t>(sample, channel.offset);
    case ChannelType::bit:
      return (value_at<std::uint32_t>(sample, channel.offset) & channel.bit) != 0 ? 1 : 0;
  }
  return 0;
}
// Compares bits; every NaN equals every NaN.
bool same_bits(const Channel& channel, const Sample& a, const Sample& b);
// REQUIRES: 0 <= value < 2^53 for u64, an integer 0..255 for u8; any value for f32 and bit.
void set_value(const Channel& channel, Sample& sample, double value);
void copy_value(const Channel& channel, const Sample& from, Sample& to);  // every bit of it
float float_of(const Channel& channel, const Sample& sample);             // REQUIRES: type f32
std::uint64_t integer_of(const Channel& channel, const Sample& sample);   // REQUIRES: type u64
// REQUIRES: type u64, or type u8 with `value` at most 255.
void set_integer(const Channel& channel, Sample& sample, std::uint64_t value);

}  // namespace attest
