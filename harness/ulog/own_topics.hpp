// Tells which samples of a log a unit of PX4 v1.14 to v1.18 published itself. Depending on the
// mode, other modules publish vehicle_attitude_setpoint and vehicle_rates_setpoint.
#pragma once

#include <cstdint>
#include <string_view>

#include "harness/trace/module.hpp"

namespace attest::ulog {

// An output that is more than this after a step does not belong to it. An attitude unit runs at up
// to 250 Hz, and publishes a fraction of a millisecond after its sample.
inline constexpr std::uint64_t latest_answer_us = 2000;

// Whether the unit itself publishes the topic in a step with these inputs. Always true for a topic
// that only this unit publishes, and for every topic of the controller of v1.5.5 and v1.3.4.
bool publishes(Module module, std::string_view topic, const Sample& sample);

// Whether the attitude unit makes its setpoint from the sticks, with filters (stabilized mode).
// REQUIRES: a sample of the attitude unit.
bool is_of_sticks(const Sample& sample);

// Whether the vehicle flies as a multicopter, or as a tailsitter in a transition, so that these
// units fly it. REQUIRES: a unit of the cascade.
bool flies_by_rotors(Module module, const Sample& sample);

// Whether the rate unit makes its setpoint from the sticks (acro mode). REQUIRES: a sample of the
// rate unit.
bool is_acro(const Sample& sample);

// Whether the vehicle is armed and off the ground, according to the inputs. REQUIRES: a unit
// of the cascade.
bool is_in_flight(Module module, const Sample& sample);

}  // namespace attest::ulog
