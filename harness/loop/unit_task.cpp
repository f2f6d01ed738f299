#include "harness/loop/unit_task.hpp"

namespace attest {

UnitTask::UnitTask(const Case& the_case, const Rate& rate, const Vehicle& vehicle, Unit& unit,
                   const ControlState& start)
    : stimulus_(the_case, rate), actuators_(vehicle), driver_(unit) {
  sample_.in.control_state = start;
}

std::optional<PortFault> UnitTask::tick(std::size_t tick, Nanoseconds now,
                                        const Arrivals& arrivals) {
  prepare(tick, now, arrivals);
  return step(tick);
}

void UnitTask::prepare(std::size_t tick, Nanoseconds now, const Arrivals& arrivals) {
  changes_.clear();
  stimulus_.tick(tick, now, sample_, changes_);
  attest_inputs& in = sample_.in;
  if (arrivals.estimate) {
    in.control_state = arrivals.estimate->state;
    sampled_ = arrivals.estimate->sampled;
  }
  timestamp_sample_us_ = stimulus_.timestamp_us(sampled_);
  if (arrivals.battery_scale) {
    in.battery_status.scale = *arrivals.battery_scale;
    in.updated |= ATTEST_UPDATED_BATTERY_STATUS;
  }
  if (arrivals.limits) {
    in.multirotor_motor_limits = *arrivals.limits;
    in.updated |= ATTEST_UPDATED_MULTIROTOR_MOTOR_LIMITS;
  }
}

std::optional<PortFault> UnitTask::step(std::size_t tick) {
  auto fault =
      ports_.run([&] { return driver_.step(tick, changes_, sample_, timestamp_sample_us_); });
  if (!fault) actuators_.mix(sample_.out, is_armed());
  return fault;
}

}  // namespace attest
