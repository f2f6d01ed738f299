#include "harness/loop/control_allocator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/QR>

namespace attest {
namespace {

constexpr Eigen::Index roll_column = 0, pitch_column = 1, yaw_column = 2, thrust_column = 3;

// The largest decrease of thrust that makes room for yaw, as a fraction of full thrust. The mixer
// has the same limit.
constexpr double thrust_for_yaw = 0.15;

// Torque about x, y, z and upward thrust of each rotor at full speed, in any common unit. A rotor
// that turns counter-clockwise, seen from above, turns the body clockwise: positive about z, which
// points down.
using Effectiveness = Eigen::Matrix<double, 4, Eigen::Dynamic>;
using Mix = Eigen::Matrix<double, Eigen::Dynamic, 4>;

Effectiveness effectiveness_of(const Vehicle& vehicle) {
  Effectiveness effectiveness(4, static_cast<Eigen::Index>(vehicle.rotors.size()));
  Eigen::Index i = 0;
  for (const VehicleRotor& rotor : vehicle.rotors) {
    effectiveness.col(i++) << -rotor.position_m[1], rotor.position_m[0],
        vehicle.torque_over_thrust_m * rotor.turns, 1;
  }
  return effectiveness;
}

// Returns the pseudo-inverse. Entries that only rounding makes different from 0 become 0.
Mix mix_of(const Effectiveness& effectiveness) {
  constexpr double rounding = 1e-6;
  Mix mix = effectiveness.completeOrthogonalDecomposition().pseudoInverse();
  for (Eigen::Index axis = 0; axis < 4; ++axis) {
    const double largest = mix.col(axis).cwiseAbs().maxCoeff();
    for (double& entry : mix.col(axis)) {
      if (std::abs(entry) <= rounding * largest) entry = 0;
    }
  }
  return mix;
}

// The root mean square of the entries that are not 0, times sqrt(2): 1 for four entries of
// sqrt(1/2).
double size_of(const Mix& mix, Eigen::Index axis) {
  double squares = 0, entries = 0;
  for (const double entry : mix.col(axis)) {
    squares += entry * entry;
    if (entry != 0) entries += 1;
  }
  return std::sqrt(squares / (entries / 2));
}

// The divisor of each column of the mix. It is not 0, because each vehicle that read_vehicle
// accepts can turn about all axes.
std::array<double, 4> scales_of(const Mix& mix) {
  const double roll_pitch = std::max(size_of(mix, roll_column), size_of(mix, pitch_column));
  double thrust = 0;
  for (const double entry : mix.col(thrust_column)) thrust += std::abs(entry);
  const double rotors = static_cast<double>(mix.rows());
  return {roll_pitch, roll_pitch, mix.col(yaw_column).cwiseAbs().maxCoeff(), thrust / rotors};
}

// The largest number from 0 to `wanted` with slope * number <= room. A negative room comes from
// rounding, and counts as 0.
double limited(double wanted, double slope, double room) {
  const double possible = std::max(room, 0.0);
  return slope * wanted > possible ? possible / slope : wanted;
}

}  // namespace

ControlAllocator::ControlAllocator(const Vehicle& vehicle) : count_(vehicle.rotors.size()) {
  const Effectiveness effectiveness = effectiveness_of(vehicle);
  const Mix mix = mix_of(effectiveness);
  const std::array<double, 4> scales = scales_of(mix);
  for (std::size_t i = 0; i < count_; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const auto entry = [&](Eigen::Index axis) {
      return static_cast<float>(mix(row, axis) / scales[static_cast<std::size_t>(axis)]);
    };
    Rotor& rotor = rotors_[i];
    rotor.roll = entry(roll_column);
    rotor.pitch = entry(pitch_column);
    rotor.yaw = entry(yaw_column);
    rotor.thrust = entry(thrust_column);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double torque = effectiveness(static_cast<Eigen::Index>(axis), row);
      rotor.torque[axis] = static_cast<float>(torque * scales[axis]);
    }
  }
}

