// The meters of the modules, for margin_meter() alone.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "harness/golden/margins.hpp"

namespace attest {

// Null if the profile is unknown or the definition is wrong.
std::unique_ptr<MarginMeter> controller_meter(const std::string& profile);
std::unique_ptr<MarginMeter> mixer_meter(const std::string& definition);
std::unique_ptr<MarginMeter> attitude_unit_meter(const std::string& profile);
std::unique_ptr<MarginMeter> rate_unit_meter(const std::string& profile);

// The meter of a unit: steps the unit in double, with a law that records its distances. `In` and
// `Out` are the ABI structs of the unit.
template <typename Unit, typename NotingLaw, typename In, typename Out>
class UnitMeter : public MarginMeter {
 public:
  // `in`: the member of a sample that has the unit's inputs.
  template <typename Profile>
  UnitMeter(Profile profile, In Sample::*in) : in_(in), unit_(profile, NotingLaw(&notes_)) {}

 protected:
  void measure(std::span<const ParameterChange> changes, const Sample& sample) override {
    for (const ParameterChange& change : changes) unit_.set_parameter(change.name, change.value);
    unit_.step(sample.*in_, out_);
  }

 private:
  In Sample::*in_;
  Unit unit_;
  Out out_{};
};

}  // namespace attest
