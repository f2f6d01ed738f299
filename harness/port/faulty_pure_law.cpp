#include "harness/port/faulty_pure_law.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "controller/cascade/law_table.hpp"
#include "harness/trace/channels.hpp"

namespace attest {
namespace {

using faults::FaultyLaw;
using faults::Scalar;
using NewAttitudeLaw = cascade::PureAttitudeLaw<Scalar, faults::AttitudeUnitLaw>;
using OldAttitudeLaw = mc_att_control::PureAttitudeLaw<Scalar, FaultyLaw>;
using NewRateLaw = cascade::PureRateLaw<Scalar, faults::RateUnitLaw>;
using OldRateLaw = mc_att_control::PureRateLaw<Scalar, FaultyLaw>;

// Signals that the controller of v1.5.5 names otherwise than the laws.
constexpr std::pair<std::string_view, std::string_view> in_controller[] = {
    {"in/vehicle_attitude.q[0]", "in/control_state.q[0]"},
    {"in/vehicle_attitude.q[1]", "in/control_state.q[1]"},
    {"in/vehicle_attitude.q[2]", "in/control_state.q[2]"},
    {"in/vehicle_attitude.q[3]", "in/control_state.q[3]"},
    {"in/vehicle_angular_velocity.xyz[0]", "in/control_state.roll_rate"},
    {"in/vehicle_angular_velocity.xyz[1]", "in/control_state.pitch_rate"},
    {"in/vehicle_angular_velocity.xyz[2]", "in/control_state.yaw_rate"},
    {"out/vehicle_torque_setpoint.xyz[0]", "out/actuator_controls_0.control[0]"},
    {"out/vehicle_torque_setpoint.xyz[1]", "out/actuator_controls_0.control[1]"},
    {"out/vehicle_torque_setpoint.xyz[2]", "out/actuator_controls_0.control[2]"},
    {"out/rate_ctrl_status.rollspeed_integ", "out/mc_att_ctrl_status.roll_rate_integ"},
    {"out/rate_ctrl_status.pitchspeed_integ", "out/mc_att_ctrl_status.pitch_rate_integ"},
    {"out/rate_ctrl_status.yawspeed_integ", "out/mc_att_ctrl_status.yaw_rate_integ"},
};

// The signals that a law shares with the unit around it.
class SharedSignals {
 public:
  SharedSignals(Module law, Module unit) {
    for (const Channel& channel : channels()) {
      if (channel.module != law) continue;
      const auto in_unit = find_channel(unit, name_in(unit, channel.name));
      if (in_unit) pairs_.emplace_back(&channel, &channels()[*in_unit]);
    }
  }

  void to_unit(const Sample& law, Sample& unit) const {
    for (const auto& [from, to] : pairs_) set_value(*to, unit, value_of(*from, law));
  }
  void to_law(const Sample& unit, Sample& law) const {
    for (const auto& [to, from] : pairs_) set_value(*to, law, value_of(*from, unit));
  }

 private:
  static std::string_view name_in(Module unit, std::string_view name) {
    if (unit != Module::mc_att_control) return name;
    for (const auto& [of_law, of_controller] : in_controller) {
      if (of_law == name) return of_controller;
    }
    return name;
  }

  std::vector<std::pair<const Channel*, const Channel*>> pairs_;
};

// The law between the changes that a fault makes to the unit's inputs and outputs.
template <typename New, typename Old>
class FaultyPureLaw final : public Unit {
 public:
  FaultyPureLaw(Module module, const FaultyLaw& law, std::unique_ptr<std::variant<New, Old>> pure)
      : module_(module),
        is_old_(std::holds_alternative<Old>(*pure)),
        law_(law),
        pure_(std::move(pure)),
        shared_(module, unit()) {
    unit_.in.updated = ~std::uint32_t{0};
    for (const Channel& channel : channels()) {
      if (channel.module != unit()) continue;
      const bool is_set =
          channel.is_published_flag() || std::ranges::find(set, channel.field()) != set.end();
      if (is_set) set_value(channel, unit_, 1);
    }
  }

  int set_parameter(const std::string&, float) override { return ATTEST_INVALID; }

  int step_structs(const void* in, void* out) override {
    const ModuleInfo& info = info_of(module_);
    Sample sample;
    std::memcpy(info.in.in(sample), in, info.in.size);
    shared_.to_unit(sample, unit_);
    before();
    shared_.to_law(unit_, sample);
    step(sample);
    shared_.to_unit(sample, unit_);
    after();
    shared_.to_law(unit_, sample);
    std::memcpy(out, info.out.in(sample), info.out.size);
    return ATTEST_OK;
  }

 private:
  // The flags of a vehicle that flies by this law.
  static constexpr std::array<std::string_view, 5> set{"armed", "flag_armed", "is_rotary_wing",
                                                       "flag_control_rates_enabled",
                                                       "flag_control_attitude_enabled"};

  Module unit() const {
    if (is_old_) return Module::mc_att_control;
    return module_ == Module::rate_law ? Module::rate_unit : Module::attitude_unit;
  }

  void before() {
    if (is_old_) return law_.before(unit_.in);
    if (module_ == Module::rate_law) return law_.rate_unit.before(unit_.rate_in);
    law_.attitude_unit.before(unit_.attitude_in);
  }

  void after() {
    if (is_old_) return law_.after(unit_.in, unit_.out);
    if (module_ == Module::rate_law) return law_.rate_unit.after(unit_.rate_in, unit_.rate_out);
    law_.attitude_unit.after(unit_.attitude_in, unit_.attitude_out);
  }

  void step(Sample& sample) {
    if constexpr (std::is_same_v<New, NewRateLaw>) {
      cascade::step_law(*pure_, sample.rate_law.in, sample.rate_law_out);
    } else {
      cascade::step_law(*pure_, sample.attitude_law.in, sample.attitude_law_out);
    }
  }

  Module module_;
  bool is_old_;
  FaultyLaw law_;
  std::unique_ptr<std::variant<New, Old>> pure_;
  SharedSignals shared_;
  Sample unit_;  // the inputs and outputs that the unit would have
};

template <typename New, typename Old, typename UnitLaw>
std::unique_ptr<Unit> made(Module module, const std::string& profile, const FaultyLaw& law,
                           const UnitLaw& of_unit) {
  auto pure = cascade::make_law<New, Old>(profile, of_unit, law);
  if (!pure) return nullptr;
  return std::make_unique<FaultyPureLaw<New, Old>>(module, law, std::move(pure));
}

}  // namespace

std::unique_ptr<Unit> make_faulty_law(Module module, const std::string& profile,
                                      const FaultyLaw& law) {
  return module == Module::rate_law
             ? made<NewRateLaw, OldRateLaw>(module, profile, law, law.rate_unit)
             : made<NewAttitudeLaw, OldAttitudeLaw>(module, profile, law, law.attitude_unit);
}

}  // namespace attest
