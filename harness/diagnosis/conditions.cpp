#include "harness/diagnosis/conditions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <string_view>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "harness/port/profiles.hpp"

namespace attest {
namespace {

using Reading = std::function<double(const Sample&)>;
using Axes = std::array<Reading, 3>;

constexpr double degree = std::numbers::pi / 180;

// Null if the module has no such signal.
Reading signal(Module module, std::string_view name) {
  const auto found = find_channel(module, name);
  if (!found) return nullptr;
  return [channel = channels()[*found]](const Sample& sample) { return value_of(channel, sample); };
}

// The first of some names that the module has.
Axes axes(Module module, std::initializer_list<std::array<const char*, 3>> names) {
  for (const auto& [roll, pitch, yaw] : names) {
    Axes found{signal(module, roll), signal(module, pitch), signal(module, yaw)};
    if (found[0]) return found;
  }
  return {};
}

// Null if the module has no such signal.
using Attitude = std::function<Eigen::Quaterniond(const Sample&)>;
Attitude attitude(Module module, std::string_view name) {
  std::array<Reading, 4> q;
  for (std::size_t i = 0; i < q.size(); ++i) {
    q[i] = signal(module, fmt::format("{}[{}]", name, i));
    if (!q[i]) return nullptr;
  }
  return [q](const Sample& sample) {
    return Eigen::Quaterniond(q[0](sample), q[1](sample), q[2](sample), q[3](sample)).normalized();
  };
}

// Angles of the attitude error [deg].
struct AttitudeError {
  double tilt = 0, yaw = 0;
  bool is_negative = false;  // the product of the two quaternions has a negative scalar part
};

AttitudeError error_between(const Eigen::Quaterniond& q, const Eigen::Quaterniond& q_d) {
  const Eigen::Quaterniond error = q.conjugate() * q_d;
  const double cosine = (q * Eigen::Vector3d::UnitZ()).dot(q_d * Eigen::Vector3d::UnitZ());
  AttitudeError angles;
  angles.tilt = std::acos(std::clamp(cosine, -1.0, 1.0)) / degree;
  angles.yaw = 2 * std::abs(std::atan2(error.z(), error.w())) / degree;
  if (angles.yaw > 180) angles.yaw = 360 - angles.yaw;
  angles.is_negative = error.w() < 0;
  return angles;
}

// Empty if the module has no attitude. A unit that publishes a setpoint of the sticks follows it.
std::vector<AttitudeError> attitude_errors(Module module, const Trace& trace) {
  const Attitude q = attitude(
      module, module == Module::mc_att_control ? "in/control_state.q" : "in/vehicle_attitude.q");
  const Attitude given = attitude(module, "in/vehicle_attitude_setpoint.q_d");
  const Attitude own = attitude(module, "out/vehicle_attitude_setpoint.q_d");
  const Reading is_own = signal(module, "out/vehicle_attitude_setpoint.published");
  std::vector<AttitudeError> errors;
  if (!q || !given) return errors;
  for (const Sample& sample : trace.samples) {
    const bool sticks = own && is_own(sample) != 0;
    errors.push_back(error_between(q(sample), sticks ? own(sample) : given(sample)));
  }
  return errors;
}

void add_of_attitude(Module module, const Trace& trace, std::vector<Condition>& conditions) {
  const auto errors =
      std::make_shared<const std::vector<AttitudeError>>(attitude_errors(module, trace));
  if (errors->empty()) return;
  const auto add = [&](std::string text, auto holds) {
    conditions.push_back({std::move(text), [errors, holds](std::size_t tick, int) {
                            return holds((*errors)[tick]);
                          }});
  };
  for (const double limit : {1.0, 30.0, 60.0, 90.0, 120.0, 150.0, 175.0}) {
    add(fmt::format("the tilt error exceeds {} deg", limit),
        [limit](const AttitudeError& error) { return error.tilt > limit; });
  }
  add("the tilt error is below 1 deg", [](const AttitudeError& error) { return error.tilt < 1; });
  for (const double limit : {1.0, 30.0, 90.0, 150.0, 175.0}) {
    add(fmt::format("the yaw error exceeds {} deg", limit),
        [limit](const AttitudeError& error) { return error.yaw > limit; });
  }
  add("there is a tilt error and a yaw error",
      [](const AttitudeError& error) { return error.tilt > 1 && error.yaw > 1; });
  add("the scalar part of the error quaternion is negative",
      [](const AttitudeError& error) { return error.is_negative; });
}

// Adds conditions, one at a time.
struct Adder {
  const Trace& trace;
  std::vector<Condition>& conditions;

