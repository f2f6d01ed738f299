// Which samples of a log a unit of PX4 v1.14 to v1.16 published itself. Other modules publish
// vehicle_attitude_setpoint and vehicle_rates_setpoint, too, depending on the mode.
#pragma once

#include <string_view>

#include "harness/trace/module.hpp"

namespace attest::ulog {

// Whether the unit itself publishes the topic in a step with these inputs. Always true for a topic
// that only this unit publishes, and for every topic of the controller of v1.5.5.
bool publishes(Module module, std::string_view topic, const Sample& sample);

// Whether the attitude unit makes its setpoint from the sticks, with filters (stabilized mode).
bool is_of_sticks(const Sample& sample);

// Whether the vehicle is armed and off the ground, as far as the module knows.
bool is_in_flight(Module module, const Sample& sample);

}  // namespace attest::ulog