Allocation ControlAllocator::allocate(const std::array<float, 3>& torque,
                                      const std::array<float, 3>& thrust) const {
  Allocation result;
  result.commands.fill(-1);
  const auto is_finite = [](float value) { return std::isfinite(value); };
  if (!std::all_of(torque.begin(), torque.end(), is_finite) || !is_finite(thrust[2])) {
    std::fill_n(result.commands.begin(), count_, std::numeric_limits<float>::quiet_NaN());
    result.unallocated_torque = torque;
    result.torque_setpoint_achieved = false;
    return result;
  }
  const std::array<double, 3> wanted{torque[0], torque[1], torque[2]};
  const double up = std::max(-static_cast<double>(thrust[2]), 0.0);
  const Speeds level = with_roll_pitch(roll_pitch_turns(wanted[0], wanted[1]), up);
  const Speeds speeds = with_yaw(wanted[2], level);

  std::array<double, 3> given{};
  for (std::size_t i = 0; i < count_; ++i) {
    const Rotor& rotor = rotors_[i];
    const double speed = std::clamp(speeds[i] * static_cast<double>(rotor.thrust), 0.0, 1.0);
    result.commands[i] = static_cast<float>(2 * speed - 1);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      given[axis] += static_cast<double>(rotor.torque[axis]) * speed;
    }
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto lacking = static_cast<float>(wanted[axis] - given[axis]);
    if (std::abs(lacking) <= torque_resolution) continue;
    result.unallocated_torque[axis] = lacking;
    result.torque_setpoint_achieved = false;
  }
  return result;
}

ControlAllocator::Speeds ControlAllocator::roll_pitch_turns(double roll, double pitch) const {
  Speeds turns{};
  for (std::size_t i = 0; i < count_; ++i) {
    const Rotor& rotor = rotors_[i];
    const double turn =
        static_cast<double>(rotor.roll) * roll + static_cast<double>(rotor.pitch) * pitch;
    turns[i] = turn * full(i);
  }
  return turns;
}

// Finds the largest part (0..1) of the roll and pitch changes `turns` that fits with this thrust or
// a lower one; then the largest thrust, up to `thrust`, that fits with this part. Each rotor i is
// between stopped and full if
//
//     0 <= part * turn_i + thrust <= full_i
//
// So the lowest possible thrust is part * lowest, where lowest = max(0, -turn_i) over all rotors.
ControlAllocator::Speeds ControlAllocator::with_roll_pitch(Speeds turns, double thrust) const {
  double lowest = 0;
  for (std::size_t i = 0; i < count_; ++i) lowest = std::max(lowest, -turns[i]);
  double part = limited(1, lowest, thrust);
  for (std::size_t i = 0; i < count_; ++i) part = limited(part, lowest + turns[i], full(i));
  for (std::size_t i = 0; i < count_; ++i) {
    turns[i] *= part;
    thrust = std::min(thrust, full(i) - turns[i]);
  }
  for (std::size_t i = 0; i < count_; ++i) turns[i] += thrust;
  return turns;
}

// Adds the largest part of the yaw torque that fits, then lowers the thrust as far as it requires.
ControlAllocator::Speeds ControlAllocator::with_yaw(double yaw, Speeds speeds) const {
  Speeds turns{};
  for (std::size_t i = 0; i < count_; ++i) {
    turns[i] = static_cast<double>(rotors_[i].yaw) * yaw * full(i);
  }
  const double part = part_that_fits(turns, speeds);
  double above = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    speeds[i] += part * turns[i];
    above = std::max(above, speeds[i] - full(i));
  }
  for (std::size_t i = 0; i < count_; ++i) speeds[i] -= above;
  return speeds;
}

// The largest part of yaw that fits when the thrust is lowered by a suitable amount `lower`, which
// is at least 0 and at most thrust_for_yaw:
//
//     0 <= speed_i + part * turn_i - lower <= full_i        for each rotor i
//
// Each lower bound on `lower` has to be at most each upper bound on it.
double ControlAllocator::part_that_fits(const Speeds& yaw_turns, const Speeds& speeds) const {
  double part = 1;
  for (std::size_t i = 0; i < count_; ++i) {
    const double room = full(i) - speeds[i];
    part = limited(part, -yaw_turns[i], speeds[i]);
    part = limited(part, yaw_turns[i], room + thrust_for_yaw);
    for (std::size_t k = 0; k < count_; ++k) {
      part = limited(part, yaw_turns[i] - yaw_turns[k], room + speeds[k]);
    }
  }
  return part;
}

}  // namespace attest
