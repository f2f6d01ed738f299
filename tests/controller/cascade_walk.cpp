#include "tests/controller/cascade_walk.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <random>

#include "controller/cascade/parameters.hpp"

namespace attest::test {
namespace {

constexpr int walk_count = 900;
constexpr int step_count = 160;
constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float pi = 3.14159274f;

// Draws from std::mt19937 without the distributions of the library, which differ between libraries.
class Draw {
 public:
  explicit Draw(std::uint32_t seed) : bits_(seed) {}

  float uniform(float low, float high) {
    const auto share = static_cast<float>(bits_() >> 8) / 16777216.0f;
    return low + (high - low) * share;
  }
  bool chance(float probability) { return uniform(0, 1) < probability; }
  std::uint32_t below(std::uint32_t count) { return static_cast<std::uint32_t>(bits_()) % count; }
  template <typename T>
  T of(std::initializer_list<T> values) {
    return values.begin()[below(static_cast<std::uint32_t>(values.size()))];
  }
  std::uint8_t flag(float probability = 0.5f) {
    if (!chance(probability)) return 0;
    return chance(0.1f) ? 2 : 1;
  }
  float stick() {
    if (chance(0.02f)) return of({nan, infinity, 1.5f});
    return chance(0.4f) ? of({0.0f, 0.0f, 1.0f, -1.0f, 0.05f, -0.95f}) : uniform(-1.2f, 1.2f);
  }
  // Tilts around level at any heading; half turns, poles, any attitude.
  void quaternion(float (&q)[4]) {
    constexpr float half = 0.70710678f;
    const auto set = [&q](float w, float x, float y, float z) {
      q[0] = w, q[1] = x, q[2] = y, q[3] = z;
    };
    const std::uint32_t kind = below(10);
    if (kind == 0) {
      for (float& one : q) one = uniform(-1, 1);
      normalise(q);
    } else if (kind == 1) {
      set(0, 0, 0, 0);
      q[below(4)] = of({1.0f, -1.0f});
    } else if (kind == 2) {
      set(half, 0, of({half, -half}), 0);
      if (chance(0.5f)) turn(q);
    } else {
      const float tilt = kind < 8 ? 0.2f : 1.5f;
      set(1, uniform(-tilt, tilt), uniform(-tilt, tilt), 0);
      normalise(q);
      turn(q);
    }
    if (chance(0.2f)) scale(q, -1);
    if (chance(0.05f)) scale(q, of({2.0f, 0.9f, 1.01f}));
    if (chance(0.01f)) scale(q, of({nan, 0.0f, infinity}));
  }

 private:
  static void scale(float (&q)[4], float factor) {
    for (float& one : q) one *= factor;
  }
  static void normalise(float (&q)[4]) {
    scale(q, 1 / std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]));
  }
  // By any yaw, about the world's z axis.
  void turn(float (&q)[4]) {
    const float yaw = uniform(-pi, pi), c = std::cos(yaw / 2), s = std::sin(yaw / 2);
    const float w = q[0], x = q[1], y = q[2], z = q[3];
    q[0] = c * w - s * z, q[1] = c * x - s * y, q[2] = s * x + c * y, q[3] = s * w + c * z;
  }

  std::mt19937 bits_;
};

float value_for(Draw& draw, const cascade::ParameterInfo& info) {
  if (info.is_int()) return static_cast<float>(draw.below(3));
  if (info.name == "MC_YAW_WEIGHT") return draw.of({0.0f, 0.05f, 0.7f, 1.0f, 1.5f});
  if (info.name == "MPC_THR_HOVER") return draw.of({0.06f, 0.35f, 0.89f});
  if (info.name == "MC_REF_W_N") return draw.of({0.02f, 3.0f, 30.0f, 50.0f, 200.0f});
  if (info.name == "MC_REF_FF") return draw.of({0.0f, 0.4f, 1.0f, 1.5f});
  const float max = std::isfinite(info.max) ? info.max : 2 * info.default_value + 0.3f;
  return draw.chance(0.1f) ? info.min : draw.uniform(info.min, max);
}

