#include "tests/harness/realtime/flights.hpp"

#include "harness/trace/channels.hpp"

namespace attest::test {

Case hover_case(double duration_s) {
  Case hover;
  hover.file = "cases/px4-v1.5.5/flight/hover.toml";
  hover.profile = "px4-v1.5.5";
  hover.group = "flight";
  hover.name = "hover";
  hover.duration = {duration_s, Span::In::seconds};
  TopicStimulus armed{"actuator_armed", ATTEST_UPDATED_ACTUATOR_ARMED, {}, {}, {}};
  armed.fields.push_back(
      {*find_channel(Module::mc_att_control, "in/actuator_armed.armed"), Constant{1}});
  hover.topics.push_back(armed);
  hover.flight.emplace();
  return hover;
}

Case cascade_case(double duration_s) {
  Case hover;
  hover.file = "cases/px4-v1.16.0/flight/hover.toml";
  hover.profile = "px4-v1.16.0";
  hover.group = "flight";
  hover.name = "hover";
  hover.module = Module::rate_unit;
  hover.duration = {duration_s, Span::In::seconds};
  hover.flight.emplace();
  hover.attitude_loop.emplace();
  return hover;
}

Vehicle quad_vehicle() {
  Vehicle vehicle;
  vehicle.mass_kg = 1;
  vehicle.rotors.resize(4);
  vehicle.thrust_coefficient = gravity_m_s2 / 4 / (400.0 * 400.0);
  vehicle.rotor_max_rad_s = 800;
  vehicle.mixer = "R: 4x 10000 10000 10000 0";
  return vehicle;
}

}  // namespace attest::test
