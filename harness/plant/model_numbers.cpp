#include "harness/plant/model_numbers.hpp"

#include <cmath>

#include <fmt/format.h>

namespace attest {
namespace {

class Agreement {
 public:
  explicit Agreement(const Vehicle& vehicle) : toml_(vehicle.file.filename().string()) {}

  void same(const std::string& what, double model, double vehicle) {
    // With a tolerance, because MuJoCo recomputes the inertia.
    constexpr double relative = 1e-9;
    if (!difference.empty() || std::abs(model - vehicle) <= relative * std::abs(vehicle)) return;
    difference = fmt::format("{} is {:g}, in {} it is {:g}", what, model, toml_, vehicle);
  }
  void same(const std::string& what, const Vector3& model, const Vector3& vehicle) {
    constexpr const char* axes[] = {"x", "y", "z"};
    for (std::size_t i = 0; i < 3; ++i) {
      same(fmt::format("{} along {} (FRD)", what, axes[i]), model[i], vehicle[i]);
    }
  }

  std::string difference;

 private:
  std::string toml_;
};

}  // namespace

std::string first_difference(const ModelNumbers& model, const Vehicle& vehicle) {
  if (model.rotors.size() != vehicle.rotors.size()) {
    return fmt::format("has {} rotors, {} has {}", model.rotors.size(),
                       vehicle.file.filename().string(), vehicle.rotors.size());
  }
  Agreement agreement(vehicle);
  agreement.same("the mass [kg]", model.mass_kg, vehicle.mass_kg);
  agreement.same("the inertia [kg m2]", model.inertia_kg_m2, vehicle.inertia_kg_m2);
  agreement.same("the centre of mass [m]", model.centre_of_mass_m, {0, 0, 0});
  agreement.same("the gravity [m/s2]", model.gravity_m_s2, gravity_m_s2);
  for (std::size_t i = 0; i < vehicle.rotors.size(); ++i) {
    const ModelNumbers::Rotor& rotor = model.rotors[i];
    const auto of_rotor = [i](const char* what) { return fmt::format("{} of rotor {}", what, i); };
    agreement.same(of_rotor("the place [m]"), rotor.position_m, vehicle.rotors[i].position_m);
    agreement.same(of_rotor("the force gear"), rotor.force_gear, {0, 0, -1});
    // A rotor that turns counter-clockwise, seen from above, pushes the body clockwise: +z in FRD.
    const double torque = vehicle.rotors[i].turns * vehicle.torque_over_thrust_m;
    agreement.same(of_rotor("the torque gear [m]"), rotor.torque_gear_m, {0, 0, torque});
    agreement.same(of_rotor("the thrust coefficient"), rotor.thrust_coefficient,
                   vehicle.thrust_coefficient);
    agreement.same(of_rotor("the time constant up [s]"), rotor.time_constant_up_s,
                   vehicle.time_constant_up_s);
    agreement.same(of_rotor("the time constant down [s]"), rotor.time_constant_down_s,
                   vehicle.time_constant_down_s);
  }
  return agreement.difference;
}

}  // namespace attest