template <typename Inputs>
std::vector<Setting> draw_parameters(Draw& draw, cascade::ParameterTable table) {
  std::vector<Setting> settings;
  for (const cascade::ParameterInfo& info : table) {
    if (draw.chance(0.3f)) settings.emplace_back(info.name, value_for(draw, info));
  }
  return settings;
}

std::uint64_t draw_step_us(Draw& draw, std::uint64_t usual_us) {
  return draw.chance(0.8f) ? usual_us
                           : draw.of<std::uint64_t>({100, 160, 1300, 3003, 30000, 700000});
}

// ---- attitude unit ------------------------------------------------------------------------------

void draw_modes(Draw& draw, attest_attitude_inputs& in) {
  auto& mode = in.vehicle_control_mode;
  mode = {draw.flag(0.9f), 0, 0, 0, draw.flag(0.9f)};
  if (draw.chance(0.25f)) mode.flag_control_altitude_enabled = draw.flag();
  if (draw.chance(0.25f)) mode.flag_control_velocity_enabled = draw.flag();
  if (draw.chance(0.25f)) mode.flag_control_position_enabled = draw.flag();
}

void draw_status(Draw& draw, attest_attitude_inputs& in) {
  in.vehicle_status = {
      .armed_time = in.timestamp - draw.of<std::uint64_t>({0, 500000, 1500000, 4000000}),
      .armed = draw.flag(0.8f),
      .is_rotary_wing = draw.flag(0.9f),
      .is_vtol = draw.flag(0.2f),
      .in_transition_mode = draw.flag(0.2f),
      .is_vtol_tailsitter = draw.flag(0.3f)};
}

void draw_position(Draw& draw, attest_attitude_inputs& in) {
  auto& position = in.vehicle_local_position;
  position.heading_good_for_control = draw.flag(0.9f);
  float& heading = position.unaided_heading;
  if (draw.chance(0.3f)) heading = draw.of({nan, 0.0f, infinity});
  if (!std::isfinite(heading) || draw.chance(0.2f)) heading = draw.uniform(-pi, pi);
  heading += draw.of({0.3f, 0.03f}) * draw.uniform(-1, 1);
  if (draw.chance(0.15f)) heading = nan;
}

void draw_reset(Draw& draw, attest_attitude_inputs& in) {
  auto& attitude = in.vehicle_attitude;
  attitude.quat_reset_counter =
      static_cast<std::uint8_t>(attitude.quat_reset_counter + draw.of({1, 1, 2, 200}));
  draw.quaternion(attitude.delta_q_reset);
}

// A half turn about the body's x or y axis away from q.
void half_turn(bool about_x, const float (&q)[4], float (&turned)[4]) {
  if (about_x) {
    turned[0] = -q[1], turned[1] = q[0], turned[2] = q[3], turned[3] = -q[2];
  } else {
    turned[0] = -q[2], turned[1] = -q[3], turned[2] = q[0], turned[3] = q[1];
  }
}

void draw_setpoint(Draw& draw, attest_attitude_inputs& in) {
  auto& setpoint = in.vehicle_attitude_setpoint;
  setpoint.timestamp = in.timestamp - draw.of<std::uint64_t>({0, 0, 500, 1500, 9000});
  if (draw.chance(0.03f)) setpoint.timestamp = in.timestamp + 20000;
  draw.quaternion(setpoint.q_d);
  if (draw.chance(0.1f)) half_turn(draw.chance(0.5f), in.vehicle_attitude.q, setpoint.q_d);
  for (float& thrust : setpoint.thrust_body) thrust = draw.uniform(-1.2f, 0.3f);
  setpoint.yaw_sp_move_rate = draw.chance(0.1f) ? draw.of({nan, infinity}) : draw.uniform(-4, 4);
}

