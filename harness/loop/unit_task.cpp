#include "harness/loop/unit_task.hpp"

#include <algorithm>

namespace attest {

std::optional<RatesSetpoint> rates_setpoint_of(const attest_attitude_outputs& outputs) {
  const auto& out = outputs.vehicle_rates_setpoint;
  if (out.published == 0) return std::nullopt;
  return RatesSetpoint{
      out.roll, out.pitch, out.yaw, {out.thrust_body[0], out.thrust_body[1], out.thrust_body[2]}};
}

UnitTask::UnitTask(const Case& the_case, const Rate& rate, const Vehicle& vehicle, Unit& unit,
                   const Estimate& start)
    : module_(the_case.module),
      stimulus_(the_case, rate),
      airmode_signal_(the_case.flight->airmode, timeline_of(the_case, rate)),
      actuators_(vehicle, the_case.module),
      driver_(unit, the_case.module),
      estimate_(start) {}

std::optional<PortFault> UnitTask::tick(std::size_t tick, Nanoseconds now,
                                        const Arrivals& arrivals) {
  prepare(tick, now, arrivals);
  return step(tick);
}

void UnitTask::prepare(std::size_t tick, Nanoseconds now, const Arrivals& arrivals) {
  airmode_ = airmode_of(airmode_signal_.at(now));
  changes_.clear();
  stimulus_.tick(tick, now, sample_, changes_);
  if (arrivals.estimate) estimate_ = *arrivals.estimate;
  switch (module_) {
    case Module::mc_att_control:
      return take(arrivals, sample_.in);
    case Module::attitude_unit:
      return take(arrivals, sample_.attitude_in);
    case Module::rate_unit:
      return take(arrivals, sample_.rate_in);
    default:  // does not fly
      return;
  }
}

void UnitTask::take(const Arrivals& arrivals, attest_inputs& in) {
  in.control_state = estimate_.state;
  if (arrivals.battery_scale) {
    in.battery_status.scale = *arrivals.battery_scale;
    in.updated |= ATTEST_UPDATED_BATTERY_STATUS;
  }
  if (arrivals.saturation) {
    in.multirotor_motor_limits = arrivals.saturation->limits;
    in.updated |= ATTEST_UPDATED_MULTIROTOR_MOTOR_LIMITS;
  }
}

// vehicle_attitude is published at each tick, with the last estimate that has arrived.
void UnitTask::take(const Arrivals& arrivals, attest_attitude_inputs& in) {
  in.vehicle_attitude.timestamp = in.timestamp;
  in.vehicle_attitude.timestamp_sample = stimulus_.timestamp_us(estimate_.sampled);
  std::copy_n(estimate_.state.q, 4, in.vehicle_attitude.q);
  std::copy_n(estimate_.delta_q_reset.begin(), 4, in.vehicle_attitude.delta_q_reset);
  in.vehicle_attitude.quat_reset_counter = estimate_.resets;
  if (arrivals.landed) {
    in.vehicle_land_detected.landed = arrivals.landed->landed ? 1 : 0;
    in.updated |= ATTEST_ATTITUDE_UPDATED_VEHICLE_LAND_DETECTED;
  }
}

void UnitTask::take(const Arrivals& arrivals, attest_rate_inputs& in) {
  auto& gyro = in.vehicle_angular_velocity;
  const auto& [q, roll, pitch, yaw] = estimate_.state;
  gyro.timestamp_sample = stimulus_.timestamp_us(estimate_.sampled);
  std::copy_n(std::array{roll, pitch, yaw}.begin(), 3, gyro.xyz);
  std::copy_n(estimate_.acceleration_rad_s2.begin(), 3, gyro.xyz_derivative);
  if (arrivals.rates_setpoint) {
    in.vehicle_rates_setpoint = *arrivals.rates_setpoint;
    in.updated |= ATTEST_RATE_UPDATED_VEHICLE_RATES_SETPOINT;
  }
  if (arrivals.battery_scale) {
    in.battery_status = {*arrivals.battery_scale, 1};
    in.updated |= ATTEST_RATE_UPDATED_BATTERY_STATUS;
  }
  if (arrivals.saturation) {
    auto& status = in.control_allocator_status;
    std::copy_n(arrivals.saturation->unallocated_torque.begin(), 3, status.unallocated_torque);
    status.torque_setpoint_achieved = arrivals.saturation->torque_setpoint_achieved ? 1 : 0;
    in.updated |= ATTEST_RATE_UPDATED_CONTROL_ALLOCATOR_STATUS;
  }
  if (arrivals.landed) {
    in.vehicle_land_detected = {static_cast<std::uint8_t>(arrivals.landed->maybe_landed),
                                static_cast<std::uint8_t>(arrivals.landed->landed)};
    in.updated |= ATTEST_RATE_UPDATED_VEHICLE_LAND_DETECTED;
  }
}

std::optional<PortFault> UnitTask::step(std::size_t tick) {
  const std::uint64_t timestamp_sample_us = stimulus_.timestamp_us(estimate_.sampled);
  auto fault =
      ports_.run([&] { return driver_.step(tick, changes_, sample_, timestamp_sample_us); });
  if (!fault) actuators_.follow(sample_, airmode_);
  return fault;
}

float UnitTask::throttle() const {
  return module_ == Module::rate_unit ? -sample_.rate_out.vehicle_thrust_setpoint.xyz[2]
                                      : sample_.out.actuator_controls_0.control[3];
}

}  // namespace attest
