#include "tests/controller/generators.hpp"

#include <bit>
#include <cmath>

namespace attest::test {
namespace {

constexpr std::uint32_t all_topics = 0x1ff;

std::uint8_t draw_flag() { return *rc::gen::element<std::uint8_t>(0, 1, 2, 4); }

template <std::size_t count>
void draw_floats(float (&values)[count]) {
  for (float& value : values) value = *mostly_ordinary_float();
}

void draw_setpoints(attest_inputs& in) {
  auto& attitude = in.vehicle_attitude_setpoint;
  draw_floats(attitude.q_d);
  attitude.thrust = *mostly_ordinary_float();
  attitude.yaw_sp_move_rate = *mostly_ordinary_float();
  attitude.landing_gear = *mostly_ordinary_float();
  attitude.disable_mc_yaw_control = draw_flag();
  float rates[4];
  draw_floats(rates);
  in.vehicle_rates_setpoint = {rates[0], rates[1], rates[2], rates[3]};
  draw_floats(rates);
  in.manual_control_setpoint = {rates[0], rates[1], rates[2], rates[3]};
}

void draw_flags(attest_inputs& in) {
  in.vehicle_control_mode = {draw_flag(), draw_flag(), draw_flag(),
                             draw_flag(), draw_flag(), draw_flag()};
  in.actuator_armed.armed = draw_flag();
  in.vehicle_status = {draw_flag(), draw_flag()};
  in.multirotor_motor_limits = {draw_flag(), draw_flag(), draw_flag()};
}

}  // namespace

rc::Gen<double> uniform(double low, double high) {
  constexpr int steps = 1'000'000;
  const auto whole = rc::gen::resize(rc::kNominalSize, rc::gen::inRange(0, steps + 1));
  return rc::gen::map(whole, [low, high](int i) { return low + (high - low) * i / steps; });
}

Quaterniond tilt_quaternion(double direction, double angle) {
  const double sine = std::sin(angle / 2);
  return {std::cos(angle / 2), std::cos(direction) * sine, std::sin(direction) * sine, 0.0};
}

Quaterniond yaw_quaternion(double angle) {
  return {std::cos(angle / 2), 0.0, 0.0, std::sin(angle / 2)};
}

rc::Gen<Quaterniond> any_attitude() {
  return rc::gen::exec([] {
    const Quaterniond yaw = yaw_quaternion(*uniform(-M_PI, M_PI));
    const Quaterniond tilt = tilt_quaternion(*uniform(-M_PI, M_PI), *uniform(0.0, M_PI));
    return mc_att_control::product(yaw, tilt);
  });
}

rc::Gen<float> any_float() {
  return rc::gen::map(rc::gen::arbitrary<std::uint32_t>(),
                      [](std::uint32_t bits) { return std::bit_cast<float>(bits); });
}

rc::Gen<float> mostly_ordinary_float() {
  const auto ordinary =
      rc::gen::map(uniform(-1.5, 1.5), [](double value) { return static_cast<float>(value); });
  const auto special = rc::gen::element(0.0f, -0.0f, NAN, INFINITY, -INFINITY, 1e30f, 1e-40f);
  return rc::gen::weightedOneOf<float>({{90, ordinary}, {5, special}, {5, any_float()}});
}

rc::Gen<attest_inputs> any_step(std::uint64_t previous_us) {
  return rc::gen::exec([previous_us] {
    attest_inputs in{};
    in.timestamp = previous_us + static_cast<std::uint64_t>(*uniform(1.0, 30000.0));
    in.updated = static_cast<std::uint32_t>(*uniform(0.0, all_topics));
    draw_floats(in.control_state.q);
    in.control_state.roll_rate = *mostly_ordinary_float();
    in.control_state.pitch_rate = *mostly_ordinary_float();
    in.control_state.yaw_rate = *mostly_ordinary_float();
    in.battery_status.scale = *mostly_ordinary_float();
    draw_setpoints(in);
    draw_flags(in);
    return in;
  });
}

}  // namespace attest::test
