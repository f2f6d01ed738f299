#include "harness/diagnosis/naive_suite.hpp"

#include <cmath>

#include "harness/casefile/baseline.hpp"
#include "harness/compare/compare.hpp"
#include "harness/core/random.hpp"
#include "harness/golden/reference.hpp"
#include "harness/loop/open_loop.hpp"
#include "harness/port/profiles.hpp"

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

// `sample`: the baseline. The vehicle hovers level, and gets a setpoint in each step. All topics
// are new in the first.
Sample held(Module module, std::size_t tick, Sample sample) {
  const std::uint64_t now = sample.in.timestamp = 5'000'000 + 4000 * tick;
  const auto setpoint = updated_channel(module, info_of(module).setpoint_topic);
  sample.in.updated = tick == 0 ? ~0u : channels()[setpoint].bit;
  if (module == Module::rate_unit) {
    sample.rate_in.vehicle_angular_velocity.timestamp_sample = now;
  } else if (module == Module::attitude_unit) {
    auto& in = sample.attitude_in;
    in.vehicle_attitude.timestamp = in.vehicle_attitude.timestamp_sample = now;
    in.vehicle_attitude_setpoint.timestamp = now;
    in.vehicle_local_position.unaided_heading = 0;
    in.vehicle_control_mode.flag_control_velocity_enabled = 0;
    in.vehicle_control_mode.flag_control_position_enabled = 0;
  } else {
    sample.in.manual_control_setpoint.z = 0;
    sample.in.vehicle_control_mode.flag_control_rattitude_enabled = 0;
  }
  return sample;
}

using Q = float[4];
Q& attitude_in(Sample& sample, Module module) {
  return module == Module::attitude_unit ? sample.attitude_in.vehicle_attitude.q
                                         : sample.in.control_state.q;
}
Q& setpoint_in(Sample& sample, Module module) {
  return module == Module::attitude_unit ? sample.attitude_in.vehicle_attitude_setpoint.q_d
                                         : sample.in.vehicle_attitude_setpoint.q_d;
}

void set_rates(Sample& sample, Module module, float roll, float pitch, float yaw) {
  if (module == Module::rate_unit) {
    float(&xyz)[3] = sample.rate_in.vehicle_angular_velocity.xyz;
    xyz[0] = roll, xyz[1] = pitch, xyz[2] = yaw;
  } else if (module == Module::mc_att_control) {
    auto& state = sample.in.control_state;
    state.roll_rate = roll, state.pitch_rate = pitch, state.yaw_rate = yaw;
  }
}

// Roll and pitch that wander by small angles, small random rates, and a constant level setpoint.
Trace hover(Module module) {
  Trace trace;
  trace.present = channels_of(module);
  const Sample level = baseline_sample(module);
  Random random(1);
  double roll = 0, pitch = 0;
  for (std::size_t tick = 0; tick < 2500; ++tick) {
    Sample sample = held(module, tick, level);
    roll = 0.99 * roll + between(random, -0.003, 0.003);
    pitch = 0.99 * pitch + between(random, -0.003, 0.003);
    if (module != Module::rate_unit) set_quaternion(attitude_in(sample, module), 1, roll, pitch, 0);
    const auto p = static_cast<float>(between(random, -0.05, 0.05));
    const auto q = static_cast<float>(between(random, -0.05, 0.05));
    const auto r = static_cast<float>(between(random, -0.02, 0.02));
    set_rates(sample, module, p, q, r);
    trace.samples.push_back(sample);
  }
  return trace;
}

// The rates setpoint alone is compared.
Trace random_attitudes(Module module) {
  Trace trace;
  trace.present = channels_of(module) & ~channels_of(module, "out/");
  trace.present |= channels_of(module, "out/vehicle_rates_setpoint.");
  const Sample level = baseline_sample(module);
  Random random(2);
  const auto any = [&](float(&q)[4]) {
    set_quaternion(q, between(random, -1, 1), between(random, -1, 1), between(random, -1, 1),
                   between(random, -1, 1));
  };
  for (std::size_t tick = 0; tick < 1000; ++tick) {
    Sample sample = held(module, tick, level);
    any(attitude_in(sample, module));
    any(setpoint_in(sample, module));
    trace.samples.push_back(sample);
  }
  return trace;
}

bool differs(Port& port, const std::string& profile, Module module, Trace given) {
  const ModuleUnderTest subject{.profile = profile, .module = module};
  const Trace want = reference_outputs(subject, given).value();
  if (drive(port, subject, given)) return true;
  return compare(given, want, Tolerances()).first.has_value();
}

bool has_cascade(const std::string& profile) {
  const ProfileInfo* const known = find_profile(profile);
  return known != nullptr && contains(known->modules, Module::attitude_unit);
}

}  // namespace

bool caught_by_hover(Port& port, const std::string& profile) {
  const auto differs_in = [&](Module module) {
    return differs(port, profile, module, hover(module));
  };
  if (!has_cascade(profile)) return differs_in(Module::mc_att_control);
  return differs_in(Module::attitude_unit) || differs_in(Module::rate_unit);
}

bool caught_by_random_attitudes(Port& port, const std::string& profile) {
  const Module module = has_cascade(profile) ? Module::attitude_unit : Module::mc_att_control;
  return differs(port, profile, module, random_attitudes(module));
}

}  // namespace attest