void draw_autotune(Draw& draw, attest_attitude_inputs& in) {
  auto& autotune = in.autotune_attitude_control_status;
  autotune.timestamp = in.timestamp - draw.of<std::uint64_t>({0, 0, 500000, 2000000});
  for (float& rate : autotune.rate_sp) rate = draw.uniform(-1, 1);
  autotune.state = static_cast<std::uint8_t>(draw.below(14));
}

// Each topic changes with the probability `restless`.
void wander(Draw& draw, float restless, attest_attitude_inputs& in) {
  const auto moves = [&](float share) { return draw.chance(restless * share); };
  if (moves(1)) draw.quaternion(in.vehicle_attitude.q);
  if (moves(0.2f)) draw_reset(draw, in);
  if (moves(1)) draw_setpoint(draw, in);
  auto& sticks = in.manual_control_setpoint;
  for (float* stick : {&sticks.roll, &sticks.pitch, &sticks.yaw, &sticks.throttle}) {
    if (moves(0.7f)) *stick = draw.stick();
  }
  if (moves(0.3f)) draw_modes(draw, in);
  if (moves(0.3f)) draw_status(draw, in);
  if (moves(0.5f)) draw_position(draw, in);
  if (moves(0.3f)) in.vehicle_land_detected.landed = draw.flag(0.3f);
  if (moves(0.5f))
    in.hover_thrust_estimate = {draw.of({0.02f, 0.02f, 0.4f, 0.97f, nan}), draw.flag(0.8f)};
  if (moves(0.3f)) draw_autotune(draw, in);
}

void draw_clock(Draw& draw, std::uint64_t usual_us, attest_attitude_inputs& in) {
  in.timestamp += draw_step_us(draw, usual_us);
  auto& attitude = in.vehicle_attitude;
  attitude.timestamp = in.timestamp - draw.of<std::uint64_t>({0, 0, 0, 400});
  attitude.timestamp_sample = attitude.timestamp - draw.of<std::uint64_t>({0, 0, 0, 700});
}

void start(Draw& draw, attest_attitude_inputs& in) {
  draw.quaternion(in.vehicle_attitude.q);
  in.vehicle_attitude.quat_reset_counter = draw.of<std::uint8_t>({0, 0, 3});
  draw.quaternion(in.vehicle_attitude.delta_q_reset);
  draw_setpoint(draw, in);
  draw_modes(draw, in);
  draw_status(draw, in);
  in.vehicle_status.is_rotary_wing = 1;
  in.vehicle_local_position = {draw.of({nan, 0.5f}), 1};
}

// ---- rate unit ----------------------------------------------------------------------------------

void draw_rates(Draw& draw, attest_rate_inputs& in) {
  const float range = draw.of({0.5f, 0.5f, 9.0f});
  for (float& rate : in.vehicle_angular_velocity.xyz) {
    rate = draw.chance(0.003f) ? draw.of({nan, infinity}) : draw.uniform(-range, range);
  }
  for (float& acceleration : in.vehicle_angular_velocity.xyz_derivative) {
    acceleration = draw.uniform(-20, 20);
  }
}

void draw_rates_setpoint(Draw& draw, attest_rate_inputs& in) {
  auto& setpoint = in.vehicle_rates_setpoint;
  for (float* rate : {&setpoint.roll, &setpoint.pitch, &setpoint.yaw}) {
    *rate = draw.chance(0.03f) ? draw.of({nan, infinity}) : draw.uniform(-4, 4);
  }
  for (float& thrust : setpoint.thrust_body) {
    thrust = draw.chance(0.02f) ? nan : draw.uniform(-1.3f, 0.3f);
  }
}

void draw_allocation(Draw& draw, attest_rate_inputs& in) {
  auto& status = in.control_allocator_status;
  for (float& torque : status.unallocated_torque) {
    torque = draw.of({0.0f, 0.0f, 0.01f, -0.01f, 0.3f, -0.3f});
  }
  status.torque_setpoint_achieved = draw.flag(0.4f);
}

