#include "harness/plant/vehicle_dynamics.hpp"

namespace attest {
namespace {

Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

}  // namespace

// Written in plain scalars, because this takes most of a step's time.
void VehicleDynamics::derivative(const double* y, double* dy) const {
  Vector3 force_B{}, torque_B{};
  add_rotors(y, dy, force_B, torque_B);
  const double w = y[attitude], x = y[attitude + 1], yy = y[attitude + 2], z = y[attitude + 3];
  // Rows of the rotation from body to world; q may differ from norm 1 by the integrator's error.
  const double R_NB[3][3] = {
      {w * w + x * x - yy * yy - z * z, 2 * (x * yy - w * z), 2 * (x * z + w * yy)},
      {2 * (x * yy + w * z), w * w - x * x + yy * yy - z * z, 2 * (yy * z - w * x)},
      {2 * (x * z - w * yy), 2 * (yy * z + w * x), w * w - x * x - yy * yy + z * z}};
  add_drag(y, R_NB, force_B);
  for (int i = 0; i < 3; ++i) {
    const double force_N =
        R_NB[i][0] * force_B[0] + R_NB[i][1] * force_B[1] + R_NB[i][2] * force_B[2];
    dy[position + i] = y[velocity + i];
    dy[velocity + i] = force_N / vehicle_.mass_kg;
  }
  dy[velocity + 2] += gravity_m_s2;
  add_rotation(y, torque_B, dy);
}

void VehicleDynamics::add_rotors(const double* y, double* dy, Vector3& force_B,
                                 Vector3& torque_B) const {
  for (std::size_t i = 0; i < count_; ++i) {
    const double speed = y[static_cast<std::size_t>(rotors) + i];
    const double missing = inputs.command[i] - speed;
    dy[static_cast<std::size_t>(rotors) + i] =
        missing / (missing > 0 ? vehicle_.time_constant_up_s : vehicle_.time_constant_down_s);
    const VehicleRotor& rotor = vehicle_.rotors[i];
    const double thrust = vehicle_.thrust_coefficient * speed * speed;
    force_B[2] -= thrust;
    torque_B[0] -= (rotor.position_m[1] - inputs.centre_of_mass_m[1]) * thrust;
    torque_B[1] += (rotor.position_m[0] - inputs.centre_of_mass_m[0]) * thrust;
    torque_B[2] += rotor.turns * vehicle_.torque_over_thrust_m * thrust;
  }
  dy[used] = vehicle_.power_ratio({y + rotors, count_});
}

// Drag acts at the centre of mass, so it does not turn the body.
void VehicleDynamics::add_drag(const double* y, const double (&R_NB)[3][3],
                               Vector3& force_B) const {
  const Vector3& k = vehicle_.drag_kg_s;
  if (k[0] == 0 && k[1] == 0 && k[2] == 0) return;
  const Vector3 air_N = {y[velocity] - inputs.wind_m_s[0], y[velocity + 1] - inputs.wind_m_s[1],
                         y[velocity + 2] - inputs.wind_m_s[2]};
  for (std::size_t i = 0; i < 3; ++i) {
    force_B[i] -= k[i] * (R_NB[0][i] * air_N[0] + R_NB[1][i] * air_N[1] + R_NB[2][i] * air_N[2]);
  }
}

// Euler's equations about principal axes, and dq/dt = q (0, w) / 2.
void VehicleDynamics::add_rotation(const double* y, const Vector3& torque_B, double* dy) const {
  const Vector3 w_BN_B = {y[rate], y[rate + 1], y[rate + 2]};
  const Vector3& I = vehicle_.inertia_kg_m2;
  const Vector3 gyro_B = cross(w_BN_B, {I[0] * w_BN_B[0], I[1] * w_BN_B[1], I[2] * w_BN_B[2]});
  for (std::size_t i = 0; i < 3; ++i) {
    dy[static_cast<std::size_t>(rate) + i] = (torque_B[i] - gyro_B[i]) / I[i];
  }
  const double* q = y + attitude;
  double* dq = dy + attitude;
  dq[0] = 0.5 * (-q[1] * w_BN_B[0] - q[2] * w_BN_B[1] - q[3] * w_BN_B[2]);
  dq[1] = 0.5 * (q[0] * w_BN_B[0] + q[2] * w_BN_B[2] - q[3] * w_BN_B[1]);
  dq[2] = 0.5 * (q[0] * w_BN_B[1] + q[3] * w_BN_B[0] - q[1] * w_BN_B[2]);
  dq[3] = 0.5 * (q[0] * w_BN_B[2] + q[1] * w_BN_B[1] - q[2] * w_BN_B[0]);
}

}  // namespace attest
