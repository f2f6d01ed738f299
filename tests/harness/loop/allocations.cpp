#include "tests/harness/loop/allocations.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/SVD>

namespace attest::test {
namespace {

using Array = Eigen::ArrayXd;

// Root of twice the mean square of the entries that are not 0.
double spread(const Array& column) {
  const Array used = (column.abs() > 1e-6 * column.abs().maxCoeff()).cast<double>();
  return std::sqrt(2 * (column.square() * used).sum() / used.sum());
}

double factor(const Array& speeds, const Array& column, double upper) {
  const Array limit = speeds.max(0).min(upper);
  const Array each = (column.abs() < 0.2).select(0, (limit - speeds) / column);
  return std::max(each.maxCoeff(), 0.0) + std::min(each.minCoeff(), 0.0);
}

void desaturate(Array& speeds, const Array& column, double upper = 1) {
  speeds += factor(speeds, column, upper) * column;
  speeds += factor(speeds, column, upper) / 2 * column;
}

void lower_thrust(Array& speeds, const Array& column) {
  if (factor(speeds, column, 1) <= 0) desaturate(speeds, column);
}

// `part`, or the largest smaller one with slope * part <= room. A negative room counts as 0.
double limited(double part, double slope, double room) {
  const double possible = std::max(room, 0.0);
  return slope * part > possible ? possible / slope : part;
}

}  // namespace

AllocationModel::AllocationModel(const Vehicle& vehicle) {
  const auto count = static_cast<Eigen::Index>(vehicle.rotors.size());
  Eigen::Matrix4Xd effectiveness(4, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto& [position, turns] = vehicle.rotors[static_cast<std::size_t>(i)];
    const double yaw = vehicle.torque_over_thrust_m * turns;
    effectiveness.col(i) = Eigen::Vector4d(-position[1], position[0], yaw, 1);
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(effectiveness,
                                              Eigen::ComputeThinU | Eigen::ComputeThinV);
  mix_ =
      svd.matrixV() * svd.singularValues().cwiseInverse().asDiagonal() * svd.matrixU().transpose();
  const double tilt = std::max(spread(mix_.col(0)), spread(mix_.col(1)));
  const Eigen::Array4d scale(tilt, tilt, mix_.col(2).abs().maxCoeff(), mix_.col(3).mean());
  mix_.rowwise() /= scale.transpose();
  torque_of_ = scale.head(3).matrix().asDiagonal() * effectiveness.topRows(3);
}

AllocationModel::Speeds AllocationModel::mixed(const Torque& torque, double thrust) const {
  return mix_.matrix() * Eigen::Vector4d(torque[0], torque[1], torque[2], thrust);
}

bool AllocationModel::saturates(const Torque& torque, double thrust) const {
  const Speeds speeds = mixed(torque, thrust);
  return speeds.minCoeff() < 0 || speeds.maxCoeff() > 1;
}

AllocationModel::Speeds AllocationModel::sequential(const Torque& torque, double thrust,
                                                    Airmode airmode) const {
  const Array roll = mix_.col(0), pitch = mix_.col(1), yaw = mix_.col(2), up = mix_.col(3);
  if (airmode == Airmode::roll_pitch_yaw) {
    Speeds speeds = mixed(torque, thrust);
    desaturate(speeds, up);
    desaturate(speeds, yaw);
    return speeds.max(0).min(1);
  }
  Speeds speeds = mixed({torque[0], torque[1], 0}, thrust);
  if (airmode == Airmode::roll_pitch) {
    desaturate(speeds, up);
  } else {
    lower_thrust(speeds, up);
    desaturate(speeds, roll);
    desaturate(speeds, pitch);
  }
  speeds += torque[2] * yaw;
  desaturate(speeds, yaw, 1.15);
  lower_thrust(speeds, up);
  return speeds.max(0).min(1);
}

AllocationModel::Speeds AllocationModel::scaled(const Torque& torque, double thrust) const {
  // In units of the thrust: a rotor is at full speed at `full`.
  const Array full = 1 / mix_.col(3);
  const Array turn = full * (torque[0] * mix_.col(0) + torque[1] * mix_.col(1));
  const Array yaw = full * torque[2] * mix_.col(2);
  const double lowest = std::max(-turn.minCoeff(), 0.0);
  double part = limited(1, lowest, thrust);
  for (Eigen::Index i = 0; i < full.size(); ++i) part = limited(part, lowest + turn[i], full[i]);
  Array speeds = part * turn + std::min(thrust, (full - part * turn).minCoeff());

  // The thrust may fall by up to 0.15 for yaw.
  part = 1;
  for (Eigen::Index i = 0; i < full.size(); ++i) {
    const double room = full[i] - speeds[i];
    part = limited(part, -yaw[i], speeds[i]);
    part = limited(part, yaw[i], room + 0.15);
    for (Eigen::Index k = 0; k < full.size(); ++k) {
      part = limited(part, yaw[i] - yaw[k], room + speeds[k]);
    }
  }
  speeds += part * yaw;
  speeds -= std::max((speeds - full).maxCoeff(), 0.0);
  return (speeds / full).max(0).min(1);
}

std::array<int, 3> AllocationModel::flags(const Torque& torque, const Speeds& speeds) const {
  const Eigen::Vector3d lacks = torque.matrix() - torque_of_ * speeds.matrix();
  std::array<int, 3> result{};
  if (lacks.norm() < 1e-3) return result;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double lack = lacks[static_cast<Eigen::Index>(axis)];
    if (std::abs(lack) > 1e-6) result[axis] = lack > 0 ? 1 : -1;
  }
  return result;
}

}  // namespace attest::test