void wander(Draw& draw, float restless, attest_rate_inputs& in) {
  const auto moves = [&](float share) { return draw.chance(restless * share); };
  if (moves(1)) draw_rates(draw, in);
  if (moves(0.5f)) draw_rates_setpoint(draw, in);
  auto& sticks = in.manual_control_setpoint;
  for (float* stick : {&sticks.roll, &sticks.pitch, &sticks.yaw, &sticks.throttle}) {
    if (moves(0.7f)) *stick = draw.stick();
  }
  if (moves(0.3f)) draw_allocation(draw, in);
  if (moves(0.3f)) {
    in.battery_status = {draw.of({0.0f, -1.0f, 1.0f, 0.8f, 1.4f, infinity}), draw.flag(0.8f)};
  }
  if (moves(0.2f)) {
    in.vehicle_control_mode = {draw.flag(0.85f), draw.flag(0.5f), draw.flag(0.6f),
                               draw.flag(0.85f)};
  }
  if (moves(0.1f)) in.vehicle_status.is_rotary_wing = draw.flag(0.8f);
  if (moves(0.2f)) in.vehicle_land_detected = {draw.flag(0.3f), draw.flag(0.3f)};
}

void draw_clock(Draw& draw, std::uint64_t usual_us, attest_rate_inputs& in) {
  in.timestamp += draw_step_us(draw, usual_us);
  std::uint64_t& sample_us = in.vehicle_angular_velocity.timestamp_sample;
  sample_us = in.timestamp - draw.of<std::uint64_t>({0, 0, 0, 700});
}

void start(Draw& draw, attest_rate_inputs& in) {
  draw_rates(draw, in);
  draw_rates_setpoint(draw, in);
  draw_allocation(draw, in);
  in.battery_status = {1.3f, 1};
  in.vehicle_control_mode = {1, draw.flag(), draw.flag(), 1};
  in.vehicle_status.is_rotary_wing = 1;
}

// ---- both ---------------------------------------------------------------------------------------

template <typename Inputs>
Walk<Inputs> draw_walk(Draw& draw, cascade::ParameterTable table) {
  Walk<Inputs> walk{draw_parameters<Inputs>(draw, table), {}};
  const float restless = draw.of({0.005f, 0.02f, 0.1f, 0.5f});
  const auto usual_us = draw.of<std::uint64_t>({150, 1000, 4000, 4000, 20000});
  Inputs in{};
  in.timestamp = draw.of<std::uint64_t>({5'000'000, 900'000'000, 4'294'900'000});
  start(draw, in);
  for (int i = 0; i < step_count; ++i) {
    draw_clock(draw, usual_us, in);
    wander(draw, restless, in);
    in.updated = 0;
    for (std::uint32_t bit = 0; bit < 8; ++bit) {
      if (draw.chance(i == 0 ? 0.8f : 0.3f)) in.updated |= 1u << bit;
    }
    WalkStep<Inputs> step{in, std::nullopt};
    if (draw.chance(0.03f)) {
      const auto& info = table[draw.below(static_cast<std::uint32_t>(table.size()))];
      step.set = {info.name, value_for(draw, info)};
    }
    if (step.set || draw.chance(0.03f)) step.in.updated |= 1u << 8;  // parameter_update
    walk.steps.push_back(step);
  }
  return walk;
}

template <typename Inputs>
std::vector<Walk<Inputs>> draw_walks(cascade::ParameterTable table) {
  Draw draw(20160601);
  std::vector<Walk<Inputs>> walks;
  for (int i = 0; i < walk_count; ++i) walks.push_back(draw_walk<Inputs>(draw, table));
  return walks;
}

}  // namespace

std::vector<Walk<attest_attitude_inputs>> attitude_walks() {
  return draw_walks<attest_attitude_inputs>(cascade::attitude_parameters());
}

std::vector<Walk<attest_rate_inputs>> rate_walks() {
  return draw_walks<attest_rate_inputs>(cascade::rate_parameters());
}

}  // namespace attest::test
