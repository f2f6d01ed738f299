// The rate unit with stages that record its distances from decisions.
#include <cmath>
#include <limits>

#include "controller/cascade/pure_laws.hpp"
#include "controller/cascade/rate_unit_definition.hpp"
#include "harness/golden/margin_meters.hpp"

namespace attest {
namespace {

// The distance of |value| from the threshold FLT_EPSILON, as a ratio: negative below it.
double from_epsilon(double value) { return std::abs(value) / double(cascade::epsilon) - 1; }

// The law treats non-finite values differently. A value beyond the largest float is finite in
// double, but not in a float port.
void note_overflow(double value, MarginNotes& notes) {
  constexpr double largest = std::numeric_limits<float>::max();
  notes.note(Decision::overflow, std::abs(value) / largest - 1);
}

struct NotingRateLaw : cascade::RateStages<double> {
  using Law = cascade::RateStages<double>;
  MarginNotes* notes;

  cascade::Saturation saturation(const Allocation& status) const {
    for (const float torque : status.unallocated_torque) {
      // Exactly 0 is the same in every port.
      if (status.torque_setpoint_achieved == 0 && torque != 0) {
        notes->note(Decision::saturation_flag, from_epsilon(torque));
      }
    }
    return Law::saturation(status);
  }
  double limited(double next, double before, double max) const {
    note_overflow(next, *notes);
    return Law::limited(next, before, max);
  }
};

struct NotingRateStep : cascade::RateStepStages<double> {
  using Law = cascade::RateStepStages<double>;
  MarginNotes* notes;

  cascade::RateUnitGains<double> gains(const cascade::Parameters& parameters) const {
    const double cutoff_Hz = parameters.mc_yaw_tq_cutoff;
    if (cutoff_Hz > 0) notes->note(Decision::yaw_cutoff, from_epsilon(cutoff_Hz));
    return Law::gains(parameters);
  }
  double guarded(double torque) const {
    note_overflow(torque, *notes);
    return Law::guarded(torque);
  }
  double battery_scale(double before,
                       const decltype(attest_rate_inputs::battery_status)& sample) const {
    // Every port takes a scale of exactly 0 as no scaling.
    if (sample.connected != 0 && sample.scale != 0) {
      notes->note(Decision::battery_scale, double(sample.scale));
    }
    return Law::battery_scale(before, sample);
  }
};

struct NotingRateUnit {
  NotingRateStep step;
  NotingRateLaw rate;

  explicit NotingRateUnit(MarginNotes* notes) : step{{}, notes}, rate{{}, notes} {}
};

using RateUnitMeter = UnitMeter<cascade::RateUnit<double, NotingRateUnit>, NotingRateUnit,
                                attest_rate_inputs, attest_rate_outputs>;
using RateLawMeter = UnitMeter<cascade::PureRateLaw<double, NotingRateUnit>, NotingRateUnit,
                               attest_rate_law_inputs, attest_rate_law_outputs>;

}  // namespace

std::unique_ptr<MarginMeter> rate_unit_meter(const std::string& profile) {
  return meter_of<RateUnitMeter>(cascade::profile_from_name(profile), Module::rate_unit);
}

std::unique_ptr<MarginMeter> rate_law_meter(const std::string& profile) {
  return meter_of<RateLawMeter>(cascade::profile_from_name(profile), Module::rate_law);
}

}  // namespace attest
