#include "harness/port/fault_port.hpp"

#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "controller/actuation/unit_table.hpp"
#include "controller/cascade/profile.hpp"
#include "controller/faults/faulty_controller.hpp"
#include "controller/mc_att_control/profile.hpp"
#include "harness/core/suggestion.hpp"
#include "harness/port/faulty_pure_law.hpp"

namespace attest {
namespace {

using faults::Fault;

// Controller is FaultyController, FaultyAttitudeUnit or FaultyRateUnit.
template <typename Controller, typename Inputs, typename Outputs>
class FaultyUnit final : public UnitOf<Inputs, Outputs> {
 public:
  template <typename Profile>
  FaultyUnit(Profile profile, const std::vector<const Fault*>& faults)
      : controller_(profile, faults) {}

  int set_parameter(const std::string& name, float value) override {
    return controller_.set_parameter(name, value) ? ATTEST_OK : ATTEST_INVALID;
  }
  int step(const Inputs& in, Outputs& out) override {
    controller_.step(in, out);
    return ATTEST_OK;
  }

 private:
  Controller controller_;
};

using FaultyControllerUnit = FaultyUnit<faults::FaultyController, attest_inputs, attest_outputs>;
using FaultyAttitudeUnit =
    FaultyUnit<faults::FaultyAttitudeUnit, attest_attitude_inputs, attest_attitude_outputs>;
using FaultyRateUnit = FaultyUnit<faults::FaultyRateUnit, attest_rate_inputs, attest_rate_outputs>;

class FaultyMixer final : public UnitOf<attest_mixer_inputs, attest_mixer_outputs> {
 public:
  FaultyMixer(const actuation::MixerDefinition& definition, const faults::MixerStages& stages)
      : mixer_(definition, stages) {}

  int set_parameter(const std::string&, float) override { return ATTEST_INVALID; }
  int step(const attest_mixer_inputs& in, attest_mixer_outputs& out) override {
    actuation::step_mixer(mixer_, in, out);
    return ATTEST_OK;
  }

 private:
  actuation::BasicMixer<faults::Scalar, faults::MixerStages> mixer_;
};

class FaultyBattery final : public UnitOf<attest_battery_inputs, attest_battery_outputs> {
 public:
  explicit FaultyBattery(faults::BatteryStages stages) : stages_(std::move(stages)) {}

  int set_parameter(const std::string& name, float value) override {
    return actuation::set_battery_parameter(options_, name, value) ? ATTEST_OK : ATTEST_INVALID;
  }
  int step(const attest_battery_inputs& in, attest_battery_outputs& out) override {
    if (!battery_) battery_.emplace(options_, stages_);
    actuation::step_battery(*battery_, in, out);
    return ATTEST_OK;
  }

 private:
  actuation::BatteryOptions options_;
  faults::BatteryStages stages_;
  std::optional<actuation::BasicBatteryStatus<faults::Scalar, faults::BatteryStages>> battery_;
};

class FaultPort final : public Port {
 public:
  FaultPort(std::vector<const Fault*> faults, std::optional<int> fraction_bits)
      : faults_(std::move(faults)), fraction_bits_(fraction_bits) {}

  std::string name() const override {
    std::string name = "fault ";
    for (const Fault* fault : faults_) {
      if (fault != faults_.front()) name += '+';
      name += fault->id;
    }
    return name;
  }
  std::string version() const override { return "of the catalogue"; }
  std::optional<int> fraction_bits() const override { return fraction_bits_; }
  ModuleSet modules() const override { return ModuleSet().set(); }
  std::unique_ptr<Unit> create_unit(Module module, const std::string& profile,
                                    const std::string& definition) override {
    switch (module) {
      case Module::mc_att_control:
        return make<FaultyControllerUnit>(mc_att_control::profile_from_name(profile));
      case Module::attitude_unit:
        return make<FaultyAttitudeUnit>(cascade::profile_from_name(profile));
      case Module::rate_unit:
        return make<FaultyRateUnit>(cascade::profile_from_name(profile));
      case Module::battery_status:
        if (!actuation::is_profile(profile.c_str())) return nullptr;
        return std::make_unique<FaultyBattery>(faults::law_with(faults_).battery);
      case Module::mixer:
        return make_mixer(profile, definition);
      case Module::attitude_law:
      case Module::rate_law:
        return make_faulty_law(module, profile, faults::law_with(faults_));
    }
    return nullptr;
  }

 private:
  // Returns null if there is no profile.
  template <typename Made, typename Profile>
  std::unique_ptr<Unit> make(std::optional<Profile> profile) const {
    return profile ? std::make_unique<Made>(*profile, faults_) : nullptr;
  }

  std::unique_ptr<Unit> make_mixer(const std::string& profile,
                                   const std::string& definition) const {
    const auto parsed = actuation::parse_mixer(definition);
    if (!parsed || !actuation::is_profile(profile.c_str())) return nullptr;
    return std::make_unique<FaultyMixer>(*parsed, faults::law_with(faults_).mixer);
  }

  std::vector<const Fault*> faults_;
  std::optional<int> fraction_bits_;
};

}  // namespace

Result<std::unique_ptr<Port>> open_fault(std::string_view ids, std::optional<int> fraction_bits) {
  std::vector<const Fault*> faults;
  for (std::size_t at = 0; at <= ids.size();) {
    const std::size_t end = std::min(ids.find('+', at), ids.size());
    const std::string_view id = ids.substr(at, end - at);
    const Fault* fault = faults::find_fault(id);
    if (fault == nullptr) {
      std::vector<std::string> known;
      for (const Fault* one : faults::catalogue()) known.emplace_back(one->id);
      return fail(fmt::format("no fault `{}`{}; `attest faults --list` shows all", id,
                              suggestion(id, known)));
    }
    faults.push_back(fault);
    at = end + 1;
  }
  return open_faults(std::move(faults), fraction_bits);
}

std::unique_ptr<Port> open_faults(std::vector<const Fault*> faults,
                                  std::optional<int> fraction_bits) {
  return std::make_unique<FaultPort>(std::move(faults), fraction_bits);
}

}  // namespace attest
