// Computes the rotor speeds from the outputs of the unit that commands the motors: mixer or
// allocator, arming, battery voltage, motor failure. No allocation of memory after construction.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "controller/actuation/mixer.hpp"
#include "harness/loop/control_allocator.hpp"
#include "harness/loop/motor_commands.hpp"
#include "harness/plant/vehicle.hpp"
#include "harness/trace/module.hpp"

namespace attest {

class Actuators {
 public:
  // For the outputs of `module`. REQUIRES: read_vehicle accepts the vehicle, which outlives this.
  explicit Actuators(const Vehicle& vehicle, Module module = Module::mc_att_control);

  // Takes the outputs of a step. The mixer runs when the controller publishes its controls, the
  // allocator when the rate unit publishes torque and thrust. Disarmed, all motors stop and neither
  // of them runs. Outputs of the attitude unit are ignored. `airmode` is for the allocator.
  void follow(const Sample& sample, Airmode airmode = Airmode::off);

  const MotorCommands& commands() const { return commands_; }
  const Saturation& saturation() const { return saturation_; }  // of the last mixing or allocation

  // The speeds [rad/s] for `commands`, one per rotor, valid until the next call. Each is linear in
  // its command, and is multiplied by `supply`, the battery's ratio. The `failed` rotor has speed
  // 0. Empty if a command is not finite.
  std::span<const double> speeds(const MotorCommands& commands, double supply,
                                 const std::optional<std::size_t>& failed);

 private:
  void mix(const attest_outputs& out);
  void allocate(const attest_rate_outputs& out, Airmode airmode);

  const Vehicle& vehicle_;
  Module module_;
  actuation::Mixer mixer_;
  std::optional<ControlAllocator> allocator_;  // only for the rate unit
  MotorCommands commands_{};
  Saturation saturation_;
  std::array<double, rotors_max> speeds_{};
};

}  // namespace attest
