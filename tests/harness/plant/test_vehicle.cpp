#include "tests/harness/plant/test_vehicle.hpp"

#include <fstream>
#include <stdexcept>

#include <fmt/format.h>

namespace attest::test {
namespace {

constexpr double arm = 0.1414;  // along x and along y
constexpr double kf = 1e-5;
constexpr double torque_over_thrust = 0.02;

std::string toml_of(const Numbers& n) {
  const auto& I = n.inertia_kg_m2;
  const auto& d = n.drag_kg_s;
  return fmt::format(
      "description = \"a brick\"\nmass_kg = {}\ninertia_kg_m2 = [{}, {}, {}]\n"
      "thrust_coefficient = {}\ntorque_over_thrust_m = {}\ntime_constant_up_s = {}\n"
      "time_constant_down_s = {}\nrotor_max_rad_s = 4000.0\ndrag_kg_s = [{}, {}, {}]\n"
      "rate_bound_rad_s = {}\nmixer = \"R: 4x 10000 10000 10000 0\"\n[rotors]\n"
      "r0 = {{ position_m = [{arm}, {arm}, 0], turns = \"ccw\" }}\n"
      "r1 = {{ position_m = [-{arm}, -{arm}, 0], turns = \"ccw\" }}\n"
      "r2 = {{ position_m = [{arm}, -{arm}, 0], turns = \"cw\" }}\n"
      "r3 = {{ position_m = [-{arm}, {arm}, 0], turns = \"cw\" }}\n"
      "[battery]\ncells = 3\nfull_V = 12.6\nfall_V = 3\ncapacity_Ah = 2\nhover_current_A = 10\n",
      n.mass_kg, I[0], I[1], I[2], kf, torque_over_thrust, n.time_constant_up_s,
      n.time_constant_down_s, d[0], d[1], d[2], n.rate_bound_rad_s, fmt::arg("arm", arm));
}

std::string xml_of(const Numbers& n) {
  const auto& I = n.inertia_kg_m2;
  std::string sites, motors;
  const double places[4][3] = {{arm, -arm, -1}, {-arm, arm, -1}, {arm, arm, 1}, {-arm, -arm, 1}};
  for (int i = 0; i < 4; ++i) {
    sites += fmt::format("<site name=\"r{}\" pos=\"{} {} 0\"/>", i, places[i][0], places[i][1]);
    motors += fmt::format(
        "<general site=\"r{}\" gear=\"0 0 1 0 0 {}\" dyntype=\"user\" dynprm=\"{} {}\" "
        "gaintype=\"user\" gainprm=\"{}\" biastype=\"none\"/>",
        i, places[i][2] * torque_over_thrust, n.time_constant_up_s, n.time_constant_down_s, kf);
  }
  return fmt::format(
      "<mujoco><option integrator=\"RK4\" gravity=\"0 0 -9.80665\">"
      "<flag constraint=\"disable\" contact=\"disable\"/></option>"
      "<size njmax=\"1\" nconmax=\"1\" nstack=\"20000\" nuserdata=\"6\"/>"
      "<worldbody><body><freejoint/><inertial pos=\"0 0 0\" mass=\"{}\" diaginertia=\"{} {} {}\"/>"
      "{}</body></worldbody><actuator>{}</actuator></mujoco>\n",
      n.mass_kg, I[0], I[1], I[2], sites, motors);
}

std::shared_ptr<const VehicleModel> loaded(const std::filesystem::path& models,
                                           const std::string& name) {
  auto vehicle_model = VehicleModel::load(models, name);
  if (!vehicle_model) throw std::runtime_error(vehicle_model.error().to_string());
  return *vehicle_model;
}

}  // namespace

void write_vehicle(const std::filesystem::path& folder, const Numbers& numbers) {
  std::ofstream(folder / "brick.toml") << toml_of(numbers);
  std::ofstream(folder / "brick.xml") << xml_of(numbers);
}

std::shared_ptr<const VehicleModel> vehicle_model(const Numbers& numbers) {
  const TemporaryDirectory folder;
  write_vehicle(folder.path(), numbers);
  return loaded(folder.path(), "brick");
}

std::shared_ptr<const VehicleModel> vehicle_model(const std::string& name) {
  return loaded(ATTEST_SOURCE_DIR "/models", name);
}

}  // namespace attest::test
