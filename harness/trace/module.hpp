// The modules of a flight controller as data: where the inputs and outputs of each are in a Sample,
// and how the modules differ. module_table.cpp has the rows.
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "controller/attest_actuation.h"
#include "controller/attest_cascade.h"
#include "controller/attest_law.h"
#include "controller/attest_unit.h"

namespace attest {

// What a port steps: the controller of attest_unit.h, or one of its extensions.
enum class Module : std::uint8_t {
  mc_att_control,
  mixer,
  battery_status,
  attitude_unit,
  rate_unit,
  attitude_law,
  rate_law
};
inline constexpr auto module_count = static_cast<std::size_t>(Module::rate_law) + 1;
using ModuleSet = std::bitset<module_count>;
inline ModuleSet only(Module module) { return ModuleSet().set(static_cast<std::size_t>(module)); }
inline bool contains(const ModuleSet& set, Module module) {
  return set[static_cast<std::size_t>(module)];
}

// The stage of the law that writes an output; `input` for an input. The order is that of the data
// flow within a step, of all modules: the only place for it. If the outputs of several stages
// deviate in one step, the mistake is in the first of them, or before it.
enum class Stage : std::uint8_t {
  input,
  sticks,
  attitude_law,
  rate_law,    // uses the integrals of the step before
  integrator,  // moves them
  actuators,   // thrust, scaling by the battery, landing gear
  mixer,
  battery_status
};
inline constexpr auto stage_count = static_cast<std::size_t>(Stage::battery_status) + 1;
using StageSet = std::bitset<stage_count>;  // by enumerator
inline StageSet only(Stage stage) { return StageSet().set(static_cast<std::size_t>(stage)); }
inline bool contains(const StageSet& set, Stage stage) {
  return set[static_cast<std::size_t>(stage)];
}

// The inputs and outputs of one step of one module. Those of the other modules are zero, except the
// timestamp in `in`.
//
// The units (controller, attitude unit, rate unit) and the pure laws share the memory of their
// structs, because a sample is of one of them. Their inputs begin with the same members, so
// `in.timestamp` is valid for each of them, and `in.updated` for each unit.
struct Sample {
  template <typename Inputs>
  struct Timed {
    std::uint64_t timestamp;  // that of the tick: a law has no clock
    Inputs in;
  };
  union {
    attest_inputs in;  // its timestamp is that of mixer and battery estimate, too
    attest_attitude_inputs attitude_in;
    attest_rate_inputs rate_in;
    Timed<attest_attitude_law_inputs> attitude_law;
    Timed<attest_rate_law_inputs> rate_law;
  };
  attest_mixer_inputs mixer_in;
  attest_battery_inputs battery_in;
  union {
    attest_outputs out;
    attest_attitude_outputs attitude_out;
    attest_rate_outputs rate_out;
    attest_attitude_law_outputs attitude_law_out;
    attest_rate_law_outputs rate_law_out;
  };
  attest_mixer_outputs mixer_out;
  attest_battery_outputs battery_out;

  // All zero.
  Sample() { std::memset(static_cast<void*>(this), 0, sizeof *this); }

  // The bytes of the outputs of all modules.
  std::span<const std::byte> outputs() const;
  std::span<std::byte> outputs();
  void copy_outputs(const Sample& from);
  void clear_outputs();
};

inline constexpr std::size_t outputs_size = sizeof(Sample) - offsetof(Sample, out);

// The place of an ABI struct in a Sample.
struct Block {
  std::size_t offset, size;  // [bytes]

  const void* in(const Sample& sample) const {
    return reinterpret_cast<const std::byte*>(&sample) + offset;
  }
  void* in(Sample& sample) const { return reinterpret_cast<std::byte*>(&sample) + offset; }

  // Those of all samples, one after the other.
  std::vector<std::byte> copy(std::span<const Sample> samples) const;
  // REQUIRES: `copied` has `size` bytes for each sample.
  void paste(std::span<const std::byte> copied, std::span<Sample> samples) const;
};

// The functions of a module's table in the ABI, with one signature for all modules. `table` is the
// table that a port has: attest_unit, or that of the module's extension.
struct ModuleAbi {
  bool (*is_complete)(const void* table);  // no function is null
  void* (*create)(const void* table, const char* profile, const char* definition);
  void (*destroy)(const void* table, void* self);
  int (*set_parameter)(const void* table, void* self, const char* name, float value);
  int (*step)(const void* table, void* self, const void* in, void* out);
};

// The profiles that have a module.
enum class Profiles : std::uint8_t { with_controller, only_v1_5_5, with_cascade, all };

struct ModuleInfo {
  Module module;
  std::string_view name;   // "battery_status"
  std::string_view title;  // for messages: "battery estimate"
  const char* extension;   // the id that has it: ATTEST_EXTENSION_MIXER; null: controller
  Block in, out;
  ModuleAbi abi;
  std::string_view case_table = {};  // that makes a case one of the module; empty: `module = NAME`
  std::span<const int> default_rates_hz = {};  // of open-loop cases; empty: standard_rates()
  Profiles profiles = Profiles::with_controller;
  // Only of a unit. Its inputs have `updated`: a bit for each topic that is new.
  std::string_view step_topic = {};      // the input that is new at every step, without a bit
  std::string_view setpoint_topic = {};  // the input that the law follows
  Block sampled = {};                    // the time from which the law computes its dt [us]
  Block armed = {};                      // the flag that arms the motors, in the inputs

  Block all_inputs() const { return {0, in.offset + in.size}; }  // with the timestamp
  // A port needs all units of a profile to conform to it. Other modules are optional.
  bool is_unit() const { return !step_topic.empty(); }
  bool is_law() const { return profiles == Profiles::all; }  // of attest_law.h
  bool has_law() const { return is_unit() || is_law(); }     // not mixer and battery estimate
  bool is_of_cascade() const { return profiles == Profiles::with_cascade; }
  // REQUIRES: a unit.
  std::uint64_t sampled_us(const Sample& sample) const {
    return *static_cast<const std::uint64_t*>(sampled.in(sample));
  }
  bool is_armed(const Sample& sample) const {
    return *static_cast<const std::uint8_t*>(armed.in(sample)) != 0;
  }
};

// In the order of Module.
std::span<const ModuleInfo> modules();
const ModuleInfo& info_of(Module module);
std::string_view name_of(Module module);
std::optional<Module> module_named(std::string_view name);
std::vector<std::string_view> names_of(const ModuleSet& modules);

}  // namespace attest
