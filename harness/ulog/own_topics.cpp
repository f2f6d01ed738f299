#include "harness/ulog/own_topics.hpp"

#include "controller/cascade/attitude_unit.hpp"
#include "controller/cascade/rate_unit.hpp"

namespace attest::ulog {
namespace {

using AttitudeStages = cascade::AttitudeStepStages<float>;

cascade::AttitudeTopics topics_of(const attest_attitude_inputs& in) {
  cascade::AttitudeTopics topics;
  topics.mode = in.vehicle_control_mode;
  topics.status = in.vehicle_status;
  return topics;
}

}  // namespace

bool is_of_sticks(const Sample& sample) {
  const cascade::AttitudeTopics topics = topics_of(sample.attitude_in);
  return AttitudeStages::runs(topics) && AttitudeStages::follows_sticks(topics);
}

bool publishes(Module module, std::string_view topic, const Sample& sample) {
  if (module == Module::attitude_unit) {
    return topic == "vehicle_attitude_setpoint"
               ? is_of_sticks(sample)
               : AttitudeStages::runs(topics_of(sample.attitude_in));
  }
  if (module == Module::rate_unit && topic == "vehicle_rates_setpoint") return is_acro(sample);
  return true;
}

bool is_acro(const Sample& sample) {
  cascade::RateTopics topics;
  topics.mode = sample.rate_in.vehicle_control_mode;
  return cascade::RateStepStages<float>::is_acro(topics);
}

bool flies_by_rotors(Module module, const Sample& sample) {
  if (module == Module::rate_unit) return sample.rate_in.vehicle_status.is_rotary_wing != 0;
  cascade::AttitudeTopics topics = topics_of(sample.attitude_in);
  topics.mode.flag_control_attitude_enabled = 1;
  return AttitudeStages::runs(topics);
}

bool is_in_flight(Module module, const Sample& sample) {
  const auto& land = sample.rate_in.vehicle_land_detected;
  const bool may_stand = module == Module::attitude_unit
                             ? sample.attitude_in.vehicle_land_detected.landed != 0
                             : land.landed != 0 || land.maybe_landed != 0;
  return info_of(module).is_armed(sample) && !may_stand;
}

}  // namespace attest::ulog
