#include "controller/faults/faulty_controller.hpp"

#include <type_traits>

#include "controller/cascade/attitude_unit_definition.hpp"
#include "controller/cascade/rate_unit_definition.hpp"
#include "controller/mc_att_control/mc_att_control_definition.hpp"

namespace attest::faults {

FaultyLaw law_with(std::span<const Fault* const> faults) {
  FaultyLaw law;
  for (const Fault* fault : faults) fault->inject(law);
  return law;
}

struct FaultyController::Controller {
  mc_att_control::McAttControl<Scalar, FaultyLaw> control;
};

// The law is copied into the controller. State that its functions share with `before` and `after`
// is therefore held by pointer.
FaultyController::FaultyController(Profile profile, std::span<const Fault* const> faults)
    : law_(law_with(faults)),
      controller_(std::make_unique<Controller>(
          Controller{mc_att_control::McAttControl<Scalar, FaultyLaw>(profile, law_)})) {}

FaultyController::~FaultyController() = default;

bool FaultyController::set_parameter(std::string_view name, float value) {
  return controller_->control.set_parameter(name, value);
}

void FaultyController::step(const attest_inputs& in, attest_outputs& out) {
  attest_inputs given = in;
  law_.before(given);
  controller_->control.step(given, out);
  law_.after(given, out);
}

namespace {

template <typename Law>
Law part_of(const FaultyLaw& law) {
  if constexpr (std::is_same_v<Law, AttitudeUnitLaw>) {
    return law.attitude_unit;
  } else {
    return law.rate_unit;
  }
}

}  // namespace

template <typename Law>
FaultyUnit<Law>::FaultyUnit(cascade::Profile profile, std::span<const Fault* const> faults)
    : law_(part_of<Law>(law_with(faults))), unit_(profile, law_) {}

template <typename Law>
bool FaultyUnit<Law>::set_parameter(std::string_view name, float value) {
  return unit_.set_parameter(name, value);
}

template <typename Law>
void FaultyUnit<Law>::step(const Inputs& in, Outputs& out) {
  Inputs given = in;
  law_.before(given);
  unit_.step(given, out);
  law_.after(given, out);
}

template class FaultyUnit<AttitudeUnitLaw>;
template class FaultyUnit<RateUnitLaw>;

}  // namespace attest::faults
