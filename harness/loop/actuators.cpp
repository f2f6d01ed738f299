#include "harness/loop/actuators.hpp"

#include <algorithm>
#include <cmath>

namespace attest {
namespace {

constexpr std::uint8_t lower_limit_bit = 1, upper_limit_bit = 2, yaw_bit = 4;

MotorLimits limits_of(const actuation::Saturation& saturation) {
  const auto bit = [](bool set, std::uint8_t mask) { return set ? mask : std::uint8_t{0}; };
  return {bit(saturation.lower, lower_limit_bit), bit(saturation.upper, upper_limit_bit),
          bit(saturation.yaw, yaw_bit)};
}

}  // namespace

Actuators::Actuators(const Vehicle& vehicle, Module module)
    : vehicle_(vehicle), module_(module), mixer_(actuation::parse_mixer(vehicle.mixer).value()) {
  if (module == Module::rate_unit) allocator_.emplace(vehicle);
  commands_.fill(-1);
}

void Actuators::follow(const Sample& sample, Airmode airmode) {
  if (module_ == Module::attitude_unit) return;
  if (!info_of(module_).is_armed(sample)) {
    commands_.fill(-1);
  } else if (allocator_) {
    allocate(sample.rate_out, airmode);
  } else {
    mix(sample.out);
  }
}

void Actuators::mix(const attest_outputs& out) {
  if (out.actuator_controls_0.published == 0) return;
  const float* control = out.actuator_controls_0.control;
  actuation::Saturation saturation{};
  const auto mixed = mixer_.mix({control[0], control[1], control[2], control[3]}, 0, saturation);
  std::copy(mixed.begin(), mixed.end(), commands_.begin());
  saturation_.limits = limits_of(saturation);
}

void Actuators::allocate(const attest_rate_outputs& out, Airmode airmode) {
  const auto& torque = out.vehicle_torque_setpoint;
  const auto& thrust = out.vehicle_thrust_setpoint;
  if (torque.published == 0 || thrust.published == 0) return;
  const Allocation allocation =
      allocator_->allocate(std::to_array(torque.xyz), std::to_array(thrust.xyz), airmode);
  commands_ = allocation.commands;
  saturation_.unallocated_torque = allocation.unallocated_torque;
  saturation_.torque_setpoint_achieved = allocation.torque_setpoint_achieved;
}

std::span<const double> Actuators::speeds(const MotorCommands& commands, double supply,
                                          const std::optional<std::size_t>& failed) {
  const std::size_t rotors = vehicle_.rotors.size();
  const double max_speed = vehicle_.rotor_max_rad_s * supply;
  for (std::size_t i = 0; i < rotors; ++i) {
    if (!std::isfinite(commands[i])) return {};
    speeds_[i] = failed == i ? 0 : (static_cast<double>(commands[i]) + 1) / 2 * max_speed;
  }
  return std::span(speeds_).first(rotors);
}

}  // namespace attest
