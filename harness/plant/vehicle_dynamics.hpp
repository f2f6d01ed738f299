// The equations of a vehicle in flight, as an integrator needs them (plant.hpp describes them).
#pragma once

#include <array>
#include <cstddef>

#include "harness/core/frames.hpp"
#include "harness/plant/vehicle.hpp"

namespace attest {

// dy/dt with held inputs. Frames NED and FRD, SI units.
class VehicleDynamics {
 public:
  // The index at which each variable of the state y begins.
  enum Variable : int {
    position = 0,
    velocity = 3,
    attitude = 6,
    rate = 10,
    used = 13,
    rotors = 14
  };

  struct Inputs {
    std::array<double, rotors_max> command{};  // rad/s
    Vector3 wind_m_s{};
    Vector3 centre_of_mass_m{};
  };

  // The vehicle must outlive this.
  explicit VehicleDynamics(const Vehicle& vehicle)
      : vehicle_(vehicle), count_(vehicle.rotors.size()) {}

  Inputs inputs;

  void derivative(const double* y, double* dy) const;

 private:
  void add_rotors(const double* y, double* dy, Vector3& force_B, Vector3& torque_B) const;
  void add_drag(const double* y, const double (&R_NB)[3][3], Vector3& force_B) const;
  void add_rotation(const double* y, const Vector3& torque_B, double* dy) const;

  const Vehicle& vehicle_;
  std::size_t count_;
};

}  // namespace attest
