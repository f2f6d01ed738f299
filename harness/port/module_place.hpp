// Where in a sample the inputs and outputs of a module are.
#pragma once

#include "harness/port/port.hpp"
#include "harness/trace/channels.hpp"

namespace attest {

// ModuleUnit is Unit, MixerUnit or BatteryUnit.
template <typename ModuleUnit>
struct ModulePlace;

template <>
struct ModulePlace<Unit> {
  static constexpr Module module = Module::mc_att_control;
  static constexpr auto in = &Sample::in;
  static constexpr auto out = &Sample::out;
};

template <>
struct ModulePlace<MixerUnit> {
  static constexpr Module module = Module::mixer;
  static constexpr auto in = &Sample::mixer_in;
  static constexpr auto out = &Sample::mixer_out;
};

template <>
struct ModulePlace<BatteryUnit> {
  static constexpr Module module = Module::battery_status;
  static constexpr auto in = &Sample::battery_in;
  static constexpr auto out = &Sample::battery_out;
};

}  // namespace attest
