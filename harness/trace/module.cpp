#include "harness/trace/module.hpp"

#include <algorithm>
#include <array>
#include <cstring>

namespace attest {
namespace {

#define BLOCK(member) \
  Block { offsetof(Sample, member), sizeof(Sample::member) }

constexpr std::array<ModuleInfo, module_count> infos{{
    {Module::mc_att_control, "mc_att_control", "controller", nullptr, BLOCK(in), BLOCK(out),
     "control_state", "vehicle_attitude_setpoint", BLOCK(in.timestamp),
     BLOCK(in.actuator_armed.armed), false},
    {Module::mixer, "mixer", "mixer", ATTEST_EXTENSION_MIXER, BLOCK(mixer_in), BLOCK(mixer_out)},
    {Module::battery_status, "battery_status", "battery estimate", ATTEST_EXTENSION_BATTERY_STATUS,
     BLOCK(battery_in), BLOCK(battery_out)},
    {Module::attitude_unit, "attitude_unit", "attitude unit", ATTEST_EXTENSION_ATTITUDE_UNIT,
     BLOCK(attitude_in), BLOCK(attitude_out), "vehicle_attitude", "vehicle_attitude_setpoint",
     BLOCK(attitude_in.vehicle_attitude.timestamp_sample), BLOCK(attitude_in.vehicle_status.armed),
     true},
    {Module::rate_unit, "rate_unit", "rate unit", ATTEST_EXTENSION_RATE_UNIT, BLOCK(rate_in),
     BLOCK(rate_out), "vehicle_angular_velocity", "vehicle_rates_setpoint",
     BLOCK(rate_in.vehicle_angular_velocity.timestamp_sample),
     BLOCK(rate_in.vehicle_control_mode.flag_armed), true},
}};

#undef BLOCK

// In Sample, all outputs follow all inputs, so the outputs of all modules are one range of bytes.
constexpr std::size_t outputs_begin = sizeof(Sample) - outputs_size;
static_assert(offsetof(attest_attitude_inputs, updated) == offsetof(attest_inputs, updated) &&
              offsetof(attest_rate_inputs, updated) == offsetof(attest_inputs, updated));
static_assert(std::all_of(infos.begin(), infos.end(), [](const ModuleInfo& info) {
  return info.in.offset < outputs_begin && info.out.offset >= outputs_begin;
}));

}  // namespace

std::span<const std::byte> Sample::outputs() const {
  return std::as_bytes(std::span(this, 1)).subspan(outputs_begin);
}

std::span<std::byte> Sample::outputs() {
  return std::as_writable_bytes(std::span(this, 1)).subspan(outputs_begin);
}

void Sample::copy_outputs(const Sample& from) {
  std::memcpy(outputs().data(), from.outputs().data(), outputs().size());
}

std::vector<std::byte> Block::copy(std::span<const Sample> samples) const {
  std::vector<std::byte> copied(samples.size() * size);
  std::byte* to = copied.data();
  for (const Sample& sample : samples) {
    std::memcpy(to, in(sample), size);
    to += size;
  }
  return copied;
}

void Block::paste(std::span<const std::byte> copied, std::span<Sample> samples) const {
  const std::byte* from = copied.data();
  for (Sample& sample : samples) {
    std::memcpy(in(sample), from, size);
    from += size;
  }
}

std::span<const ModuleInfo> modules() { return infos; }

const ModuleInfo& info_of(Module module) { return infos[static_cast<std::size_t>(module)]; }

std::string_view name_of(Module module) { return info_of(module).name; }

std::optional<Module> module_named(std::string_view name) {
  const auto found = std::find_if(infos.begin(), infos.end(),
                                  [&](const ModuleInfo& info) { return info.name == name; });
  return found == infos.end() ? std::nullopt : std::optional(found->module);
}

}  // namespace attest
