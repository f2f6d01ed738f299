#include "harness/trace/module_table.hpp"

namespace attest {
namespace {

// The battery is measured at 100 Hz in the firmware. Mixer and laws have no clock, so one rate is
// enough: the rate law is given its dt. The estimator publishes 50 to 1000 attitudes a second.
constexpr int rates_of_mixer[] = {250}, rates_of_battery[] = {100}, rates_of_law[] = {250};
constexpr int rates_of_attitude_unit[] = {50, 100, 250, 500, 1000};
constexpr std::span<const int> standard;

#define BLOCK(member) \
  Block { offsetof(Sample, member), sizeof(Sample::member) }

}  // namespace

constinit const std::array<ModuleInfo, module_count> module_table{{
    {Module::mc_att_control, "mc_att_control", "controller", nullptr, BLOCK(in), BLOCK(out),
     abi_of(&attest_unit::step), "", standard, Profiles::with_controller, "control_state",
     "vehicle_attitude_setpoint", BLOCK(in.timestamp), BLOCK(in.actuator_armed.armed)},
    {Module::mixer, "mixer", "mixer", ATTEST_EXTENSION_MIXER, BLOCK(mixer_in), BLOCK(mixer_out),
     abi_of(&attest_mixer::step), "mixer", rates_of_mixer, Profiles::only_v1_5_5},
    {Module::battery_status, "battery_status", "battery estimate", ATTEST_EXTENSION_BATTERY_STATUS,
     BLOCK(battery_in), BLOCK(battery_out), abi_of(&attest_battery_status::step), "battery",
     rates_of_battery, Profiles::only_v1_5_5},
    {Module::attitude_unit, "attitude_unit", "attitude unit", ATTEST_EXTENSION_ATTITUDE_UNIT,
     BLOCK(attitude_in), BLOCK(attitude_out), abi_of(&attest_attitude_unit::step), "",
     rates_of_attitude_unit, Profiles::with_cascade, "vehicle_attitude",
     "vehicle_attitude_setpoint", BLOCK(attitude_in.vehicle_attitude.timestamp_sample),
     BLOCK(attitude_in.vehicle_status.armed)},
    {Module::rate_unit, "rate_unit", "rate unit", ATTEST_EXTENSION_RATE_UNIT, BLOCK(rate_in),
     BLOCK(rate_out), abi_of(&attest_rate_unit::step), "", standard, Profiles::with_cascade,
     "vehicle_angular_velocity", "vehicle_rates_setpoint",
     BLOCK(rate_in.vehicle_angular_velocity.timestamp_sample),
     BLOCK(rate_in.vehicle_control_mode.flag_armed)},
    {Module::attitude_law, "attitude_law", "attitude law", ATTEST_EXTENSION_ATTITUDE_LAW,
     BLOCK(attitude_law.in), BLOCK(attitude_law_out), abi_of(&attest_attitude_law::step), "",
     rates_of_law, Profiles::all},
    {Module::rate_law, "rate_law", "rate law", ATTEST_EXTENSION_RATE_LAW, BLOCK(rate_law.in),
     BLOCK(rate_law_out), abi_of(&attest_rate_law::step), "", rates_of_law, Profiles::all},
}};

#undef BLOCK

constinit const std::array<std::string_view, stage_count> stage_names{
    "input",      "sticks",    "attitude law", "rate law",
    "integrator", "actuators", "mixer",        "battery status"};

}  // namespace attest
