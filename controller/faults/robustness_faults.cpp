// Wrong treatment of values that are not finite.
#include <algorithm>
#include <array>
#include <cmath>

#include "controller/faults/groups.hpp"

namespace attest::faults {
namespace {

const Fault robustness_list[] = {
    {"guard-missing", "robustness", Stage::guard, "publishes NaN and infinity", "a NaN rate",
     "NaN handling", [](FaultyLaw& law) { law.step.guarded = [](float value) { return value; }; }},
    {"guard-zero-only", "robustness", Stage::guard, "tests `x ? x : 0` instead of isfinite(x)",
     "a NaN rate", "NaN handling",
     [](FaultyLaw& law) {
       law.step.guarded = [](float value) { return value != 0 ? value : 0.0f; };
     }},
    {"guard-nan-only", "robustness", Stage::guard, "publishes infinity", "an infinite rate",
     "NaN handling",
     [](FaultyLaw& law) {
       law.step.guarded = [](float value) { return std::isnan(value) ? 0.0f : value; };
     }},
    {"guard-holds", "robustness", Stage::guard, "holds the last finite value", "a NaN rate",
     "NaN handling",
     [](FaultyLaw& law) {
       law.step.guarded = [last = std::array<float, 4>{}, i = 0u](float value) mutable {
         float& kept = last[i++ % 4];
         return kept = std::isfinite(value) ? value : kept;
       };
     }},
    {"guard-stops-all", "robustness", Stage::guard, "zeroes all axes where one is not finite",
     "a NaN on one axis", "NaN handling",
     [](FaultyLaw& law) {
       auto bad = std::make_shared<bool>(false);
       change_stage(law.rate.control, [bad](const auto& then, const Vector& p, const Vector& d,
                                            const Vector& i, const Vector& ff) {
         const Vector control = then(p, d, i, ff);
         *bad = !control.allFinite();
         return *bad ? Vector(Vector::Zero()) : control;
       });
     }},
    {"clamp-catches-nan", "robustness", Stage::guard, "clamps NaN to the limit", "a NaN attitude",
     "NaN handling",
     [](FaultyLaw& law) {
       law.attitude.limit = [](const Vector& rates, bool autonomous, const AttitudeGains& gains) {
         const Vector bound = autonomous ? gains.auto_rate_max_rad_s : gains.rate_max_rad_s;
         Vector limited;
         for (int i = 0; i < 3; ++i) {
           limited[i] = std::fmin(std::fmax(rates[i], -bound[i]), bound[i]);
         }
         return limited;
       };
     }},
    {"nan-throttle-is-nan", "robustness", Stage::guard, "passes a NaN throttle in acro",
     "a NaN throttle in acro", "NaN handling",
     [](FaultyLaw& law) {
       change_stage(law.step.acro, [](const auto& then, const decltype(Topics::manual)& manual,
                                      const Gains& gains) {
         RateCommand command = then(manual, gains);
         command.thrust_sp = manual.z > 0.9f ? 0.9f : manual.z;
         return command;
       });
     }},
    {"nan-thrust-no-p",
     "robustness",
     Stage::guard,
     "uses an attenuation factor of 0 at a NaN thrust",
     "a NaN thrust",
     "NaN handling",
     [](FaultyLaw& law) {
       change_stage(law.rate.throttle_attenuation,
                    [](const auto& then, float thrust, const RateGains& gains) {
                      const float factor = then(thrust, gains);
                      return std::isnan(thrust) ? 0.0f : factor;
                    });
     },
     {},
     mc_att_control::from_v1_5_5},
    {"nan-poisons-integral", "robustness", Stage::guard,
     "inverts the comparisons of the gates, so that NaN passes", "a NaN rate", "NaN handling",
     [](FaultyLaw& law) {
       law.rate.integrate_axis = [](float integral, float control, float thrust, float growth,
                                    bool frozen) {
         const float next = integral + growth;
         const float bound = mc_att_control::integral_limit;
         const bool shut = std::abs(control) >= thrust || next <= -bound || next >= bound ||
                           control <= -bound || control >= bound || frozen;
         return shut ? integral : next;
       };
     }},
    {"nan-rates-skipped", "robustness", Stage::guard, "replaces a NaN rate by the last rate",
     "a NaN rate", "a helpful extra",
     [](FaultyLaw& law) {
       also_before(law, [last = std::array<float, 3>{}](attest_inputs& in) mutable {
         float* const rates[] = {&in.control_state.roll_rate, &in.control_state.pitch_rate,
                                 &in.control_state.yaw_rate};
         for (std::size_t i = 0; i < 3; ++i) {
           if (std::isnan(*rates[i])) *rates[i] = last[i];
           last[i] = *rates[i];
         }
       });
     }},
    {"zero-quat-is-level", "robustness", Stage::guard, "treats an all-zero quaternion as level",
     "a setpoint of zeros", "a helpful extra",
     [](FaultyLaw& law) {
       also_before(law, [](attest_inputs& in) {
         for (float* q : {in.control_state.q, in.vehicle_attitude_setpoint.q_d}) {
           if (q[0] == 0 && q[1] == 0 && q[2] == 0 && q[3] == 0) q[0] = 1;
         }
       });
     }},
    {"nan-stops-the-step", "robustness", Stage::guard, "publishes nothing for a NaN attitude",
     "a NaN attitude", "a helpful extra",
     [](FaultyLaw& law) {
       also_after(law, [](const attest_inputs& in, attest_outputs& out) {
         const float* q = in.control_state.q;
         if (std::isfinite(q[0] + q[1] + q[2] + q[3])) return;
         out.vehicle_rates_setpoint.published = 0;
         out.actuator_controls_0.published = 0;
       });
     }},
    {"fast-math", "robustness", Stage::guard, "assumes that all values are finite", "a NaN rate",
     "fast math",
     [](FaultyLaw& law) {
       law.step.guarded = [](float value) { return value; };
       law.rate.throttle_attenuation = [](float thrust, const RateGains& gains) {
         const float factor = 1 - gains.tpa_slope * (std::abs(thrust) - gains.tpa_break);
         return std::min(std::max(factor, 0.0f), 1.0f);
       };
     }},
};

}  // namespace

std::span<const Fault> robustness_faults() { return robustness_list; }

}  // namespace attest::faults