  void of_sample(std::string text, std::function<bool(const Sample&)> holds) const {
    conditions.push_back(
        {std::move(text), [&samples = trace.samples, holds](std::size_t tick, int) {
           return holds(samples[tick]);
         }});
  }
  // About the axis of the output.
  void of_axis(std::string text, std::function<bool(const Sample&, std::size_t axis)> holds) const {
    conditions.push_back(
        {std::move(text), [&samples = trace.samples, holds](std::size_t tick, int axis) {
           return axis >= 0 && holds(samples[tick], static_cast<std::size_t>(axis));
         }});
  }
};

// The saturation of an axis in one direction.
Axes saturation(Module module, bool positive) {
  const Reading achieved = signal(module, "in/control_allocator_status.torque_setpoint_achieved");
  Axes flags;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!achieved) {
      flags[i] = signal(module,
                        fmt::format("in/saturation.{}[{}]", positive ? "positive" : "negative", i));
      continue;
    }
    const Reading torque =
        signal(module, fmt::format("in/control_allocator_status.unallocated_torque[{}]", i));
    flags[i] = [=](const Sample& sample) {
      return achieved(sample) == 0 && (positive ? torque(sample) > 0 : torque(sample) < 0);
    };
  }
  return flags;
}

void add_of_saturation(Module module, const Adder& add) {
  for (const bool positive : {true, false}) {
    const std::string direction = positive ? "positive" : "negative";
    const Axes flags = saturation(module, positive);
    if (!flags[0]) continue;
    add.of_axis(
        fmt::format("the {} direction of the same axis is saturated", direction),
        [flags](const Sample& sample, std::size_t axis) { return flags[axis](sample) != 0; });
    add.of_sample(fmt::format("the {} direction of an axis is saturated", direction),
                  [flags](const Sample& sample) {
                    return std::any_of(flags.begin(), flags.end(),
                                       [&](const Reading& one) { return one(sample) != 0; });
                  });
  }
}

void add_of_rates(Module module, const Adder& add) {
  const Axes rates = axes(
      module,
      {{"in/control_state.roll_rate", "in/control_state.pitch_rate", "in/control_state.yaw_rate"},
       {"in/vehicle_angular_velocity.xyz[0]", "in/vehicle_angular_velocity.xyz[1]",
        "in/vehicle_angular_velocity.xyz[2]"}});
  const bool own = module == Module::mc_att_control;
  const Axes setpoint =
      axes(module, {{own ? "out/vehicle_rates_setpoint.roll" : "in/vehicle_rates_setpoint.roll",
                     own ? "out/vehicle_rates_setpoint.pitch" : "in/vehicle_rates_setpoint.pitch",
                     own ? "out/vehicle_rates_setpoint.yaw" : "in/vehicle_rates_setpoint.yaw"}});
  if (!rates[0] || !setpoint[0]) return;
  for (const double limit : {100.0, 200.0, 400.0}) {
    add.of_axis(fmt::format("the rate error of the axis exceeds {} deg/s", limit),
                [=](const Sample& sample, std::size_t axis) {
                  return std::abs(setpoint[axis](sample) - rates[axis](sample)) > limit * degree;
                });
  }
  for (const double sign : {1.0, -1.0}) {
    add.of_axis(fmt::format("the rate error of the axis is {}", sign > 0 ? "positive" : "negative"),
                [=](const Sample& sample, std::size_t axis) {
                  return sign * (setpoint[axis](sample) - rates[axis](sample)) > 0;
                });
  }
}

