// The meters of the modules, for margin_meter() alone.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>

#include "harness/golden/margins.hpp"

namespace attest {

// Null if the profile is unknown or the definition is wrong.
std::unique_ptr<MarginMeter> controller_meter(const std::string& profile);
std::unique_ptr<MarginMeter> mixer_meter(const std::string& definition);
std::unique_ptr<MarginMeter> attitude_unit_meter(const std::string& profile);
std::unique_ptr<MarginMeter> rate_unit_meter(const std::string& profile);
// Of the pure laws of v1.14 and later, and of those of v1.5.5 and v1.3.4.
std::unique_ptr<MarginMeter> attitude_law_meter(const std::string& profile);
std::unique_ptr<MarginMeter> rate_law_meter(const std::string& profile);
std::unique_ptr<MarginMeter> old_attitude_law_meter(const std::string& profile);
std::unique_ptr<MarginMeter> old_rate_law_meter(const std::string& profile);

// The meter of a unit or law: steps it in double, with stages that record its distances. `In` and
// `Out` are its structs of the ABI.
template <typename Unit, typename NotingLaw, typename In, typename Out>
class UnitMeter : public MarginMeter {
 public:
  template <typename Profile>
  UnitMeter(Profile profile, Module module)
      : in_(info_of(module).in), unit_(profile, NotingLaw(&notes_)) {}

 protected:
  void measure(std::span<const ParameterChange> changes, const Sample& sample) override {
    if constexpr (requires { unit_.set_parameter("", 0.0f); }) {
      for (const ParameterChange& change : changes) unit_.set_parameter(change.name, change.value);
    }
    unit_.step(*static_cast<const In*>(in_.in(sample)), out_);
  }

 private:
  Block in_;  // the inputs in a sample
  Unit unit_;
  Out out_{};
};

// Null without a profile.
template <typename Meter, typename Profile>
std::unique_ptr<MarginMeter> meter_of(std::optional<Profile> profile, Module module) {
  return profile ? std::make_unique<Meter>(*profile, module) : nullptr;
}

}  // namespace attest
