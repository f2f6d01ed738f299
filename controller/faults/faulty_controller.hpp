// The wrong controllers: a law with faults of the catalogue, and a controller or a unit of the
// cascade that runs it.
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "controller/attest_unit.h"
#include "controller/faults/fault.hpp"
#include "controller/faults/faulty_law.hpp"

namespace attest::faults {

// The law with all these faults at once.
FaultyLaw law_with(std::span<const Fault* const> faults);

// A controller of profile `px4-v1.5.5` or `px4-v1.3.4` with some faults.
class FaultyController {
 public:
  FaultyController(Profile profile, std::span<const Fault* const> faults);
  ~FaultyController();

  // Same as in McAttControl.
  bool set_parameter(std::string_view name, float value);
  void step(const attest_inputs& in, attest_outputs& out);

 private:
  FaultyLaw law_;
  struct Controller;
  std::unique_ptr<Controller> controller_;
};

// A unit of the cascade with some faults. Law is AttitudeUnitLaw or RateUnitLaw.
template <typename Law>
class FaultyUnit {
 public:
  using Inputs = typename Law::Inputs;
  using Outputs = typename Law::Outputs;

  FaultyUnit(cascade::Profile profile, std::span<const Fault* const> faults);

  // Same as in cascade::AttitudeUnit and cascade::RateUnit.
  bool set_parameter(std::string_view name, float value);
  void step(const Inputs& in, Outputs& out);

 private:
  Law law_;
  typename Law::Unit unit_;
};

using FaultyAttitudeUnit = FaultyUnit<AttitudeUnitLaw>;
using FaultyRateUnit = FaultyUnit<RateUnitLaw>;
extern template class FaultyUnit<AttitudeUnitLaw>;
extern template class FaultyUnit<RateUnitLaw>;

}  // namespace attest::faults
