#include "harness/golden/margins.hpp"

#include <utility>

#include "harness/golden/margin_meters.hpp"

namespace attest {
namespace {

// The meter that one of the two makes: that of v1.14 and later, or that of v1.5.5 and v1.3.4.
std::unique_ptr<MarginMeter> either(std::unique_ptr<MarginMeter> of_cascade,
                                    std::unique_ptr<MarginMeter> of_controller) {
  return of_cascade ? std::move(of_cascade) : std::move(of_controller);
}

}  // namespace

const Margins& MarginMeter::step(std::span<const ParameterChange> changes, const Sample& sample) {
  notes_.margins = {};
  measure(changes, sample);
  ++notes_.tick;
  return notes_.margins;
}

std::unique_ptr<MarginMeter> margin_meter(const ModuleUnderTest& subject) {
  switch (subject.module) {
    case Module::mc_att_control:
      return controller_meter(subject.profile);
    case Module::mixer:
      return mixer_meter(subject.mixer);
    case Module::attitude_unit:
      return attitude_unit_meter(subject.profile);
    case Module::rate_unit:
      return rate_unit_meter(subject.profile);
    case Module::attitude_law:
      return either(attitude_law_meter(subject.profile), old_attitude_law_meter(subject.profile));
    case Module::rate_law:
      return either(rate_law_meter(subject.profile), old_rate_law_meter(subject.profile));
    case Module::battery_status:  // has no thresholds
      break;
  }
  return nullptr;
}

Margins margins(const Trace& given, MarginMeter& meter) {
  PendingChanges changes(given.parameters);
  Margins all;
  for (std::size_t tick = 0; tick < given.samples.size(); ++tick) {
    all.note(meter.step(changes.take_until(tick), given.samples[tick]), tick);
  }
  return all;
}

}  // namespace attest
