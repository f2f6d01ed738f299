#include "harness/diagnosis/naive_suite.hpp"

#include <cmath>

#include "harness/compare/compare.hpp"
#include "harness/loop/open_loop.hpp"
#include "harness/port/builtin.hpp"
#include "harness/schedule/random.hpp"

namespace attest {
namespace {

double between(Random& random, double low, double high) {
  return low + (high - low) * random.uniform();
}

void set_quaternion(float (&q)[4], double w, double x, double y, double z) {
  const double norm = std::sqrt(w * w + x * x + y * y + z * z);
  const double components[] = {w / norm, x / norm, y / norm, z / norm};
  for (int i = 0; i < 4; ++i) q[i] = static_cast<float>(components[i]);
}

// Armed in STABILIZED, with all topics updated at the first tick.
Sample hovering(std::size_t tick) {
  Sample sample{};
  sample.in.timestamp = 5'000'000 + 4000 * tick;
  sample.in.updated = ATTEST_UPDATED_VEHICLE_ATTITUDE_SETPOINT;
  if (tick == 0) sample.in.updated = ~0u;
  sample.in.control_state.q[0] = 1;
  sample.in.vehicle_attitude_setpoint.q_d[0] = 1;
  sample.in.vehicle_attitude_setpoint.thrust = 0.5f;
  sample.in.vehicle_control_mode = {1, 0, 1, 1, 0, 0};
  sample.in.actuator_armed.armed = 1;
  sample.in.vehicle_status.is_rotary_wing = 1;
  sample.in.battery_status.scale = 1;
  return sample;
}

// Small attitude errors and rates that wander, and a setpoint that tilts a little.
Trace hover() {
  Trace trace;
  trace.present = channels_of(Module::mc_att_control);
  Random random(1);
  double roll = 0, pitch = 0;
  for (std::size_t tick = 0; tick < 2500; ++tick) {
    Sample sample = hovering(tick);
    roll = 0.99 * roll + between(random, -0.003, 0.003);
    pitch = 0.99 * pitch + between(random, -0.003, 0.003);
    set_quaternion(sample.in.control_state.q, 1, roll, pitch, 0);
    auto& state = sample.in.control_state;
    state.roll_rate = static_cast<float>(between(random, -0.05, 0.05));
    state.pitch_rate = static_cast<float>(between(random, -0.05, 0.05));
    state.yaw_rate = static_cast<float>(between(random, -0.02, 0.02));
    trace.samples.push_back(sample);
  }
  return trace;
}

Trace random_attitudes() {
  Trace trace;
  trace.present =
      channels_of(Module::mc_att_control) & ~channels_of(Module::mc_att_control, "out/");
  trace.present |= channels_of(Module::mc_att_control, "out/vehicle_rates_setpoint.");
  Random random(2);
  const auto any = [&](float(&q)[4]) {
    set_quaternion(q, between(random, -1, 1), between(random, -1, 1), between(random, -1, 1),
                   between(random, -1, 1));
  };
  for (std::size_t tick = 0; tick < 1000; ++tick) {
    Sample sample = hovering(tick);
    any(sample.in.control_state.q);
    any(sample.in.vehicle_attitude_setpoint.q_d);
    trace.samples.push_back(sample);
  }
  return trace;
}

bool differs(Port& port, const std::string& profile, Trace given) {
  Trace want = given;
  const auto reference = open_builtin();
  drive(*reference->create(profile), want);
  if (drive(*port.create(profile), given)) return true;
  return compare(given, want, Tolerances()).first.has_value();
}

}  // namespace

bool caught_by_hover(Port& port, const std::string& profile) {
  return differs(port, profile, hover());
}

bool caught_by_random_attitudes(Port& port, const std::string& profile) {
  return differs(port, profile, random_attitudes());
}

}  // namespace attest
