#include "harness/compare/suspected_stages.hpp"

#include "harness/compare/followed_setpoint.hpp"
#include "harness/core/agreement.hpp"
#include "harness/trace/output_topics.hpp"

namespace attest {
namespace {

bool is_of_outer_loop(const Channel& output) {
  return output.module == Module::mc_att_control && output.stage == Stage::attitude_law;
}

bool is_in_rate_loop(Stage stage) {
  return stage == Stage::rate_law || stage == Stage::integrator || stage == Stage::actuators;
}

// In the mode `rattitude` a stick beyond a threshold (a parameter) selects acro. The thrust shows
// the choice: that of acro comes from the throttle stick, otherwise it is that of the setpoint.
StageSet writers_in_rattitude(const Sample& want) {
  const auto& manual = want.in.manual_control_setpoint;
  const auto& out = want.out.vehicle_rates_setpoint;
  const float of_acro = manual.z < 0.9f ? manual.z : 0.9f;
  const bool may_be_acro =
      (manual.x != 0 || manual.y != 0) && (out.published == 0 || same_bits(out.thrust, of_acro));
  const bool may_be_attitude =
      out.published == 0 || same_bits(out.thrust, want.in.vehicle_attitude_setpoint.thrust);
  if (!may_be_acro) return only(Stage::attitude_law);
  return may_be_attitude ? only(Stage::sticks) | only(Stage::attitude_law) : only(Stage::sticks);
}

// The stages that may have written the output.
StageSet writers_of(const Channel& output, const Sample& want) {
  if (!is_of_outer_loop(output)) return only(output.stage);
  if (!uses_attitude_law(want, output.module)) return only(Stage::sticks);
  const bool either = want.in.vehicle_control_mode.flag_control_rattitude_enabled != 0;
  return either ? writers_in_rattitude(want) : only(Stage::attitude_law);
}

// Whether the actuators may scale the controls that the rate law computes. Whether they do depends
// on a parameter, too.
bool may_be_scaled(const Channel& output, const Sample& want) {
  if (output.stage != Stage::rate_law || output.module == Module::rate_law) return false;
  const float scale = output.module == Module::rate_unit ? want.rate_in.battery_status.scale
                                                         : want.in.battery_status.scale;
  return scale > 0 && scale != 1;
}

// Whether the stage of the output ran. Only the controller has stages that run but do not publish.
bool ran(const Channel& output, const Sample& want) {
  if (is_published(output, want)) return true;
  if (output.module != Module::mc_att_control) return false;
  const auto& mode = want.in.vehicle_control_mode;
  if (is_of_outer_loop(output)) {
    return mode.flag_control_attitude_enabled != 0 || mode.flag_control_manual_enabled != 0;
  }
  return output.stage == Stage::rate_law && want.out.mc_att_ctrl_status.published != 0;
}

// The stages before that of `first` that ran, but without an output that is compared.
StageSet unseen_before(const Channel& first, const ChannelSet& compared, const Sample& want) {
  StageSet ran_before, seen;
  for (const std::size_t i : outputs_by_stage(channels_of(first.module, "out/"))) {
    const Channel& output = channels()[i];
    if (output.stage >= first.stage) break;
    if (output.type != ChannelType::f32 || !ran(output, want)) continue;
    const StageSet writers = writers_of(output, want);
    ran_before |= writers;
    if (compared[i] && is_published(output, want)) seen |= writers;
  }
  return ran_before & ~seen;
}

}  // namespace

StageSet suspected_stages(const ChannelSet& deviating, const ChannelSet& compared,
                          const Sample& want) {
  const std::vector<std::size_t> outputs = outputs_by_stage(deviating);
  const Channel& first = channels()[outputs.front()];
  StageSet stages = writers_of(first, want);
  // Whether a topic is published does not depend on its values.
  if (first.type == ChannelType::f32) stages |= unseen_before(first, compared, want);
  if (may_be_scaled(first, want)) stages |= only(Stage::actuators);
  if (!is_in_rate_loop(first.stage)) return stages;
  for (const std::size_t i : outputs) {
    if (is_in_rate_loop(channels()[i].stage)) stages |= only(channels()[i].stage);
  }
  return stages;
}

}  // namespace attest
