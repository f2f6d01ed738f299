// The parts of the catalogue, by subject.
#pragma once

#include <memory>
#include <span>

#include "controller/faults/faulty_controller.hpp"

namespace attest::faults {

std::span<const Fault> attitude_faults();
std::span<const Fault> yaw_faults();
std::span<const Fault> large_angle_faults();
std::span<const Fault> rate_limit_faults();
std::span<const Fault> yaw_feed_forward_faults();
std::span<const Fault> weathervane_faults();
std::span<const Fault> rate_faults();
std::span<const Fault> tpa_faults();
std::span<const Fault> anti_windup_faults();
std::span<const Fault> battery_faults();
std::span<const Fault> mode_faults();
std::span<const Fault> arming_faults();
std::span<const Fault> parameter_faults();
std::span<const Fault> timing_faults();
std::span<const Fault> robustness_faults();
std::span<const Fault> tailsitter_faults();
std::span<const Fault> actuator_faults();
std::span<const Fault> v1_3_4_faults();
std::span<const Fault> mixer_faults();
std::span<const Fault> mixer_fit_faults();
std::span<const Fault> battery_status_faults();

// The faults of the two units of the cascade (files cascade_*.cpp).
namespace in_cascade {
std::span<const Fault> attitude_faults();
std::span<const Fault> large_angle_faults();
std::span<const Fault> yaw_weight_faults();
std::span<const Fault> yaw_feed_forward_faults();
std::span<const Fault> model_faults();
std::span<const Fault> model_yaw_faults();
std::span<const Fault> model_forward_faults();
std::span<const Fault> model_state_faults();
std::span<const Fault> stick_faults();
std::span<const Fault> yaw_lock_faults();
std::span<const Fault> lost_heading_faults();
std::span<const Fault> throttle_faults();
std::span<const Fault> spool_up_faults();
std::span<const Fault> reset_faults();
std::span<const Fault> attitude_mode_faults();
std::span<const Fault> guard_faults();
std::span<const Fault> torque_faults();
std::span<const Fault> integral_faults();
std::span<const Fault> rate_mode_faults();
std::span<const Fault> yaw_filter_faults();
std::span<const Fault> battery_faults();
std::span<const Fault> parameter_faults();
std::span<const Fault> timing_faults();
std::span<const Fault> axis_faults();
std::span<const Fault> signal_faults();
std::span<const Fault> step_faults();
std::span<const Fault> formula_faults();
std::span<const Fault> filter_faults();
}  // namespace in_cascade

}  // namespace attest::faults