void add_of_torque(Module module, const Adder& add) {
  const Axes torque =
      axes(module, {{"out/vehicle_torque_setpoint.xyz[0]", "out/vehicle_torque_setpoint.xyz[1]",
                     "out/vehicle_torque_setpoint.xyz[2]"},
                    {"out/actuator_controls_0.control[0]", "out/actuator_controls_0.control[1]",
                     "out/actuator_controls_0.control[2]"}});
  if (!torque[0]) return;
  add.of_axis("the torque of the axis is beyond -1 .. 1",
              [torque](const Sample& sample, std::size_t axis) {
                return std::abs(torque[axis](sample)) > 1;
              });
}

void add_of_parameters(const ModuleUnderTest& subject, const Adder& add) {
  const auto later = std::find_if(add.trace.parameters.begin(), add.trace.parameters.end(),
                                  [](const ParameterChange& one) { return one.tick > 0; });
  const std::size_t from =
      later == add.trace.parameters.end() ? add.trace.samples.size() : later->tick;
  add.conditions.push_back({"a parameter has changed since the first step",
                            [from](std::size_t tick, int) { return tick >= from; }});
  const ProfileInfo* const profile = find_profile(subject.profile);
  if (!profile) return;
  for (const Parameter& parameter : parameters_of(subject.module, *profile)) {
    const bool is_set = std::any_of(
        add.trace.parameters.begin(), add.trace.parameters.end(), [&](const auto& change) {
          return change.name == parameter.name && change.value != parameter.default_value;
        });
    add.conditions.push_back(
        {fmt::format("{} is not {:g}", parameter.name, parameter.default_value),
         [is_set](std::size_t, int) { return is_set; }, ConditionKind::parameter});
  }
}

void add_of_input(const Channel& channel, const Adder& add) {
  const auto value = [channel](const Sample& sample) { return value_of(channel, sample); };
  const std::string name = fmt::format("{}.{}", channel.topic(), channel.field());
  if (channel.type == ChannelType::bit) {
    add.of_sample(fmt::format("{} is new", channel.topic()),
                  [=](const Sample& sample) { return value(sample) != 0; });
  } else if (channel.quantity == Quantity::flag) {
    add.of_sample(name + " is set", [=](const Sample& sample) { return value(sample) != 0; });
    add.of_sample(name + " is not set", [=](const Sample& sample) { return value(sample) == 0; });
  } else if (channel.type == ChannelType::f32) {
    add.of_sample(name + " is not finite",
                  [=](const Sample& sample) { return !std::isfinite(value(sample)); });
    const bool is_yaw_command = channel.field() == "yaw_sp_move_rate" ||
                                name == "manual_control_setpoint.yaw" ||
                                name == "manual_control_setpoint.r";
    if (!is_yaw_command) return;
    add.of_sample(name + " is not 0", [=](const Sample& sample) { return value(sample) != 0; });
  }
}

}  // namespace

std::vector<Condition> conditions_of(const Trace& trace, const ModuleUnderTest& subject) {
  std::vector<Condition> conditions;
  const Adder add{trace, conditions};
  conditions.push_back({"it is the first step", [](std::size_t tick, int) { return tick == 0; }});
  add_of_attitude(subject.module, trace, conditions);
  add_of_saturation(subject.module, add);
  add_of_rates(subject.module, add);
  add_of_torque(subject.module, add);
  add_of_parameters(subject, add);
  const ChannelSet inputs = channels_of(subject.module, "in/");
  const std::size_t before = conditions.size();
  for (std::size_t i = 0; i < channels().size(); ++i) {
    if (inputs[i]) add_of_input(channels()[i], add);
  }
  for (std::size_t i = before; i < conditions.size(); ++i) {
    conditions[i].kind = ConditionKind::input;
  }
  return conditions;
}

}  // namespace attest
