#include "harness/loop/control_allocator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/QR>

namespace attest {
namespace {

constexpr Eigen::Index roll_column = 0, pitch_column = 1, yaw_column = 2, thrust_column = 3;

// Yaw may exceed full speed by this much before it is reduced. Thrust is lowered in its place.
constexpr double yaw_margin = 0.15;

// A rotor whose speed changes less along a column does not decide how far to go along it.
constexpr double weak = 0.2;

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

std::array<float, rotors_max> in_single(const Eigen::VectorXd& rotors) {
  std::array<float, rotors_max> result{};
  for (Eigen::Index i = 0; i < rotors.size(); ++i) {
    result[static_cast<std::size_t>(i)] = static_cast<float>(rotors(i));
  }
  return result;
}

}  // namespace

Airmode airmode_of(double parameter) {
  if (parameter == 1) return Airmode::roll_pitch;
  return parameter == 2 ? Airmode::roll_pitch_yaw : Airmode::off;
}

ControlAllocator::ControlAllocator(const Vehicle& vehicle) : count_(vehicle.rotors.size()) {
  const Effectiveness effectiveness = effectiveness_of(vehicle);
  const Mix mix = mix_of(effectiveness);
  const std::array<double, 4> scales = scales_of(mix);
  roll_ = in_single(mix.col(roll_column) / scales[roll_column]);
  pitch_ = in_single(mix.col(pitch_column) / scales[pitch_column]);
  yaw_ = in_single(mix.col(yaw_column) / scales[yaw_column]);
  thrust_ = in_single(mix.col(thrust_column) / scales[thrust_column]);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto row = static_cast<Eigen::Index>(axis);
    torque_[axis] = in_single(effectiveness.row(row).transpose() * scales[axis]);
  }
}

Allocation ControlAllocator::allocate(const std::array<float, 3>& torque,
                                      const std::array<float, 3>& thrust, Airmode airmode) const {
  Allocation result;
  result.commands.fill(-1);
  const auto is_finite = [](float value) { return std::isfinite(value); };
  if (!std::all_of(torque.begin(), torque.end(), is_finite) || !is_finite(thrust[2])) {
    std::fill_n(result.commands.begin(), count_, std::numeric_limits<float>::quiet_NaN());
    result.unallocated_torque = torque;
    result.torque_setpoint_achieved = false;
    return result;
  }
  const Speeds speeds = desaturated(torque, -thrust[2], airmode);
  std::array<double, 3> lacking{torque[0], torque[1], torque[2]};
  for (std::size_t i = 0; i < count_; ++i) {
    const double speed = std::clamp(speeds[i], 0.0, 1.0);
    result.commands[i] = static_cast<float>(2 * speed - 1);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      lacking[axis] -= static_cast<double>(torque_[axis][i]) * speed;
    }
  }
  double squares = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    squares += lacking[axis] * lacking[axis];
    if (std::abs(lacking[axis]) <= torque_resolution) continue;
    result.unallocated_torque[axis] = static_cast<float>(lacking[axis]);
  }
  result.torque_setpoint_achieved = squares < achieved_below * achieved_below;
  return result;
}

void ControlAllocator::add(const Column& column, double amount, Speeds& speeds) {
  for (std::size_t i = 0; i < speeds.size(); ++i) {
    speeds[i] += static_cast<double>(column[i]) * amount;
  }
}

// How far to go along a column, so that rotors beyond 0 or `full` return to it: as far as the one
// that needs most in the positive direction, plus as far as the one that needs most in the negative
// direction.
double ControlAllocator::way_back(const Column& column, const Speeds& speeds, double full) {
  double forwards = 0, backwards = 0;
  for (std::size_t i = 0; i < speeds.size(); ++i) {
    const auto slope = static_cast<double>(column[i]);
    if (std::abs(slope) < weak) continue;
    const double way = (std::clamp(speeds[i], 0.0, full) - speeds[i]) / slope;
    forwards = std::max(forwards, way);
    backwards = std::min(backwards, way);
  }
  return forwards + backwards;
}

// The first step returns the rotors of one side. If it takes others beyond the opposite limit, the
// second step halves what is left, so that both sides saturate equally.
void ControlAllocator::desaturate(const Column& column, Speeds& speeds, double full) {
  add(column, way_back(column, speeds, full), speeds);
  add(column, way_back(column, speeds, full) / 2, speeds);
}

ControlAllocator::Speeds ControlAllocator::desaturated(const std::array<float, 3>& torque, float up,
                                                       Airmode airmode) const {
  const auto [roll, pitch, yaw] = torque;
  Speeds speeds{};
  add(roll_, roll, speeds);
  add(pitch_, pitch, speeds);
  add(thrust_, up, speeds);
  switch (airmode) {
    case Airmode::roll_pitch_yaw:
      add(yaw_, yaw, speeds);
      desaturate(thrust_, speeds);
      desaturate(yaw_, speeds);
      return speeds;
    case Airmode::roll_pitch:
      desaturate(thrust_, speeds);
      break;
    case Airmode::off:
      lower_thrust(speeds);
      desaturate(roll_, speeds);
      desaturate(pitch_, speeds);
      break;
  }
  add_yaw(yaw, speeds);
  return speeds;
}

void ControlAllocator::add_yaw(float yaw, Speeds& speeds) const {
  add(yaw_, yaw, speeds);
  desaturate(yaw_, speeds, 1 + yaw_margin);
  lower_thrust(speeds);
}

// Desaturates along the thrust, unless that needs more thrust.
void ControlAllocator::lower_thrust(Speeds& speeds) const {
  if (way_back(thrust_, speeds, 1) <= 0) desaturate(thrust_, speeds);
}

}  // namespace attest
