// The functions that make mixer and battery estimate available through attest_actuation.h.
//
// Every function is noexcept: an exception must not cross into a host written in C.
#pragma once

#include <cstring>
#include <new>

#include "controller/actuation/battery_status.hpp"
#include "controller/actuation/mixer.hpp"
#include "controller/attest_actuation.h"

namespace attest::actuation {

// The profile of this mixer and of this estimate.
inline constexpr const char* profile_name = "px4-v1.5.5";

inline bool is_profile(const char* name) {
  return name != nullptr && std::strcmp(name, profile_name) == 0;
}

// The inputs and outputs of the ABI are float, whatever type Scalar is.
template <typename Scalar, typename Stages>
void step_mixer(BasicMixer<Scalar, Stages>& mixer, const attest_mixer_inputs& in,
                attest_mixer_outputs& out) {
  const float* control = in.actuator_controls_0.control;
  Saturation saturation{};
  const auto mixed =
      mixer.mix({Scalar(control[0]), Scalar(control[1]), Scalar(control[2]), Scalar(control[3])},
                Scalar(in.mixer.delta_out_max), saturation);
  for (std::size_t i = 0; i < mixed.size(); ++i) {
    out.actuator_outputs.output[i] = static_cast<float>(mixed[i]);
  }
  out.multirotor_motor_limits = {saturation.lower, saturation.upper, saturation.yaw};
}

template <typename Battery>
void step_battery(Battery& battery, const attest_battery_inputs& in, attest_battery_outputs& out) {
  const auto& [voltage_v, current_a, throttle, armed] = in.battery;
  out.battery_status.scale =
      static_cast<float>(battery.update({voltage_v, current_a, throttle, armed != 0}));
}

template <typename Scalar>
struct MixerTable {
  using Self = BasicMixer<Scalar>;

  static void* create(const char* profile, const char* definition) noexcept {
    if (!is_profile(profile) || definition == nullptr) return nullptr;
    const auto parsed = parse_mixer(definition);
    return parsed ? new (std::nothrow) Self(*parsed) : nullptr;
  }
  static void destroy(void* self) noexcept { delete static_cast<Self*>(self); }
  static int step(void* self, const attest_mixer_inputs* in, attest_mixer_outputs* out) noexcept {
    if (self == nullptr || in == nullptr || out == nullptr) return ATTEST_INVALID;
    step_mixer(*static_cast<Self*>(self), *in, *out);
    return ATTEST_OK;
  }

  static constexpr attest_mixer table{create, destroy, step};
};

// Collects the parameters until the first sample, which creates the estimate.
template <typename Battery>
struct ConfiguredBattery {
  BatteryOptions options;
  std::optional<Battery> battery;
};

template <typename Scalar>
struct BatteryTable {
  using Battery = BasicBatteryStatus<Scalar>;
  using Self = ConfiguredBattery<Battery>;

  static void* create(const char* profile) noexcept {
    return is_profile(profile) ? new (std::nothrow) Self{} : nullptr;
  }
  static void destroy(void* self) noexcept { delete static_cast<Self*>(self); }
  static int set_parameter(void* self, const char* name, float value) noexcept {
    if (self == nullptr || name == nullptr) return ATTEST_INVALID;
    auto& [options, battery] = *static_cast<Self*>(self);
    return !battery && set_battery_parameter(options, name, value) ? ATTEST_OK : ATTEST_INVALID;
  }
  static int step(void* self, const attest_battery_inputs* in,
                  attest_battery_outputs* out) noexcept {
    if (self == nullptr || in == nullptr || out == nullptr) return ATTEST_INVALID;
    auto& [options, battery] = *static_cast<Self*>(self);
    if (!battery) battery.emplace(options);
    step_battery(*battery, *in, *out);
    return ATTEST_OK;
  }

  static constexpr attest_battery_status table{create, destroy, set_parameter, step};
};

// extension() of a unit that has both modules.
template <typename Scalar>
const void* extension(const char* id) noexcept {
  if (id == nullptr) return nullptr;
  if (std::strcmp(id, ATTEST_EXTENSION_MIXER) == 0) return &MixerTable<Scalar>::table;
  if (std::strcmp(id, ATTEST_EXTENSION_BATTERY_STATUS) == 0) return &BatteryTable<Scalar>::table;
  return nullptr;
}

}  // namespace attest::actuation
