#include "harness/plant/mujoco_numbers.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <mujoco/mujoco.h>

namespace attest {

using namespace mujoco_layout;  // NOLINT(google-build-using-namespace)

namespace {

Vector3 vector_of_model(const mjtNum* numbers) { return {numbers[0], numbers[1], numbers[2]}; }

void copy_to_model(const Vector3& vector, mjtNum* numbers) {
  std::copy(vector.begin(), vector.end(), numbers);
}

}  // namespace

Result<ModelNumbers> numbers_of(const mjModel& model, const std::filesystem::path& xml) {
  const bool free_body = model.nbody == 2 && model.njnt == 1 && model.jnt_type[0] == mjJNT_FREE;
  if (!free_body) return fail_at(xml.string(), "needs one body with one free joint");
  if (model.opt.integrator != mjINT_RK4) {
    return fail_at(xml.string(), "needs <option integrator=\"RK4\"/>");
  }
  if (model.nuserdata < userdata_size) {
    return fail_at(xml.string(), fmt::format("needs <size nuserdata=\"{}\"/>", int{userdata_size}));
  }
  ModelNumbers numbers;
  numbers.mass_kg = model.body_mass[body];
  numbers.inertia_kg_m2 = vector_of_model(model.body_inertia + 3 * body);
  numbers.centre_of_mass_m = frd_from_flu(vector_of_model(model.body_ipos + 3 * body));
  numbers.gravity_m_s2 = -model.opt.gravity[2];
  for (int i = 0; i < model.nu; ++i) {
    const bool is_rotor = model.actuator_trntype[i] == mjTRN_SITE &&
                          model.actuator_dyntype[i] == mjDYN_USER &&
                          model.actuator_gaintype[i] == mjGAIN_USER;
    if (!is_rotor) {
      return fail_at(xml.string(), fmt::format("actuator {} needs a `site`, and `dyntype` and "
                                               "`gaintype` \"user\"",
                                               i));
    }
    const mjtNum* gear = model.actuator_gear + 6 * i;
    const mjtNum* lag = model.actuator_dynprm + i * mjNDYN;
    const mjtNum* place = model.site_pos + 3 * model.actuator_trnid[2 * i];
    numbers.rotors.push_back({frd_from_flu(vector_of_model(place)),
                              frd_from_flu(vector_of_model(gear)),
                              frd_from_flu(vector_of_model(gear + 3)),
                              model.actuator_gainprm[i * mjNGAIN], lag[0], lag[1]});
  }
  return numbers;
}

void set_numbers(const Vehicle& vehicle, mjModel& model) {
  model.body_mass[body] = vehicle.mass_kg;
  copy_to_model(vehicle.inertia_kg_m2, model.body_inertia + 3 * body);
  for (int i = 0; i < model.nu; ++i) {
    const VehicleRotor& rotor = vehicle.rotors[static_cast<std::size_t>(i)];
    copy_to_model(flu_from_frd(rotor.position_m), model.site_pos + 3 * model.actuator_trnid[2 * i]);
    model.actuator_gear[6 * i + 5] = -rotor.turns * vehicle.torque_over_thrust_m;
    model.actuator_gainprm[i * mjNGAIN] = vehicle.thrust_coefficient;
    model.actuator_dynprm[i * mjNDYN] = vehicle.time_constant_up_s;
    model.actuator_dynprm[i * mjNDYN + 1] = vehicle.time_constant_down_s;
  }
}

}  // namespace attest
