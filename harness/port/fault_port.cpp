#include "harness/port/fault_port.hpp"

#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "controller/actuation/unit_table.hpp"
#include "controller/faults/faulty_controller.hpp"
#include "controller/reference/profile.hpp"
#include "harness/core/suggestion.hpp"

namespace attest {
namespace {

using faults::Fault;

class FaultyUnit final : public UnitOf<attest_inputs, attest_outputs> {
 public:
  FaultyUnit(reference::Profile profile, const std::vector<const Fault*>& faults)
      : controller_(profile, faults) {}

  int set_parameter(const std::string& name, float value) override {
    return controller_.set_parameter(name, value) ? ATTEST_OK : ATTEST_INVALID;
  }
  int step(const attest_inputs& in, attest_outputs& out) override {
    controller_.step(in, out);
    return ATTEST_OK;
  }

 private:
  faults::FaultyController controller_;
};

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
  FaultPort(std::string ids, std::vector<const Fault*> faults, std::optional<int> fraction_bits)
      : ids_(std::move(ids)), faults_(std::move(faults)), fraction_bits_(fraction_bits) {}

  std::string name() const override { return "fault " + ids_; }
  std::string version() const override { return "of the catalogue"; }
  std::optional<int> fraction_bits() const override { return fraction_bits_; }
  ModuleSet modules() const override {
    return only(Module::mc_att_control) | only(Module::mixer) | only(Module::battery_status);
  }
  std::unique_ptr<Unit> create_unit(Module module, const std::string& profile,
                                    const std::string& definition) override {
    if (module == Module::mc_att_control) {
      const auto known = reference::profile_from_name(profile);
      return known ? std::make_unique<FaultyUnit>(*known, faults_) : nullptr;
    }
    if (!actuation::is_profile(profile.c_str())) return nullptr;
    if (module == Module::battery_status) {
      return std::make_unique<FaultyBattery>(faults::law_with(faults_).battery);
    }
    const auto parsed = actuation::parse_mixer(definition);
    if (!parsed) return nullptr;
    return std::make_unique<FaultyMixer>(*parsed, faults::law_with(faults_).mixer);
  }

 private:
  std::string ids_;
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
  return std::make_unique<FaultPort>(std::string(ids), std::move(faults), fraction_bits);
}

}  // namespace attest
