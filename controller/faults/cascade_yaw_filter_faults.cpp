// Mistakes of the rate unit of the cascade in the low-pass of the yaw torque.
#include <cmath>

#include "controller/elementary/elementary.hpp"
#include "controller/faults/cascade_change.hpp"
#include "controller/faults/groups.hpp"

namespace attest::faults::in_cascade {
namespace {

using RateStepLaw = RateStepStages::Law;
using LowPass = RateStepStages::LowPass;

// Replaces the low-pass. Filter is Scalar(LowPass&, torque, dt_s, gains, traits).
template <typename Filter>
void change_yaw_filter(FaultyLaw& law, Filter filter) {
  change_stage(law.rate_unit.step.filtered_yaw, filter);
}

template <typename Tau>
void change_yaw_tau(FaultyLaw& law, Tau tau) {
  change_gains(law.rate_unit, [tau](RateUnitGains& gains, const CascadeParameters& p) {
    gains.yaw_torque_tau_s = tau(p.mc_yaw_tq_cutoff);
  });
}

// Whenever the integral is reset, the state of the low-pass becomes 0, too.
void restart_yaw_filter(FaultyLaw& law) {
  auto restarts = std::make_shared<bool>(false);
  auto& resets = law.rate_unit.step.resets_integral;
  change_stage(resets, [restarts](const auto& then, const cascade::RateTopics& topics) {
    return *restarts = then(topics);
  });
  change_yaw_filter(law, [restarts](const auto& then, LowPass& filter, Scalar torque, Scalar dt_s,
                                    const RateUnitGains& gains, const CascadeTraits& traits) {
    if (*restarts) filter.state = 0;
    return then(filter, torque, dt_s, gains, traits);
  });
}

// Roll and pitch are filtered, too.
void filter_all_axes(FaultyLaw& law) {
  struct Filters {
    LowPass roll, pitch;
    float dt_s = 0, tau_s = 0;
    CascadeTraits traits{};
  };
  auto filters = std::make_shared<Filters>();
  change_yaw_filter(law, [filters](const auto& then, LowPass& filter, Scalar torque, Scalar dt_s,
                                   const RateUnitGains& gains, const CascadeTraits& traits) {
    filters->dt_s = dt_s, filters->tau_s = gains.yaw_torque_tau_s, filters->traits = traits;
    return then(filter, torque, dt_s, gains, traits);
  });
  also_after(law.rate_unit, [filters](const RateIn&, RateOut& out) {
    if (out.vehicle_torque_setpoint.published == 0 || filters->dt_s == 0) return;
    float(&xyz)[3] = out.vehicle_torque_setpoint.xyz;
    xyz[0] = filters->roll.update(filters->tau_s, filters->dt_s, xyz[0], filters->traits);
    xyz[1] = filters->pitch.update(filters->tau_s, filters->dt_s, xyz[1], filters->traits);
  });
}

// Older profiles have no parameter for the cutoff, so the default of v1.16.0 is used: 2 Hz.
void filter_as_in_v1_16_0(FaultyLaw& law) {
  auto is_older = std::make_shared<bool>(false);
  change_traits(law.rate_unit, [is_older](CascadeTraits& traits) {
    *is_older = !traits.filters_yaw_torque;
    traits.filters_yaw_torque = true;
  });
  change_gains(law.rate_unit, [is_older](RateUnitGains& gains, const CascadeParameters&) {
    if (*is_older) gains.yaw_torque_tau_s = 1 / (6.28318548f * 2.0f);
  });
}

const Fault yaw_filter_list[] = {
    {"cascade-yaw-torque-not-filtered", "yaw_filter", Stage::yaw_filter,
     "does not filter the yaw torque, as v1.15.4", "a yaw rate error", "another version",
     follow<&CascadeTraits::filters_yaw_torque, false>},
    {"cascade-yaw-torque-filtered",
     "rates",
     Stage::yaw_filter,
     "filters the yaw torque as in v1.16.0",
     "a yaw rate error",
     "another version",
     filter_as_in_v1_16_0,
     {},
     until_v1_15_4},
    {"cascade-yaw-filter-without-2-pi", "yaw_filter", Stage::yaw_filter,
     "takes the time constant as 1 / MC_YAW_TQ_CUTOFF", "a yaw rate error", "a missing factor",
     [](FaultyLaw& law) {
       change_yaw_tau(law, [](float cutoff) { return cutoff > 1e-7f ? 1 / cutoff : 0.0f; });
     }},
    {"cascade-yaw-filter-by-tau", "yaw_filter", Stage::yaw_filter,
     "takes MC_YAW_TQ_CUTOFF as a time constant", "a yaw rate error", "a wrong unit",
     [](FaultyLaw& law) { change_yaw_tau(law, [](float cutoff) { return cutoff; }); }},
    {"cascade-yaw-filter-of-cutoff-0", "yaw_filter", Stage::yaw_filter,
     "filters with 2 Hz if MC_YAW_TQ_CUTOFF is 0", "MC_YAW_TQ_CUTOFF 0", "a wrong fallback",
     [](FaultyLaw& law) {
       change_yaw_tau(
           law, [](float cutoff) { return 1 / (6.28318548f * (cutoff > 1e-7f ? cutoff : 2.0f)); });
     }},
    {"cascade-yaw-filter-divides-by-0", "yaw_filter", Stage::yaw_filter,
     "divides by a cutoff of 0: the yaw torque never changes", "MC_YAW_TQ_CUTOFF 0",
     "a missing guard",
     [](FaultyLaw& law) {
       change_yaw_tau(law, [](float cutoff) { return 1 / (6.28318548f * cutoff); });
     }},
    {"cascade-yaw-filter-of-fixed-dt", "yaw_filter", Stage::yaw_filter, "filters with a dt of 1 ms",
     "any rate except 1 kHz", "a fixed rate",
     [](FaultyLaw& law) {
       change_yaw_filter(law, [](const auto& then, LowPass& filter, Scalar torque, Scalar,
                                 const RateUnitGains& gains, const CascadeTraits& traits) {
         return then(filter, torque, 0.001f, gains, traits);
       });
     }},
    {"cascade-yaw-filter-by-exp", "yaw_filter", Stage::yaw_filter, "weighs by 1 - exp(-dt / tau)",
     "a yaw rate error", "another filter",
     [](FaultyLaw& law) {
       change_yaw_filter(law, [](const auto&, LowPass& filter, Scalar torque, Scalar dt_s,
                                 const RateUnitGains& gains, const CascadeTraits&) {
         const float tau_s = gains.yaw_torque_tau_s;
         const float weight = tau_s > 0 ? 1 - elementary::exp(-dt_s / tau_s) : 1.0f;
         return filter.state += weight * (torque - filter.state);
       });
     }},
    {"cascade-yaw-filter-starts-at-torque", "yaw_filter", Stage::yaw_filter,
     "starts the filter at the first torque, not at 0", "a yaw rate error at the start",
     "initial state",
     [](FaultyLaw& law) {
       change_yaw_filter(
           law, [is_first = true](const auto& then, LowPass& filter, Scalar torque, Scalar dt_s,
                                  const RateUnitGains& gains, const CascadeTraits& traits) mutable {
             if (std::exchange(is_first, false)) filter.state = torque;
             return then(filter, torque, dt_s, gains, traits);
           });
     }},
    {"cascade-yaw-filter-restarts", "yaw_filter", Stage::yaw_filter,
     "sets the filter to 0 while disarmed", "a yaw rate error while disarmed", "a reset too many",
     restart_yaw_filter},
    {"cascade-yaw-filter-on-all-axes", "yaw_filter", Stage::yaw_filter,
     "filters roll and pitch torque, too", "a roll rate error", "an axis too many",
     filter_all_axes},
    {"cascade-yaw-filter-forgets-nan", "robustness", Stage::guard,
     "guards the yaw torque before the filter: a NaN does not stay", "one NaN of the gyro",
     "steps exchanged",
     [](FaultyLaw& law) {
       change_yaw_filter(law, [](const auto& then, LowPass& filter, Scalar torque, Scalar dt_s,
                                 const RateUnitGains& gains, const CascadeTraits& traits) {
         return then(filter, RateStepLaw::guarded(torque), dt_s, gains, traits);
       });
     }},
};

}  // namespace

std::span<const Fault> yaw_filter_faults() { return yaw_filter_list; }

}  // namespace attest::faults::in_cascade
